//! `sliceflow study`

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser as _};

use super::device_args::DeviceArgs;
use super::quiet_args::QuietArgs;
use super::stdout;
use crate::error::{Error, Result};
use crate::study::{STUDIES, Settings, Size, Study};

/// Measures what papers measured, errors against theory, or what solvers endure, and writes a page with the figures
///
/// Writes one Markdown page with its pictures, and one JSON file with the same figures; says where the page is. Ctrl-C
/// ends the study and keeps the parts that were finished.
#[derive(clap::Args)]
#[command(after_help = after_help())]
pub struct Args {
    #[arg(
        help = "What to study",
        value_parser = PossibleValuesParser::new(STUDIES.iter().map(|s| PossibleValue::new(s.name).help(s.about)))
            .map(study),
    )]
    subject: &'static Study,
    /// Runs this part of the study alone (named below); may be given again
    #[arg(long = "case", value_name = "CASE")]
    cases: Vec<String>,
    /// `accuracy`: resolutions in place of each case's own (particles across, steps in a contact)
    #[arg(long = "resolution", value_name = "N,…", value_delimiter = ',')]
    resolutions: Vec<u32>,
    /// `speed-error`: a Python that has pysplishsplash or pysph, to run these beside; may be given again
    #[arg(long, value_name = "PYTHON")]
    peers: Vec<PathBuf>,
    /// `small` takes minutes on two cores; `full` has the papers' own sizes and wants a graphics card
    #[arg(long, value_name = "SCALE", default_value = "small")]
    scale: Scale,
    /// Folder to write [default: out/study/SUBJECT]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces an earlier study in that folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow study harada --case table_1
  sliceflow study green --scale full --adapter 0
  sliceflow study stability
  sliceflow study speed-error --case still_water
  sliceflow study harada --out out/today --force
  sliceflow study accuracy --case collision --resolution 50,200,1000";

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Scale {
    #[value(hide = true)]
    Tiny,
    Small,
    Full,
}

fn after_help() -> String {
    let cases = |study: &Study| format!("  {}: {}\n", study.name, (study.cases)().join(", "));
    format!(
        "Cases:\n{}\n{EXAMPLES}",
        STUDIES.iter().map(cases).collect::<String>()
    )
}

/// The row of a name that clap has found among them.
fn study(name: String) -> &'static Study {
    STUDIES
        .iter()
        .find(|study| study.name == name)
        .expect("one of the possible values")
}

pub fn main(args: &Args) -> Result<()> {
    let study = args.subject;
    if !args.resolutions.is_empty() && study.name != "accuracy" {
        return Err(Error::usage(
            format!("`study {}` has no resolutions to choose", study.name),
            "leave out --resolution, or study `accuracy`",
        ));
    }
    if !args.peers.is_empty() && study.name != "speed-error" {
        return Err(Error::usage(
            format!("`study {}` runs no other programs", study.name),
            "leave out --peers, or study `speed-error`",
        ));
    }
    let page = (study.run)(&Settings {
        peers: args.peers.clone(),
        cases: args.cases.clone(),
        resolutions: args.resolutions.clone(),
        size: match args.scale {
            Scale::Tiny => Size::Tiny,
            Scale::Small => Size::Small,
            Scale::Full => Size::Full,
        },
        folder: args
            .out
            .clone()
            .unwrap_or_else(|| PathBuf::from("out/study").join(study.name)),
        force: args.force,
        adapter: args.device.adapter(),
        quiet: args.quiet.is_quiet(),
    })?;
    stdout::print(&format!("{}\n", page.display()))
}
