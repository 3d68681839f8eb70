//! Particles of a run's frames, read back from its particle files or its checkpoints.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::checkpoint::Checkpoint;
use super::configuration::Recorded;
use super::particles::{FORMATS, found};
use super::rewind::checkpoints;
use crate::error::{Error, Result};
use crate::files;
use crate::scene::npy::Array;
use crate::scene::particle_file;
use crate::simulation::State;

const UNREADABLE: &str = "was it written whole? remove it, and do without its frame";

/// Which frames of a run can be read back, and from what.
pub struct ReadBack {
    frames: BTreeMap<u32, PathBuf>,
    /// Boundary particles of the run, which checkpoints hold behind all others.
    boundary: usize,
}

/// One frame.
pub struct Snapshot {
    /// In order of id, without boundary particles.
    pub columns: Vec<Column>,
    /// Where it comes from a checkpoint.
    pub state: Option<State>,
}

/// One column of a frame.
pub struct Column {
    pub name: String,
    /// Numbers per particle: 3 of a vector (z is 0 in 2D), otherwise 1.
    pub width: usize,
    /// In order of id.
    pub values: Vec<f64>,
    /// Whether the file rounded to single precision what others keep in double.
    pub is_rounded: bool,
}

impl ReadBack {
    /// Looks into a run's folder; particle files come before checkpoints, since they hold more columns.
    pub fn open(folder: &Path) -> Result<Self> {
        let mut frames: BTreeMap<u32, PathBuf> = checkpoints(folder)?.into_iter().collect();
        frames.extend(found::find(folder)?);
        // Folders that nothing was simulated in have no manifest, and no checkpoints either.
        let boundary = Recorded::read(folder).map_or(0, |recorded| recorded.boundary_particles);
        Ok(Self { frames, boundary })
    }

    /// In order.
    pub fn frames(&self) -> impl Iterator<Item = u32> {
        self.frames.keys().copied()
    }

    /// `None` where there is no such frame.
    pub fn read(&self, frame: u32) -> Result<Option<Snapshot>> {
        let Some(path) = self.frames.get(&frame) else {
            return Ok(None);
        };
        let snapshot = if path.extension().is_some_and(|extension| extension == "bin") {
            Snapshot::from_checkpoint(path, frame, self.boundary)
        } else {
            Snapshot::read(path)
        };
        snapshot.map(Some)
    }
}

impl Snapshot {
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    pub fn particles(&self) -> usize {
        self.columns.first().map_or(0, Column::particles)
    }

    /// Reads a frame's particle file, or its folder of arrays.
    pub fn read(path: &Path) -> Result<Self> {
        match path.is_dir() {
            true => Self::from_arrays(path),
            false => Self::from_points(path),
        }
    }

    fn from_arrays(folder: &Path) -> Result<Self> {
        let failed =
            |path: &Path, reason: &dyn std::fmt::Display| Error::file(path, "read", reason, UNREADABLE);
        let mut paths = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(|reason| failed(folder, &reason))? {
            let path = entry.map_err(|reason| failed(folder, &reason))?.path();
            if path.extension().is_some_and(|extension| extension == "npy") {
                paths.push(path);
            }
        }
        paths.sort();
        let columns = paths
            .iter()
            .map(|path| Column::from_npy(path).map_err(|reason| failed(path, &reason)))
            .collect::<Result<Vec<_>>>()?;
        let rows = columns.first().map_or(0, Column::particles);
        if let Some(other) = columns.iter().find(|column| column.particles() != rows) {
            let reason = format!(
                "{} has {} rows and {} has {rows}",
                other.name,
                other.particles(),
                columns[0].name
            );
            return Err(failed(folder, &reason));
        }
        Ok(Self { columns, state: None })
    }

    fn from_points(path: &Path) -> Result<Self> {
        let attributes =
            particle_file::load_attributes(path).map_err(|what| Error::usage(what, UNREADABLE))?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let is_single = FORMATS
            .iter()
            .any(|format| format.is_single_precision && format.file.ends_with(&*ending));
        let column = |attribute: particle_file::Attribute| Column {
            is_rounded: is_single && attribute.name == "position",
            name: attribute.name,
            width: attribute.width,
            values: attribute.values,
        };
        Ok(Self {
            columns: attributes.into_iter().map(column).collect(),
            state: None,
        })
    }

    fn from_checkpoint(path: &Path, frame: u32, boundary: usize) -> Result<Self> {
        let failed = |wrong: String| Error::file(path, "read", wrong, "remove it, and do without its frame");
        let state = Checkpoint::read(path).map_err(failed)?.state;
        let vectors = ["position", "velocity", "acceleration"].map(|name| state.vectors(name));
        let count = state.ids().len();
        if state.frame != frame || vectors.iter().flatten().any(|vectors| vectors.len() != count) {
            return Err(failed(
                "it is of another frame, or not as this version writes it".into(),
            ));
        }
        let ids = state.ids();
        let mut slot_of: Vec<usize> = (0..ids.len()).collect();
        slot_of.sort_by_key(|&slot| ids[slot]);
        slot_of.truncate(ids.len().saturating_sub(boundary));
        let column = |name: &str| {
            let vectors = state.vectors(name)?;
            let origin = if name == "position" {
                state.origin
            } else {
                Default::default()
            };
            let values = slot_of
                .iter()
                .flat_map(|&slot| (vectors[slot].as_dvec3() + origin).to_array());
            Some(Column {
                name: name.to_owned(),
                width: 3,
                values: values.collect(),
                is_rounded: false,
            })
        };
        let vectors = ["position", "velocity", "acceleration"];
        let mut columns: Vec<Column> = vectors.into_iter().filter_map(column).collect();
        if let Some(bytes) = state.buffer("radius") {
            let radii: Vec<f32> = bytemuck::pod_collect_to_vec(bytes);
            if radii.len() != count {
                return Err(failed("it has not all radii".into()));
            }
            columns.push(Column {
                name: "radius".into(),
                width: 1,
                values: slot_of.iter().map(|&slot| f64::from(radii[slot])).collect(),
                is_rounded: false,
            });
        }
        Ok(Self {
            columns,
            state: Some(state),
        })
    }
}

impl Column {
    pub fn particles(&self) -> usize {
        self.values.len() / self.width
    }

    fn from_npy(path: &Path) -> std::io::Result<Self> {
        let wrong = |what: String| std::io::Error::new(std::io::ErrorKind::InvalidData, what);
        let file = files::read(path)?;
        let array = Array::parse(&file)?;
        let width = match array.shape[..] {
            [_] => 1,
            [_, width] if width > 0 && !array.is_fortran => width,
            _ => {
                return Err(wrong(format!(
                    "the array has shape {:?}{}, and columns have one row per particle",
                    array.shape,
                    if array.is_fortran { " in Fortran order" } else { "" }
                )));
            }
        };
        let values = array
            .numbers()
            .ok_or_else(|| wrong(format!("the array holds {}, no numbers", array.told_kind())))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if ["position", "velocity", "acceleration"].contains(&&*name) && !(2..=3).contains(&width) {
            return Err(wrong(format!(
                "the array has {width} numbers per particle, and vectors have 2 or 3"
            )));
        }
        let (width, values) = match width {
            2 => (
                3,
                values.chunks_exact(2).flat_map(|v| [v[0], v[1], 0.0]).collect(),
            ),
            _ => (width, values),
        };
        Ok(Self {
            name: name.into_owned(),
            width,
            values,
            is_rounded: false,
        })
    }
}
