//! `sliceflow resume`

use std::path::PathBuf;

use super::checkpoint_args::CheckpointArgs;
use super::guard_args::GuardArgs;
use super::run;
use super::scene_args::duration;
use super::sitting_args::{SittingArgs, beside};
use crate::error::Result;
use crate::output::{self, Recorded};

/// Goes on with a run that was stopped, or starts a variant from one of its frames
///
/// The run goes on after its newest checkpoint, in its own folder, and comes to the same bytes as if nothing had
/// happened. A damaged checkpoint is reported, and the one before it is used; without any, the run begins again.
/// With --branch-at, a variant starts from that frame in a folder of its own; the state of the frame is simulated again
/// where no checkpoint has it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of the run
    run: PathBuf,
    /// Frames that the run is to have, the first state included [default: as it was started]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Starts a variant from this frame
    #[arg(long, value_name = "FRAME")]
    branch_at: Option<u32>,
    /// Changes a key of the variant's scene: gravity=[0,0,0] (repeatable)
    #[arg(long, value_name = "KEY=VALUE", requires = "branch_at")]
    set: Vec<String>,
    /// The variant's folder [default: RUN_at_FRAME]
    #[arg(short, long, value_name = "DIR", requires = "branch_at")]
    out: Option<PathBuf>,
    /// Replaces an earlier run in the variant's folder, or a video or recording outside of the run's folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    checkpoints: CheckpointArgs,
    #[command(flatten)]
    guard: GuardArgs,
    #[command(flatten)]
    sitting: SittingArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow resume out/green_cube
  sliceflow resume out/green_cube --frames 600
  sliceflow resume out/green_cube --branch-at 40 --set 'gravity=[0,0,0]' --out out/weightless";

pub fn main(args: &Args) -> Result<()> {
    let recorded = Recorded::read(&args.run)?;
    let configuration = recorded.configuration()?;
    let (mut outputs, guard, timings) = run::recorded(&configuration.arguments)?;
    outputs.checkpoints = args.checkpoints.or(outputs.checkpoints);
    let mut overrides = args.set.clone();
    if let Some(frames) = args.frames {
        let fps = configuration.scene(&overrides)?.time.fps;
        overrides.push(format!("time.duration={:e}", duration(frames, fps)));
    }
    let folder = match (&args.out, args.branch_at) {
        (Some(out), _) => out.clone(),
        (None, Some(frame)) => beside(&args.run, &format!("at_{frame}"))?,
        (None, None) => args.run.clone(),
    };
    let settings = args.sitting.settings(folder, args.force, outputs, timings)?;
    let settings = args.guard.or(guard).put(settings);
    match args.branch_at {
        Some(frame) => output::branch(&recorded, frame, &overrides, &settings),
        None => output::resume(&recorded, &overrides, &settings),
    }
}
