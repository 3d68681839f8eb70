//! What a run has left of its particles.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::{Error, Result};
use crate::files;
use crate::output::particles::found::{POSITIONS, find};

/// A run's particle files.
#[derive(Debug)]
pub struct Sequence {
    /// Frames that have files, in order, and the file or folder of arrays.
    pub frames: Vec<(u32, PathBuf)>,
    /// Frames that the run was to have.
    pub wanted: u64,
    /// Metres.
    pub radius: f64,
    pub dimensions: u64,
}

impl Sequence {
    /// Reads the folder of a run.
    pub fn open(run: &Path) -> Result<Self> {
        let path = run.join("run.json");
        let help = "give the folder of a run, which has a run.json";
        let text = files::read(&path).map_err(|reason| Error::file(&path, "read", reason, help))?;
        let manifest: Value =
            serde_json::from_slice(&text).map_err(|reason| Error::file(&path, "read", reason, help))?;
        let scene = &manifest["scene"];
        if scene["grains"]["sizes"].is_object() {
            return Err(Error::usage(
                format!("the grains of {} are of several sizes", run.display()),
                "surfaces are made around particles of one size; `sliceflow usd` keeps each grain's own, and points have \
                 a column `radius`",
            ));
        }
        let spacing = scene["fluid"]["spacing"].as_f64();
        let radius = scene["grains"]["radius"]
            .as_f64()
            .or(spacing.map(|spacing| spacing / 2.0));
        let dimensions = scene["dimensions"].as_u64();
        let (Some(radius), Some(dimensions)) = (radius, dimensions) else {
            return Err(Error::file(
                &path,
                "read",
                "it says no radius of particles, or no dimensions",
                help,
            ));
        };
        let frames = frames(run)?;
        if frames.is_empty() {
            return Err(Error::usage(
                format!("{} has no particle files", run.display()),
                "run the scene again with --particles ply (or vtk, bgeo, npy)",
            ));
        }
        Ok(Self {
            frames,
            wanted: manifest["frames"].as_u64().unwrap_or_default(),
            radius,
            dimensions,
        })
    }
}

/// Frames whose particle files have positions.
fn frames(run: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let has_positions = |path: &PathBuf| !path.is_dir() || path.join(POSITIONS).is_file();
    Ok(find(run)?
        .into_iter()
        .filter(|(_, path)| has_positions(path))
        .collect())
}
