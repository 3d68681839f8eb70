//! A run's folder, seen by frames: its checkpoints, what must be safe on disk, and back to an earlier frame.

use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::disk;
use super::folder::Folder;
use super::text::count;
use crate::error::Result;

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

    /// Removes what the folder holds of frames behind `last` (of all frames where there is none), and half-written
    /// files. Says what that was.
    pub fn rewind(&self, last: Option<u32>) -> Result<Option<String>> {
        let mut removed = 0;
        for (frame, path) in numbered(self.path())? {
            let is_partial = path.extension().is_some_and(|extension| extension == "part");
            if is_partial || last.is_none_or(|last| frame > last) {
                remove(&path)?;
                removed += u64::from(!is_partial);
            }
        }
        cut_lines(&self.statistics(), last, 0, frame_of_statistics)?;
        for table in self.sensor_tables()? {
            // A table of no frame begins anew with its first line.
            cut_lines(&table, last, usize::from(last.is_some()), frame_of_sample)?;
        }
        Ok((removed > 0).then(|| match last {
            Some(last) => format!(
                "removed {} files of frames after frame {last}, which are made again",
                count(removed)
            ),
            None => format!("removed {} files of frames, which are made again", count(removed)),
        }))
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
    let failed = |reason| disk::failed(folder, "list", reason);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if let Some(frame) = frame_of(&path.file_name().unwrap_or_default().to_string_lossy()) {
            found.push((frame, path));
        }
    }
    found.sort();
    Ok(found)
}

/// 12 of `frame_000012.png`, `particles_000012`, `checkpoint_000012.bin` and their like.
fn frame_of(name: &str) -> Option<u32> {
    let stem = name.split('.').next()?;
    let (kind, digits) = stem.rsplit_once('_')?;
    let is_ours = matches!(kind, "frame" | "particles" | "checkpoint");
    let is_number = digits.len() >= 6 && digits.bytes().all(|b| b.is_ascii_digit());
    (is_ours && is_number).then(|| digits.parse().ok()).flatten()
}

/// Removes a file, or a folder of arrays with whatever a user has not put there.
fn remove(path: &Path) -> Result<()> {
    let remove = || {
        if !path.is_dir() {
            return fs::remove_file(path);
        }
        let mut others = 0;
        for entry in fs::read_dir(path)? {
            let file = entry?.path();
            match file.extension().and_then(|extension| extension.to_str()) {
                Some("npy" | "part") => fs::remove_file(file)?,
                _ => others += 1,
            }
        }
        if others == 0 { fs::remove_dir(path) } else { Ok(()) }
    };
    remove().map_err(|reason| disk::failed(path, "remove", reason))
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
    let text = match fs::read(path) {
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
    let cut = || {
        fs::OpenOptions::new()
            .write(true)
            .open(path)?
            .set_len(kept as u64)
    };
    cut().map_err(|reason| disk::failed(path, "shorten", reason))
}

#[cfg(test)]
mod tests {
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
        fs::write(folder.manifest(), b"{}").unwrap();
        let lines = "{\"frame\":0}\n{\"frame\":1}\n{\"frame\":2}\n{\"fra";
        fs::write(folder.statistics(), lines).unwrap();

        let told = folder.rewind(Some(1)).unwrap().unwrap();
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
        assert_eq!(
            fs::read_to_string(folder.statistics()).unwrap(),
            "{\"frame\":0}\n{\"frame\":1}\n"
        );

        folder.rewind(None).unwrap();
        assert!(!folder.picture(0).exists() && folder.manifest().exists());
        assert_eq!(fs::read_to_string(folder.statistics()).unwrap(), "");
        assert_eq!(folder.rewind(Some(3)).unwrap(), None);
    }
}
