//! Surfaces of a run's particles: marching cubes over a smoothed density (Löschner et al. 2023, `splashsurf_lib`), a
//! mesh a frame.

mod mesh_file;
mod sequence;

use std::path::Path;
use std::sync::Mutex;

use glam::DVec3;
use rayon::prelude::*;
use splashsurf_lib::nalgebra::Vector3;
use splashsurf_lib::{Parameters, reconstruct_surface};

use super::bar::Bar;
use super::folder::is_surface;
use super::{disk, interrupt};
use crate::error::{Error, Result};
use crate::files;
use crate::scene::Dimensions;
use crate::scene::particle_file;

pub use mesh_file::{MESH_FORMATS, MeshFormat};
pub use sequence::Sequence;

/// Cubes along a side of all particles.
const MOST_CUBES: f64 = 1e6;

/// How a surface is made. Lengths are in particle radii, as splashsurf counts them.
#[derive(Debug, Clone)]
pub struct SurfaceSettings {
    /// Metres; the run's own when left out.
    pub radius: Option<f64>,
    /// The kernel reaches twice as far.
    pub smoothing_length: f64,
    /// Edge of a marching cube.
    pub cube_size: f64,
    /// Density on the surface, as a share of the rest density.
    pub threshold: f64,
    pub normals: bool,
    pub format: &'static MeshFormat,
    /// Whether meshes that are there may be replaced.
    pub force: bool,
    /// Whether no progress is shown.
    pub quiet: bool,
}

/// What was made.
#[derive(Debug, Default)]
pub struct Made {
    pub meshes: u32,
    pub triangles: u64,
    /// Frames whose particles gave no surface.
    pub empty: Vec<u32>,
}

/// A mesh with global coordinates.
struct SurfaceMesh {
    /// Metres.
    vertices: Vec<DVec3>,
    /// Of length one, outward; one a vertex, or none.
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// Makes a mesh of each frame that has particle files. Ends early, with what is done, after Ctrl-C.
pub fn make_surfaces(recorded: &Sequence, out: &Path, settings: &SurfaceSettings) -> Result<Made> {
    let target = |frame: u32| out.join(format!("surface_{frame:06}.{}", settings.format.name));
    let reach = 2.0 * settings.smoothing_length;
    if settings.cube_size > reach {
        return Err(Error::usage(
            format!(
                "cubes of {} radii are larger than what the kernel reaches, {reach} radii",
                settings.cube_size
            ),
            "make --cube-size smaller, or --smoothing-length larger",
        ));
    }
    let there = recorded
        .frames
        .iter()
        .filter(|(frame, _)| target(*frame).exists())
        .count();
    if there > 0 && !settings.force {
        return Err(Error::usage(
            format!("{} has {there} of these surfaces already", out.display()),
            "replace them with --force, or choose another folder with --out",
        ));
    }
    let targets = recorded.frames.iter().map(|(frame, _)| target(*frame));
    let mut there = targets.filter(|path| path.exists() || files::is_link(path));
    if let Some(other) = there.find(|path| !is_surface(path)) {
        return Err(Error::usage(
            format!("{} is no surface that Sliceflow has written", other.display()),
            "move it to another place, or choose another folder with --out",
        ));
    }
    std::fs::create_dir_all(out).map_err(|reason| disk::failed(out, "create", reason))?;
    let bar = Bar::new(
        "{bar:30} {pos}/{len} surfaces, {eta} left",
        recorded.frames.len() as u32,
    );
    let (shown, quiet) = (bar.clone(), settings.quiet);
    if quiet {
        bar.clear();
    }
    interrupt::listen(move || {
        let told = format!(
            "note: stopping when the surfaces under way are made; {}",
            interrupt::AGAIN
        );
        if !quiet {
            shown.suspend(|| eprintln!("{told}"));
        }
    });
    let made = Mutex::new(Made::default());
    let done = recorded.frames.par_iter().try_for_each(|(frame, file)| {
        if interrupt::asked() {
            return Ok(());
        }
        let triangles = match surface(file, recorded.radius, settings)? {
            Some(mesh) => {
                disk::write(&target(*frame), &(settings.format.encode)(&mesh))?;
                mesh.triangles.len() as u64
            }
            None => 0,
        };
        let mut made = made.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match triangles {
            0 => made.empty.push(*frame),
            _ => made.meshes += 1,
        }
        made.triangles += triangles;
        bar.advance();
        Ok(())
    });
    bar.clear();
    let mut made = made
        .into_inner()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    made.empty.sort_unstable();
    done?;
    if interrupt::asked() {
        return Err(Error::interrupted(format!(
            "{} finished surfaces are on disk",
            made.meshes
        )));
    }
    Ok(made)
}

fn surface(file: &Path, recorded: f64, settings: &SurfaceSettings) -> Result<Option<SurfaceMesh>> {
    let particles = particle_file::load(file, Dimensions::Three)
        .map_err(|what| Error::usage(what, "run the scene again, or remove that frame's files"))?;
    // Single precision around the particles' own corner, so that nothing is lost far from zero.
    let origin = particles
        .position
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let local: Vec<Vector3<f32>> = particles
        .position
        .iter()
        .map(|p| Vector3::from((*p - origin).as_vec3().to_array()))
        .collect();
    let radius = settings.radius.unwrap_or(recorded) as f32;
    let extent = local.iter().flatten().copied().fold(0.0, f32::max);
    let cubes = f64::from(extent) / (settings.cube_size * f64::from(radius));
    if cubes > MOST_CUBES || cubes.is_nan() {
        return Err(Error::file(
            file,
            "make a surface of",
            format!("{cubes:.1e} cubes would stand along one side"),
            format!("make cubes larger with --cube-size or --radius: at most {MOST_CUBES:e} along a side"),
        ));
    }
    let mut parameters = Parameters::new_relative(
        radius,
        2.0 * settings.smoothing_length as f32,
        settings.cube_size as f32,
    );
    parameters.iso_surface_threshold = settings.threshold as f32;
    let mesh = reconstruct_surface::<i64, f32>(&local, &parameters)
        .map_err(|reason| {
            Error::file(
                file,
                "make a surface of",
                reason,
                "larger cubes (--cube-size) need less memory",
            )
        })?
        .mesh;
    if mesh.triangles.is_empty() {
        return Ok(None);
    }
    let normals = match settings.normals {
        true => mesh
            .par_vertex_normals()
            .iter()
            .map(|n| [n.x, n.y, n.z])
            .collect(),
        false => Vec::new(),
    };
    Ok(Some(SurfaceMesh {
        vertices: mesh
            .vertices
            .iter()
            .map(|v| DVec3::new(v.x.into(), v.y.into(), v.z.into()) + origin)
            .collect(),
        normals,
        triangles: mesh
            .triangles
            .iter()
            .map(|t| t.map(|index| index as u32))
            .collect(),
    }))
}

#[cfg(test)]
mod tests;
