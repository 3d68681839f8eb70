//! `sliceflow study`

use std::path::PathBuf;

use super::device_args::DeviceArgs;
use super::stdout;
use crate::error::{Error, Result};
use crate::study::accuracy::Choice;
use crate::study::accuracy::cases::CASES;
use crate::study::{self, Settings, Size};

/// Measures what papers measured, errors against theory, or what solvers endure, and writes a page with the figures
///
/// Writes one Markdown page with its pictures, and one JSON file with the same figures; says where the page is.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    subject: Subject,
    #[arg(long = "case", value_name = "CASE", help = cases_help())]
    cases: Vec<String>,
    /// `accuracy`: resolutions in place of each case's own (particles across, steps a contact)
    #[arg(long = "resolution", value_name = "N,…", value_delimiter = ',')]
    resolutions: Vec<u32>,
    /// `small` takes minutes on two cores; `full` has the papers' own sizes and wants a graphics card
    #[arg(long, value_name = "SIZE", default_value = "small")]
    size: SizeWord,
    /// Folder to write [default: out/study/SUBJECT]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces an earlier study in that folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow study harada
  sliceflow study green --size full --adapter 0
  sliceflow study stability
  sliceflow study harada --out out/today --force
  sliceflow study accuracy
  sliceflow study accuracy --case collision --resolution 50,200,1000";

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Subject {
    /// Harada 2007: the sliced grid's memory and times
    Harada,
    /// Green 2012: atomics, scan and sort
    Green,
    /// Errors against theory and experiment, beside what they cost
    Accuracy,
    /// Rojas 2013: real-time ratio of a dam break
    Rojas,
    /// Longest stable steps, long rests and hard cases of every solver
    Stability,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum SizeWord {
    #[value(hide = true)]
    Tiny,
    Small,
    Full,
}

fn cases_help() -> String {
    let names: Vec<_> = CASES.iter().map(|case| case.name).collect();
    format!(
        "`accuracy`: runs this case alone ({}); may be given again",
        names.join(", ")
    )
}

pub fn main(args: &Args) -> Result<()> {
    let choice = Choice {
        cases: args.cases.clone(),
        resolutions: args.resolutions.clone(),
    };
    let name = match args.subject {
        Subject::Harada => "harada",
        Subject::Green => "green",
        Subject::Accuracy => "accuracy",
        Subject::Rojas => "rojas",
        Subject::Stability => "stability",
    };
    if choice != Choice::default() && name != "accuracy" {
        return Err(Error::usage(
            format!("`study {name}` has no cases and no resolutions to choose"),
            "leave out --case and --resolution, or study `accuracy`",
        ));
    }
    let settings = Settings {
        size: match args.size {
            SizeWord::Tiny => Size::Tiny,
            SizeWord::Small => Size::Small,
            SizeWord::Full => Size::Full,
        },
        folder: args
            .out
            .clone()
            .unwrap_or_else(|| PathBuf::from("out/study").join(name)),
        force: args.force,
        adapter: args.device.adapter(),
    };
    let page = match args.subject {
        Subject::Harada => study::harada(&settings),
        Subject::Green => study::green(&settings),
        Subject::Accuracy => study::accuracy(&settings, &choice),
        Subject::Rojas => study::rojas(&settings),
        Subject::Stability => study::stability(&settings),
    }?;
    stdout::print(&format!("{}\n", page.display()))
}
