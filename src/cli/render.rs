//! `sliceflow render`

use std::path::PathBuf;

use super::scene_args::size;
use super::sitting_args::{SittingArgs, beside};
use crate::error::Result;
use crate::output::{self, Checkpoints, Every, Outputs, Recorded};

/// Draws a run's frames again without simulating: another camera, color, size or view
///
/// Particles come from the run's particle files (`--particles`, any format) or its checkpoints; frames that have neither are
/// left out and told. Colors by contacts, density or pressure are measured again, by one search a frame.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of the run
    #[arg(long, value_name = "RUN")]
    from: PathBuf,
    /// Changes what is drawn: render.color.by=y, render.camera.eye=[1,1,2] (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// What pictures show: the scene, the index pool as a heatmap, or both
    #[arg(long, value_parser = ["scene", "pool", "both"])]
    view: Option<String>,
    /// Size of pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Folder to write [default: RUN_render]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces earlier pictures in that folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    sitting: SittingArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow render --from out/green_cube --set render.color.by=y --set render.color.map=turbo
  sliceflow render --from out/green_cube --size 3840x2160 --out out/green_cube_large
  sliceflow render --from out/harada_figure_2_small --view both --set neighbors.storage=pool";

pub fn main(args: &Args) -> Result<()> {
    let recorded = Recorded::read(&args.from)?;
    let mut overrides = args.set.clone();
    overrides.extend(args.view.iter().map(|view| format!("render.view={view}")));
    overrides.extend(
        args.size
            .map(|[width, height]| format!("render.size=[{width},{height}]")),
    );
    let folder = match &args.out {
        Some(out) => out.clone(),
        None => beside(&args.from, "render")?,
    };
    let outputs = Outputs {
        pictures: true,
        statistics: false,
        particles: None,
        video: None,
        rerun: None,
        checkpoints: Checkpoints {
            every: Every::Never,
            ..Default::default()
        },
    };
    let settings = args.sitting.settings(folder, args.force, outputs, false);
    output::redraw(&recorded, &overrides, &settings)
}
