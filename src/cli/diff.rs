//! `sliceflow diff`

use std::path::PathBuf;

use super::stdout;
use super::table::Align::{Left, Right};
use super::table::Table;
use crate::error::{Error, Result};
use crate::output::compare::Comparison;
use crate::output::text::count;

/// Compares two runs: the first frame, particle and column that differ, by how much, and how it grows
///
/// Particles come from the runs' particle files (`--particles`, any format) or checkpoints; statistics and pictures
/// are compared too. Between formats, positions are compared as exactly as both keep them. Exit status: 0 where
/// everything that both have is equal, 1 where something differs, 2 where the runs cannot be compared.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of a run
    run_a: PathBuf,
    /// Folder of another
    run_b: PathBuf,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow diff out/first out/second
  sliceflow diff out/whole out/resumed && echo the same
  sliceflow diff out/stiff out/soft --json | jq .growth";

pub fn main(args: &Args) -> Result<()> {
    let is_equal = compare(args).map_err(|reason| Error::Incomparable(Box::new(reason)))?;
    if is_equal { Ok(()) } else { Err(Error::Different) }
}

fn compare(args: &Args) -> Result<bool> {
    let found = Comparison::of(&args.run_a, &args.run_b)?;
    if args.json {
        stdout::print_json(&serde_json::to_value(&found).expect("keys are text"))?;
    } else {
        stdout::print(&report(&found))?;
    }
    Ok(found.is_equal())
}

fn report(found: &Comparison) -> String {
    let mut text = String::new();
    let mut say = |line: String| text.push_str(&(line + "\n"));
    let frames = |frames: u32| format!("{} frames", count(frames.into()));
    if let Some(first) = &found.first {
        let axis = ["x", "y", "z"].get(first.component).copied().unwrap_or_default();
        let is_vector = ["position", "velocity", "acceleration"].contains(&first.column.as_str());
        let column = if is_vector {
            format!("{} {axis}", first.column)
        } else {
            first.column.clone()
        };
        say(format!(
            "first difference: frame {}, particle {}, {column}: {} in A, {} in B (by {:e})",
            first.frame,
            first.particle,
            first.a,
            first.b,
            (first.a - first.b).abs()
        ));
    } else if found.particle_frames > 0 {
        say(format!("particles: equal in {}", frames(found.particle_frames)));
    }
    match &found.statistics {
        Some(figure) => say(format!(
            "statistics: {} of frame {} is {} in A, {} in B",
            figure.key, figure.frame, figure.a, figure.b
        )),
        None if found.statistics_frames > 0 => {
            say(format!(
                "statistics: equal in {}",
                frames(found.statistics_frames)
            ));
        }
        None => {}
    }
    match found.pictures.first() {
        Some(first) => say(format!(
            "pictures: {} of {} differ, the first of frame {first}",
            count(found.pictures.len() as u64),
            count(found.picture_frames.into())
        )),
        None if found.picture_frames > 0 => {
            say(format!("pictures: equal in {}", frames(found.picture_frames)))
        }
        None => {}
    }
    for only in &found.only {
        say(only.clone());
    }
    if !found.growth.is_empty() {
        let mut table = Table::new([
            ("frame", Right),
            ("column", Left),
            ("particles", Right),
            ("largest difference", Right),
            ("root mean square", Right),
        ]);
        for row in &found.growth {
            table.row([
                row.frame.to_string(),
                row.column.clone(),
                count(row.particles.into()),
                format!("{:.3e}", row.max),
                format!("{:.3e}", row.rms),
            ]);
        }
        text.push_str(&format!("\n{table}"));
    }
    text
}
