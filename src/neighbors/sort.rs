//! Storages that sort pairs of voxel and particle; particles then stand in voxel order.
//!
//! A search that finds no room stops the passes that ask for particles' voxels or move particles (`Items::Particles`).
//! Sorting once more what the last search left does no harm, so the passes in between run a fixed number of threads.

use super::addressing::{self, RoomRule};
use super::storage::{clear_voxels, entries, follow, scan, voxel_starts};
use super::{Search, room};
use crate::gpu::compose::{SCAN_ITEMS, SCAN_THREADS};
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::Neighbors;

/// Bits that one round of the radix sort orders by, and pairs that a thread takes. As many counters as pairs: fewer
/// pairs a thread need more counters, more pairs leave too few threads.
const DIGIT_BITS: u32 = 4;
const RUN: u32 = 16;

/// Threads of a workgroup of the bitonic sort, and pairs that it keeps in workgroup memory: 8 KiB of wide ones.
const SORT_THREADS: u32 = 256;
const SORT_BLOCK: u32 = 1024;

/// Values that half of a packed pair can have (Rojas 2013: 2⁸ × 2⁸ voxels, 2¹⁶ particles).
const PACKED: u64 = 1 << 16;

/// Different keys that particles are sorted by: voxels, and where space has no bounds, the quarantine; twice as many where
/// boundary particles stand apart.
fn keys(search: &Search, voxels: u32) -> u64 {
    if search.separated {
        return entries(voxels, true) - 1;
    }
    u64::from(voxels) + u64::from(!search.flags.contains(&"bounded"))
}

/// Threads of a prefix sum over so many items.
fn scan_threads(items: u64) -> u32 {
    items.div_ceil(u64::from(SCAN_THREADS * SCAN_ITEMS)) as u32 * SCAN_THREADS
}

/// Says that a sort needs nothing for its order.
fn note_order(search: &mut Search, neighbors: &Neighbors, name: &str) {
    if !neighbors.deterministic {
        search.notes.push(format!(
            "neighbors.deterministic: false changes nothing here: `{name}` gives the same order in every run as it is"
        ));
    }
}

/// The pass that puts particles into sorted order, and those behind it.
fn rearrange(search: &mut Search, build: &str, index: Option<u32>, particles: u32) {
    clear_voxels(search);
    search.passes.push(PassPlan {
        index,
        ..PassPlan::new(
            build,
            "rearrange_particles",
            Items::Particles,
            "positions and velocities into voxel order; begin and end of each voxel",
        )
    });
    voxel_starts(search);
    follow(search, particles.into());
}

pub fn radix(search: &mut Search, particles: u32, neighbors: &Neighbors) {
    search
        .constants
        .extend([("DIGIT_BITS", DIGIT_BITS), ("RUN", RUN)]);
    let runs = particles.div_ceil(RUN);
    let counters = u64::from(runs) << DIGIT_BITS;
    // The highest voxel says how many digits there are.
    let bits = u64::BITS - (keys(search, search.grid.capacity) - 1).leading_zeros();
    let digits = bits.div_ceil(DIGIT_BITS).max(1);
    search.buffers.extend([
        BufferPlan::storage(
            "sort_pairs",
            2 * u64::from(particles),
            8,
            "voxel and particle, before and after a digit's round",
        ),
        BufferPlan::storage("digit_count", counters, 4, "pairs of each run with each digit"),
    ]);
    let build = "storage/radix/build";
    search.passes.push(PassPlan::new(
        build,
        "write_pairs",
        Items::Particles,
        "voxel of each particle",
    ));
    for digit in 0..digits {
        let of = format!("digit {} of {digits} ({DIGIT_BITS} bits)", digit + 1);
        let numbered = |entry, why| PassPlan::new(build, entry, Items::Fixed(runs), why).index(digit);
        search
            .passes
            .push(numbered("count_digits", format!("{of}: counted in each run")));
        let how = [Items::Fixed(scan_threads(counters)), Items::Fixed(1)];
        scan(search, "storage/radix/scan_digits", counters, how, &of);
        search
            .passes
            .push(numbered("scatter_pairs", format!("{of}: into its order, stable")));
    }
    rearrange(search, build, Some(digits), particles);
    note_order(search, neighbors, "radix");
}

pub fn bitonic(search: &mut Search, particles: u32, neighbors: &Neighbors) {
    let pairs = u64::from(particles);
    // What holds for all that the grid may grow to, since a run keeps its shaders.
    let voxels = match addressing::row(neighbors.addressing).room {
        RoomRule::Followed(_) => keys(search, search.grid.capacity.max(room::most(&search.grid).voxels)),
        RoomRule::Fixed(_) => keys(search, search.grid.capacity),
    };
    let packed = pairs <= PACKED && voxels <= PACKED;
    if packed {
        search.flags.push("packed_pairs");
    }
    search
        .constants
        .extend([("SORT_THREADS", SORT_THREADS), ("SORT_BLOCK", SORT_BLOCK)]);
    let why = if packed {
        "voxel and particle, packed: 16 bits hold each (Rojas 2013)".to_owned()
    } else if pairs > PACKED {
        format!("voxel and particle, 32 bits each: 16 bits hold {PACKED} particles, not {pairs}")
    } else {
        format!("voxel and particle, 32 bits each: 16 bits hold {PACKED} voxels, not {voxels}")
    };
    let bytes = if packed { 4 } else { 8 };
    search
        .buffers
        .push(BufferPlan::storage("sort_pairs", pairs, bytes, why));

    let build = "storage/bitonic/build";
    let in_blocks = Items::Fixed(particles.div_ceil(SORT_BLOCK) * SORT_THREADS);
    search.passes.extend([
        PassPlan::new(build, "write_pairs", Items::Particles, "voxel of each particle"),
        PassPlan::new(
            build,
            "sort_blocks",
            in_blocks,
            format!("sorts blocks of {SORT_BLOCK} pairs"),
        ),
    ]);
    let comparisons = Items::Fixed(particles.next_power_of_two() / 2);
    let mut sorted = SORT_BLOCK;
    while sorted < particles {
        let mut distance = sorted;
        while distance >= SORT_BLOCK {
            let mirrored = distance == sorted;
            let why = format!("merges runs of {sorted} pairs, distance {distance}");
            let number = 2 * distance.ilog2() + u32::from(mirrored);
            search
                .passes
                .push(PassPlan::new(build, "compare_far", comparisons, why).index(number));
            distance /= 2;
        }
        search.passes.push(PassPlan::new(
            build,
            "merge_blocks",
            in_blocks,
            format!("merges runs of {sorted} pairs, all distances inside a block"),
        ));
        sorted *= 2;
    }
    rearrange(search, build, None, particles);
    note_order(search, neighbors, "bitonic");
}
