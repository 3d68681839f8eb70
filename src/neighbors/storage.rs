//! How a voxel keeps its particles.

use super::Search;
use crate::gpu::compose::{SCAN_ITEMS, SCAN_THREADS};
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::model::Storage;

/// One way to keep particles in voxels.
pub struct StorageRow {
    pub kind: Storage,
    pub name: &'static str,
    pub source: &'static str,
    /// Shader file that answers `candidate_range`, `candidate` and `occupancy`.
    pub query: &'static str,
    /// Adds what it needs to a search, for so many particles and slots a voxel.
    pub plan: fn(&mut Search, capacity: u32, slots: u32),
}

pub const STORAGES: &[StorageRow] = &[
    StorageRow {
        kind: Storage::Counting,
        name: "counting",
        source: "Green 2012, two-pass atomics",
        query: "storage/counting/query",
        plan: counting,
    },
    StorageRow {
        kind: Storage::Pool,
        name: "pool",
        source: "Harada 2007's index pool; Green 2012, atomics",
        query: "storage/pool/query",
        plan: pool,
    },
];

/// The row of a storage.
pub fn row(kind: Storage) -> &'static StorageRow {
    let found = STORAGES.iter().find(|row| row.kind == kind);
    found.expect("every storage has a row")
}

fn counting(search: &mut Search, capacity: u32, _slots: u32) {
    let particles = u64::from(capacity);
    // The quarantine behind the voxels, and one entry more for the end.
    let items = u64::from(search.grid.capacity) + 2;
    let blocks = items.div_ceil(u64::from(SCAN_THREADS * SCAN_ITEMS));
    search.buffers.extend([
        BufferPlan::storage("voxel_count", items, 4, "particles that fell into each voxel"),
        BufferPlan::storage("voxel_start", items, 4, "first particle of each voxel"),
        BufferPlan::storage("block_sum", blocks, 4, "prefix sum, blocks"),
        BufferPlan::storage("particle_voxel", particles, 4, "voxel of each particle"),
        BufferPlan::storage(
            "arrival",
            particles,
            4,
            "place of each particle among its voxel's, as counted",
        ),
        BufferPlan::storage(
            "arrived",
            particles,
            4,
            "particles in voxel order, before their order is made canonical",
        ),
    ]);
    let build = "storage/counting/build";
    let scan = "storage/counting/scan";
    search.passes.extend([
        PassPlan::new(
            build,
            "count_voxels",
            Items::Particles,
            "voxel of each particle; particles of each voxel",
        ),
        PassPlan::new(
            scan,
            "sum_blocks",
            Items::VoxelBlocks,
            "prefix sum over voxels, first part",
        ),
        PassPlan::new(scan, "scan_blocks", Items::Once, "prefix sum over blocks"),
        PassPlan::new(
            scan,
            "start_voxels",
            Items::VoxelBlocks,
            "first particle of each voxel",
        ),
        PassPlan::new(
            build,
            "scatter_particles",
            Items::Particles,
            "indices into voxel order",
        ),
        PassPlan::new(
            build,
            "reorder_particles",
            Items::Particles,
            "state into voxel order, the same in every run",
        ),
    ]);
}

fn pool(search: &mut Search, _capacity: u32, slots: u32) {
    let voxels = u64::from(search.grid.capacity);
    search.buffers.extend([
        BufferPlan::storage("voxel_count", voxels, 4, "particles that fell into each voxel"),
        BufferPlan::storage(
            "index_pool",
            voxels * u64::from(slots),
            4,
            format!("{slots} particle indices a voxel"),
        ),
        BufferPlan::storage("overflow", 2, 4, "particles that found no slot"),
    ]);
    let build = "storage/pool/build";
    search.passes.extend([
        PassPlan::new(build, "clear_voxels", Items::Voxels, "empties the pool"),
        PassPlan::new(
            build,
            "insert_particles",
            Items::Particles,
            "each particle's index into its voxel",
        ),
    ]);
}
