//! What a scene may ask of the machine that reads it: how many particles, how much memory, which files. Numbers are compared
//! with it before anything is made or gone through.

use std::path::{Path, PathBuf};

use crate::files;

/// Ids, offsets and dispatches stay far inside 32 bits.
pub const MOST_PARTICLES: u64 = 1 << 27;
/// What placing a particle takes at most, bytes: its coordinates in double and single precision, and its cell in tables of
/// neighbors.
const PARTICLE_BYTES: f64 = 300.0;
/// Where the system does not say how much memory there is.
const USUAL_MEMORY: u64 = 8 << 30;

/// The bounds of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Allowance {
    /// Particles, boundary particles included.
    pub particles: u64,
    /// Bytes of memory for placing them and for distance fields.
    pub memory: u64,
    /// Folders, besides the scene's own, that the files which it names may lie in; `None` for all.
    pub folders: Option<Vec<PathBuf>>,
}

impl Default for Allowance {
    /// As much as the machine has, and any files: for scenes that are trusted.
    fn default() -> Self {
        Self {
            particles: MOST_PARTICLES,
            memory: files::memory_bytes().unwrap_or(USUAL_MEMORY) / 2,
            folders: None,
        }
    }
}

impl Allowance {
    /// Bytes that placing so many particles takes.
    pub fn bytes_of(particles: f64) -> f64 {
        particles * PARTICLE_BYTES
    }

    /// Whether a file may be read for a scene that lies in a folder. What is not there is not refused.
    pub fn reads(&self, file: &Path, folder: &Path) -> bool {
        let Some(folders) = &self.folders else { return true };
        let Ok(file) = file.canonicalize() else {
            return true;
        };
        let own = match folder.as_os_str().is_empty() {
            true => Path::new("."),
            false => folder,
        };
        let mut folders = folders.iter().map(PathBuf::as_path).chain([own]);
        folders.any(|folder| folder.canonicalize().is_ok_and(|folder| file.starts_with(folder)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_lie_in_the_scenes_folder_or_in_one_that_is_allowed() {
        let temporary = tempfile::tempdir().unwrap();
        let path = |name: &str| temporary.path().join(name);
        for folder in ["scene/data", "meshes"] {
            std::fs::create_dir_all(path(folder)).unwrap();
        }
        for file in ["scene/data/a.ply", "meshes/b.ply", "c.ply"] {
            std::fs::write(path(file), "").unwrap();
        }
        let reads = |folders: Option<Vec<PathBuf>>, file: &str| {
            let allowance = Allowance {
                folders,
                ..Allowance::default()
            };
            allowance.reads(&path("scene").join(file), &path("scene"))
        };
        assert!(reads(None, "../c.ply"));
        assert!(reads(Some(vec![]), "data/a.ply") && reads(Some(vec![]), "missing.ply"));
        assert!(!reads(Some(vec![]), "../meshes/b.ply") && !reads(Some(vec![]), "../c.ply"));
        let meshes = || Some(vec![path("meshes")]);
        assert!(reads(meshes(), "../meshes/b.ply") && !reads(meshes(), "../c.ply"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(path("c.ply"), path("scene/link.ply")).unwrap();
            assert!(!reads(Some(vec![]), "link.ply"));
        }
    }
}
