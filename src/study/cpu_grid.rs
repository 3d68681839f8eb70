//! The grids built by all of the processor's threads, for Harada 2007's Figure 5. The same work as on the device:
//! `pool` keeps indices; `counting` brings the state into voxel order, the same order in every run.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::Vec3;
use rayon::prelude::*;

use crate::scene::{Particles, Scene};

/// Particles that one task counts, and voxels that one task sums.
const CHUNK: usize = 8192;

/// Which voxels have memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Addressing {
    Uniform,
    /// The bounding box of each slice across y (Harada 2007, Eq. 1 to 5).
    Sliced,
}

/// How voxels keep particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// So many indices per voxel.
    Pool(u32),
    Counting,
}

/// The voxels' place and size.
#[derive(Debug, Clone, Copy)]
struct Space {
    lower: Vec3,
    inverse_side: f32,
    size: [i32; 3],
}

/// First voxel, lower corner (x, z) and width along x of a slice.
#[derive(Debug, Clone, Copy, Default)]
struct Slice {
    first: u32,
    low: [i32; 2],
    width: i32,
}

/// Lowest and highest x and z of a slice's particles; lowest above highest where there are none.
type Bounds = [i32; 4];
const NOTHING: Bounds = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];

/// A grid with its buffers, which are kept from build to build.
pub struct CpuGrid {
    space: Space,
    addressing: Addressing,
    storage: Storage,
    slices: Vec<Slice>,
    /// Voxels of the last build.
    pub voxels: usize,
    voxel_of: Vec<u32>,
    arrival: Vec<u32>,
    count: Vec<AtomicU32>,
    start: Vec<u32>,
    arrived: Vec<AtomicU32>,
    pool: Vec<AtomicU32>,
    /// The state in voxel order, of `Counting`.
    pub order: Vec<AtomicU32>,
    pub sorted: Particles,
}

impl CpuGrid {
    pub fn new(scene: &Scene, addressing: Addressing, storage: Storage) -> Self {
        let side = 2.0 * scene.radius() * (1.0 + 1e-4);
        let extent = (scene.domain.max - scene.domain.min).as_dvec3();
        let size = (extent / side).to_array().map(|n| (n.ceil() as i32).max(1));
        let slice = Slice {
            width: size[0],
            ..Default::default()
        };
        let slices = (0..size[1]).map(|y| Slice {
            first: (y * size[0] * size[2]) as u32,
            ..slice
        });
        Self {
            slices: slices.collect(),
            space: Space {
                lower: scene.domain.min,
                inverse_side: (1.0 / side) as f32,
                size,
            },
            addressing,
            storage,
            voxels: size.iter().map(|&n| n as usize).product(),
            voxel_of: Vec::new(),
            arrival: Vec::new(),
            count: Vec::new(),
            start: Vec::new(),
            arrived: Vec::new(),
            pool: Vec::new(),
            order: Vec::new(),
            sorted: Particles::default(),
        }
    }

    /// Builds the grid for these particles.
    pub fn build(&mut self, particles: &Particles) {
        if self.addressing == Addressing::Sliced {
            self.bound_slices(&particles.position);
        }
        match self.storage {
            Storage::Pool(slots) => self.fill_pool(&particles.position, slots),
            Storage::Counting => self.sort(particles),
        }
    }

    /// Harada 2007, Eq. 1 to 3.
    fn bound_slices(&mut self, positions: &[Vec3]) {
        let space = self.space;
        let none = || vec![NOTHING; space.size[1] as usize];
        let widen = |bounds: &mut Bounds, other: Bounds| {
            for k in 0..2 {
                bounds[k] = bounds[k].min(other[k]);
                bounds[k + 2] = bounds[k + 2].max(other[k + 2]);
            }
        };
        let bounds = positions
            .par_chunks(CHUNK)
            .fold(none, |mut bounds, chunk| {
                for &position in chunk {
                    let [x, y, z] = space.voxel(position);
                    widen(&mut bounds[y as usize], [x, z, x, z]);
                }
                bounds
            })
            .reduce(none, |mut a, b| {
                for (a, b) in a.iter_mut().zip(b) {
                    widen(a, b);
                }
                a
            });
        let mut first = 0;
        for (slice, [x0, z0, x1, z1]) in self.slices.iter_mut().zip(bounds) {
            let width = if x1 < x0 { 0 } else { x1 - x0 + 1 };
            *slice = Slice {
                first,
                low: [x0, z0],
                width,
            };
            first += if width == 0 {
                0
            } else {
                (width * (z1 - z0 + 1)) as u32
            };
        }
        self.voxels = first as usize;
    }

    /// Harada 2007, Eq. 4 and 5.
    fn address(space: Space, slices: &[Slice], position: Vec3) -> u32 {
        let [x, y, z] = space.voxel(position);
        let slice = slices[y as usize];
        slice.first + ((x - slice.low[0]) + (z - slice.low[1]) * slice.width) as u32
    }

    fn fill_pool(&mut self, positions: &[Vec3], slots: u32) {
        clear(&mut self.count, self.voxels);
        room(&mut self.pool, self.voxels * slots as usize);
        let (space, slices, count, pool) = (self.space, &self.slices, &self.count, &self.pool);
        positions.par_iter().enumerate().for_each(|(index, &position)| {
            let voxel = Self::address(space, slices, position);
            let slot = count[voxel as usize].fetch_add(1, Relaxed);
            if slot < slots {
                pool[(voxel * slots + slot) as usize].store(index as u32, Relaxed);
            }
        });
    }

    fn sort(&mut self, particles: &Particles) {
        let positions = &particles.position;
        clear(&mut self.count, self.voxels);
        let (space, slices, count) = (self.space, &self.slices, &self.count);
        positions
            .par_iter()
            .map(|&position| {
                let voxel = Self::address(space, slices, position);
                (voxel, count[voxel as usize].fetch_add(1, Relaxed))
            })
            .unzip_into_vecs(&mut self.voxel_of, &mut self.arrival);
        self.sum_counts();

        room(&mut self.arrived, positions.len());
        room(&mut self.order, positions.len());
        let (voxel_of, arrival, start) = (&self.voxel_of, &self.arrival, &self.start);
        let (count, arrived, order) = (&self.count, &self.arrived, &self.order);
        (0..positions.len()).into_par_iter().for_each(|index| {
            let slot = start[voxel_of[index] as usize] + arrival[index];
            arrived[slot as usize].store(index as u32, Relaxed);
        });
        // Each particle's place among its voxel's is the number of smaller indices there.
        (0..positions.len()).into_par_iter().for_each(|index| {
            let voxel = voxel_of[index] as usize;
            let first = start[voxel] as usize;
            let end = first + count[voxel].load(Relaxed) as usize;
            let same = arrived[first..end].iter();
            let smaller = same.filter(|other| other.load(Relaxed) < index as u32).count();
            order[first + smaller].store(index as u32, Relaxed);
        });
        let gather = |from: &[Vec3], into: &mut Vec<Vec3>| {
            order[..positions.len()]
                .par_iter()
                .map(|index| from[index.load(Relaxed) as usize])
                .collect_into_vec(into);
        };
        gather(positions, &mut self.sorted.position);
        gather(&particles.velocity, &mut self.sorted.velocity);
    }

    /// Prefix sum of the voxels' counts: sums of chunks, their own prefix sum, and each chunk's.
    fn sum_counts(&mut self) {
        let count = &self.count[..self.voxels];
        let mut chunks: Vec<u32> = count
            .par_chunks(CHUNK)
            .map(|chunk| chunk.iter().map(|n| n.load(Relaxed)).sum())
            .collect();
        let mut sum = 0;
        for chunk in &mut chunks {
            sum += std::mem::replace(chunk, sum);
        }
        self.start.resize(self.voxels, 0);
        self.start
            .par_chunks_mut(CHUNK)
            .zip(count.par_chunks(CHUNK))
            .zip(chunks)
            .for_each(|((start, count), mut sum)| {
                for (start, count) in start.iter_mut().zip(count) {
                    *start = sum;
                    sum += count.load(Relaxed);
                }
            });
    }
}

impl Space {
    fn voxel(&self, position: Vec3) -> [i32; 3] {
        let scaled = (position - self.lower) * self.inverse_side;
        [0, 1, 2].map(|k| (scaled[k].floor() as i32).clamp(0, self.size[k] - 1))
    }
}

/// Makes a buffer large enough; what is in it stays.
fn room(buffer: &mut Vec<AtomicU32>, len: usize) {
    if buffer.len() < len {
        buffer.resize_with(len, Default::default);
    }
}

/// Sets the first `len` to zero.
fn clear(buffer: &mut Vec<AtomicU32>, len: usize) {
    room(buffer, len);
    buffer[..len]
        .par_chunks(CHUNK)
        .for_each(|chunk| chunk.iter().for_each(|n| n.store(0, Relaxed)));
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::study::scenes;

    const GRIDS: [Addressing; 2] = [Addressing::Uniform, Addressing::Sliced];

    /// Grains in a block and a few strays, in no order.
    fn scene() -> Scene {
        let scene = scenes::dropped_block(64, 16, 32, 0.1, 60.0).unwrap();
        let mut particles = scenes::shuffled(&scene.particles);
        for k in 0..50 {
            let along = 0.012 * k as f32;
            particles.position.push(Vec3::new(along, 0.5, 0.6 - along));
            // Three in one voxel.
            particles.position.push(Vec3::new(0.1, 0.011, 0.1));
        }
        scenes::replaced(&scene, scenes::at_rest(particles.position))
    }

    fn brute(grid: &CpuGrid, particles: &Particles) -> BTreeMap<[i32; 3], Vec<u32>> {
        let mut voxels: BTreeMap<_, Vec<u32>> = BTreeMap::new();
        for (index, &position) in (0..).zip(&particles.position) {
            voxels.entry(grid.space.voxel(position)).or_default().push(index);
        }
        voxels
    }

    /// Every voxel's address, by the slices that the grid made.
    fn address(grid: &CpuGrid, [x, y, z]: [i32; 3]) -> usize {
        let slice = grid.slices[y as usize];
        slice.first as usize + ((x - slice.low[0]) + (z - slice.low[1]) * slice.width) as usize
    }

    #[test]
    fn counting_agrees_with_brute_counts() {
        let scene = scene();
        for addressing in GRIDS {
            let mut grid = CpuGrid::new(&scene, addressing, Storage::Counting);
            // A second build must not see the first one's counts.
            for _ in 0..2 {
                grid.build(&scene.particles);
                for (voxel, members) in brute(&grid, &scene.particles) {
                    let at = address(&grid, voxel);
                    assert!(at < grid.voxels);
                    assert_eq!(grid.count[at].load(Relaxed) as usize, members.len());
                    let first = grid.start[at] as usize;
                    let found: Vec<u32> = grid.order[first..first + members.len()]
                        .iter()
                        .map(|n| n.load(Relaxed))
                        .collect();
                    assert_eq!(found, members, "{addressing:?} {voxel:?}");
                    let moved = grid.sorted.position[first];
                    assert_eq!(moved, scene.particles.position[members[0] as usize]);
                }
            }
        }
    }

    #[test]
    fn a_pool_keeps_what_has_a_slot() {
        let scene = scene();
        for addressing in GRIDS {
            let mut grid = CpuGrid::new(&scene, addressing, Storage::Pool(4));
            grid.build(&scene.particles);
            for (voxel, members) in brute(&grid, &scene.particles) {
                let at = address(&grid, voxel);
                assert_eq!(grid.count[at].load(Relaxed) as usize, members.len());
                let mut kept: Vec<u32> = grid.pool[4 * at..4 * at + members.len().min(4)]
                    .iter()
                    .map(|n| n.load(Relaxed))
                    .collect();
                kept.sort_unstable();
                kept.dedup();
                assert_eq!(kept.len(), members.len().min(4));
                assert!(kept.iter().all(|one| members.contains(one)), "{addressing:?}");
            }
        }
    }

    #[test]
    fn slices_are_no_larger_than_their_particles() {
        let scene = scene();
        let mut grid = CpuGrid::new(&scene, Addressing::Sliced, Storage::Counting);
        let all = grid.voxels;
        grid.build(&scene.particles);
        let mut boxes: BTreeMap<i32, Bounds> = BTreeMap::new();
        for [x, y, z] in brute(&grid, &scene.particles).into_keys() {
            let b = boxes.entry(y).or_insert(NOTHING);
            *b = [b[0].min(x), b[1].min(z), b[2].max(x), b[3].max(z)];
        }
        let expected: i32 = boxes
            .values()
            .map(|b| (b[2] - b[0] + 1) * (b[3] - b[1] + 1))
            .sum();
        assert_eq!(grid.voxels, expected as usize);
        assert!(grid.voxels < all / 4);
    }
}
