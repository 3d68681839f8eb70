//! `sliceflow render`

use std::path::PathBuf;

use super::look_args::LookArgs;
use super::scene_args::size;
use super::sitting_args::{SittingArgs, beside};
use crate::error::Result;
use crate::output::{self, Checkpoints, Every, FrameRange, Outputs, Recorded, VideoOutput};

/// Draws a run's frames again without simulating: another camera, color, size or view, or a video
///
/// Particles come from the run's particle files (`--particles`, any format) or its checkpoints; a message names frames that
/// have neither. Any column that the files hold can color them; others are measured again where positions and velocities
/// tell them, by one search per frame.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of the run
    run: PathBuf,
    /// Frames to draw, both included: 10..40, 10.., ..40 or 12 [default: all]
    #[arg(long, value_name = "FIRST..LAST")]
    frames: Option<FrameRange>,
    /// Changes what is drawn: render.color.by=y, render.camera.eye=[1,1,2] (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// What pictures show: the scene, the index pool as a heatmap, or both
    #[arg(long, value_parser = ["scene", "pool", "both"])]
    view: Option<String>,
    /// Size of pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    #[command(flatten)]
    looks: LookArgs,
    /// Makes a video: .mp4 and .webm by the program ffmpeg; .gif and .png (animated), small, by Sliceflow itself
    #[arg(long, value_name = "FILE")]
    video: Option<PathBuf>,
    /// Writes no picture of each frame, nor extra images
    #[arg(long, requires = "video", conflicts_with = "passes")]
    no_pictures: bool,
    /// Folder to write [default: RUN_render]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces earlier pictures in that folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    sitting: SittingArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow render out/green_cube --set render.color.by=y --set render.color.map=turbo
  sliceflow render out/green_cube --size 3840x2160 --out out/green_cube_large
  sliceflow render out/dam --look water --no-overlay
  sliceflow render out/dam --passes color,depth,normal,motion --set render.background=transparent
  sliceflow render out/dam --set render.color.by=pressure --frames 10..40 --video out/dam.gif
  sliceflow render out/harada_figure_2_small --view both --set neighbors.storage=pool";

pub fn main(args: &Args) -> Result<()> {
    let recorded = Recorded::read(&args.run)?;
    let mut overrides = args.set.clone();
    args.looks.put(&mut |key: &str, value: Option<String>| {
        overrides.extend(value.map(|value| format!("{key}={value}")));
    });
    overrides.extend(args.no_pictures.then(|| "render.passes=[]".to_owned()));
    overrides.extend(args.view.iter().map(|view| format!("render.view={view}")));
    overrides.extend(
        args.size
            .map(|[width, height]| format!("render.size=[{width},{height}]")),
    );
    let folder = match &args.out {
        Some(out) => out.clone(),
        None => beside(&args.run, "render")?,
    };
    let outputs = Outputs {
        pictures: !args.no_pictures,
        statistics: false,
        particles: None,
        video: args.video.as_deref().map(VideoOutput::new).transpose()?,
        rerun: None,
        checkpoints: Checkpoints {
            every: Every::Never,
            ..Default::default()
        },
    };
    let settings = args.sitting.settings(folder, args.force, outputs, false)?;
    output::redraw(
        &recorded,
        &overrides,
        args.frames.unwrap_or(FrameRange::ALL),
        &settings,
    )
}
