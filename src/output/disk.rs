//! Writing files so that a reader never sees half of one.

use std::ffi::OsString;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Writes a file that appears under its name only when it is whole.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let partial = partial(path);
    std::fs::write(&partial, bytes)
        .and_then(|()| std::fs::rename(&partial, path))
        .map_err(|reason| {
            // The half-written file only takes room; what went wrong is in `reason`.
            let _ = std::fs::remove_file(&partial);
            failed(path, "write", reason)
        })
}

/// The error for something that a run could not do on disk.
pub fn failed(path: &Path, doing: &'static str, reason: io::Error) -> Error {
    let mend = match reason.kind() {
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
    Error::file(path, doing, reason, mend)
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
