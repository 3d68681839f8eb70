//! How full voxels are and what memory each grid needs for them, counted on the host for any positions.
//!
//! Voxels are those of the search's [`Grid`]; how many of them an addressing gives memory to is in its row of
//! [`super::ADDRESSINGS`], and bytes are those of the buffers that a search plans for so many.

mod allocation;
mod octree;

pub use allocation::{Allocation, hash_buckets};
pub use octree::Octree;

use std::collections::BTreeMap;

use glam::Vec3;
use rayon::prelude::*;

use super::{Grid, Search};
use crate::scene::{Dimensions, Scene};

/// A voxel with particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Occupied {
    /// Coordinates in the order (u, s, w) of [`Grid`].
    pub at: [i32; 3],
    /// At least one.
    pub particles: u32,
}

/// The occupied voxels of a state.
#[derive(Debug, Clone)]
pub struct Census {
    /// With exactly the room that this state needs.
    pub grid: Grid,
    pub dimensions: Dimensions,
    /// All that voxels hold, boundary particles included.
    pub particles: u32,
    /// How many of them are boundary particles, by slice.
    pub boundary: BTreeMap<i32, u64>,
    /// Particles in no voxel: farther away than the search follows.
    pub quarantined: u32,
    /// By slice, then by w, then by u.
    pub voxels: Vec<Occupied>,
}

/// A slice and its voxels' figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slice {
    /// Coordinate along the slicing axis; the domain's slices count from 0.
    pub at: i32,
    pub figures: Figures,
    /// How many of its particles are boundary particles.
    pub boundary: u64,
}

impl Slice {
    /// Particles, boundary particles apart.
    pub fn particles(&self) -> u64 {
        self.figures.particles - self.boundary
    }
}

/// Voxels by how many particles they hold; of one slice or of all.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Figures {
    pub particles: u64,
    pub occupied: u64,
    /// Voxels with one, two, three and four particles.
    pub with: [u64; 4],
    pub with_more: u64,
}

impl Figures {
    fn of<'a>(voxels: impl IntoIterator<Item = &'a Occupied>) -> Self {
        let mut figures = Self::default();
        for voxel in voxels {
            figures.particles += u64::from(voxel.particles);
            figures.occupied += 1;
            match figures.with.get_mut(voxel.particles as usize - 1) {
                Some(with) => *with += 1,
                None => figures.with_more += 1,
            }
        }
        figures
    }
}

impl Census {
    /// Counts local positions (metres) into the voxels of a scene's grid.
    pub fn of(scene: &Scene, positions: &[Vec3]) -> Self {
        Self::with_boundary(scene, positions, 0)
    }

    /// The same where the last `boundary` positions are those of boundary particles.
    pub fn with_boundary(scene: &Scene, positions: &[Vec3], boundary: usize) -> Self {
        let (grid, room) = super::least(scene, positions);
        let grid = grid.with_room(room);
        let bounded = Search::new(scene, grid, 0).flags.contains(&"bounded");
        let voxel = |&position: &Vec3| match bounded {
            true => Some(grid.voxel_in_domain(position)),
            false => grid.voxel(position),
        };
        let mut by_slice = BTreeMap::new();
        for [_, slice, _] in positions[positions.len() - boundary..].iter().filter_map(voxel) {
            *by_slice.entry(slice).or_default() += 1;
        }
        let mut voxels: Vec<[i32; 3]> = positions
            .par_iter()
            .filter_map(voxel)
            .map(|[u, s, w]| [s, w, u])
            .collect();
        voxels.par_sort_unstable();
        let quarantined = (positions.len() - voxels.len()) as u32;
        let voxels = voxels.chunk_by(|a, b| a == b).map(|same| {
            let [s, w, u] = same[0];
            Occupied {
                at: [u, s, w],
                particles: same.len() as u32,
            }
        });
        Self {
            grid,
            dimensions: scene.dimensions,
            particles: positions.len() as u32,
            boundary: by_slice,
            quarantined,
            voxels: voxels.collect(),
        }
    }

    pub fn figures(&self) -> Figures {
        Figures::of(&self.voxels)
    }

    /// The domain's slices, empty ones included, and those beyond it that hold particles; ascending.
    pub fn slices(&self) -> Vec<Slice> {
        let empty = (0..self.grid.size[1]).map(|s| (s, Figures::default()));
        let mut slices: BTreeMap<i32, Figures> = empty.collect();
        for slice in self.occupied_slices() {
            slices.insert(slice[0].at[1], Figures::of(slice));
        }
        let slice = |(at, figures)| Slice {
            at,
            figures,
            boundary: self.boundary.get(&at).copied().unwrap_or(0),
        };
        slices.into_iter().map(slice).collect()
    }

    /// Particles beyond the first `slots` of their voxel.
    pub fn overflow(&self, slots: u32) -> u64 {
        let beyond = |voxel: &Occupied| u64::from(voxel.particles.saturating_sub(slots));
        self.voxels.iter().map(beyond).sum()
    }

    /// The voxels of each slice that has any.
    pub fn occupied_slices(&self) -> impl Iterator<Item = &[Occupied]> {
        self.voxels.chunk_by(|a, b| a.at[1] == b.at[1])
    }
}
