//! How much room a grid's buffers need, counted on the host from positions; the device counts again at every search.

use std::collections::BTreeMap;

use serde::Serialize;

use super::grid::{Grid, Voxel};
use super::{REGION_GAP, REGIONS_ALONG};

/// Nothing is made smaller than this, so that a few particles more do not make it grow at once.
const LEAST: f64 = 1024.0;

/// Entries of a grid's tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Room {
    pub voxels: u32,
    /// Of `rows` and `bitmap`.
    pub rows: u32,
    /// Of 32 voxels each, of `bitmap`.
    pub words: u32,
    /// Neighbors in a particle's list.
    pub list: u32,
    /// Boundary particles in reach of fluid, where only these have lists.
    pub reached: u32,
}

impl Room {
    /// With `margin` times as much of everything, but never more than `most`.
    pub fn with_margin(self, margin: f64, most: Room) -> Self {
        let grown = |need: u32, most: u32| {
            let wanted = (f64::from(need) * margin).ceil().max(LEAST);
            (wanted.min(f64::from(u32::MAX)) as u32).min(most).max(need)
        };
        Self {
            voxels: grown(self.voxels, most.voxels),
            rows: grown(self.rows, most.rows),
            words: grown(self.words, most.words),
            list: (f64::from(self.list) * margin).ceil().min(f64::from(most.list)) as u32,
            reached: grown(self.reached, most.reached),
        }
    }

    pub fn is_within(self, other: Room) -> bool {
        self.voxels <= other.voxels
            && self.rows <= other.rows
            && self.words <= other.words
            && self.list <= other.list
            && self.reached <= other.reached
    }
}

/// Whatever the particles do, no more than this can be needed.
pub fn most(grid: &Grid) -> Room {
    let along = |k: usize| (grid.high[k] - grid.low[k]).max(1) as u64;
    let fit = |count: u64| u32::try_from(count).unwrap_or(u32::MAX);
    let rows = along(1) * along(2);
    Room {
        voxels: fit(rows.saturating_mul(along(0))),
        rows: fit(rows),
        words: fit(rows.saturating_mul(along(0).div_ceil(32))),
        list: u32::MAX,
        reached: u32::MAX,
    }
}

/// Lowest and highest of a few values.
#[derive(Clone, Copy)]
struct Extent(i32, i32);

impl Extent {
    const NOTHING: Self = Self(i32::MAX, i32::MIN);

    fn add(&mut self, value: i32) {
        *self = Self(self.0.min(value), self.1.max(value));
    }

    fn len(self) -> u64 {
        (i64::from(self.1) - i64::from(self.0) + 1).max(0) as u64
    }
}

fn fit(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// The region of each column that holds a particle.
fn regions(mut columns: Vec<i32>) -> BTreeMap<i32, usize> {
    columns.sort_unstable();
    columns.dedup();
    let mut region = 0;
    let mut last = None;
    let mut numbered = BTreeMap::new();
    for column in columns {
        if last.is_some_and(|last| column - last > REGION_GAP as i32) {
            region = (region + 1).min(REGIONS_ALONG as usize - 1);
        }
        last = Some(column);
        numbered.insert(column, region);
    }
    numbered
}

/// Harada 2007, Eq. 1 to 3: the bounding box of each slice, in each of its regions where they are parted.
pub fn of_slices(parted: bool, voxels: &mut dyn Iterator<Item = Voxel>) -> Room {
    Room {
        voxels: fit(voxels_of_slices(parted, voxels).values().sum()),
        ..Default::default()
    }
}

/// The same, slice by slice.
pub fn voxels_of_slices(parted: bool, voxels: &mut dyn Iterator<Item = Voxel>) -> BTreeMap<i32, u64> {
    let mut boxes: BTreeMap<(i32, usize, usize), [Extent; 2]> = BTreeMap::new();
    let mut add = |[u, s, w]: Voxel, across: usize, along: usize| {
        let slice = boxes.entry((s, across, along)).or_insert([Extent::NOTHING; 2]);
        slice[0].add(u);
        slice[1].add(w);
    };
    if parted {
        let voxels: Vec<Voxel> = voxels.collect();
        let along = |k: usize| regions(voxels.iter().map(|voxel| voxel[k]).collect());
        let (along_u, along_w) = (along(0), along(2));
        for &voxel in &voxels {
            add(voxel, along_u[&voxel[0]], along_w[&voxel[2]]);
        }
    } else {
        for voxel in voxels {
            add(voxel, 0, 0);
        }
    }
    let mut slices = BTreeMap::new();
    for ((s, _, _), [u, w]) in boxes {
        *slices.entry(s).or_insert(0) += u.len() * w.len();
    }
    slices
}

/// Extents of rows, and of each slice along w: rows, voxels and words of 32 voxels in all.
fn row_extents(voxels: &mut dyn Iterator<Item = Voxel>) -> (u64, u64, u64) {
    let mut slices: BTreeMap<i32, Extent> = BTreeMap::new();
    let mut rows: BTreeMap<(i32, i32), Extent> = BTreeMap::new();
    for [u, s, w] in voxels {
        slices.entry(s).or_insert(Extent::NOTHING).add(w);
        rows.entry((s, w)).or_insert(Extent::NOTHING).add(u);
    }
    (
        slices.values().map(|w| w.len()).sum(),
        rows.values().map(|u| u.len()).sum(),
        rows.values().map(|u| u.len().div_ceil(32)).sum(),
    )
}

/// The extent of each row of each slice.
pub fn of_rows(voxels: &mut dyn Iterator<Item = Voxel>) -> Room {
    let (rows, voxels, _) = row_extents(voxels);
    Room {
        voxels: fit(voxels),
        rows: fit(rows),
        ..Default::default()
    }
}

/// Voxels that hold particles, and the bits of the rows' extents.
pub fn of_bitmap(voxels: &mut dyn Iterator<Item = Voxel>) -> Room {
    let mut occupied: Vec<Voxel> = voxels.collect();
    occupied.sort_unstable();
    occupied.dedup();
    let (rows, _, words) = row_extents(&mut occupied.iter().copied());
    Room {
        voxels: fit(occupied.len() as u64),
        rows: fit(rows),
        words: fit(words),
        ..Default::default()
    }
}
