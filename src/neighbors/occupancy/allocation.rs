//! What a grid gives memory to, and the bytes of it.

use super::{Census, Slice};
use crate::gpu::BufferPlan;
use crate::neighbors::addressing::{self, RoomRule};
use crate::neighbors::{Grid, Room, Search, room, storage};
use crate::scene::model::{Addressing, Storage};
use crate::scene::{Neighbors, Scene};

/// What one grid needs for a state, without any margin.
#[derive(Debug, Clone)]
pub struct Allocation {
    pub neighbors: Neighbors,
    /// Voxels (buckets of a hash table) that have memory.
    pub voxels: u64,
    /// Voxels of each of [`Census::slices`] that have memory; `None` where memory does not follow slices.
    pub slices: Option<Vec<u64>>,
    /// Particles that find no slot; `None` for `hash`, whose voxels share buckets.
    pub overflow: Option<u64>,
    /// The search's own buffers, as large as these voxels and particles need them.
    pub buffers: Vec<BufferPlan>,
    /// Their bytes.
    pub bytes: u64,
    /// The part of `bytes` that grows with the voxels, for each voxel.
    pub bytes_per_voxel: u64,
    /// The part of `bytes` that grows with the particles.
    pub particle_bytes: u64,
}

impl Allocation {
    /// What the search that a scene chooses needs for a state; the census is that of the same scene.
    pub fn of(scene: &Scene, census: &Census) -> Self {
        let neighbors = &scene.neighbors;
        let room = census.grid.room();
        let planned = |voxels, particles| {
            let grid = census.grid.with_room(Room { voxels, ..room });
            Search::new(scene, grid, particles).buffers
        };
        let buffers = planned(room.voxels, census.particles);
        let bytes = total(&buffers);
        let grown = buffers
            .iter()
            .zip(planned(room.voxels.saturating_mul(2), census.particles));
        let per_voxel = grown.map(|(one, two)| (two.bytes - one.bytes) / u64::from(room.voxels.max(1)));
        Self {
            neighbors: *neighbors,
            voxels: room.voxels.into(),
            slices: voxels_by_slice(scene, census),
            overflow: match (neighbors.addressing, neighbors.storage) {
                (Addressing::Hash, _) => None,
                (_, Storage::Pool) => Some(census.overflow(neighbors.slots)),
                _ => Some(0),
            },
            bytes,
            bytes_per_voxel: per_voxel.sum(),
            particle_bytes: bytes - total(&planned(room.voxels, 0)),
            buffers,
        }
    }

    /// Bytes that a storage alone needs for so many cells, however they are addressed.
    pub fn storage_bytes(neighbors: &Neighbors, cells: u64, particles: u32) -> u64 {
        let room = Room {
            // No device has room for more.
            voxels: cells.min(u32::MAX.into()) as u32,
            ..Default::default()
        };
        let mut search = Search {
            grid: Grid::default().with_room(room),
            buffers: Vec::new(),
            passes: Vec::new(),
            flags: Vec::new(),
            constants: Vec::new(),
            goes_on: Default::default(),
            separated: false,
            notes: Vec::new(),
        };
        (storage::row(neighbors.storage).plan)(&mut search, particles, neighbors);
        total(&search.buffers)
    }
}

fn voxels_by_slice(scene: &Scene, census: &Census) -> Option<Vec<u64>> {
    let kind = scene.neighbors.addressing;
    let slices = census.slices();
    let in_slice = |at: i32| {
        let begin = census.voxels.partition_point(|voxel| voxel.at[1] < at);
        let end = census.voxels.partition_point(|voxel| voxel.at[1] <= at);
        census.voxels[begin..end].iter().map(|voxel| voxel.at)
    };
    match (kind, addressing::row(kind).room) {
        // Regions are parted by the particles of all slices.
        (Addressing::Sliced, _) => {
            let mut voxels = census.voxels.iter().map(|voxel| voxel.at);
            let found = room::voxels_of_slices(scene.neighbors.regions, &mut voxels);
            let of_slice = |slice: &Slice| found.get(&slice.at).copied().unwrap_or(0);
            Some(slices.iter().map(of_slice).collect())
        }
        (Addressing::Uniform, _) => {
            let [u, _, w, _] = census.grid.size;
            Some(vec![u as u64 * w as u64; slices.len()])
        }
        (_, RoomRule::Followed(room)) => {
            let of_slice = |slice: &Slice| room(scene, &mut in_slice(slice.at)).voxels.into();
            Some(slices.iter().map(of_slice).collect())
        }
        (_, RoomRule::Fixed(_)) => None,
    }
}

/// Buckets of a hash table (Teschner 2003) that is at most half full: the smallest power of two that is at least
/// twice the number of particles.
pub fn hash_buckets(particles: u32) -> u64 {
    (2 * u64::from(particles)).next_power_of_two()
}

fn total(buffers: &[BufferPlan]) -> u64 {
    buffers.iter().map(|buffer| buffer.bytes).sum()
}
