//! Every particle's neighbors, as a simulation's own search finds them.

use super::Simulation;
use crate::error::Result;
use crate::gpu::buffers::Usage;
use crate::gpu::{Buffers, Pass, Shader, readback};

/// Neighbors by id, compressed: those of particle i are `ids[start[i]..start[i + 1]]`, in ascending order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NeighborLists {
    pub start: Vec<u32>,
    pub ids: Vec<u32>,
}

impl Simulation {
    /// All pairs nearer than a grain's diameter, at the present state.
    pub fn neighbor_lists(&mut self) -> Result<NeighborLists> {
        let count = self.count as usize;
        let mut start = vec![0u32; count + 1];
        if count == 0 {
            return Ok(NeighborLists {
                start,
                ids: Vec::new(),
            });
        }
        let shader = Shader::load("storage/list_neighbors", &self.plan.variant)?;
        let gpu = &self.gpu;
        let buffers: &mut Buffers = &mut self.buffers;
        let bytes = 4 * count as u64;
        buffers.create(gpu, "search_radius", 4, Usage::Storage);
        buffers.create(gpu, "neighbor_count", bytes, Usage::Storage);
        buffers.create(gpu, "neighbor_start", bytes, Usage::Storage);
        let radius = (2.0 * self.scene.grains.radius) as f32;
        buffers.write(gpu, "search_radius", 0, &[radius])?;

        let run = |entry, buffers: &Buffers| -> Result<()> {
            let pass = Pass::new(gpu, &shader, entry, buffers)?;
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            pass.encode(&mut encoder.begin_compute_pass(&Default::default()), count as u32);
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        };
        run("count_neighbors", buffers)?;
        let counts: Vec<u32> = readback::read(gpu, buffers.get("neighbor_count", "(host)")?, count)?;
        for (i, neighbors) in counts.iter().enumerate() {
            start[i + 1] = start[i] + neighbors;
        }
        let total = start[count] as usize;
        buffers.write(gpu, "neighbor_start", 0, &start[..count])?;
        buffers.create(gpu, "neighbor_id", 4 * total.max(1) as u64, Usage::Storage);
        run("list_neighbors", buffers)?;
        let mut ids: Vec<u32> = readback::read(gpu, buffers.get("neighbor_id", "(host)")?, total)?;
        for i in 0..count {
            ids[start[i] as usize..start[i + 1] as usize].sort_unstable();
        }
        Ok(NeighborLists { start, ids })
    }
}
