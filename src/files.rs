//! Files whose names come from users, scenes and runs of strangers.
//!
//! What is read is a plain file of a size that memory has room for: a device or a pipe may never end. What is written is a
//! new file under its own name: a link that stands there would carry the bytes to another place.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

/// Bytes of a file that is read, where the system does not say how much memory there is.
const USUAL_MOST: u64 = 4 << 30;

/// Opens a plain file to read it.
///
/// # Errors
///
/// Where it is a folder, a pipe or a device, besides what the system says.
pub fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    without_waiting(&mut options, false);
    plain(options.open(path)?)
}

/// All bytes of a plain file.
///
/// # Errors
///
/// Where it is larger than half of the machine's memory, besides those of [`open`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let length = file.metadata()?.len();
    let most = memory_bytes().map_or(USUAL_MOST, |all| all / 2);
    let too_large = || {
        io::Error::new(
            ErrorKind::FileTooLarge,
            format!("it has more than the {most} bytes that are read on this machine"),
        )
    };
    if length > most {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(usize::try_from(length).map_err(|_| too_large())?)
        .map_err(|_| io::Error::from(ErrorKind::OutOfMemory))?;
    // It may grow while it is read.
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(too_large());
    }
    Ok(bytes)
}

/// The text of a plain file.
///
/// # Errors
///
/// Where it is not UTF-8, besides those of [`read`].
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// Creates a file; whatever had its name is removed, and nothing is written through a link.
pub fn create(path: &Path) -> io::Result<File> {
    remove(path)?;
    OpenOptions::new()
        .read(true)
        .write(true)
        .create_new(true)
        .open(path)
}

/// Removes a file, or a link and not what it leads to, where there is one.
///
/// # Errors
///
/// Where the name is that of a device, a pipe or a socket, besides what the system says.
pub fn remove(path: &Path) -> io::Result<()> {
    let kind = fs::symlink_metadata(path).map(|found| found.file_type());
    if kind.is_ok_and(|kind| !(kind.is_file() || kind.is_symlink() || kind.is_dir())) {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is no plain file"));
    }
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        done => done,
    }
}

/// Opens a plain file to append to it, and creates it where it is missing.
///
/// # Errors
///
/// Where a link, a folder, a pipe or a device has the name, besides what the system says.
pub fn append(path: &Path) -> io::Result<File> {
    refuse_link(path)?;
    let mut options = OpenOptions::new();
    options.append(true).create(true);
    without_waiting(&mut options, true);
    plain(options.open(path)?)
}

/// Saves a plain file from a power cut; what is none has nothing to save.
pub fn sync(path: &Path) -> io::Result<()> {
    if !fs::symlink_metadata(path)?.is_file() {
        return Ok(());
    }
    let mut options = OpenOptions::new();
    options.write(true);
    without_waiting(&mut options, true);
    options.open(path)?.sync_all()
}

/// Whether a name belongs to a link, wherever that leads.
pub fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}

/// Bytes of memory that the machine has.
pub fn memory_bytes() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

fn refuse_link(path: &Path) -> io::Result<()> {
    match is_link(path) {
        true => Err(io::Error::new(
            ErrorKind::InvalidInput,
            "it is a link to another place, and nothing is written through links",
        )),
        false => Ok(()),
    }
}

fn plain(file: File) -> io::Result<File> {
    let kind = file.metadata()?.file_type();
    if kind.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    match kind.is_file() {
        true => Ok(file),
        false => Err(io::Error::new(
            ErrorKind::InvalidInput,
            "it is a pipe or a device, and only files are read and written",
        )),
    }
}

/// Opening a pipe would wait for its other end.
#[cfg(unix)]
fn without_waiting(options: &mut OpenOptions, to_write: bool) {
    use std::os::unix::fs::OpenOptionsExt as _;
    let no_links = if to_write { libc::O_NOFOLLOW } else { 0 };
    options.custom_flags(libc::O_NONBLOCK | no_links);
}

#[cfg(not(unix))]
fn without_waiting(_options: &mut OpenOptions, _to_write: bool) {}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn devices_and_pipes_are_refused_without_waiting() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        for path in [Path::new("/dev/zero"), &pipe] {
            assert!(read(path).unwrap_err().to_string().contains("a pipe or a device"));
            assert!(append(path).is_err(), "{}", path.display());
            assert!(sync(path).is_ok());
        }
        assert_eq!(read(folder.path()).unwrap_err().kind(), ErrorKind::IsADirectory);
    }

    #[test]
    fn a_file_that_memory_has_no_room_for_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse");
        File::create(&path).unwrap().set_len(1 << 42).unwrap();
        assert_eq!(read(&path).unwrap_err().kind(), ErrorKind::FileTooLarge);
    }

    #[test]
    fn nothing_is_written_through_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "kept").unwrap();
        symlink(&target, &link).unwrap();
        assert!(append(&link).unwrap_err().to_string().contains("a link"));
        drop(create(&link).unwrap());
        assert!(!is_link(&link));
        assert_eq!(fs::read_to_string(&target).unwrap(), "kept");
    }
}
