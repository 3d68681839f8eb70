//! Particle files: one folder a frame, one NumPy array a column, rows in order of `id`.

use std::io;
use std::path::Path;
use std::sync::Arc;

use super::folder::Folder;
use super::workers::Workers;
use super::{Sink, disk, npy};
use crate::error::{Error, Result};
use crate::scene::column::{COLUMNS, Column, VECTORS};
use crate::simulation::frame::{ColumnData, Frame, Values};

/// What `--particles` writes unless `--columns` says otherwise.
pub const DEFAULT_COLUMNS: &[&str] = &["position", "velocity", "id", "density", "pressure", "contacts"];

/// The columns with these names, each once.
pub fn columns_named<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Vec<Column>> {
    let mut columns: Vec<Column> = Vec::new();
    for name in names {
        let found = VECTORS
            .iter()
            .chain(COLUMNS)
            .find(|column| column.name == name)
            .ok_or_else(|| {
                let known: Vec<_> = VECTORS.iter().chain(COLUMNS).map(|column| column.name).collect();
                Error::usage(
                    format!("no column is named `{name}`"),
                    format!("choose among {}", known.join(", ")),
                )
            })?;
        if !columns.contains(found) {
            columns.push(*found);
        }
    }
    Ok(columns)
}

/// Writes columns that a frame brings along.
pub struct ParticleFiles {
    folder: Arc<Folder>,
    columns: Vec<Column>,
    workers: Workers,
}

impl ParticleFiles {
    pub fn new(folder: Arc<Folder>, columns: &[Column]) -> Self {
        Self {
            folder,
            columns: columns.to_vec(),
            workers: Workers::new(1),
        }
    }
}

impl Sink for ParticleFiles {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        let target = self.folder.particles(frame.index);
        let (frame, columns) = (frame.clone(), self.columns.clone());
        self.workers.submit(move || {
            disk::create_folder(&target)?;
            let is_mine = |found: &&ColumnData| columns.iter().any(|column| column.name == found.name);
            for column in frame.columns.iter().filter(is_mine) {
                let path = target.join(column.name).with_extension("npy");
                write(column, &path).map_err(|reason| disk::failed(&path, "write", reason))?;
            }
            Ok(())
        })
    }

    fn flush(&mut self) -> Result<()> {
        self.workers.wait()
    }

    fn finish(&mut self) -> Result<()> {
        self.workers.finish()
    }
}

fn write(column: &ColumnData, path: &Path) -> io::Result<()> {
    match &column.values {
        Values::Float(values) => npy::write(path, 1, values),
        Values::Unsigned(values) => npy::write(path, 1, values),
        Values::Double { columns, values } => npy::write(path, *columns, values),
        Values::Vector { columns, values } => npy::write(path, *columns, values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_columns_exist() {
        let columns = columns_named(DEFAULT_COLUMNS.iter().copied()).unwrap();
        assert_eq!(columns.len(), DEFAULT_COLUMNS.len());
    }

    #[test]
    fn columns_come_once_and_unknown_ones_are_told() {
        assert_eq!(columns_named(["speed", "id", "speed"]).unwrap().len(), 2);
        let message = columns_named(["mass"]).unwrap_err().to_string();
        assert!(
            message.contains("`mass`") && message.contains("position"),
            "{message}"
        );
    }
}
