//! What each grid needs memory for, counted on the host.

use glam::Vec3;

use crate::neighbors::occupancy::{Allocation, Census, Octree};
use crate::neighbors::{ADDRESSINGS, Grid, STORAGES};
use crate::scene::{Neighbors, Scene};
use crate::study::bench::grid_names;

/// A state's voxels.
pub struct Memory {
    pub particles: u32,
    /// Of the whole domain.
    pub domain_voxels: u64,
    pub octree: Octree,
    census: Census,
    neighbors: Neighbors,
}

impl Memory {
    pub fn of(scene: &Scene, positions: &[Vec3]) -> Self {
        let census = Census::of(scene, &Grid::new(scene), positions);
        Self {
            particles: census.particles,
            domain_voxels: u64::from(census.grid.capacity),
            octree: census.octree(),
            neighbors: scene.neighbors,
            census,
        }
    }

    /// Voxels of each addressing, in the order of [`ADDRESSINGS`].
    pub fn voxels(&self) -> Vec<u64> {
        let names = ADDRESSINGS.iter().map(|row| format!("{}-counting", row.name));
        names.map(|name| self.allocation(&name).voxels).collect()
    }

    pub fn allocation(&self, grid: &str) -> Allocation {
        Allocation::of(&self.census, &self.choice(grid))
    }

    /// Bytes of an octree's leaves and nodes where each leaf keeps what a voxel keeps.
    pub fn octree_bytes(&self, storage: &str) -> [u64; 2] {
        let choice = self.choice(&format!("uniform-{storage}"));
        [
            self.octree.leaf_bytes(&choice, self.particles),
            self.octree.bytes(&choice, self.particles),
        ]
    }

    fn choice(&self, grid: &str) -> Neighbors {
        let all = ADDRESSINGS
            .iter()
            .flat_map(|a| STORAGES.iter().map(move |s| (a, s)));
        let (_, (addressing, storage)) = grid_names()
            .into_iter()
            .zip(all)
            .find(|(name, _)| name == grid)
            .unwrap_or_else(|| panic!("no grid is named {grid}"));
        Neighbors {
            addressing: addressing.kind,
            storage: storage.kind,
            ..self.neighbors
        }
    }
}
