//! How a voxel keeps its particles.

use super::{Search, sort};
use crate::gpu::compose::{SCAN_ITEMS, SCAN_THREADS};
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::Neighbors;
use crate::scene::model::Storage;

/// One way to keep particles in voxels.
pub struct StorageRow {
    pub kind: Storage,
    pub name: &'static str,
    pub source: &'static str,
    /// Shader file that answers `candidate_range`, `candidate` and `occupancy`.
    pub query: &'static str,
    /// Whether particles stand in voxel order, boundary particles behind all others.
    pub sorts: bool,
    /// Adds what it needs to a search, for so many particles.
    pub plan: fn(&mut Search, particles: u32, &Neighbors),
}

pub const STORAGES: &[StorageRow] = &[
    StorageRow {
        kind: Storage::Counting,
        name: "counting",
        source: "Green 2012, two-pass atomics",
        query: "storage/sorted/query",
        sorts: true,
        plan: counting,
    },
    StorageRow {
        kind: Storage::Pool,
        name: "pool",
        source: "Harada 2007's index pool; Green 2012, atomics",
        query: "storage/pool/query",
        sorts: false,
        plan: pool,
    },
    StorageRow {
        kind: Storage::Radix,
        name: "radix",
        source: "Green 2012, sorting",
        query: "storage/sorted/query",
        sorts: true,
        plan: sort::radix,
    },
    StorageRow {
        kind: Storage::Bitonic,
        name: "bitonic",
        source: "Rojas 2013",
        query: "storage/sorted/query",
        sorts: true,
        plan: sort::bitonic,
    },
];

/// The row of a storage.
pub fn row(kind: Storage) -> &'static StorageRow {
    let found = STORAGES.iter().find(|row| row.kind == kind);
    found.expect("every storage has a row")
}

/// Adds the prefix sum of a shader file over at most `items` items, by workgroups as `how` says: many, one.
pub(super) fn scan(search: &mut Search, shader: &str, items: u64, how: [Items; 2], what: &str) {
    let blocks = items.div_ceil(u64::from(SCAN_THREADS * SCAN_ITEMS));
    let sums = BufferPlan::storage("block_sum", blocks, 4, "prefix sum, blocks");
    match search.buffers.iter_mut().find(|buffer| buffer.name == sums.name) {
        Some(known) => known.bytes = known.bytes.max(sums.bytes),
        None => search.buffers.push(sums),
    }
    let [many, one] = how;
    let pass = |entry, items, why: &str| PassPlan::new(shader, entry, items, format!("{what}: {why}"));
    search.passes.extend([
        pass("sum_blocks", many, "prefix sum, sums of blocks"),
        pass("scan_blocks", one, "prefix sum over blocks"),
        pass("finish_scan", many, "prefix sum, inside blocks"),
    ]);
}

/// Entries of `voxel_start` (`shaders/storage/sorted/entries.wgsl`): the voxels, the quarantine behind them, all of these
/// once more where boundary particles stand apart, and the end.
pub fn entries(voxels: u32, separated: bool) -> u64 {
    (1 + u64::from(separated)) * (u64::from(voxels) + 1) + 1
}

/// Adds `voxel_start` with the pass that clears it, for storages in voxel order.
pub(super) fn clear_voxels(search: &mut Search) {
    let items = entries(search.grid.capacity, search.separated);
    search.buffers.push(BufferPlan::storage(
        "voxel_start",
        items,
        4,
        "first particle of each voxel; before, how many it has",
    ));
    search.passes.push(PassPlan::new(
        "storage/sorted/clear_voxels",
        "clear_voxels",
        Items::VoxelBlocks,
        "no voxel has particles yet",
    ));
}

/// Adds the prefix sum that turns counts in `voxel_start` into first particles.
pub(super) fn voxel_starts(search: &mut Search) {
    let items = entries(search.grid.capacity, search.separated);
    let how = [Items::VoxelBlocks, Items::Once];
    scan(search, "storage/sorted/scan_voxels", items, how, "voxels");
}

/// Adds the pass in which the rest of what particles have follows them to where they were sorted.
pub(super) fn follow(search: &mut Search, particles: u64) {
    search.buffers.push(BufferPlan::storage(
        "origin",
        particles,
        4,
        "where each particle was before it was sorted",
    ));
    search.passes.push(PassPlan::new(
        "storage/sorted/follow",
        "follow_particles",
        Items::Particles,
        "the rest of what particles have, into voxel order",
    ));
    if search.goes_on.follow {
        search.passes.push(PassPlan::new(
            "storage/sorted/follow_too",
            "follow_particles_too",
            Items::Particles,
            "what one pass more takes into voxel order",
        ));
    }
}

fn counting(search: &mut Search, particles: u32, neighbors: &Neighbors) {
    let particles = u64::from(particles);
    let build = "storage/counting/build";
    let pass = |entry, why| PassPlan::new(build, entry, Items::Particles, why);
    clear_voxels(search);
    search.passes.push(PassPlan::new(
        "storage/counting/count",
        "count_voxels",
        Items::Particles,
        "voxel of each particle; particles of each voxel",
    ));
    voxel_starts(search);
    search.buffers.extend([
        BufferPlan::storage("particle_voxel", particles, 4, "voxel of each particle"),
        BufferPlan::storage(
            "arrival",
            particles,
            4,
            "place of each particle among its voxel's, as counted",
        ),
    ]);
    if !neighbors.deterministic {
        search.passes.push(pass(
            "reorder_particles",
            "positions and velocities into voxel order, as it was counted",
        ));
        follow(search, particles);
        return;
    }
    search.buffers.push(BufferPlan::storage(
        "arrived",
        particles,
        4,
        "particles in voxel order, before their order is made canonical",
    ));
    search.passes.extend([
        pass("scatter_particles", "indices into voxel order"),
        pass(
            "reorder_particles",
            "positions and velocities into voxel order, the same in every run",
        ),
    ]);
    follow(search, particles);
}

fn pool(search: &mut Search, _: u32, neighbors: &Neighbors) {
    let voxels = u64::from(search.grid.capacity);
    let slots = neighbors.slots;
    search.buffers.extend([
        BufferPlan::storage("voxel_count", voxels, 4, "particles that fell into each voxel"),
        BufferPlan::storage(
            "index_pool",
            voxels * u64::from(slots),
            4,
            format!("{slots} particle indices per voxel"),
        ),
        // Its second number counts from one frame to the next.
        BufferPlan::storage("overflow", 2, 4, "particles that found no slot").reported_from(4),
    ]);
    let build = "storage/pool/build";
    search.passes.extend([
        PassPlan::new(build, "clear_voxels", Items::VoxelBlocks, "empties the pool"),
        PassPlan::new(
            "storage/pool/take",
            "take_particles",
            Items::Particles,
            "particles keep their places",
        ),
    ]);
    if search.goes_on.follow {
        search.passes.push(PassPlan::new(
            "storage/pool/take_too",
            "take_particles_too",
            Items::Particles,
            "what one pass more takes along",
        ));
    }
    search.passes.push(PassPlan::new(
        build,
        "insert_particles",
        Items::Particles,
        "each particle's index into its voxel",
    ));
}
