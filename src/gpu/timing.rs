//! Milliseconds a pass, by timestamp queries.

use crate::error::Result;
use crate::gpu::{Gpu, readback};

/// Times up to `capacity` passes of one submission.
pub struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    labels: Vec<String>,
    capacity: u32,
    /// Nanoseconds a tick.
    period: f32,
}

impl Timer {
    /// `None` where the adapter has no timestamps.
    pub fn new(gpu: &Gpu, capacity: u32) -> Option<Self> {
        if !gpu.has_timestamps {
            return None;
        }
        let count = 2 * capacity;
        Some(Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            resolved: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("pass times"),
                size: u64::from(count) * 8,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            labels: Vec::new(),
            capacity,
            period: gpu.queue.get_timestamp_period(),
        })
    }

    /// Where the next pass writes its begin and end; `None` when the capacity is used up.
    pub fn writes(&mut self, label: &str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let index = self.labels.len() as u32;
        if index >= self.capacity {
            return None;
        }
        self.labels.push(label.to_owned());
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        })
    }

    /// Call once after the last timed pass of a submission.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let count = 2 * self.labels.len() as u32;
        if count > 0 {
            encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
        }
    }

    /// Waits for the device; label and milliseconds of every pass timed since the last call, in order.
    pub fn take(&mut self, gpu: &Gpu) -> Result<Vec<(String, f64)>> {
        let ticks: Vec<u64> = readback::read(gpu, &self.resolved, 2 * self.labels.len())?;
        let milliseconds = |pair: &[u64]| {
            pair[1].saturating_sub(pair[0]) as f64 * f64::from(self.period) * 1e-6
        };
        let times = ticks.chunks_exact(2).map(milliseconds);
        Ok(std::mem::take(&mut self.labels).into_iter().zip(times).collect())
    }
}
