//! The formats of particle files, registered once.

use std::path::Path;

use super::cloud::Moment;
use super::{bgeo, ply, pvd, vtk};
use crate::error::Result;
use crate::output::{disk, npy};
use crate::simulation::frame::{ColumnData, Values};

/// A format of particle files. To add one: a row of [`FORMATS`].
#[derive(Debug)]
pub struct Format {
    /// On the command line.
    pub name: &'static str,
    pub about: &'static str,
    /// A frame's file, for the manifest.
    pub file: &'static str,
    /// Whether a file is a cloud of points, which needs positions.
    pub is_points: bool,
    /// Whether coordinates lose digits far from zero.
    pub is_single_precision: bool,
    /// What a particle's position takes, with what the format adds to it.
    pub position_bytes: usize,
    /// Writes a frame's columns; the path is that of the frame's files, without an extension.
    pub(super) write: fn(&Moment, &Path) -> Result<()>,
    /// Writes what names all frames' files with their times, from those that are in a folder; takes frames a second.
    pub index: Option<fn(&Path, f64) -> Result<()>>,
}

pub const FORMATS: &[Format] = &[
    Format {
        name: "ply",
        about: "points with properties: Blender, MeshLab, Open3D, splashsurf",
        file: "particles_NNNNNN.ply",
        is_points: true,
        is_single_precision: true,
        position_bytes: 12,
        write: |moment, stem| disk::write(&stem.with_extension("ply"), &ply::encode(moment)),
        index: None,
    },
    Format {
        name: "vtk",
        about: "VTK points (.vtp), and particles.pvd with their times: ParaView, PyVista",
        file: "particles_NNNNNN.vtp",
        is_points: true,
        is_single_precision: false,
        position_bytes: 32,
        write: |moment, stem| disk::write(&stem.with_extension("vtp"), &vtk::encode(moment)),
        index: Some(pvd::write),
    },
    Format {
        name: "bgeo",
        about: "points with attributes: Houdini, splashsurf, SPlisHSPlasH",
        file: "particles_NNNNNN.bgeo",
        is_points: true,
        is_single_precision: true,
        position_bytes: 16,
        write: |moment, stem| disk::write(&stem.with_extension("bgeo"), &bgeo::encode(moment)),
        index: None,
    },
    Format {
        name: "npy",
        about: "a folder per frame, a NumPy array per column",
        file: "particles_NNNNNN/COLUMN.npy",
        is_points: false,
        is_single_precision: false,
        position_bytes: 24,
        write: write_arrays,
        index: None,
    },
];

fn write_arrays(moment: &Moment, folder: &Path) -> Result<()> {
    disk::create_folder(folder)?;
    for column in &moment.columns {
        let path = folder.join(column.name).with_extension("npy");
        write_array(column, &path).map_err(|reason| disk::failed(&path, "write", reason))?;
    }
    Ok(())
}

fn write_array(column: &ColumnData, path: &Path) -> std::io::Result<()> {
    match &column.values {
        Values::Float(values) => npy::write(path, 1, values),
        Values::Unsigned(values) => npy::write(path, 1, values),
        Values::Double { columns, values } => npy::write(path, *columns, values),
        Values::Vector { columns, values } => npy::write(path, *columns, values),
    }
}
