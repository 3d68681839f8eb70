//! Every particle's neighbors, as a simulation's own search finds them: all pairs nearer than a grain's diameter.

use rayon::prelude::*;

use super::Simulation;
use crate::error::{Error, Result};
use crate::gpu::buffers::Usage;
use crate::gpu::readback::{self, Ring};
use crate::gpu::{Buffers, Kernel, Pass};
use crate::neighbors::{FROM_VOXELS, lists};
use crate::scene::field::{Field, Travels};

/// Neighbors by id, compressed: those of particle i are `ids[start[i]..start[i + 1]]`, in ascending order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NeighborLists {
    pub start: Vec<u64>,
    pub ids: Vec<u32>,
}

/// How many neighbors each particle has.
pub struct NeighborCounts {
    /// The particle in each slot of the search's order, and its number of neighbors.
    id: Vec<u32>,
    count: Vec<u32>,
}

impl NeighborCounts {
    /// In order of id.
    pub fn by_id(&self) -> Vec<u32> {
        let mut by_id = vec![0; self.count.len()];
        for (&id, &count) in self.id.iter().zip(&self.count) {
            by_id[id as usize] = count;
        }
        by_id
    }
}

/// Lists are made in parts of at most so many bytes: while the host sorts one, the device makes the next.
const LARGEST_PART: u64 = 32 << 20;
/// Parts that may be on their way to the host.
const PARTS_UNDER_WAY: usize = 2;

/// The passes that count and list neighbors, ready to run.
pub struct PairQuery {
    count: Pass,
    list: Pass,
    /// Neighbors that one part of the lists has room for.
    room: usize,
}

impl Simulation {
    /// Prepares the passes. None of them runs for the first time when it is timed: each has run on one workgroup.
    pub fn pair_query(&mut self) -> Result<PairQuery> {
        let mut variant = self.plan.variant.clone();
        if lists::knows_reach(&self.scene) {
            // Boundary particles out of reach have no lists.
            variant.role("candidates", FROM_VOXELS);
        }
        let (gpu, buffers): (_, &mut Buffers) = (&self.gpu, &mut self.buffers);
        let slots = 4 * u64::from(self.scene.capacity);
        let part = LARGEST_PART.min(gpu.limits.binding).min(gpu.limits.buffer) / 4 * 4;
        for (name, bytes) in [
            ("search_radius", 4),
            ("listed_slots", 8),
            ("neighbor_count", slots),
            ("neighbor_start", slots),
            ("neighbor_id", part),
        ] {
            buffers.create(gpu, name, bytes, Usage::Storage)?;
        }
        let radius = self.scene.search_radius() as f32;
        buffers.write(gpu, "search_radius", 0, &[radius])?;
        let pass = |entry| Kernel::load(gpu, "storage/list_neighbors", &variant, entry)?.pass(gpu, buffers);
        let query = PairQuery {
            count: pass("count_neighbors")?,
            list: pass("list_neighbors")?,
            room: part as usize / 4,
        };
        let mut encoder = self.encoder("warm up");
        let mut compute = encoder.begin_compute_pass(&Default::default());
        query.count.encode(&mut compute, 1);
        // No slot is listed yet.
        query.list.encode(&mut compute, 1);
        drop(compute);
        self.gpu.submit(encoder)?;
        self.gpu.wait(None)?;
        Ok(query)
    }

    /// A step that moves nothing: leaves all particles for [`Simulation::search_again`].
    pub fn stand_still(&self) -> Result<()> {
        let mut encoder = self.encoder("stand still");
        // A search itself leaves what no step changes for the next one.
        let stepped = |field: &&Field| field.travels == Travels::Stepped && field.beside.is_none();
        for field in self.scene.fields().filter(stepped) {
            self.copy_for_search(&mut encoder, field)?;
        }
        self.gpu.submit(encoder)?;
        self.gpu.wait(None)
    }

    /// Runs the search again and waits for it.
    pub fn search_again(&self) -> Result<()> {
        self.search()?;
        self.gpu.wait(None)
    }

    /// Number of neighbors of each particle at the present state.
    pub fn count_neighbors(&self, query: &PairQuery) -> Result<NeighborCounts> {
        let mut encoder = self.encoder("count neighbors");
        let mut compute = encoder.begin_compute_pass(&Default::default());
        query.count.encode(&mut compute, self.count);
        drop(compute);
        self.gpu.submit(encoder)?;
        let read = |name| -> Result<Vec<u32>> {
            let buffer = self.buffers.get(name, "(host)")?;
            readback::read(&self.gpu, buffer, self.count as usize)
        };
        Ok(NeighborCounts {
            count: read("neighbor_count")?,
            id: read("id")?,
        })
    }

    /// The neighbors of each particle, which were counted at the present state.
    pub fn list_neighbors(&self, query: &PairQuery, counts: &NeighborCounts) -> Result<NeighborLists> {
        let parts = parts(counts, query.room)?;
        let mut start = vec![0; counts.count.len() + 1];
        for (id, count) in counts.by_id().into_iter().enumerate() {
            start[id + 1] = start[id] + u64::from(count);
        }
        let mut ids = reserve(start[start.len() - 1])?;
        self.buffers
            .write(&self.gpu, "neighbor_start", 0, &starts(counts, &parts))?;

        // The place of each slot's list among all lists.
        let mut by_id = Vec::with_capacity(counts.id.len());
        let mut rest = &mut ids[..];
        for pair in start.windows(2) {
            let (list, behind) = rest.split_at_mut((pair[1] - pair[0]) as usize);
            by_id.push(list);
            rest = behind;
        }
        let mut lists: Vec<_> = counts
            .id
            .iter()
            .map(|&id| std::mem::take(&mut by_id[id as usize]))
            .collect();

        // One size for all parts, so that staging buffers are used again.
        let staging_bytes = 4 * parts.iter().map(|part| part.neighbors).max().unwrap_or(0) as u64;
        let mut ring = Ring::new(PARTS_UNDER_WAY);
        let mut sort = |bytes: &[u8], part: &Part| {
            let mut found: &[u32] = bytemuck::cast_slice(bytes);
            let mut tasks = Vec::with_capacity(part.slots.len());
            for list in &mut lists[part.slots.clone()] {
                let (mine, behind) = found.split_at(list.len());
                tasks.push((list, mine));
                found = behind;
            }
            tasks.into_par_iter().with_min_len(256).for_each(|(list, mine)| {
                list.copy_from_slice(mine);
                list.sort_unstable();
            });
        };
        for part in parts {
            if ring.is_full() {
                ring.receive_with(&self.gpu, &mut sort)?;
            }
            let slots = [part.slots.start as u32, part.slots.end as u32];
            self.buffers.write(&self.gpu, "listed_slots", 0, &[slots])?;
            let mut encoder = self.encoder("list neighbors");
            query.list.encode(
                &mut encoder.begin_compute_pass(&Default::default()),
                slots[1] - slots[0],
            );
            let listed = self.buffers.get("neighbor_id", "(host)")?;
            let bytes = 4 * part.neighbors as u64;
            ring.send(&self.gpu, encoder, staging_bytes, part, |encoder, staging| {
                encoder.copy_buffer_to_buffer(listed, 0, staging, 0, bytes);
            })?;
        }
        while ring.receive_with(&self.gpu, &mut sort)?.is_some() {}
        Ok(NeighborLists { start, ids })
    }

    /// All pairs nearer than a grain's diameter, at the present state.
    pub fn neighbor_lists(&mut self) -> Result<NeighborLists> {
        let query = self.pair_query()?;
        let counts = self.count_neighbors(&query)?;
        self.list_neighbors(&query, &counts)
    }
}

/// Slots whose neighbors are listed together.
struct Part {
    slots: std::ops::Range<usize>,
    neighbors: usize,
}

/// Cuts the slots into parts that have room for their neighbors.
fn parts(counts: &NeighborCounts, room: usize) -> Result<Vec<Part>> {
    let mut parts: Vec<Part> = Vec::new();
    for (slot, &count) in counts.count.iter().enumerate() {
        let count = count as usize;
        if count > room {
            return Err(Error::Limit {
                what: format!(
                    "point {} has {count} neighbors, and the adapter holds {room} at once",
                    counts.id[slot]
                ),
                help: "take a smaller radius, or ask for counts alone".into(),
            });
        }
        match parts.last_mut() {
            Some(part) if part.neighbors + count <= room => {
                part.slots.end = slot + 1;
                part.neighbors += count;
            }
            _ => parts.push(Part {
                slots: slot..slot + 1,
                neighbors: count,
            }),
        }
    }
    parts.retain(|part| part.neighbors > 0);
    Ok(parts)
}

/// Where the list of each slot begins in its part.
fn starts(counts: &NeighborCounts, parts: &[Part]) -> Vec<u32> {
    let mut starts = vec![0; counts.count.len()];
    for part in parts {
        let mut next = 0;
        for slot in part.slots.clone() {
            starts[slot] = next;
            next += counts.count[slot];
        }
    }
    starts
}

/// Zeroes for so many neighbors. It asks for the memory first: `vec!` would end the program where there is none.
fn reserve(neighbors: u64) -> Result<Vec<u32>> {
    match Vec::<u32>::new().try_reserve_exact(neighbors as usize) {
        Ok(()) => Ok(vec![0; neighbors as usize]),
        Err(_) => Err(Error::Limit {
            what: format!("lists of {neighbors} neighbors need {} bytes", 4 * neighbors),
            help: "take a smaller radius, or ask for counts alone".into(),
        }),
    }
}
