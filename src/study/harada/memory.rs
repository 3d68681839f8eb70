//! What each grid needs memory for, counted on the host.

use glam::Vec3;

use crate::neighbors::occupancy::{Allocation, Census, Octree};
use crate::neighbors::{ADDRESSINGS, Room, STORAGES, lists};
use crate::scene::{Neighbors, Particles, Scene};
use crate::study::bench::grid_names;
use crate::study::scenes::LISTS;

/// A state's voxels.
pub struct Memory<'a> {
    /// Without its particles.
    scene: Scene,
    positions: &'a [Vec3],
    pub octree: Octree,
    /// Voxels of the whole domain.
    pub domain_voxels: u64,
}

impl<'a> Memory<'a> {
    pub fn of(scene: &Scene, positions: &'a [Vec3]) -> Self {
        let scene = Scene {
            capacity: positions.len() as u32,
            particles: Particles::default(),
            ..scene.clone()
        };
        let census = Census::of(&scene, positions);
        Self {
            octree: census.octree(),
            domain_voxels: census.grid.domain_voxels(),
            scene,
            positions,
        }
    }

    /// Voxels of each addressing, in the order of [`ADDRESSINGS`].
    pub fn voxels(&self) -> Vec<u64> {
        let names = ADDRESSINGS.iter().map(|row| format!("{}-counting", row.name));
        names.map(|name| self.allocation(&name).voxels).collect()
    }

    pub fn allocation(&self, grid: &str) -> Allocation {
        let scene = Scene {
            neighbors: self.choice(grid),
            ..self.scene.clone()
        };
        Allocation::of(&scene, &Census::of(&scene, self.positions))
    }

    /// Bytes of a grid's search; with those of its lists, where it has some.
    pub fn bytes(&self, grid: &str) -> u64 {
        let scene = Scene {
            neighbors: self.choice(grid),
            ..self.scene.clone()
        };
        let lists = if lists::wanted(&scene) {
            let room = Room {
                list: lists::usual_length(&scene),
                ..Room::default()
            };
            lists::buffers(&scene, room)
        } else {
            Vec::new()
        };
        self.allocation(grid).bytes + lists.iter().map(|buffer| buffer.bytes).sum::<u64>()
    }

    /// Bytes of an octree's leaves where each keeps what a voxel keeps: what they keep alone; that and a key of four
    /// bytes each, by which they are found without nodes (a linear octree); and that with nodes instead.
    pub fn octree_bytes(&self, storage: &str) -> [u64; 3] {
        let choice = self.choice(&format!("uniform-{storage}"));
        let leaves = self.octree.leaf_bytes(&choice, self.scene.capacity);
        [
            leaves,
            leaves + 4 * self.octree.leaves,
            self.octree.bytes(&choice, self.scene.capacity),
        ]
    }

    fn choice(&self, grid: &str) -> Neighbors {
        let plain = grid.trim_end_matches(LISTS);
        let all = ADDRESSINGS
            .iter()
            .flat_map(|a| STORAGES.iter().map(move |s| (a, s)));
        let (_, (addressing, storage)) = grid_names()
            .into_iter()
            .zip(all)
            .find(|(name, _)| name == plain)
            .unwrap_or_else(|| panic!("no grid is named {grid}"));
        Neighbors {
            addressing: addressing.kind,
            storage: storage.kind,
            skin: if grid == plain {
                0.0
            } else {
                Neighbors::default().skin
            },
            ..self.scene.neighbors
        }
    }
}
