//! Surfaces of a run's particles, one mesh per frame: marching cubes over a smoothed density (Löschner et al. 2023,
//! `splashsurf_lib`), or what the device makes ([`crate::surface`]).

mod glb;
mod mesh_file;
mod on_device;
mod reconstruct;
mod sequence;
mod walls;

use std::path::Path;
use std::sync::Mutex;

use glam::DVec3;
use rayon::prelude::*;

use super::bar::Bar;
use super::folder::is_surface;
use super::read_back::Snapshot;
use super::{disk, interrupt};
use crate::error::{Error, Result};
use crate::files;

pub use mesh_file::{MESH_FORMATS, MeshFormat};
pub use on_device::OnDevice;
use reconstruct::{Cloud, reconstruct};
pub use sequence::Sequence;
pub use walls::Walls;

/// Cubes along a side of all particles.
const MOST_CUBES: f64 = 1e6;
const UNREADABLE: &str = "run the scene again, or remove that frame's files";

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
    /// Rounds of Laplacian smoothing, weighted so that splashes keep their shape.
    pub smoothing: u32,
    /// Whether vertices beside the same corner of a cube are joined.
    pub cleanup: bool,
    pub normals: bool,
    /// Columns of the particles that vertices get too; velocities where there are some when left out.
    pub columns: Option<Vec<String>>,
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
    /// Of length one, outward; one per vertex, or none.
    normals: Vec<[f32; 3]>,
    columns: Vec<VertexColumn>,
    triangles: Vec<[u32; 3]>,
}

/// One column of the particles, at vertices or at the particles themselves.
struct VertexColumn {
    name: String,
    /// Numbers per vertex: 3 of a vector, 1 of all others.
    width: usize,
    values: Vec<f32>,
}

impl VertexColumn {
    fn row(&self, vertex: usize) -> &[f32] {
        &self.values[vertex * self.width..][..self.width]
    }
}

/// Makes a mesh of each frame that has particle files, by splashsurf or by a device. Ends early, with what is done, after
/// Ctrl-C.
pub fn make_surfaces(
    recorded: &Sequence,
    walls: &Walls,
    out: &Path,
    settings: &SurfaceSettings,
    device: Option<&OnDevice>,
) -> Result<Made> {
    let target = |frame: u32| out.join(format!("surface_{frame:06}.{}", settings.format.name));
    let reach = 2.0 * settings.smoothing_length;
    if device.is_none() && settings.cube_size > reach {
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
        let radius = settings.radius.unwrap_or(recorded.radius);
        let cloud = read(*frame, file, settings.columns.as_deref())?;
        let mesh = match device {
            Some(device) => {
                let (spacing, width) = (2.0 * radius, settings.cube_size * radius);
                device.reconstruct(&cloud, spacing, width, walls, settings.normals)?
            }
            None => surface(&cloud, file, radius, walls, settings)?,
        };
        let triangles = match mesh {
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

/// Reads a frame's particles.
fn read(frame: u32, file: &Path, columns: Option<&[String]>) -> Result<Cloud> {
    let unreadable = |what: String| Error::file(file, "make a surface of", what, UNREADABLE);
    let snapshot = Snapshot::read(file)?;
    let place = snapshot.column("position").filter(|column| column.width == 3);
    let place = place.ok_or_else(|| unreadable("it has no positions in space".into()))?;
    if let Some(row) = place
        .values
        .chunks_exact(3)
        .position(|p| !p.iter().all(|x| x.is_finite()))
    {
        return Err(unreadable(format!(
            "the position of particle {row} is not a number"
        )));
    }
    if place.values.is_empty() {
        return Err(unreadable("it has no particles".into()));
    }
    let mut found = Vec::new();
    for name in columns.unwrap_or(&["velocity".to_owned()]) {
        match snapshot.column(name) {
            Some(column) if [1, 3].contains(&column.width) && column.particles() == place.particles() => {
                found.push(VertexColumn {
                    name: name.clone(),
                    width: column.width,
                    values: column.values.iter().map(|&value| value as f32).collect(),
                })
            }
            Some(column) => {
                return Err(unreadable(format!(
                    "its column `{name}` has {} rows of {} numbers",
                    column.particles(),
                    column.width
                )));
            }
            // Velocities come along where there are some.
            _ if columns.is_none() => {}
            _ => {
                let known: Vec<_> = snapshot
                    .columns
                    .iter()
                    .map(|column| column.name.as_str())
                    .collect();
                return Err(Error::usage(
                    format!("{} has no column `{name}`", file.display()),
                    format!("it has {}; `run --columns` says what it holds", known.join(", ")),
                ));
            }
        }
    }
    Ok(Cloud {
        frame,
        position: place.values.chunks_exact(3).map(DVec3::from_slice).collect(),
        columns: found,
    })
}

fn surface(
    cloud: &Cloud,
    file: &Path,
    radius: f64,
    walls: &Walls,
    settings: &SurfaceSettings,
) -> Result<Option<SurfaceMesh>> {
    let ends =
        [DVec3::min, DVec3::max].map(|pick| cloud.position.iter().copied().reduce(pick).unwrap_or_default());
    let cubes = (ends[1] - ends[0]).max_element() / (settings.cube_size * radius);
    if cubes > MOST_CUBES || cubes.is_nan() {
        return Err(Error::file(
            file,
            "make a surface of",
            format!("{cubes:.1e} cubes would stand along one side"),
            format!("make cubes larger with --cube-size or --radius: at most {MOST_CUBES:e} along a side"),
        ));
    }
    let larger = "larger cubes (--cube-size) need less memory";
    // splashsurf orders vertices as its threads come; of one thread the bytes are the same every time. Frames are made side
    // by side instead.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let alone = alone.map_err(|reason| Error::file(file, "make a surface of", reason, larger))?;
    alone
        .install(|| reconstruct(cloud, radius, walls, settings))
        .map_err(|reason| Error::file(file, "make a surface of", reason, larger))
}

#[cfg(test)]
mod tests;
