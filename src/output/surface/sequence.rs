//! What a run has left of its particles.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::{Error, Result};
use crate::output::disk;
use crate::output::folder::numbered;

/// Ending of a frame's files and what in it has the positions, the most exact first.
const SOURCES: [(&str, &str); 4] = [("", "position.npy"), (".vtp", ""), (".ply", ""), (".bgeo", "")];

/// A run's particle files.
#[derive(Debug)]
pub struct Sequence {
    /// Frames that have files, in order, and the file with the positions.
    pub frames: Vec<(u32, PathBuf)>,
    /// Frames that the run was to have.
    pub wanted: u64,
    /// Metres.
    pub radius: f64,
    pub dimensions: u64,
}

impl Sequence {
    /// Reads the folder of a run.
    pub fn open(run: &Path) -> Result<Self> {
        let path = run.join("run.json");
        let mend = "give the folder of a run, which has a run.json";
        let text = std::fs::read(&path).map_err(|reason| Error::file(&path, "read", reason, mend))?;
        let manifest: Value =
            serde_json::from_slice(&text).map_err(|reason| Error::file(&path, "read", reason, mend))?;
        let scene = &manifest["scene"];
        let radius = scene["grains"]["radius"].as_f64();
        let dimensions = scene["dimensions"].as_u64();
        let (Some(radius), Some(dimensions)) = (radius, dimensions) else {
            return Err(Error::file(
                &path,
                "read",
                "it says no radius of particles, or no dimensions",
                mend,
            ));
        };
        let frames = frames(run)?;
        if frames.is_empty() {
            return Err(Error::usage(
                format!("{} has no particle files", run.display()),
                "run the scene again with --particles ply (or vtk, bgeo, npy)",
            ));
        }
        Ok(Self {
            frames,
            wanted: manifest["frames"].as_u64().unwrap_or_default(),
            radius,
            dimensions,
        })
    }
}

fn frames(run: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let failed = |reason| disk::failed(run, "list", reason);
    let mut found: Vec<(u32, usize, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(run).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        for (rank, (ending, inside)) in SOURCES.into_iter().enumerate() {
            let file = if inside.is_empty() {
                path.clone()
            } else {
                path.join(inside)
            };
            let frame = numbered(&name, "particles_", ending);
            found.extend(frame.filter(|_| file.is_file()).map(|frame| (frame, rank, file)));
        }
    }
    found.sort_unstable();
    found.dedup_by_key(|(frame, _, _)| *frame);
    Ok(found.into_iter().map(|(frame, _, file)| (frame, file)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_frame_comes_once_from_its_most_exact_file() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str| std::fs::write(folder.path().join(name), "").unwrap();
        std::fs::create_dir(folder.path().join("particles_000002")).unwrap();
        std::fs::create_dir(folder.path().join("particles_000003")).unwrap();
        for name in [
            "particles_000002/position.npy",
            "particles_000002.ply",
            "particles_000000.bgeo",
            "particles_000000.vtp",
            "particles_000001.ply.part",
            "frame_000000.png",
        ] {
            put(name);
        }
        let found = frames(folder.path()).unwrap();
        let names: Vec<_> = found
            .iter()
            .map(|(frame, path)| {
                (
                    *frame,
                    path.strip_prefix(folder.path()).unwrap().to_str().unwrap(),
                )
            })
            .collect();
        assert_eq!(
            names,
            [(0, "particles_000000.vtp"), (2, "particles_000002/position.npy")]
        );
    }
}
