//! The folder of a run: what its files are called, and what an earlier run left there.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::record::{Record, frame_of, is_like_ours, names};
use super::text::count;
use super::{bodies, disk, sensors};
use crate::error::{Error, Result};
use crate::files;

/// Where a run that a guard stopped leaves what helps to find the reason.
pub const POST_MORTEM: &str = "post_mortem";

/// A folder that exists and can be written, by nobody else as long as this lives.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: Option<fs::File>,
}

/// Files that a run has written, found before this one, as [`names`] gives them.
#[derive(Debug, Default)]
struct Earlier {
    pictures: Vec<String>,
    /// Extra images.
    passes: Vec<String>,
    particles: Vec<String>,
    /// Folders of NumPy arrays, and that of a post-mortem.
    arrays: BTreeSet<String>,
    surfaces: Vec<String>,
    checkpoints: Vec<String>,
    /// Tables and charts of sensors.
    sensors: Vec<String>,
    /// Manifest, statistics, index.
    records: Vec<String>,
    /// All of these, folders of arrays by their files, with what was left half-written.
    files: Vec<String>,
    /// What has a name like these, and no run has recorded.
    others: Vec<String>,
}

impl Folder {
    /// Creates the folder where it is missing. Refuses one that holds an earlier run, unless it may be replaced.
    pub fn open(path: &Path, replace: bool) -> Result<Self> {
        fs::create_dir_all(path).map_err(|reason| disk::failed(path, "create", reason))?;
        let folder = Self::existing(path)?;
        let earlier = folder.earlier()?;
        if !replace && !earlier.files.is_empty() {
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
        folder.refuse_links()?;
        folder.try_writing()?;
        Ok(folder)
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn picture(&self, frame: u32) -> PathBuf {
        self.path.join(format!("frame_{frame:06}.png"))
    }

    /// One frame's particle files, without an extension.
    pub fn particles(&self, frame: u32) -> PathBuf {
        self.path.join(format!("particles_{frame:06}"))
    }

    /// The list of a folder's VTK files.
    pub fn index_of_particles(folder: &Path) -> PathBuf {
        folder.join("particles.pvd")
    }

    pub fn statistics(&self) -> PathBuf {
        self.path.join("stats.jsonl")
    }

    /// The table of all sensors but profiles.
    pub fn sensors(&self) -> PathBuf {
        self.path.join("sensors.csv")
    }

    /// The table of a profile.
    pub fn sensor_profile(&self, name: &str) -> PathBuf {
        self.path.join(format!("sensor_{name}.csv"))
    }

    /// The table of rigid bodies.
    pub fn bodies(&self) -> PathBuf {
        self.path.join(bodies::NAME)
    }

    /// Tables of sensors and of rigid bodies.
    pub fn tables(&self) -> Result<Vec<PathBuf>> {
        let is_named =
            |name: &String| name == bodies::NAME || name.starts_with("sensor") && name.ends_with(".csv");
        let tables = names(&self.path)?.into_iter().filter(is_named);
        let tables = tables.map(|name| self.path.join(name));
        Ok(tables.filter(|path| sensors::is_table(path)).collect())
    }

    pub fn manifest(&self) -> PathBuf {
        self.path.join("run.json")
    }

    /// Refuses to replace files that no run has recorded: `coming` are those of the run that is about to begin.
    pub fn check_names(&self, coming: &Record) -> Result<()> {
        let earlier = Record::read(&self.path);
        let mut names = names(&self.path)?.into_iter();
        match names.find(|name| coming.has(name) && !earlier.has(name)) {
            None => Ok(()),
            Some(name) => Err(Error::usage(
                format!(
                    "{} would be replaced, and no run in this folder has recorded it as its own",
                    self.path.join(name).display()
                ),
                "move it to another place, or choose another folder with --out",
            )),
        }
    }

    /// Removes what an earlier run has recorded as its own, and nothing else; says what that was, and what of the same
    /// kind stays.
    pub fn clear(&self) -> Result<Vec<String>> {
        let earlier = self.earlier()?;
        let mut told = Vec::new();
        if !earlier.files.is_empty() {
            // The record goes last, so that what is left of a removal that was cut off is still known.
            let (record, files): (Vec<_>, Vec<_>) =
                earlier.files.iter().partition(|name| *name == "run.json");
            for name in files {
                self.remove(name)?;
            }
            for folder in &earlier.arrays {
                self.remove_folder(folder)?;
            }
            for name in record {
                self.remove(name)?;
            }
            told.push(format!(
                "removed an earlier run from {}: {earlier}",
                self.path.display()
            ));
        }
        if let Some(first) = earlier.others.first() {
            told.push(format!(
                "{} files stay in {}, since no run has recorded them as its own: {first}{}",
                count(earlier.others.len() as u64),
                self.path.display(),
                if earlier.others.len() > 1 { ", …" } else { "" }
            ));
        }
        Ok(told)
    }

    /// Removes a file of the folder, which it names as [`names`] does.
    pub fn remove(&self, name: &str) -> Result<()> {
        let path = self.path.join(name);
        files::remove(&path).map_err(|reason| disk::failed(&path, "remove", reason))
    }

    /// Removes a folder of arrays, unless something is left in it.
    pub fn remove_folder(&self, name: &str) -> Result<()> {
        let path = self.path.join(name);
        match fs::remove_dir(&path) {
            Err(reason) if reason.kind() != io::ErrorKind::DirectoryNotEmpty => {
                Err(disk::failed(&path, "remove", reason))
            }
            _ => Ok(()),
        }
    }

    fn earlier(&self) -> Result<Earlier> {
        let record = Record::read(&self.path);
        let mut earlier = Earlier::default();
        for name in names(&self.path)? {
            // Surfaces are made afterwards, so the manifest does not know them; they say themselves whose they are.
            let is_surface = name.starts_with("surface_") && is_surface(&self.path.join(&name));
            if !record.has(&name) && !is_surface {
                if is_like_ours(&name) {
                    earlier.others.push(name);
                }
                continue;
            }
            earlier.files.push(name.clone());
            if name.starts_with("post_mortem/") {
                earlier.arrays.insert(POST_MORTEM.into());
            }
            let kind = match name.split(['_', '.']).next() {
                _ if name.ends_with(".part") => continue,
                Some("frame") => match numbered(&name, "frame_", ".png") {
                    Some(_) => &mut earlier.pictures,
                    None => &mut earlier.passes,
                },
                Some("checkpoint") => &mut earlier.checkpoints,
                Some("surface") => &mut earlier.surfaces,
                Some("sensor" | "sensors") => &mut earlier.sensors,
                Some("particles") if frame_of(&name).is_some() => match name.split_once('/') {
                    Some((folder, _)) => {
                        earlier.arrays.insert(folder.to_owned());
                        continue;
                    }
                    None => &mut earlier.particles,
                },
                _ => &mut earlier.records,
            };
            kind.push(name);
        }
        Ok(earlier)
    }

    /// Refuses a folder in which something that a run writes is a link: its bytes would go to another place.
    fn refuse_links(&self) -> Result<()> {
        let mut names = names(&self.path)?.into_iter();
        let is_ours = |name: &String| is_like_ours(name) || name.ends_with(".part");
        match names.find(|name| is_ours(name) && files::is_link(&self.path.join(name))) {
            None => Ok(()),
            Some(name) => Err(Error::usage(
                format!(
                    "{} is a link to another place, and runs neither write nor remove through links",
                    self.path.join(name).display()
                ),
                "remove the link, or put what it leads to in its place",
            )),
        }
    }

    fn try_writing(&self) -> Result<()> {
        // Always the same file, so that one left by a run that was killed is removed by the next.
        let trial = self.path.join(".sliceflow");
        files::create(&trial)
            .and_then(|_| files::remove(&trial))
            .map_err(|reason| disk::failed(&self.path, "write into", reason))
    }
}

impl std::fmt::Display for Earlier {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counted =
            |files: usize, what: &str| (files > 0).then(|| format!("{} {what}", count(files as u64)));
        let parts = counted(self.pictures.len(), "frames")
            .into_iter()
            .chain(counted(self.passes.len(), "files of extra images"))
            .chain(counted(self.particles.len(), "particle files"))
            .chain(counted(self.arrays.len(), "folders of arrays"))
            .chain(counted(self.surfaces.len(), "surfaces"))
            .chain(counted(self.checkpoints.len(), "checkpoints"))
            .chain(counted(self.sensors.len(), "files of sensors"))
            .chain(self.records.iter().cloned());
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

/// The number in a name that is `prefix`, at least six digits, `suffix`.
pub fn numbered(name: &str, prefix: &str, suffix: &str) -> Option<u32> {
    let digits = name.strip_prefix(prefix)?.strip_suffix(suffix)?;
    let all = digits.len() >= 6 && digits.bytes().all(|b| b.is_ascii_digit());
    all.then(|| digits.parse().ok()).flatten()
}

const GLB_TEXT: &[u8] = br#"{"asset":{"generator":"Sliceflow""#;

/// Whether a file begins as surfaces of Sliceflow do.
pub fn is_surface(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = files::open(path).and_then(|file| file.take(64).read_to_end(&mut head));
    let marks: [&[u8]; 2] = [
        b"# Sliceflow\n",
        b"ply\nformat binary_little_endian 1.0\ncomment Sliceflow\n",
    ];
    // In a .glb the text stands behind two headers.
    let is_glb = head.starts_with(b"glTF") && head.get(20..).is_some_and(|text| text.starts_with(GLB_TEXT));
    read.is_ok() && !files::is_link(path) && (is_glb || marks.iter().any(|mark| head.starts_with(mark)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::manifest::Files;

    fn names(path: &Path) -> Vec<String> {
        let entries = fs::read_dir(path).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// A manifest as a run of ten frames leaves it.
    const MANIFEST: &str = r#"{"program":"sliceflow","first_frame":0,"last_frame":9,"files":[{"name":"run.json"},
        {"name":"frame_NNNNNN.png"},{"name":"particles_NNNNNN/COLUMN.npy"},{"name":"particles_NNNNNN.vtp"},
        {"name":"particles.pvd"},{"name":"sensors.csv"}]}"#;

    fn put(path: &Path, names: &[&str]) {
        for name in names {
            if let Some((folder, _)) = name.split_once('/') {
                fs::create_dir_all(path.join(folder)).unwrap();
            }
            fs::write(path.join(name), b"").unwrap();
        }
    }

    #[test]
    fn an_earlier_run_is_refused_and_then_replaced_alone() {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path().join("deep/out");
        let folder = Folder::open(&path, false).unwrap();
        assert!(folder.clear().unwrap().is_empty());
        let ours = [
            "frame_000000.png",
            "frame_000009.png",
            "frame_000003.png.part",
            "particles_000000/id.npy",
            "particles_000000.vtp",
            "particles.pvd",
            "sensors.csv",
            "sensors_pressure.png",
        ];
        let others = [
            "notes.txt",
            "frame_000123.png",
            "particles_000001/mine.npy",
            "particles_000002.ply",
            "surface_000001.obj",
            "sensor_mine.csv",
        ];
        put(&path, &ours);
        put(&path, &others);
        fs::write(path.join("surface_000002.obj"), "# Sliceflow\nv 0 0 0\n").unwrap();
        fs::write(folder.manifest(), MANIFEST).unwrap();

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
        assert!(path.join("run.json").exists());

        let folder = Folder::open(&path, true).unwrap();
        let told = folder.clear().unwrap();
        assert!(
            told[0].contains("2 frames") && told[0].contains("run.json"),
            "{told:?}"
        );
        assert!(
            told[1].contains("5 files stay") && told[1].contains("frame_000123.png"),
            "{told:?}"
        );
        let left = super::super::record::names(&path).unwrap();
        let mut expected = others.map(str::to_owned);
        expected.sort();
        assert_eq!(left, expected[..]);
        assert!(!path.join("particles_000000").exists());
    }

    #[test]
    fn what_no_run_has_recorded_is_neither_removed_nor_replaced() {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path();
        put(path, &["frame_000003.png", "frame_000123.png"]);
        let folder = Folder::open(path, true).unwrap();
        let file = |name: &str| Files {
            name: name.into(),
            about: String::new(),
        };
        let coming = [file("run.json"), file("frame_NNNNNN.png")];
        let told = folder
            .check_names(&Record::new(&coming, 0..=9))
            .unwrap_err()
            .to_string();
        assert!(
            told.contains("frame_000003.png") && told.contains("--out"),
            "{told}"
        );
        assert!(folder.check_names(&Record::new(&coming, 10..=19)).is_ok());
        assert!(folder.clear().unwrap()[0].contains("2 files stay"));
        assert_eq!(names(path), ["frame_000003.png", "frame_000123.png"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_under_names_of_a_run_are_refused_and_others_stay() {
        use std::os::unix::fs::symlink;

        let temporary = tempfile::tempdir().unwrap();
        let (path, outside) = (temporary.path().join("run"), temporary.path().join("outside"));
        fs::create_dir_all(&path).unwrap();
        put(&outside, &["a/id.npy"]);
        symlink(&outside, path.join("latest")).unwrap();
        assert!(Folder::open(&path, true).is_ok());
        for name in [
            "particles_000005",
            "stats.jsonl",
            "run.json.part",
            "checkpoint_000001.bin",
        ] {
            symlink(outside.join("a"), path.join(name)).unwrap();
            let told = Folder::open(&path, true).unwrap_err().to_string();
            assert!(told.contains(name) && told.contains("a link"), "{told}");
            fs::remove_file(path.join(name)).unwrap();
        }
        assert!(outside.join("a/id.npy").exists());
    }

    #[test]
    fn only_numbered_names_count() {
        assert_eq!(numbered("frame_000012.png", "frame_", ".png"), Some(12));
        assert_eq!(numbered("particles_1000000", "particles_", ""), Some(1_000_000));
        for other in [
            "frame_0.png",
            "frame_00000x.png",
            "frame_000000.jpg",
            "my_frame_000000.png",
        ] {
            assert_eq!(numbered(other, "frame_", ".png"), None, "{other}");
        }
    }
}
