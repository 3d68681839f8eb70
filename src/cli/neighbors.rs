//! `sliceflow neighbors`

mod files;

use std::path::PathBuf;
use std::time::Instant;

use serde_json::{Value, json};

use super::device_args::DeviceArgs;
use super::table::Align::{Left, Right};
use super::table::Table;
use super::{grid, stdout};
use crate::error::{Error, Result};
use crate::gpu::timing::median;
use crate::gpu::{Gpu, Variant, device};
use crate::neighbors;
use crate::output::text::{bytes, count, printable};
use crate::plan::{Plan, Wanted};
use crate::scene::{Dimensions, Neighbors, Scene, particle_file};
use crate::simulation::{NeighborLists, Simulation};
use files::Files;

/// Finds all pairs of points nearer than a radius
///
/// POINTS is a .ply, .csv or .npy file with columns x, y and z, or x and y; other columns are ignored. Any unit will
/// do, and any place: the center is subtracted in f64. Two points are neighbors where their distance, in f32, is less
/// than the radius; no point is its own neighbor.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Particle file
    points: PathBuf,
    /// Search radius, in the unit of the file
    #[arg(long, value_name = "R")]
    radius: f64,
    /// 2 or 3 [default: 2 where the file has no z]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=3))]
    dimensions: Option<u8>,
    /// Writes the number of neighbors of each point, uint32, in order of the file's rows
    #[arg(long, value_name = "FILE.npy")]
    counts: Option<PathBuf>,
    /// Writes the neighbors of each point: those of row i, ascending, are ids[offsets[i]:offsets[i+1]], rows counted
    /// from 0. Files: PREFIX_offsets.npy (uint64) and PREFIX_ids.npy (uint32)
    #[arg(long, value_name = "PREFIX")]
    lists: Option<PathBuf>,
    /// Replaces these files where they exist
    #[arg(long)]
    force: bool,
    /// Neighbor search, ADDRESSING-STORAGE [default: that of scenes]
    #[arg(long, value_name = "NAME")]
    grid: Option<String>,
    /// Indices that a voxel of storage `pool` can hold [default: that of scenes]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    slots: Option<u32>,
    /// Goes on where a `pool` has no room for a point, though pairs are then missing
    #[arg(long)]
    allow_overflow: bool,
    /// How often build and query are timed; their medians are given
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    #[command(flatten)]
    device: DeviceArgs,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Times, milliseconds, each with the host's wait for the device:
  build   the grid over points that are on the device
  counts  numbers of neighbors, brought to the host
  lists   neighbors, where --lists asks for them, brought to the host and sorted
Before them, build has run once and query on one workgroup, so that pipelines are ready. The total includes reading the
file, opening the device, compiling and writing.

Examples:
  sliceflow neighbors cloud.ply --radius 0.1
  sliceflow neighbors cloud.npy --radius 0.1 --counts counts.npy --lists pairs
  sliceflow neighbors cloud.csv --radius 2.5 --grid sliced-pool --slots 16 --repeat 10 --json

In Python:
  ids, offsets = numpy.load('pairs_ids.npy'), numpy.load('pairs_offsets.npy')
  n = len(offsets) - 1
  matrix = scipy.sparse.csr_matrix((numpy.ones(len(ids), 'b'), ids, offsets), shape=(n, n))";

pub fn main(args: &Args) -> Result<()> {
    let began = Instant::now();
    let files = Files::new(args.counts.as_deref(), args.lists.as_deref(), args.force)?;
    let mut choice = match &args.grid {
        Some(name) => grid::neighbors(name)?,
        None => Neighbors::default(),
    };
    choice.slots = args.slots.unwrap_or(choice.slots);
    let adapter = args.device.adapter();
    let scene = scene(args, choice)?;
    for note in &scene.notes {
        eprintln!("note: {}", printable(note));
    }
    let gpu = Gpu::open(&adapter, false)?;
    let name = device::describe(&gpu.adapter);
    let found = search(gpu, &scene, args)?;
    files.write(&found.counts, found.lists.as_ref())?;
    let report = Report {
        scene: &scene,
        radius: args.radius,
        adapter: name,
        grid: grid::name(&choice),
        found,
        files: files.paths(),
        whole_ms: milliseconds(began),
    };
    if args.json {
        stdout::print_json(&report.json())
    } else {
        stdout::print(&report.table())
    }
}

fn scene(args: &Args, choice: Neighbors) -> Result<Scene> {
    let dimensions = args.dimensions.map(|number| match number {
        2 => Dimensions::Two,
        _ => Dimensions::Three,
    });
    let (points, dimensions) = particle_file::load_positions(&args.points, dimensions).map_err(|what| {
        let (what, help) = what.split_once("; ").unwrap_or((&what, "check the file"));
        Error::usage(what, help)
    })?;
    Scene::of_points(&points, dimensions, args.radius, choice)
}

/// What was found, and how long it took.
struct Found {
    counts: Vec<u32>,
    lists: Option<NeighborLists>,
    /// Points that found no slot in a pool.
    overflow: u64,
    grid_bytes: u64,
    build_ms: f64,
    counts_ms: f64,
    lists_ms: Option<f64>,
}

fn search(gpu: Gpu, scene: &Scene, args: &Args) -> Result<Found> {
    let plan = Plan::new(scene, &gpu.limits, &Wanted::default())?;
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    simulation.next_frame()?;
    let overflow = simulation.finish_frame()?.map_or(0, |frame| frame.overflow);
    if overflow > 0 && !args.allow_overflow {
        return Err(Error::usage(
            format!(
                "{overflow} of {} points find no slot in their voxel, so pairs would be missing",
                scene.capacity
            ),
            format!(
                "give a voxel more than {} slots with --slots, choose another storage with --grid, or \
                 let pairs be missing with --allow-overflow",
                scene.neighbors.slots
            ),
        ));
    }
    let query = simulation.pair_query()?;
    let [mut build, mut count, mut list] = [const { Vec::new() }; 3];
    let mut found = None;
    for _ in 0..args.repeat {
        drop(found.take());
        simulation.stand_still()?;
        build.push(timed(|| simulation.search_again())?.1);
        let (counts, ms) = timed(|| simulation.count_neighbors(&query))?;
        count.push(ms);
        let lists = match args.lists {
            Some(_) => {
                let (lists, ms) = timed(|| simulation.list_neighbors(&query, &counts))?;
                list.push(ms);
                Some(lists)
            }
            None => None,
        };
        found = Some((counts, lists));
    }
    let (counts, lists) = found.expect("at least one repetition");
    let search = neighbors::plan(scene, plan.grid, &mut Variant::default());
    Ok(Found {
        counts: counts.by_id(),
        lists,
        overflow,
        grid_bytes: search.buffers.iter().map(|buffer| buffer.bytes).sum(),
        build_ms: median(build),
        counts_ms: median(count),
        lists_ms: args.lists.is_some().then(|| median(list)),
    })
}

fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    let done = work()?;
    Ok((done, milliseconds(start)))
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

struct Report<'a> {
    scene: &'a Scene,
    radius: f64,
    adapter: String,
    grid: String,
    found: Found,
    files: Vec<PathBuf>,
    whole_ms: f64,
}

impl Report<'_> {
    /// Neighbors of all points; each pair twice.
    fn neighbors(&self) -> u64 {
        self.found.counts.iter().map(|&count| u64::from(count)).sum()
    }

    /// Each once; unknown where a pool overflowed, since one of two points may then see the other alone.
    fn pairs(&self) -> Option<u64> {
        (self.found.overflow == 0).then(|| self.neighbors() / 2)
    }

    fn spread(&self) -> (u32, f64, u32) {
        let counts = &self.found.counts;
        let least = counts.iter().min().copied().unwrap_or(0);
        let most = counts.iter().max().copied().unwrap_or(0);
        (least, self.neighbors() as f64 / counts.len() as f64, most)
    }

    fn total_ms(&self) -> f64 {
        let Found {
            build_ms,
            counts_ms,
            lists_ms,
            ..
        } = self.found;
        build_ms + counts_ms + lists_ms.unwrap_or(0.0)
    }

    fn json(&self) -> Value {
        let (least, mean, most) = self.spread();
        let found = &self.found;
        json!({
            "points": found.counts.len(),
            "dimensions": self.scene.dimensions.count(),
            "radius": self.radius,
            "pairs": self.pairs(),
            "neighbors": self.neighbors(),
            "neighbors_min": least,
            "neighbors_mean": mean,
            "neighbors_max": most,
            "overflow": found.overflow,
            "grid": self.grid,
            "grid_bytes": found.grid_bytes,
            "adapter": self.adapter,
            "build_ms": found.build_ms,
            "counts_ms": found.counts_ms,
            "lists_ms": found.lists_ms,
            "total_ms": self.total_ms(),
            "whole_ms": self.whole_ms,
            "files": self.files,
            "notes": self.scene.notes,
        })
    }

    fn table(&self) -> String {
        let (least, mean, most) = self.spread();
        let found = &self.found;
        let mut table = Table::new([("points", Left), (&count(found.counts.len() as u64), Right)]);
        let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
        let ms = |ms: f64| format!("{ms:.1} ms");
        if let Some(pairs) = self.pairs() {
            row("pairs", count(pairs));
        }
        row("neighbors of a point, least", count(least.into()));
        row("mean", format!("{mean:.2}"));
        row("most", count(most.into()));
        if found.overflow > 0 {
            row("points without a slot", count(found.overflow));
        }
        row("grid", self.grid.clone());
        row("grid takes", bytes(found.grid_bytes));
        row("build", ms(found.build_ms));
        row("query, counts", ms(found.counts_ms));
        if let Some(lists_ms) = found.lists_ms {
            row("query, lists", ms(lists_ms));
        }
        row("total", ms(self.total_ms()));
        row("whole program", ms(self.whole_ms));
        let mut text = format!("{}\n{table}", self.adapter);
        for path in &self.files {
            text += &format!("wrote {}\n", path.display());
        }
        text
    }
}
