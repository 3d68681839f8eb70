//! `sliceflow usd`

use std::path::PathBuf;

use super::quiet_args::QuietArgs;
use super::sitting_args::beside;
use crate::error::Result;
use crate::output::Recorded;
use crate::output::usd::{Export, SCENE};

/// Writes a run as USD, for Blender, Houdini, Maya and usdview
///
/// Reads the particle files that `sliceflow run --particles` has written and the surfaces that `sliceflow surface` has made
/// of them. scene.usda has the particles (with widths, ids, velocities and every other column), the surface, the camera and
/// the obstacles with their motion; frames are time codes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of a run
    run: PathBuf,
    /// Folder with surfaces in .ply files [default: the run's]
    #[arg(long, value_name = "DIR")]
    surfaces: Option<PathBuf>,
    /// Folder to write [default: RUN_usd]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Writes all frames into scene.usda; otherwise each has files of its own, which scene.usda joins by value clips
    #[arg(long)]
    one_file: bool,
    /// Replaces files that are there
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow run harada_dam --particles ply --out out/dam
  sliceflow surface out/dam
  sliceflow usd out/dam
  sliceflow usd out/dam --one-file --out out/dam_usd_one";

pub fn main(args: &Args) -> Result<()> {
    let scene = Recorded::read(&args.run)?.configuration()?.scene(&[])?;
    let out = match &args.out {
        Some(out) => out.clone(),
        None => beside(&args.run, "usd")?,
    };
    let export = Export {
        scene: &scene,
        run: &args.run,
        surfaces: args.surfaces.as_ref().unwrap_or(&args.run),
        out: &out,
        one_file: args.one_file,
        force: args.force,
    };
    let written = export.write()?;
    args.quiet.tell(&format!(
        "done: {} with particles of {} frames and surfaces of {}",
        out.join(SCENE).display(),
        written.particles,
        written.surfaces
    ));
    Ok(())
}
