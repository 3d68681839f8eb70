//! The octree that Harada 2007 (Figure 6) holds his grid against: its leaves are voxels.

use super::{Allocation, Census};
use crate::scene::{Dimensions, Neighbors};

/// An octree (in 2D a quadtree) over the smallest cube of 2^levels voxels per side that begins at the lower corner of the
/// domain and of the occupied voxels and holds them all. Leaves are voxels, all on the last level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Octree {
    /// Levels below the root.
    pub levels: u32,
    /// Children of a node: 8, in 2D 4.
    pub children: u64,
    /// Leaves with particles: the occupied voxels.
    pub leaves: u64,
    /// Nodes above the leaves that have particles below them, the root included.
    pub inner: u64,
    /// Leaves where a node's children come all together.
    pub allocated_leaves: u64,
    /// Nodes above the leaves where children come all together.
    pub allocated_inner: u64,
}

impl Octree {
    /// Leaves and nodes that have particles below them.
    pub fn nodes(&self) -> u64 {
        self.leaves + self.inner
    }

    /// The same where a node's children come all together.
    pub fn allocated_nodes(&self) -> u64 {
        self.allocated_leaves + self.allocated_inner
    }

    /// Bytes of the leaves alone, each one taking what a voxel takes in this storage.
    pub fn leaf_bytes(&self, neighbors: &Neighbors, particles: u32) -> u64 {
        Allocation::storage_bytes(neighbors, self.leaves, particles)
    }

    /// Bytes of leaves and nodes; a node is an index (4 bytes) for each child, and only leaves with particles exist.
    pub fn bytes(&self, neighbors: &Neighbors, particles: u32) -> u64 {
        self.leaf_bytes(neighbors, particles) + 4 * self.children * self.inner
    }

    /// Bytes where children come all together, so that a node is the index (4 bytes) of its first child.
    pub fn allocated_bytes(&self, neighbors: &Neighbors, particles: u32) -> u64 {
        Allocation::storage_bytes(neighbors, self.allocated_leaves, particles) + 4 * self.allocated_inner
    }
}

impl Census {
    pub fn octree(&self) -> Octree {
        let (mut low, mut high) = ([0; 3], [0, 1, 2].map(|i| self.grid.size[i]));
        for voxel in &self.voxels {
            for (i, &at) in voxel.at.iter().enumerate() {
                low[i] = low[i].min(at);
                high[i] = high[i].max(at + 1);
            }
        }
        let widest = (0..3).map(|i| high[i].abs_diff(low[i])).max().unwrap_or(1);
        let levels = widest.next_power_of_two().ilog2();
        let children = match self.dimensions {
            Dimensions::Two => 4,
            Dimensions::Three => 8,
        };
        let mut cells: Vec<[i32; 3]> = self
            .voxels
            .iter()
            .map(|voxel| [0, 1, 2].map(|i| voxel.at[i].wrapping_sub(low[i])))
            .collect();
        let leaves = cells.len() as u64;
        let root = u64::from(leaves > 0);
        // Occupied cells of each level above the leaves, from the lowest to the root.
        let mut above = Vec::new();
        for _ in 0..levels {
            for cell in &mut cells {
                *cell = cell.map(|x| x >> 1);
            }
            cells.sort_unstable();
            cells.dedup();
            above.push(cells.len() as u64);
        }
        // The root stands alone; each occupied node brings all its children.
        let higher: u64 = above.iter().skip(1).sum();
        Octree {
            levels,
            children,
            leaves,
            inner: above.iter().sum(),
            allocated_leaves: above.first().map_or(root, |nodes| children * nodes),
            allocated_inner: if levels == 0 { 0 } else { root + children * higher },
        }
    }
}
