//! `sliceflow study`

use std::path::PathBuf;

use super::device_args::DeviceArgs;
use super::stdout;
use crate::error::Result;
use crate::study::{self, Settings, Size};

/// Measures again what a paper measured, and writes a page with the paper's figures beside ours
///
/// Writes one Markdown page with its pictures, and one JSON file with the same figures; says where the page is.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    paper: Paper,
    /// `small` takes minutes on two cores; `full` has the papers' own sizes and wants a graphics card
    #[arg(long, value_name = "SIZE", default_value = "small")]
    size: SizeWord,
    /// Folder to write [default: out/study/PAPER]
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
  sliceflow study harada --out out/today --force";

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Paper {
    /// Harada 2007: the sliced grid's memory and times
    Harada,
    /// Green 2012: atomics, scan and sort
    Green,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum SizeWord {
    #[value(hide = true)]
    Tiny,
    Small,
    Full,
}

pub fn main(args: &Args) -> Result<()> {
    let (name, study): (_, fn(&Settings) -> Result<PathBuf>) = match args.paper {
        Paper::Harada => ("harada", study::harada),
        Paper::Green => ("green", study::green),
    };
    let page = study(&Settings {
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
    })?;
    stdout::print(&format!("{}\n", page.display()))
}
