//! The arrays that `sliceflow neighbors` writes.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::output::npy;
use crate::scene::npy::Number;
use crate::simulation::NeighborLists;

/// Where counts and lists go.
pub struct Files {
    counts: Option<PathBuf>,
    /// Offsets and ids.
    lists: Option<[PathBuf; 2]>,
}

impl Files {
    /// Refuses before any work is done what could not be written after it.
    pub fn new(counts: Option<&Path>, lists: Option<&Path>, force: bool) -> Result<Self> {
        let is_npy = |path: &Path| path.extension().is_some_and(|ending| ending == "npy");
        if let Some(path) = counts.filter(|path| !is_npy(path)) {
            return Err(Error::usage(
                format!(
                    "--counts writes a NumPy array, and {} is no name for one",
                    path.display()
                ),
                "let the name end in .npy",
            ));
        }
        if let Some(prefix) = lists.filter(|path| is_npy(path) || path.file_name().is_none() || path.is_dir())
        {
            return Err(Error::usage(
                format!(
                    "--lists {} is not the beginning of a file's name",
                    prefix.display()
                ),
                "give one: with `--lists pairs` the files are pairs_offsets.npy and pairs_ids.npy",
            ));
        }
        let files = Self {
            counts: counts.map(Path::to_owned),
            lists: lists.map(|prefix| ["_offsets.npy", "_ids.npy"].map(|ending| with(prefix, ending))),
        };
        for path in files.paths() {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
                return Err(Error::usage(
                    format!("there is no folder {} for {}", folder.display(), path.display()),
                    "create it, or choose another",
                ));
            }
            if path.exists() && !force {
                return Err(Error::usage(
                    format!("{} exists", path.display()),
                    "move it, choose another name, or replace it with --force",
                ));
            }
        }
        match (&files.counts, &files.lists) {
            (Some(counts), Some(lists)) if lists.contains(counts) => Err(Error::usage(
                format!("{} would be written twice", counts.display()),
                "give --counts another name",
            )),
            _ => Ok(files),
        }
    }

    pub fn paths(&self) -> Vec<PathBuf> {
        self.counts
            .iter()
            .chain(self.lists.iter().flatten())
            .cloned()
            .collect()
    }

    pub fn write(&self, counts: &[u32], lists: Option<&NeighborLists>) -> Result<()> {
        if let Some(path) = &self.counts {
            write(path, counts)?;
        }
        if let (Some([offsets, ids]), Some(lists)) = (&self.lists, lists) {
            write(offsets, &lists.start)?;
            write(ids, &lists.ids)?;
        }
        Ok(())
    }
}

fn with(prefix: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(prefix);
    name.push(ending);
    name.into()
}

fn write<T: Number>(path: &Path, values: &[T]) -> Result<()> {
    npy::write(path, 1, values).map_err(|reason| {
        Error::file(
            path,
            "write",
            reason,
            "check that the folder may be written and has room, or choose another",
        )
    })
}
