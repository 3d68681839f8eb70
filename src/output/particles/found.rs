//! What a run has left of its particles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::error::Result;
use crate::output::disk;
use crate::output::folder::numbered;

/// Endings of a frame's files, the most exact first; arrays have a folder of their own.
const ENDINGS: [&str; 4] = ["", ".vtp", ".ply", ".bgeo"];

/// The file of a folder of arrays that has the positions.
pub const POSITIONS: &str = "position.npy";

/// Frames that have particle files, and for each the most exact that has positions: a file, or a folder of arrays. Arrays
/// without positions stand back behind everything else.
pub fn find(run: &Path) -> Result<BTreeMap<u32, PathBuf>> {
    let mut found: Vec<(u32, usize, PathBuf)> = Vec::new();
    for (name, path) in disk::list(run)? {
        for (mut rank, ending) in ENDINGS.into_iter().enumerate() {
            let Some(frame) = numbered(&name, "particles_", ending) else {
                continue;
            };
            if path.is_dir() && !path.join(POSITIONS).is_file() {
                rank = ENDINGS.len();
            }
            if path.is_dir() == ending.is_empty() {
                found.push((frame, rank, path.clone()));
            }
        }
    }
    found.sort_unstable();
    found.reverse();
    Ok(found.into_iter().map(|(frame, _, path)| (frame, path)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_frame_comes_once_from_its_most_exact_file() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str| std::fs::write(folder.path().join(name), "").unwrap();
        for frame in 2..5 {
            std::fs::create_dir(folder.path().join(format!("particles_{frame:06}"))).unwrap();
        }
        for name in [
            "particles_000002/position.npy",
            "particles_000002.ply",
            "particles_000003/id.npy",
            "particles_000004/id.npy",
            "particles_000004.bgeo",
            "particles_000000.bgeo",
            "particles_000000.vtp",
            "particles_000001.ply.part",
            "frame_000000.png",
        ] {
            put(name);
        }
        let found = find(folder.path()).unwrap();
        let names: Vec<_> = found
            .iter()
            .map(|(frame, path)| (*frame, path.file_name().unwrap().to_str().unwrap()))
            .collect();
        assert_eq!(
            names,
            [
                (0, "particles_000000.vtp"),
                (2, "particles_000002"),
                (3, "particles_000003"),
                (4, "particles_000004.bgeo")
            ]
        );
    }
}
