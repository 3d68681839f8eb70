//! The folder of a run: what its files are called, and what an earlier run left there.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::disk;
use super::text::count;
use crate::error::{Error, Result};

/// A folder that exists and can be written, by nobody else as long as this lives.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: Option<fs::File>,
}

/// Files that a run writes, found before this one.
#[derive(Debug, Default)]
struct Earlier {
    pictures: Vec<PathBuf>,
    particles: Vec<PathBuf>,
    checkpoints: Vec<PathBuf>,
    /// Manifest and statistics.
    records: Vec<PathBuf>,
}

impl Folder {
    /// Creates the folder where it is missing. Refuses one that holds an earlier run, unless it may be replaced.
    pub fn open(path: &Path, replace: bool) -> Result<Self> {
        fs::create_dir_all(path).map_err(|reason| disk::failed(path, "create", reason))?;
        let folder = Self::existing(path)?;
        let earlier = folder.earlier()?;
        if !replace && !earlier.is_empty() {
            return Err(Error::usage(
                format!("{} holds an earlier run ({earlier})", path.display()),
                "replace it with --force, or choose another folder with --out",
            ));
        }
        Ok(folder)
    }

    /// The folder of an earlier run, to write more into it.
    pub fn existing(path: &Path) -> Result<Self> {
        let folder = Self {
            path: path.to_owned(),
            _lock: lock(path)?,
        };
        folder.try_writing()?;
        Ok(folder)
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn picture(&self, frame: u32) -> PathBuf {
        self.path.join(format!("frame_{frame:06}.png"))
    }

    /// Folder of one frame's particle files.
    pub fn particles(&self, frame: u32) -> PathBuf {
        self.path.join(format!("particles_{frame:06}"))
    }

    pub fn statistics(&self) -> PathBuf {
        self.path.join("stats.jsonl")
    }

    pub fn manifest(&self) -> PathBuf {
        self.path.join("run.json")
    }

    /// Removes what an earlier run left, and nothing else; says what that was.
    pub fn clear(&self) -> Result<Option<String>> {
        let earlier = self.earlier()?;
        if earlier.is_empty() {
            return Ok(None);
        }
        let files = earlier.pictures.iter().chain(&earlier.checkpoints);
        for file in files.chain(&earlier.records) {
            fs::remove_file(file).map_err(|reason| disk::failed(file, "remove", reason))?;
        }
        for folder in &earlier.particles {
            remove_arrays(folder).map_err(|reason| disk::failed(folder, "remove", reason))?;
        }
        Ok(Some(format!(
            "removed an earlier run from {}: {earlier}",
            self.path.display()
        )))
    }

    fn earlier(&self) -> Result<Earlier> {
        let failed = |reason| disk::failed(&self.path, "list", reason);
        let mut earlier = Earlier::default();
        for entry in fs::read_dir(&self.path).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if path == self.manifest() || path == self.statistics() {
                earlier.records.push(path);
            } else if is_numbered(&name, "frame_", ".png") {
                earlier.pictures.push(path);
            } else if is_numbered(&name, "checkpoint_", ".bin") {
                earlier.checkpoints.push(path);
            } else if is_numbered(&name, "particles_", "") && path.is_dir() {
                earlier.particles.push(path);
            }
        }
        Ok(earlier)
    }

    fn try_writing(&self) -> Result<()> {
        let trial = self.path.join(format!(".sliceflow-{}", std::process::id()));
        fs::write(&trial, b"")
            .and_then(|()| fs::remove_file(&trial))
            .map_err(|reason| disk::failed(&self.path, "write into", reason))
    }
}

impl Earlier {
    fn is_empty(&self) -> bool {
        [&self.pictures, &self.particles, &self.checkpoints, &self.records]
            .iter()
            .all(|files| files.is_empty())
    }
}

impl std::fmt::Display for Earlier {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counted = |files: &[PathBuf], what: &str| {
            (!files.is_empty()).then(|| format!("{} {what}", count(files.len() as u64)))
        };
        let names = self.records.iter().filter_map(|path| path.file_name()?.to_str());
        let parts = counted(&self.pictures, "frames")
            .into_iter()
            .chain(counted(&self.particles, "folders of particle files"))
            .chain(counted(&self.checkpoints, "checkpoints"))
            .chain(names.map(str::to_owned));
        f.write_str(&parts.collect::<Vec<_>>().join(", "))
    }
}

/// Keeps other runs out of a folder until it is dropped. Where a system or file system cannot, there is no lock.
fn lock(path: &Path) -> Result<Option<fs::File>> {
    let Ok(file) = fs::File::open(path) else {
        return Ok(None);
    };
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(fs::TryLockError::WouldBlock) => Err(Error::usage(
            format!("another run is writing into {}", path.display()),
            "wait for it or stop it, or choose another folder with --out",
        )),
        Err(fs::TryLockError::Error(_)) => Ok(None),
    }
}

/// Whether `name` is `prefix`, at least six digits, `suffix`.
fn is_numbered(name: &str, prefix: &str, suffix: &str) -> bool {
    let digits = name
        .strip_prefix(prefix)
        .and_then(|rest| rest.strip_suffix(suffix));
    digits.is_some_and(|digits| digits.len() >= 6 && digits.bytes().all(|b| b.is_ascii_digit()))
}

/// Removes a frame's arrays, and its folder unless something else is in it.
fn remove_arrays(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "npy") {
            fs::remove_file(path)?;
        }
    }
    match fs::remove_dir(folder) {
        Err(reason) if reason.kind() == io::ErrorKind::DirectoryNotEmpty => Ok(()),
        done => done,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &Path) -> Vec<String> {
        let entries = fs::read_dir(path).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn an_earlier_run_is_refused_and_then_replaced_alone() {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path().join("deep/out");
        let folder = Folder::open(&path, false).unwrap();
        assert_eq!(folder.clear().unwrap(), None);
        for file in [
            folder.picture(0),
            folder.picture(1),
            folder.manifest(),
            path.join("notes.txt"),
        ] {
            fs::write(file, b"").unwrap();
        }
        fs::create_dir(folder.particles(0)).unwrap();
        fs::write(folder.particles(0).join("id.npy"), b"").unwrap();

        let busy = Folder::open(&path, true).unwrap_err().to_string();
        assert!(busy.contains("another run is writing"), "{busy}");
        drop(folder);

        let refused = Folder::open(&path, false).unwrap_err();
        assert_eq!(refused.exit_code(), 2);
        let message = refused.to_string();
        assert!(
            message.contains("2 frames") && message.contains("--force"),
            "{message}"
        );
        assert_eq!(names(&path).len(), 5);

        let told = Folder::open(&path, true).unwrap().clear().unwrap().unwrap();
        assert!(told.contains("2 frames") && told.contains("run.json"), "{told}");
        assert_eq!(names(&path), ["notes.txt"]);
    }

    #[test]
    fn only_numbered_names_count() {
        assert!(is_numbered("frame_000000.png", "frame_", ".png"));
        assert!(is_numbered("particles_1000000", "particles_", ""));
        for other in [
            "frame_0.png",
            "frame_00000x.png",
            "frame_000000.jpg",
            "my_frame_000000.png",
        ] {
            assert!(!is_numbered(other, "frame_", ".png"), "{other}");
        }
    }
}
