//! `sliceflow inspect`

use std::path::PathBuf;

use serde_json::{Value, json};

use super::scene_args::{Choices, SceneArgs};
use super::table::Align::{Left, Right};
use super::table::Table;
use super::{grid, stdout};
use crate::error::{Error, Result};
use crate::gpu::{AdapterChoice, Gpu};
use crate::output::text::{bytes, count};
use crate::output::{Progress, Tally, compose_picture, encode_png, progress, write_file};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::Scene;
use crate::scene::model::Storage;
use crate::simulation::Simulation;
use crate::simulation::frame::{Frame, Statistics};

/// Says how full the neighbor search's voxels are at a frame
///
/// Runs to that frame, once for each --grid, and compares with a uniform grid over the whole domain.
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
    /// Writes the index pool as a heatmap, PNG (one grid, with storage `pool`)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Adapter, by index or part of its name (see `sliceflow devices`)
    #[arg(long, value_name = "NAME|INDEX")]
    adapter: Option<String>,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow inspect harada_figure_2 --frame 30 --grid uniform-pool sliced-pool
  sliceflow inspect harada_figure_2_small --grid sliced-pool --out pool.png
  sliceflow inspect my_scene.json --json";

pub fn main(args: &Args) -> Result<()> {
    if args.out.is_some() && args.grid.len() > 1 {
        return Err(Error::usage(
            "--out draws one grid, and several are given",
            "give one --grid",
        ));
    }
    let adapter = args
        .adapter
        .as_deref()
        .map(AdapterChoice::parse)
        .unwrap_or_default();
    let mut grids: Vec<_> = args.grid.iter().map(|name| Some(name.as_str())).collect();
    if grids.is_empty() {
        grids.push(None);
    }
    let mut found = Vec::new();
    for grid in grids {
        let choices = Choices {
            frames: args.frame.map(|frame| frame + 1),
            grid,
            view: None,
        };
        let scene = args.scene.load(&choices)?;
        found.push(inspect(&scene, &adapter, args.out.as_ref())?);
    }
    if args.json {
        stdout::print_json(&found.iter().map(Occupancy::json).collect())
    } else {
        stdout::print(&report(&found))
    }
}

/// How full a grid is.
struct Occupancy {
    grid: String,
    frame: u32,
    /// Seconds.
    time: f64,
    particles: u32,
    voxels: Statistics,
    /// Voxels of the whole domain.
    domain_voxels: u64,
    /// Bytes a voxel takes in the index pool or the list of voxel starts.
    voxel_bytes: u64,
}

fn inspect(scene: &Scene, adapter: &AdapterChoice, picture: Option<&PathBuf>) -> Result<Occupancy> {
    let gpu = Gpu::open(adapter, false)?;
    let view = picture.map(|_| scene.render.view);
    let plan = Plan::new(
        scene,
        &gpu.limits,
        &Wanted {
            statistics: true,
            columns: Vec::new(),
            view,
        },
    )?;
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    let frame = last_frame(&mut simulation, scene.time.frames)?;
    if let Some(path) = picture
        && let Some(picture) = compose_picture(&frame, &Overlay::new(scene, scene.render.view)?)?
    {
        write_file(path, &encode_png(picture, path)?)?;
    }
    let slots = match scene.neighbors.storage {
        Storage::Pool => scene.neighbors.slots,
        Storage::Counting => 1,
    };
    Ok(Occupancy {
        grid: grid::name(&scene.neighbors),
        frame: frame.index,
        time: frame.time,
        particles: frame.particles,
        voxels: frame.statistics.expect("a frame of a plan with statistics"),
        domain_voxels: plan.domain_voxels,
        voxel_bytes: 4 * u64::from(slots),
    })
}

fn last_frame(simulation: &mut Simulation, frames: u32) -> Result<Frame> {
    let mut progress = Progress::new(progress::Style::Bar, frames);
    let mut tally = Tally::start(frames);
    let mut last = None;
    for _ in 0..frames {
        let Some(frame) = simulation.next_frame()? else {
            continue;
        };
        tally.add(&frame);
        progress.frame(&frame, &tally);
        last = Some(frame);
    }
    while let Some(frame) = simulation.finish_frame()? {
        tally.add(&frame);
        progress.frame(&frame, &tally);
        last = Some(frame);
    }
    progress.clear();
    Ok(last.expect("a scene has at least one frame"))
}

impl Occupancy {
    fn bytes(&self) -> u64 {
        u64::from(self.voxels.voxels_allocated) * self.voxel_bytes
    }

    fn domain_bytes(&self) -> u64 {
        self.domain_voxels * self.voxel_bytes
    }

    fn share(&self) -> f64 {
        f64::from(self.voxels.voxels_allocated) / self.domain_voxels as f64
    }

    fn json(&self) -> Value {
        let voxels = &self.voxels;
        let [with_1, with_2, with_3, with_4] = voxels.voxels_with;
        json!({
            "grid": self.grid,
            "frame": self.frame,
            "time_s": self.time,
            "particles": self.particles,
            "voxels_domain": self.domain_voxels,
            "voxels_allocated": voxels.voxels_allocated,
            "voxels_occupied": voxels.voxels_occupied,
            "voxels_with_1": with_1,
            "voxels_with_2": with_2,
            "voxels_with_3": with_3,
            "voxels_with_4": with_4,
            "voxels_with_more": voxels.voxels_with_more,
            "overflow": voxels.overflow,
            "grid_bytes": self.bytes(),
            "domain_bytes": self.domain_bytes(),
            "share_of_domain": self.share(),
        })
    }
}

fn report(found: &[Occupancy]) -> String {
    let heads = found.iter().map(|one| (one.grid.clone(), Right));
    let mut table = Table::with_heads([(String::new(), Left)].into_iter().chain(heads));
    let mut row = |name: &str, cell: &dyn Fn(&Occupancy) -> String| {
        table.row([name.to_owned()].into_iter().chain(found.iter().map(cell)));
    };
    row("frame", &|one| one.frame.to_string());
    row("time", &|one| format!("{:.3} s", one.time));
    row("particles", &|one| count(one.particles.into()));
    row("voxels of the domain", &|one| count(one.domain_voxels));
    row("voxels allocated", &|one| {
        count(one.voxels.voxels_allocated.into())
    });
    row("voxels occupied", &|one| count(one.voxels.voxels_occupied.into()));
    for (i, name) in ["with 1 particle", "with 2", "with 3", "with 4"]
        .into_iter()
        .enumerate()
    {
        row(name, &|one| count(one.voxels.voxels_with[i].into()));
    }
    row("with more", &|one| count(one.voxels.voxels_with_more.into()));
    row("particles without a slot", &|one| {
        count(one.voxels.overflow.into())
    });
    row("grid takes", &|one| bytes(one.bytes()));
    row("the whole domain would", &|one| bytes(one.domain_bytes()));
    row("share of the domain", &|one| {
        format!("{:.1} %", 100.0 * one.share())
    });
    table.to_string()
}
