//! A run's folder, seen by frames: its checkpoints, what must be safe on disk, and back to an earlier frame.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::disk;
use super::folder::{Folder, POST_MORTEM};
use super::record::{Record, frame_of, names};
use super::text::count;
use crate::error::Result;
use crate::files;

impl Folder {
    pub fn checkpoint(&self, frame: u32) -> PathBuf {
        self.path().join(format!("checkpoint_{frame:06}.bin"))
    }

    /// Frames and files of all checkpoints, oldest first.
    pub fn checkpoints(&self) -> Result<Vec<(u32, PathBuf)>> {
        checkpoints(self.path())
    }

    /// Waits until everything that was written of these frames is safe from a power cut.
    pub fn save(&self, frames: RangeInclusive<u32>) -> Result<()> {
        for (frame, path) in numbered(self.path())? {
            if frames.contains(&frame) {
                disk::sync(&path)?;
            }
        }
        disk::sync_folder(&self.manifest()).map_err(|reason| disk::failed(self.path(), "save", reason))
    }

    /// Removes what the folder's run has recorded as its own of frames behind `last` (of all frames where there is none),
    /// and half-written files. Says what that was.
    pub fn rewind(&self, last: Option<u32>) -> Result<Vec<String>> {
        let record = Record::read(self.path());
        let (mut removed, mut folders) = (BTreeSet::new(), BTreeSet::new());
        for name in names(self.path())? {
            if name.starts_with("post_mortem/") && record.has(&name) {
                self.remove(&name)?;
                folders.insert(POST_MORTEM.to_owned());
                continue;
            }
            let Some(frame) = frame_of(&name).filter(|_| record.has(&name)) else {
                continue;
            };
            let is_partial = name.ends_with(".part");
            if is_partial || last.is_none_or(|last| frame > last) {
                self.remove(&name)?;
                // Arrays count as their folder.
                let folder = name.split_once('/').map(|(folder, _)| folder.to_owned());
                folders.extend(folder.clone());
                if !is_partial {
                    removed.insert(folder.unwrap_or(name));
                }
            }
        }
        for folder in &folders {
            self.remove_folder(folder)?;
        }
        cut_lines(&self.statistics(), last, 0, frame_of_statistics)?;
        for table in self.tables()? {
            // A table of no frame begins anew with its first line.
            cut_lines(&table, last, usize::from(last.is_some()), frame_of_sample)?;
        }
        let told = match (removed.len() as u64, last) {
            (0, _) => None,
            (removed, Some(last)) => Some(format!(
                "removed {} files of frames after frame {last}, which are made again",
                count(removed)
            )),
            (removed, None) => Some(format!(
                "removed {} files of frames, which are made again",
                count(removed)
            )),
        };
        Ok(told.into_iter().collect())
    }
}

/// Frames and files of all checkpoints in a folder, oldest first.
pub fn checkpoints(folder: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let mut found = numbered(folder)?;
    found.retain(|(_, path)| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("checkpoint_") && name.ends_with(".bin")
    });
    Ok(found)
}

/// Files and folders that belong to one frame, by frame.
pub fn numbered(folder: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let of_frame = |(name, path): (String, PathBuf)| Some((frame_of(&name)?, path));
    let mut found: Vec<_> = disk::list(folder)?.into_iter().filter_map(of_frame).collect();
    found.sort();
    Ok(found)
}

fn frame_of_statistics(line: &[u8]) -> Option<u64> {
    let value: Value = serde_json::from_slice(line).ok()?;
    value["frame"].as_u64()
}

/// Behind time and step.
fn frame_of_sample(line: &[u8]) -> Option<u64> {
    let cell = line.split(|&byte| byte == b',').nth(2)?;
    std::str::from_utf8(cell).ok()?.trim().parse().ok()
}

/// Keeps `titles` lines and those behind that are whole and of frames up to `last`.
fn cut_lines(
    path: &Path,
    last: Option<u32>,
    titles: usize,
    frame_of: fn(&[u8]) -> Option<u64>,
) -> Result<()> {
    let text = match files::read(path) {
        Ok(text) => text,
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(reason) => return Err(disk::failed(path, "read", reason)),
    };
    let is_early = |line: &[u8]| {
        let frame = frame_of(line);
        frame.is_some_and(|frame| last.is_some_and(|last| frame <= u64::from(last)))
    };
    let lines = text.split_inclusive(|&byte| byte == b'\n').enumerate();
    let kept =
        lines.take_while(|&(number, line)| line.ends_with(b"\n") && (number < titles || is_early(line)));
    let kept: usize = kept.map(|(_, line)| line.len()).sum();
    // A file of its own, in case the old one has other names in other places.
    disk::write(path, &text[..kept])
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn going_back_leaves_earlier_frames_and_what_is_not_ours() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = Folder::open(temporary.path(), false).unwrap();
        let path = |name: &str| temporary.path().join(name);
        for frame in 0..4 {
            fs::write(folder.picture(frame), b"").unwrap();
            fs::write(folder.checkpoint(frame), b"").unwrap();
            fs::create_dir(folder.particles(frame)).unwrap();
            fs::write(folder.particles(frame).join("id.npy"), b"").unwrap();
        }
        fs::write(folder.particles(3).join("mine.txt"), b"").unwrap();
        fs::write(path("frame_000001.png.part"), b"").unwrap();
        fs::write(path("notes_000009.txt"), b"").unwrap();
        let manifest = r#"{"program":"sliceflow","first_frame":0,"last_frame":3,"files":[{"name":"run.json"},
            {"name":"frame_NNNNNN.png"},{"name":"checkpoint_NNNNNN.bin"},{"name":"particles_NNNNNN/COLUMN.npy"}]}"#;
        fs::write(folder.manifest(), manifest).unwrap();
        fs::write(folder.picture(4), b"of somebody else").unwrap();
        let lines = "{\"frame\":0}\n{\"frame\":1}\n{\"frame\":2}\n{\"fra";
        fs::write(folder.statistics(), lines).unwrap();

        let told = folder.rewind(Some(1)).unwrap().remove(0);
        assert!(told.contains("6 files") && told.contains("frame 1"), "{told}");
        assert!(folder.picture(1).exists() && !folder.picture(2).exists());
        assert!(folder.particles(1).exists() && !folder.particles(2).exists());
        let left: Vec<_> = fs::read_dir(folder.particles(3))
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        assert_eq!(left, ["mine.txt"]);
        assert_eq!(folder.checkpoints().unwrap().len(), 2);
        assert!(!path("frame_000001.png.part").exists());
        assert!(path("notes_000009.txt").exists() && folder.manifest().exists());
        assert!(folder.picture(4).exists());
        assert_eq!(
            fs::read_to_string(folder.statistics()).unwrap(),
            "{\"frame\":0}\n{\"frame\":1}\n"
        );

        folder.rewind(None).unwrap();
        assert!(!folder.picture(0).exists() && folder.manifest().exists());
        assert_eq!(fs::read_to_string(folder.statistics()).unwrap(), "");
        assert!(folder.rewind(Some(3)).unwrap().is_empty());
    }
}
