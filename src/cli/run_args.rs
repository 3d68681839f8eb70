//! Arguments that `run` and `plan` share: the scene and what to write.

use super::checkpoint_args::CheckpointArgs;
use super::grid;
use super::rerun_args::RerunArgs;
use super::scene_args::{Choices, SceneArgs};
use crate::error::Result;
use crate::output::{Checkpoints, DEFAULT_COLUMNS, Outputs, columns_named};
use crate::scene::Scene;

#[derive(clap::Args)]
pub struct RunArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Frames to make, the first state included
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// What pictures show: the scene, the index pool as a heatmap, or both
    #[arg(long, value_parser = ["scene", "pool", "both"])]
    view: Option<String>,
    #[arg(long, value_name = "NAME", help = grid::help())]
    grid: Option<String>,
    /// Writes particle files in this format
    #[arg(long, value_name = "FORMAT")]
    particles: Option<Format>,
    /// Columns of particle files (see `sliceflow scenes --columns`)
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', requires = "particles")]
    columns: Vec<String>,
    /// Draws nothing
    #[arg(long)]
    no_pictures: bool,
    /// Measures nothing; the warning about overlapping grains needs it
    #[arg(long)]
    no_statistics: bool,
    #[command(flatten)]
    rerun: RerunArgs,
    #[command(flatten)]
    checkpoints: CheckpointArgs,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// NumPy, one file a column
    Npy,
}

impl RunArgs {
    pub fn load(&self) -> Result<Scene> {
        self.scene.load(&Choices {
            frames: self.frames,
            grid: self.grid.as_deref(),
            view: self.view.as_deref(),
        })
    }

    pub fn outputs(&self) -> Result<Outputs> {
        let particles = match self.particles {
            None => Vec::new(),
            Some(Format::Npy) if self.columns.is_empty() => columns_named(DEFAULT_COLUMNS.iter().copied())?,
            Some(Format::Npy) => columns_named(self.columns.iter().map(|name| name.trim()))?,
        };
        Ok(Outputs {
            pictures: !self.no_pictures,
            statistics: !self.no_statistics,
            particles,
            rerun: self.rerun.settings(),
            checkpoints: self.checkpoints.or(Checkpoints::default()),
        })
    }
}
