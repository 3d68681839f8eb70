//! The folder of a run: what its files are called, and what an earlier run left there.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::text::count;
use super::{disk, sensors};
use crate::error::{Error, Result};

/// A folder that exists and can be written, by nobody else as long as this lives.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: Option<fs::File>,
}

const PARTICLE_EXTENSIONS: [&str; 3] = [".ply", ".vtp", ".bgeo"];

/// Files that a run writes, found before this one.
#[derive(Debug, Default)]
struct Earlier {
    pictures: Vec<PathBuf>,
    particles: Vec<PathBuf>,
    /// Folders of NumPy arrays.
    arrays: Vec<PathBuf>,
    surfaces: Vec<PathBuf>,
    checkpoints: Vec<PathBuf>,
    /// Tables and charts of sensors.
    sensors: Vec<PathBuf>,
    /// Manifest, statistics, index.
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

    /// Tables of sensors.
    pub fn sensor_tables(&self) -> Result<Vec<PathBuf>> {
        let failed = |reason| disk::failed(&self.path, "list", reason);
        let mut tables = Vec::new();
        for entry in fs::read_dir(&self.path).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let is_named = name.starts_with("sensor") && name.ends_with(".csv");
            if is_named && sensors::is_table(&path) {
                tables.push(path);
            }
        }
        tables.sort();
        Ok(tables)
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
        let files = [
            &earlier.pictures,
            &earlier.particles,
            &earlier.surfaces,
            &earlier.checkpoints,
            &earlier.sensors,
            &earlier.records,
        ];
        for file in files.into_iter().flatten() {
            fs::remove_file(file).map_err(|reason| disk::failed(file, "remove", reason))?;
        }
        for folder in &earlier.arrays {
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
        let tables = self.sensor_tables()?;
        let charts = tables.iter().map(|table| table.with_extension("png"));
        let charts: Vec<PathBuf> = match tables.contains(&self.sensors()) {
            true => charts
                .chain(sensors::chart_names().map(|name| self.path.join(name)))
                .collect(),
            false => charts.collect(),
        };
        for entry in fs::read_dir(&self.path).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let records = [
                self.manifest(),
                self.statistics(),
                Self::index_of_particles(&self.path),
            ];
            let is_particles = |extension| numbered(&name, "particles_", extension).is_some();
            if records.contains(&path) {
                earlier.records.push(path);
            } else if tables.contains(&path) || charts.contains(&path) {
                earlier.sensors.push(path);
            } else if numbered(&name, "frame_", ".png").is_some() {
                earlier.pictures.push(path);
            } else if numbered(&name, "checkpoint_", ".bin").is_some() {
                earlier.checkpoints.push(path);
            } else if PARTICLE_EXTENSIONS.into_iter().any(is_particles) {
                earlier.particles.push(path);
            } else if [".ply", ".obj"]
                .iter()
                .any(|e| numbered(&name, "surface_", e).is_some())
            {
                earlier.surfaces.push(path);
            } else if is_particles("") && path.is_dir() {
                earlier.arrays.push(path);
            }
        }
        Ok(earlier)
    }

    fn try_writing(&self) -> Result<()> {
        // Always the same file, so that one left by a run that was killed is removed by the next.
        let trial = self.path.join(".sliceflow");
        let removed = || match fs::remove_file(&trial) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            other => other,
        };
        fs::write(&trial, b"")
            .and_then(|()| removed())
            .map_err(|reason| disk::failed(&self.path, "write into", reason))
    }
}

impl Earlier {
    fn is_empty(&self) -> bool {
        [
            &self.pictures,
            &self.particles,
            &self.arrays,
            &self.surfaces,
            &self.checkpoints,
            &self.sensors,
            &self.records,
        ]
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
            .chain(counted(&self.particles, "particle files"))
            .chain(counted(&self.arrays, "folders of arrays"))
            .chain(counted(&self.surfaces, "surfaces"))
            .chain(counted(&self.checkpoints, "checkpoints"))
            .chain(counted(&self.sensors, "files of sensors"))
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

/// The number in a name that is `prefix`, at least six digits, `suffix`.
pub fn numbered(name: &str, prefix: &str, suffix: &str) -> Option<u32> {
    let digits = name.strip_prefix(prefix)?.strip_suffix(suffix)?;
    let all = digits.len() >= 6 && digits.bytes().all(|b| b.is_ascii_digit());
    all.then(|| digits.parse().ok()).flatten()
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
        for name in [
            "particles_000000.ply",
            "particles_000000.vtp",
            "particles_000000.bgeo",
            "particles.pvd",
        ] {
            fs::write(path.join(name), b"").unwrap();
        }

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
        assert_eq!(names(&path).len(), 9);

        let told = Folder::open(&path, true).unwrap().clear().unwrap().unwrap();
        assert!(told.contains("2 frames") && told.contains("run.json"), "{told}");
        assert_eq!(names(&path), ["notes.txt"]);
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
