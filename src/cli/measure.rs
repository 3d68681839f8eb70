//! `sliceflow measure`

use std::path::{Path, PathBuf};

use super::quiet_args::QuietArgs;
use super::stdout;
use crate::error::{Error, Result};
use crate::files;
use crate::output::{Recorded, measure_files};
use crate::scene::load;

/// Has sensors look at the particles that a run has left
///
/// Reads the particle files (or checkpoints) of a run, and prints what the sensors find in each frame as a table with commas,
/// as `sensors.csv` of a run has it. Forces are left out: particle files do not hold them.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of a run
    run: PathBuf,
    /// JSON file with a list of sensors, as `sensors` in a scene, or a scene with such a list [default: the run's own]
    #[arg(long, value_name = "FILE")]
    sensors: Option<PathBuf>,
    /// Folder to write tables and charts into, instead of printing one table
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces tables that are there
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow run dam_break_2d --particles npy --columns position,velocity,pressure --out out/dam
  sliceflow measure out/dam --sensors gauges.json
  sliceflow measure out/dam --sensors gauges.json --out out/gauges";

pub fn main(args: &Args) -> Result<()> {
    let recorded = Recorded::read(&args.run)?;
    let more = match &args.sensors {
        Some(path) => vec![format!("sensors={}", sensors(path)?)],
        None => Vec::new(),
    };
    let scene = recorded.configuration()?.scene(&more)?;
    let found = measure_files(&args.run, &scene)?;
    if !found.left_out.is_empty() {
        args.quiet.tell(&format!(
            "note: particle files hold no forces, so these sensors are left out: {}",
            found.left_out.join(", ")
        ));
    }
    match (&args.out, &found.tables[..]) {
        (Some(out), tables) => {
            found.save(out, args.force)?;
            args.quiet.tell(&format!(
                "done: {} tables of {} frames in {}",
                tables.len(),
                found.frames,
                out.display()
            ));
            Ok(())
        }
        (None, [(_, table)]) => stdout::print(table),
        (None, tables) => {
            let names: Vec<_> = tables.iter().map(|(name, _)| name.as_str()).collect();
            Err(Error::usage(
                format!("the sensors make {} tables: {}", tables.len(), names.join(", ")),
                "give a folder for them with --out DIR",
            ))
        }
    }
}

/// The list of sensors in a file, as JSON on one line.
fn sensors(path: &Path) -> Result<String> {
    let text = files::read_text(path)
        .map_err(|reason| Error::file(path, "read", reason, "give a JSON file with a list of sensors"))?;
    let value = load::json(&text).map_err(|problem| Error::Scene {
        file: path.display().to_string(),
        problems: vec![problem],
    })?;
    match value.get("sensors").unwrap_or(&value) {
        list if list.is_array() => Ok(list.to_string()),
        _ => Err(Error::usage(
            format!("{} has no list of sensors", path.display()),
            "write a list in brackets, as `sensors` in a scene: `sliceflow schema sensors` explains it",
        )),
    }
}
