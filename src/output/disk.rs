//! Writing files so that a reader never sees half of one.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files;

/// Writes a file that appears under its name only when it is whole.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let partial = partial(path);
    files::create(&partial)
        .and_then(|mut file| file.write_all(bytes))
        .and_then(|()| std::fs::rename(&partial, path))
        .map_err(|reason| {
            // The half-written file only takes room; what went wrong is in `reason`.
            let _ = std::fs::remove_file(&partial);
            failed(path, "write", reason)
        })
}

/// Writes a file that is whole or absent under its name, even after a power cut.
pub fn write_durably(path: &Path, bytes: &[u8]) -> Result<()> {
    let partial = partial(path);
    let write = || {
        let mut file = files::create(&partial)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        std::fs::rename(&partial, path)?;
        sync_folder(path)
    };
    write().map_err(|reason| {
        let _ = std::fs::remove_file(&partial);
        failed(path, "write", reason)
    })
}

/// Creates a folder in one that exists; a run's folder that was removed meanwhile is not made anew.
pub fn create_folder(path: &Path) -> Result<()> {
    if files::is_link(path) {
        return Err(failed(path, "create", ErrorKind::NotADirectory.into()));
    }
    match std::fs::create_dir(path) {
        Err(reason) if reason.kind() != ErrorKind::AlreadyExists => Err(failed(path, "create", reason)),
        _ => Ok(()),
    }
}

/// What is in a folder, by name. A name that is no text is none of ours.
pub fn list(folder: &Path) -> Result<Vec<(String, PathBuf)>> {
    let failed = |reason| failed(folder, "list", reason);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if let Ok(name) = entry.file_name().into_string() {
            found.push((name, entry.path()));
        }
    }
    Ok(found)
}

/// Waits until a file, or a folder with all its files, is safe from a power cut.
pub fn sync(path: &Path) -> Result<()> {
    let sync = || {
        if path.is_dir() && !files::is_link(path) {
            for entry in std::fs::read_dir(path)? {
                files::sync(&entry?.path())?;
            }
            return Ok(());
        }
        files::sync(path)
    };
    sync().map_err(|reason| failed(path, "save", reason))
}

/// Saves the names in the folder that a file is in. Only Unix lets a program do this; elsewhere renaming does it.
pub fn sync_folder(path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(folder) if cfg!(unix) && !folder.as_os_str().is_empty() => File::open(folder)?.sync_all(),
        _ => Ok(()),
    }
}

/// The error for something that a run could not do on disk.
pub fn failed(path: &Path, doing: &'static str, reason: io::Error) -> Error {
    let help = match reason.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "free space there, or choose another folder with --out"
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that you may write, with --out"
        }
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "a file stands where a folder is needed; move it, or choose another folder with --out"
        }
        ErrorKind::NotFound => "was the folder removed? create it, or choose another with --out",
        _ => "check that folder, or choose another with --out",
    };
    Error::file(path, doing, reason, help)
}

fn partial(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        for text in ["first, and longer", "second"] {
            write(&path, text.as_bytes()).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn names_the_path_and_the_mend() {
        let error = write(Path::new("/dev/null/frame.png"), b"")
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("/dev/null/frame.png") && error.contains("--out"),
            "{error}"
        );
    }
}
