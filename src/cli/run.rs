//! `sliceflow run`

use std::path::PathBuf;

use super::guard_args::GuardArgs;
use super::run_args::RunArgs;
use super::sitting_args::SittingArgs;
use super::{plan, stdout};
use crate::error::{Error, Result};
use crate::output::{self, Outputs};

/// Simulates a scene and writes its frames
///
/// Writes pictures (frame_000000.png …), statistics (stats.jsonl), particle files and a video on request, and a manifest
/// that says what everything is (run.json). Ctrl-C ends the run as soon as nothing is lost by that, and says what it waits
/// for; `sliceflow resume` goes on with it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    run: RunArgs,
    /// Folder to write [default: out/NAME OF THE SCENE]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces an earlier run in that folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    guard: GuardArgs,
    #[command(flatten)]
    sitting: SittingArgs,
    /// Times every pass on the device
    #[arg(long)]
    timings: bool,
    /// Prints the plan instead of running it
    #[arg(long)]
    dry_run: bool,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow run green_cube
  sliceflow run my_scene.json --out out/trial --frames 60 --size 1920x1080
  sliceflow run harada_figure_2 --view both --grid sliced-pool
  sliceflow run harada_figure_2_small --rerun out/session.rrd
  sliceflow run bunny_pour --video out/bunny_pour.mp4
  sliceflow run green_cube --particles vtk,ply --particles-every 5
  sliceflow run column_2d --particles npy --columns position,velocity,id --no-pictures
  sliceflow run green_cube --set grains.restitution=0.9 --set 'gravity=[0,-1.62,0]' --force";

pub fn main(args: &Args) -> Result<()> {
    let scene = args.run.load(args.dry_run.then_some(plan::MEMORY))?;
    let outputs = args.run.outputs()?;
    if args.dry_run {
        let report = plan::Report::new(&scene, &outputs.of(&scene), &args.sitting.adapter())?;
        return stdout::print(&report.to_string());
    }
    let folder = args
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(file_name(&scene.name)));
    let settings = args.sitting.settings(folder, args.force, outputs, args.timings)?;
    output::run(&scene, &args.guard.put(settings))
}

/// What a recorded `sliceflow run` writes, what stops it, and whether it times passes.
pub fn recorded(command_line: &[String]) -> Result<(Outputs, GuardArgs, bool)> {
    let args = super::run_args(command_line).ok_or_else(|| {
        Error::usage(
            format!(
                "the run was started by another version: `{}`",
                command_line.join(" ")
            ),
            "start a new run",
        )
    })?;
    Ok((args.run.outputs()?, args.guard, args.timings))
}

/// A scene's name as the name of a folder anywhere.
fn file_name(name: &str) -> String {
    let keep = |c: char| {
        if c.is_alphanumeric() || matches!(c, '-' | '_') {
            c
        } else {
            '_'
        }
    };
    name.chars().map(keep).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_become_folders() {
        assert_eq!(super::file_name("green_cube"), "green_cube");
        assert_eq!(super::file_name("../My scene: 2"), "___My_scene__2");
    }
}
