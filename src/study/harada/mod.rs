//! `sliceflow study harada`: what Harada 2007 measured, measured again.

mod construction;
mod drops;
mod fluids;
mod large;
mod memory;
mod pictures;
mod resize;
mod shapes;
mod times;

use std::path::PathBuf;
use std::rc::Rc;

use super::bench::{Bench, LISTED};
use super::measure::Effort;
use super::page::Page;
use super::parts::{self, Part};
use super::{Settings, Size};
use crate::error::Result;
use drops::Drop;
use times::AllTimes;

/// A row of Harada 2007's Tables 1 and 2, measured on a GeForce 8800 GTX.
pub struct Paper {
    grains: u64,
    /// Largest share of the cube's voxels that the sliced grid used.
    ratio: f64,
    /// Milliseconds: construction (a), (b) and one step (c), (d), fixed grid and sliced grid.
    build: [f64; 2],
    step: [f64; 2],
    /// Largest number of the sliced grid's voxels.
    voxels: u64,
}

/// The first row says 16,386 grains; 16 × 64 × 16 are 16,384, and the others fit such blocks too.
const PAPER: [Paper; 4] = [
    paper(16_386, 0.0394, [1.48, 0.688], [2.53, 2.19], 82_675),
    paper(65_536, 0.0619, [3.91, 2.56], [9.68, 8.58], 129_781),
    paper(262_144, 0.269, [13.9, 10.3], [42.0, 36.9], 564_354),
    paper(589_824, 0.488, [31.7, 23.0], [96.4, 90.9], 1_022_551),
];

const fn paper(grains: u64, ratio: f64, build: [f64; 2], step: [f64; 2], voxels: u64) -> Paper {
    Paper {
        grains,
        ratio,
        build,
        step,
        voxels,
    }
}

/// How large everything is.
pub struct Scale {
    /// Voxels along a side of the cube; the paper has 128.
    cells: u32,
    /// Grains along the sides of the blocks' floors; blocks are half as high as the cube.
    columns: [u32; 4],
    /// Of each drop.
    seconds: [f64; 4],
    fps: f64,
    effort: Effort,
    /// Grids that are timed, where these are not all.
    grids: Option<&'static [&'static str]>,
    /// Repetitions of a construction on the processor.
    cpu_rounds: u32,
    /// The paper's large area has 700 × 256 × 700 voxels; ours that runs is so many times smaller along each side.
    large_divisor: u32,
    /// The same for what is only counted.
    area_divisor: u32,
    /// Steps of each policy of sizing the pool.
    resizing_steps: u32,
    /// Voxels along a side of Table 3's tank, a multiple of 32; the paper has 256.
    tank: u32,
    /// Steps that its dams fall before they are measured.
    tank_steps: u32,
}

impl Scale {
    /// Those of these grids that are timed.
    fn timed(&self, mut names: Vec<String>) -> Vec<String> {
        names.retain(|name| self.grids.is_none_or(|grids| grids.contains(&name.as_str())));
        names
    }
}

/// Those that the pages' tables and pictures name, and one that is a sort.
const FEW_GRIDS: [&str; 6] = [
    times::FIXED,
    times::SLICED,
    "uniform-counting",
    "sliced-counting",
    "rows-bitonic",
    LISTED[0],
];

fn scale(size: Size) -> Scale {
    match size {
        Size::Tiny => Scale {
            cells: 16,
            columns: [2, 4, 8, 12],
            seconds: [0.02; 4],
            fps: 200.0,
            effort: Effort { rounds: 1, steps: 2 },
            grids: Some(&FEW_GRIDS),
            cpu_rounds: 3,
            large_divisor: 16,
            area_divisor: 16,
            resizing_steps: 20,
            tank: 32,
            tank_steps: 10,
        },
        Size::Small => Scale {
            cells: 48,
            columns: [6, 12, 24, 36],
            seconds: [1.2, 1.2, 0.8, 0.4],
            fps: 60.0,
            effort: Effort { rounds: 3, steps: 12 },
            grids: None,
            cpu_rounds: 15,
            large_divisor: 5,
            area_divisor: 1,
            resizing_steps: 400,
            tank: 64,
            tank_steps: 300,
        },
        Size::Full => Scale {
            cells: 128,
            columns: [16, 32, 64, 96],
            seconds: [2.0, 2.0, 1.6, 1.2],
            fps: 60.0,
            effort: Effort {
                rounds: 15,
                steps: 20,
            },
            grids: None,
            cpu_rounds: 31,
            large_divisor: 1,
            area_divisor: 1,
            resizing_steps: 6000,
            tank: 256,
            tank_steps: 4000,
        },
    }
}

pub fn harada(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("harada", PARTS, &settings.cases)?;
    let title = "Harada, Koshizuka and Kawaguchi 2007, *Sliced Data Structure for Particle-Based Simulations on GPUs*, \
                 beside Sliceflow";
    let mut page = Page::create(&settings.folder, "harada", title, settings.force)?;
    let bench = Bench::open(settings)?;
    let scale = scale(settings.size);
    page.paragraph(format!(
        "The paper's scene: a block of s × {0} × s grains is dropped in a cube of {1}³ voxels, each as wide as a \
         grain{2}. The paper's figures are from its tables and text (GeForce 8800 GTX, Core 2 X6800); everything else \
         was measured when this page was made.",
        scale.cells / 2,
        scale.cells,
        match settings.size {
            Size::Full => "",
            Size::Small | Size::Tiny =>
                "; the paper's cube has 128³ voxels, and `--scale full` has them too. Here blocks and cube are smaller \
                 by the same factor along each side",
        },
    ));
    bench.describe(&mut page, scale.effort);
    let mut shared = Shared {
        scale,
        drops: Default::default(),
        times: None,
    };
    parts::run(page, &bench, &mut shared, &parts, |_, _| {})
}

/// What parts share, made when the first of them asks.
pub struct Shared {
    scale: Scale,
    /// The drops of Table 1.
    drops: [Option<Rc<Drop>>; 4],
    /// Of every grid, for each drop.
    times: Option<Rc<AllTimes>>,
}

impl Shared {
    fn drop(&mut self, bench: &Bench, number: usize) -> Result<Rc<Drop>> {
        if let Some(drop) = &self.drops[number] {
            return Ok(drop.clone());
        }
        let drop = Rc::new(drops::run(bench, &self.scale, number)?);
        self.drops[number] = Some(drop.clone());
        Ok(drop)
    }

    fn all_drops(&mut self, bench: &Bench) -> Result<Vec<Rc<Drop>>> {
        (0..self.drops.len())
            .map(|number| self.drop(bench, number))
            .collect()
    }

    fn times(&mut self, bench: &Bench) -> Result<Rc<AllTimes>> {
        if let Some(times) = &self.times {
            return Ok(times.clone());
        }
        let drops = self.all_drops(bench)?;
        let times = Rc::new(times::of_drops(bench, &self.scale, &drops)?);
        bench.check()?;
        self.times = Some(times.clone());
        Ok(times)
    }
}

/// The second drop, which the paper's figures show.
const SECOND: usize = 1;

pub const PARTS: &[Part<Shared>] = &[
    Part {
        name: "table_1",
        run: |page, bench, shared| {
            drops::table_1(page, &shared.all_drops(bench)?);
            Ok(())
        },
    },
    Part {
        name: "table_2",
        run: |page, bench, shared| {
            let drops = shared.all_drops(bench)?;
            times::table_2(page, &drops, &*shared.times(bench)?)
        },
    },
    Part {
        name: "table_3",
        run: |page, bench, shared| fluids::table_3(page, bench, &shared.scale),
    },
    Part {
        name: "figure_5",
        run: |page, bench, shared| {
            let (drops, times) = (shared.all_drops(bench)?, shared.times(bench)?);
            construction::figure_5(page, bench, &shared.scale, &drops, &times)
        },
    },
    Part {
        name: "figure_6",
        run: |page, bench, shared| drops::figure_6(page, &*shared.drop(bench, SECOND)?),
    },
    Part {
        name: "figure_2",
        run: |page, bench, shared| pictures::figure_2(page, bench, &*shared.drop(bench, SECOND)?),
    },
    Part {
        name: "figure_7",
        run: |page, bench, shared| pictures::figure_7(page, bench, &shared.all_drops(bench)?),
    },
    Part {
        name: "figure_8",
        run: |page, bench, shared| large::figure_8(page, bench, &shared.scale),
    },
    Part {
        name: "shapes",
        run: |page, bench, shared| {
            let drop = shared.drop(bench, SECOND)?;
            shapes::shapes(page, bench, &shared.scale, &drop)
        },
    },
    Part {
        name: "resizing",
        run: |page, bench, shared| {
            let drop = shared.drop(bench, SECOND)?;
            resize::resizing(page, bench, &drop, shared.scale.resizing_steps)
        },
    },
];
