//! Runs as USD, which Blender, Houdini, Maya and usdview open: particles and surfaces over time, camera, obstacles. Text
//! (`.usda`), which `usdcat -o scene.usdc` makes binary.

mod layer;
mod prims;
mod stage;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use self::layer::{Layer, MARK};
use self::prims::{points, surface};
use super::disk;
use super::folder::numbered;
use super::particles::found::find;
use super::read_back::Snapshot;
use crate::error::{Error, Result};
use crate::files;
use crate::scene::{Scene, ply};

/// The file that is opened.
pub const SCENE: &str = "scene.usda";

/// What of a run becomes USD, and where.
pub struct Export<'a> {
    pub scene: &'a Scene,
    /// Folder with particle files.
    pub run: &'a Path,
    /// Folder with surfaces that `sliceflow surface` has made as PLY.
    pub surfaces: &'a Path,
    pub out: &'a Path,
    /// Whether `scene.usda` holds all frames; otherwise each has files of its own, which are joined by value clips.
    pub one_file: bool,
    pub force: bool,
}

/// What was written.
pub struct Exported {
    pub particles: usize,
    pub surfaces: usize,
}

/// What moves from frame to frame: the name of its prim, and a file per frame.
struct Sequence {
    name: &'static str,
    frames: Vec<(u32, PathBuf)>,
    read: fn(&Scene, &Path) -> Result<Layer>,
}

impl Export<'_> {
    pub fn write(&self) -> Result<Exported> {
        let particles: Vec<_> = find(self.run)?.into_iter().collect();
        let surfaces = surfaces(self.surfaces)?;
        if particles.is_empty() && surfaces.is_empty() {
            return Err(Error::usage(
                format!("{} has no particle files and no surfaces", self.run.display()),
                "run the scene again with --particles ply (or vtk, bgeo, npy)",
            ));
        }
        let exported = Exported {
            particles: particles.len(),
            surfaces: surfaces.len(),
        };
        self.check_names([&particles, &surfaces])?;
        disk::create_folder(self.out)?;
        let mut moving = Vec::new();
        for (name, frames, read) in [
            (
                "particles",
                particles,
                read_particles as fn(&Scene, &Path) -> Result<Layer>,
            ),
            ("surface", surfaces, read_surface),
        ] {
            if !frames.is_empty() {
                moving.push(self.sequence(&Sequence { name, frames, read })?);
            }
        }
        let last = moving.iter().filter_map(|prim| prim.frames.last()).max();
        let text = stage::scene(self.scene, last.copied().unwrap_or_default(), &moving);
        disk::write(&self.out.join(SCENE), text.as_bytes())?;
        Ok(exported)
    }

    /// The prim of a sequence; writes the files of its frames, where they have some.
    fn sequence(&self, sequence: &Sequence) -> Result<stage::Moving> {
        let name = sequence.name;
        let frames: Vec<u32> = sequence.frames.iter().map(|(frame, _)| *frame).collect();
        if self.one_file {
            let layers = sequence
                .frames
                .iter()
                .map(|(frame, path)| Ok((*frame, (sequence.read)(self.scene, path)?)));
            let joined = Layer::joined(layers.collect::<Result<_>>()?);
            return Ok(stage::Moving {
                name,
                frames,
                declared: joined,
                clips: false,
            });
        }
        let declared = sequence.frames.par_iter().map(|(frame, path)| {
            let layer = (sequence.read)(self.scene, path)?;
            let declared = layer.declared();
            let text = stage::clip(name, &Layer::joined(vec![(*frame, layer)]));
            disk::write(&self.out.join(format!("{name}_{frame:06}.usda")), text.as_bytes())?;
            Ok(declared)
        });
        let declared = declared.collect::<Result<Vec<_>>>()?;
        let declared = declared.into_iter().reduce(Layer::united).unwrap_or_default();
        let manifest = stage::clip(name, &declared);
        disk::write(
            &self.out.join(format!("{name}_manifest.usda")),
            manifest.as_bytes(),
        )?;
        Ok(stage::Moving {
            name,
            frames,
            declared,
            clips: true,
        })
    }

    /// Refuses to replace what is there, unless it is ours and may be replaced.
    fn check_names(&self, frames: [&Vec<(u32, PathBuf)>; 2]) -> Result<()> {
        let mut names = vec![SCENE.to_owned()];
        for (name, frames) in ["particles", "surface"].into_iter().zip(frames) {
            if !self.one_file && !frames.is_empty() {
                names.push(format!("{name}_manifest.usda"));
                names.extend(frames.iter().map(|(frame, _)| format!("{name}_{frame:06}.usda")));
            }
        }
        let there = names
            .iter()
            .map(|name| self.out.join(name))
            .filter(|path| path.exists() || files::is_link(path));
        for path in there {
            if files::is_link(&path)
                || !files::read(&path).is_ok_and(|text| text.starts_with(MARK.as_bytes()))
            {
                return Err(Error::usage(
                    format!("{} is no USD file that Sliceflow has written", path.display()),
                    "move it to another place, or choose another folder with --out",
                ));
            }
            if !self.force {
                return Err(Error::usage(
                    format!("{} is there already", path.display()),
                    "replace it with --force, or choose another folder with --out",
                ));
            }
        }
        Ok(())
    }
}

fn read_particles(scene: &Scene, path: &Path) -> Result<Layer> {
    points(scene, &Snapshot::read(path)?).map_err(|reason| unreadable(path, reason))
}

fn read_surface(scene: &Scene, path: &Path) -> Result<Layer> {
    let file = ply::read(path).map_err(|reason| unreadable(path, reason))?;
    surface(scene, &file).map_err(|reason| unreadable(path, reason))
}

fn unreadable(path: &Path, reason: String) -> Error {
    Error::file(path, "read", reason, "make it again, or remove it")
}

/// Surfaces in a folder, by frame.
fn surfaces(folder: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let of_frame = |(name, path): (String, PathBuf)| Some((numbered(&name, "surface_", ".ply")?, path));
    let mut found: Vec<_> = disk::list(folder)?.into_iter().filter_map(of_frame).collect();
    found.sort();
    Ok(found)
}
