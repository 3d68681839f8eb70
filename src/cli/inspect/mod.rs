//! `sliceflow inspect`

#[cfg(feature = "plots")]
mod charts;
mod csv;
mod files;
mod json;
mod measure;
mod structures;
mod subject;
mod tables;

use std::path::PathBuf;

use super::device_args::DeviceArgs;
use super::quiet_args::QuietArgs;
use super::scene_args::SceneArgs;
use super::{grid, stdout};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::output::progress::Style;
use crate::scene::Scene;
use files::Files;
use measure::Measured;
use subject::Subject;

/// Says how full the neighbor search's voxels are at a frame, and what memory each grid needs for that
///
/// Simulates once, through the scene's own grid, then searches the same state through each --grid. Bytes are those of
/// the buffers that a search needs for so many voxels, beside the whole domain's (`uniform`), an octree's whose leaves
/// are voxels, and a hash table's with two buckets per particle.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Frame to look at [default: the last]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=999_999))]
    frame: Option<u32>,
    /// Neighbor searches, ADDRESSING-STORAGE [default: the scene's]
    #[arg(long, value_name = "NAME", num_args = 1..)]
    grid: Vec<String>,
    /// Also counts every N-th frame on the way there
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    every: Option<u32>,
    /// Search radius in the unit of a particle file (PLY, CSV, NPY), which stands in place of the scene
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Prints a row for each slice too
    #[arg(long)]
    slices: bool,
    /// Writes everything into this folder: occupancy.json, occupancy.md, each grid's memory as a heatmap, a profile of
    /// the slices, the allocated slices in the scene, and with --every a chart over time
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces those files
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    device: DeviceArgs,
    /// Prints JSON
    #[arg(long)]
    json: bool,
    /// Prints CSV: the memory of each grid, with --every the table over time, with --slices that of the slices
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow inspect harada_figure_2 --frame 30 --grid uniform-pool sliced-pool
  sliceflow inspect harada_figure_2_small --every 2 --grid sliced-pool rows-pool --out out/figure_6
  sliceflow inspect cloud.ply --radius 0.02 --grid sliced-counting --out out/cloud
  sliceflow inspect my_scene.json --json
  sliceflow inspect dam_break_2d --every 10 --csv > over_time.csv";

/// What was found about one state.
struct Found {
    subject: Subject,
    grids: Vec<Measured>,
}

pub fn main(args: &Args) -> Result<()> {
    if args.csv && args.slices && args.every.is_some() {
        return Err(Error::usage(
            "--csv prints one table, and --every and --slices ask for two",
            "leave one of them out, or take everything as JSON: --json",
        ));
    }
    let scene = subject::load(args)?;
    let grids = scenes_through(&scene, &args.grid)?;
    if args.out.is_some() && cfg!(not(feature = "plots")) {
        return Err(Error::absent(
            "this build draws no charts, which `inspect --out` writes",
        ));
    }
    let files = match &args.out {
        Some(folder) => Some(Files::open(folder, &grids, args.every.is_some(), args.force)?),
        None => None,
    };
    let gpu = Gpu::open(&args.device.adapter(), false)?;
    let subject = Subject::reach(&gpu, scene, &grids, args.every, args.quiet.style(Style::Bar))?;
    let mut measured = Vec::new();
    for scene in grids {
        measured.push(Measured::new(&gpu, &subject, scene, files.is_some())?);
    }
    let found = Found {
        subject,
        grids: measured,
    };
    if let Some(files) = &files {
        files.write(&found)?;
    }
    if args.json {
        stdout::print_json(&json::report(&found))
    } else if args.csv {
        let table = match (args.slices, args.every) {
            (true, _) => "slices",
            (false, Some(_)) => "over_time",
            (false, None) => "memory",
        };
        stdout::print(&csv::table(&json::report(&found)[table]))
    } else {
        stdout::print(&tables::report(&found, args.slices).to_text())
    }
}

/// The scene once for each grid, with the storage and addressing of that one; no grid twice.
fn scenes_through(scene: &Scene, names: &[String]) -> Result<Vec<Scene>> {
    let own = [grid::name(&scene.neighbors)];
    let names = if names.is_empty() { &own[..] } else { names };
    let mut scenes: Vec<Scene> = Vec::new();
    for name in names {
        let mut scene = scene.clone();
        let chosen = grid::neighbors(name)?;
        (scene.neighbors.addressing, scene.neighbors.storage) = (chosen.addressing, chosen.storage);
        if scenes.iter().any(|other| other.neighbors == scene.neighbors) {
            return Err(Error::usage(
                format!("grid `{name}` is given twice"),
                "name each grid once",
            ));
        }
        scenes.push(scene);
    }
    Ok(scenes)
}
