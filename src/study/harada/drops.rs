//! The drops of Table 1, and Figure 6: voxels over time.

use std::rc::Rc;

use super::memory::Memory;
use super::{PAPER, Paper, Scale};
use crate::error::Result;
use crate::neighbors::ADDRESSINGS;
use crate::output::plot::Plot;
use crate::output::text::count;
use crate::scene::model::Addressing;
use crate::scene::{Particles, Scene};
use crate::study::bench::{Bench, grid_names};
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// One drop with what it went through.
pub struct Drop {
    pub scene: Scene,
    pub paper: &'static Paper,
    /// Of the whole cube.
    pub domain_voxels: u64,
    pub moments: Vec<Moment>,
    pub first: State,
    /// When the sliced grid had most voxels.
    pub widest: State,
    pub last: State,
}

/// Particles at a time in seconds.
#[derive(Clone, Default)]
pub struct State {
    pub time: f64,
    pub particles: Particles,
}

/// Voxels at a time in seconds.
pub struct Moment {
    time: f64,
    /// In the order of [`ADDRESSINGS`].
    voxels: Vec<u64>,
    octree_leaves: u64,
    /// For each of [`SLIM`]: its bytes, and those of the octree's leaves ([`Memory::octree_bytes`]).
    bytes: [(u64, [u64; 3]); 2],
}

/// The grids that are held against the octree in bytes, and their storages.
const SLIM: [(&str, &str); 2] = [("bitmap-counting", "counting"), ("bitmap-pool", "pool")];

impl Drop {
    /// The scene with a state of the drop at its start.
    pub fn at(&self, state: &State) -> Scene {
        scenes::replaced(&self.scene, state.particles.clone())
    }

    fn most_voxels(&self, addressing: usize) -> u64 {
        self.moments
            .iter()
            .map(|m| m.voxels[addressing])
            .max()
            .unwrap_or(0)
    }
}

/// Place of the paper's grid among [`ADDRESSINGS`].
fn sliced() -> usize {
    let found = ADDRESSINGS.iter().position(|row| row.kind == Addressing::Sliced);
    found.expect("the sliced grid has a row")
}

/// The drop of one row of Table 1.
pub fn run(bench: &Bench, scale: &Scale, row: usize) -> Result<Drop> {
    let (columns, seconds) = (scale.columns[row], scale.seconds[row]);
    let scene = scenes::dropped_block(scale.cells, columns, scale.cells / 2, seconds, scale.fps)?;
    bench.tell(&format!(
        "harada: a block of {} grains drops",
        count(scene.capacity.into())
    ));
    let sliced = sliced();
    let mut moments = Vec::new();
    let mut domain_voxels = 0;
    let (mut first, mut widest, mut last) = (State::default(), State::default(), State::default());
    let mut most = 0;
    bench.run(&scene, |time, particles| {
        let memory = Memory::of(&scene, &particles.position);
        let voxels = memory.voxels();
        let octree_leaves = memory.octree.leaves;
        let bytes = SLIM.map(|(grid, storage)| (memory.bytes(grid), memory.octree_bytes(storage)));
        domain_voxels = memory.domain_voxels;
        last = State { time, particles };
        if moments.is_empty() {
            first = last.clone();
        }
        if voxels[sliced] > most {
            most = voxels[sliced];
            widest = last.clone();
        }
        moments.push(Moment {
            time,
            voxels,
            octree_leaves,
            bytes,
        });
    })?;
    Ok(Drop {
        scene,
        paper: &PAPER[row],
        domain_voxels,
        moments,
        first,
        widest,
        last,
    })
}

pub fn table_1(page: &mut Page, drops: &[Rc<Drop>]) {
    page.heading("Table 1: how many voxels the sliced grid needs");
    page.paragraph(
        "The largest number of voxels during a drop as a share of all voxels of the cube. `sliced` is the paper's \
         grid; the others are ours.",
    );
    let others: Vec<usize> = (0..ADDRESSINGS.len()).filter(|&k| k != sliced()).collect();
    let mut heads = vec![
        "grains, paper".to_owned(),
        "paper".to_owned(),
        "grains, ours".to_owned(),
        "`sliced`".to_owned(),
        "at or below the paper".to_owned(),
        "voxels of `sliced`, paper".to_owned(),
        "voxels of `sliced`, ours".to_owned(),
        "at, s".to_owned(),
    ];
    heads.extend(others.iter().map(|&k| format!("`{}`", ADDRESSINGS[k].name)));
    heads.push("octree's leaves".into());
    let mut table = Table::new(heads);
    for drop in drops {
        let all = drop.domain_voxels as f64;
        let most = drop.most_voxels(sliced());
        let ratio = most as f64 / all;
        let leaves = drop.moments.iter().map(|m| m.octree_leaves).max().unwrap_or(0);
        let mut row = vec![
            Cell::count(drop.paper.grains),
            Cell::number(drop.paper.ratio),
            Cell::count(drop.scene.capacity.into()),
            Cell::number(ratio),
            Cell::text(if ratio <= drop.paper.ratio { "yes" } else { "no" }),
            Cell::count(drop.paper.voxels),
            Cell::count(most),
            Cell::number(drop.widest.time),
        ];
        row.extend(
            others
                .iter()
                .map(|&k| Cell::number(drop.most_voxels(k) as f64 / all)),
        );
        row.push(Cell::number(leaves as f64 / all));
        table.row(row);
    }
    page.table("table_1", &table);
}

pub fn figure_6(page: &mut Page, drop: &Drop) -> Result<()> {
    page.heading("Figure 6: voxels over time, against an octree");
    page.paragraph(format!(
        "The second drop of Table 1 ({} grains), every frame. An octree's leaves are the voxels that hold particles; \
         where memory is given to all eight children of a node at once, it needs more. The paper ends with 6.25 % for \
         the sliced grid and 3.24 % for the octree.",
        count(drop.scene.capacity.into())
    ));
    let percent = |voxels: u64| 100.0 * voxels as f64 / drop.domain_voxels as f64;
    let uniform = |k: &usize| drop.moments.iter().any(|m| m.voxels[*k] < drop.domain_voxels);
    let mut leaves = "octree, leaves".to_owned();
    let mut plot = Plot::new("Voxels with memory", "time, s", "% of all voxels");
    for k in (0..ADDRESSINGS.len()).filter(uniform) {
        // A curve below another one could not be seen.
        let hidden = drop.moments.iter().all(|m| m.voxels[k] == m.octree_leaves);
        let points = drop.moments.iter().map(|m| (m.time, percent(m.voxels[k])));
        if hidden {
            leaves = format!("{leaves}, and {}", ADDRESSINGS[k].name);
        } else {
            plot = plot.series(ADDRESSINGS[k].name, points);
        }
    }
    plot = plot
        .series(
            leaves,
            drop.moments.iter().map(|m| (m.time, percent(m.octree_leaves))),
        )
        .mark_y(6.25, "paper's sliced, end")
        .mark_y(3.24, "paper's octree, end");
    page.picture("harada_figure_6.png", "Voxels over time.", |path| plot.save(path))?;

    let mut heads = vec!["time, s".to_owned(), "octree's leaves".to_owned()];
    heads.extend(ADDRESSINGS.iter().map(|row| format!("`{}`", row.name)));
    let mut table = Table::new(heads);
    let every = drop.moments.len().div_ceil(8).max(1);
    for moment in drop.moments.iter().step_by(every).chain(drop.moments.last()) {
        let mut row = vec![Cell::number(moment.time), Cell::count(moment.octree_leaves)];
        row.extend(moment.voxels.iter().map(|&voxels| Cell::count(voxels)));
        table.row(row);
    }
    page.table("figure_6", &table);
    let worst = |k: usize| {
        let shares = drop
            .moments
            .iter()
            .map(|m| m.voxels[k] as f64 / m.octree_leaves as f64);
        shares.fold(0.0, f64::max)
    };
    let mut table = Table::new([
        "grid",
        "most voxels, as a multiple of the octree's leaves at that moment",
    ]);
    for (k, row) in ADDRESSINGS.iter().enumerate() {
        table.row([Cell::text(format!("`{}`", row.name)), Cell::number(worst(k))]);
    }
    page.table("figure_6_against_leaves", &table);
    page.paragraph(
        "The same in bytes, all buffers of the search. What a leaf keeps is what a voxel keeps: with `counting` the index \
         of its first particle (4 bytes), with a pool four indices and their number (20 bytes). Leaves that keep no more \
         than that cannot be found: they need a key of 4 bytes each (a linear octree, searched in logarithmic time) or \
         nodes of eight indices above them. `bitmap` finds its voxels in constant time through its tables.",
    );
    let mut table = Table::new([
        "grid",
        "most bytes, as a multiple of what leaves keep",
        "of leaves with keys",
        "of leaves and nodes",
        "at or below leaves with keys, always",
    ]);
    for (k, (grid, _)) in SLIM.iter().enumerate() {
        let most = |which: usize| {
            let ratios = drop.moments.iter().map(|moment| {
                let (bytes, octree) = moment.bytes[k];
                bytes as f64 / octree[which] as f64
            });
            ratios.fold(0.0, f64::max)
        };
        table.row([
            Cell::text(format!("`{grid}`")),
            Cell::number(most(0)),
            Cell::number(most(1)),
            Cell::number(most(2)),
            Cell::text(if most(1) <= 1.0 { "yes" } else { "no" }),
        ]);
    }
    page.table("figure_6_bytes_against_leaves", &table);
    bytes(page, drop);
    Ok(())
}

/// Bytes of every grid at three moments.
fn bytes(page: &mut Page, drop: &Drop) {
    page.paragraph(
        "Bytes at the beginning, when the sliced grid is widest, and at the end. A grid's bytes are those of the \
         search's buffers, as large as the state needs them; `of voxels` is the part that the number of particles \
         does not change.",
    );
    let mut table = Table::new([
        "grid",
        "time, s",
        "voxels",
        "bytes",
        "of voxels",
        "particles without a slot",
    ]);
    for state in [&drop.first, &drop.widest, &drop.last] {
        let memory = Memory::of(&drop.scene, &state.particles.position);
        for grid in grid_names() {
            let one = memory.allocation(&grid);
            table.row([
                Cell::text(format!("`{grid}`")),
                Cell::number(state.time),
                Cell::count(one.voxels),
                Cell::bytes(one.bytes),
                Cell::bytes(one.bytes - one.particle_bytes),
                one.overflow.map_or(Cell::Nothing, Cell::count),
            ]);
        }
        for storage in ["pool", "counting"] {
            let [leaves, keys, nodes] = memory.octree_bytes(storage);
            for (name, bytes) in [
                ("what leaves keep", leaves),
                ("leaves with keys", keys),
                ("leaves and nodes", nodes),
            ] {
                table.row([
                    Cell::text(format!("octree, {storage}, {name}")),
                    Cell::number(state.time),
                    Cell::count(memory.octree.leaves),
                    Cell::bytes(bytes),
                    Cell::Nothing,
                    Cell::Nothing,
                ]);
            }
        }
    }
    page.table("figure_6_bytes", &table);
}
