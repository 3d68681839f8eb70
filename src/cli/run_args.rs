//! Arguments that `run` and `plan` share: the scene and what to write.

use std::path::PathBuf;

use super::checkpoint_args::CheckpointArgs;
use super::grid;
use super::particle_args::ParticleArgs;
use super::rerun_args::RerunArgs;
use super::scene_args::{Choices, SceneArgs};
use crate::error::Result;
use crate::output::{Checkpoints, Outputs, VideoOutput};
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
    #[command(flatten)]
    particles: ParticleArgs,
    /// Makes a video: .mp4 and .webm by the program ffmpeg; .gif and .png (animated), small, by Sliceflow itself
    #[arg(long, value_name = "FILE")]
    video: Option<PathBuf>,
    /// Draws no pictures, nor extra images
    #[arg(long, conflicts_with = "passes")]
    no_pictures: bool,
    /// Writes no statistics; guards of energy, overlap and density need them
    #[arg(long)]
    no_statistics: bool,
    #[command(flatten)]
    rerun: RerunArgs,
    #[command(flatten)]
    checkpoints: CheckpointArgs,
}

impl RunArgs {
    /// `memory` is what the scene may take before it runs, bytes, where the user does not say.
    pub fn load(&self, memory: Option<u64>) -> Result<Scene> {
        self.scene.load(&Choices {
            memory,
            frames: self.frames,
            grid: self.grid.as_deref(),
            view: self.view.as_deref(),
            no_passes: self.no_pictures,
        })
    }

    pub fn outputs(&self) -> Result<Outputs> {
        Ok(Outputs {
            pictures: !self.no_pictures,
            statistics: !self.no_statistics,
            particles: self.particles.output()?,
            video: self.video.as_deref().map(VideoOutput::new).transpose()?,
            rerun: self.rerun.settings(),
            checkpoints: self.checkpoints.or(Checkpoints::default()),
        })
    }
}
