//! The grids that were asked for, and what they are held against: the whole domain, an octree, a hash table.

use super::Found;
use crate::cli::grid;
use crate::neighbors::occupancy::{Allocation, Census, hash_buckets};
use crate::scene::model::Addressing;
use crate::scene::{Neighbors, Scene};

/// Something that can hold particles by voxel.
pub struct Structure {
    pub name: String,
    /// Voxels, buckets, or leaves and nodes.
    pub cells: u64,
    /// Particles that find no slot; `None` where that was not counted.
    pub overflow: Option<u64>,
    pub bytes: u64,
    /// Bytes of the whole domain's voxels with the same storage.
    pub uniform_bytes: u64,
}

/// The grids in the order given; then, for each storage among them, the references with that storage.
pub fn structures(found: &Found) -> Vec<Structure> {
    let scene = &found.subject.scene;
    let mut storages: Vec<Neighbors> = Vec::new();
    for one in &found.grids {
        let neighbors = one.allocation.neighbors;
        if storages.iter().all(|known| known.storage != neighbors.storage) {
            storages.push(neighbors);
        }
    }
    let mut structures: Vec<Structure> = Vec::new();
    for one in &found.grids {
        structures.push(Structure {
            name: one.name.clone(),
            cells: one.voxels(),
            overflow: one.overflow(),
            bytes: one.allocation.bytes,
            uniform_bytes: uniform(scene, one.allocation.neighbors).1.bytes,
        });
    }
    for neighbors in storages {
        let (name, whole) = uniform(scene, neighbors);
        let mut add = |name: String, cells, bytes, overflow| {
            if structures.iter().all(|known| known.name != name) {
                structures.push(Structure {
                    name,
                    cells,
                    overflow,
                    bytes,
                    uniform_bytes: whole.bytes,
                });
            }
        };
        let storage = name.trim_start_matches("uniform-").to_owned();
        add(name, whole.voxels, whole.bytes, whole.overflow);
        let particles = found.subject.census.particles;
        let octree = found.subject.census.octree();
        let tree = if octree.children == 8 {
            "octree"
        } else {
            "quadtree"
        };
        add(
            format!("{tree}, leaves and nodes, {storage}"),
            octree.nodes(),
            octree.bytes(&neighbors, particles),
            None,
        );
        add(
            format!("{tree}, leaves alone, {storage}"),
            octree.leaves,
            octree.leaf_bytes(&neighbors, particles),
            None,
        );
        add(
            format!("{tree}, children together, {storage}"),
            octree.allocated_nodes(),
            octree.allocated_bytes(&neighbors, particles),
            None,
        );
        let buckets = hash_buckets(particles);
        let bytes = Allocation::storage_bytes(&neighbors, buckets, particles);
        add(format!("hash table, {storage}"), buckets, bytes, None);
    }
    structures
}

/// The whole domain's voxels with the storage of `neighbors`, and what `--grid` calls that.
fn uniform(scene: &Scene, neighbors: Neighbors) -> (String, Allocation) {
    let mut scene = scene.clone();
    scene.neighbors = Neighbors {
        addressing: Addressing::Uniform,
        ..neighbors
    };
    let name = grid::name(&scene.neighbors);
    let census = Census::of(&scene, &scene.positions());
    (name, Allocation::of(&scene, &census))
}
