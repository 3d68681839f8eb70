//! Milliseconds a pass.

use std::time::Instant;

use crate::error::Result;
use crate::gpu::{Gpu, Groups, Pass, readback};

/// Times passes one by one.
pub enum Timer {
    /// Timestamp queries of the device.
    Queries {
        queries: wgpu::QuerySet,
        resolved: wgpu::Buffer,
        /// Nanoseconds a tick.
        period: f32,
    },
    /// Each pass is submitted alone and waited for: software adapters stamp when they queue a pass, not when its
    /// threads are done.
    HostClock,
}

impl Timer {
    /// For up to `capacity` passes at once; `None` where the adapter has no timestamps.
    pub fn new(gpu: &Gpu, capacity: u32) -> Option<Self> {
        if gpu.is_software() {
            return Some(Self::HostClock);
        }
        let count = 2 * capacity;
        gpu.has_timestamps.then(|| Self::Queries {
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
            period: gpu.queue.get_timestamp_period(),
        })
    }

    /// Runs passes with their workgroups, in order, waits for them, and gives label and milliseconds of each.
    pub fn run(&self, gpu: &Gpu, passes: &[(&Pass, Groups<'_>)]) -> Result<Vec<(String, f64)>> {
        match self {
            Self::HostClock => {
                gpu.wait(None)?;
                let time = |(pass, groups): &(&Pass, Groups<'_>)| {
                    let mut encoder = gpu.device.create_command_encoder(&Default::default());
                    pass.dispatch(&mut encoder.begin_compute_pass(&Default::default()), *groups);
                    let start = Instant::now();
                    gpu.submit(encoder)?;
                    gpu.wait(None)?;
                    Ok((pass.label.clone(), start.elapsed().as_secs_f64() * 1e3))
                };
                passes.iter().map(time).collect()
            }
            Self::Queries {
                queries,
                resolved,
                period,
            } => {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                for (index, (pass, groups)) in (0..).zip(passes) {
                    let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                        label: Some(&pass.label),
                        timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                            query_set: queries,
                            beginning_of_pass_write_index: Some(2 * index),
                            end_of_pass_write_index: Some(2 * index + 1),
                        }),
                    });
                    pass.dispatch(&mut compute, *groups);
                }
                let count = 2 * passes.len() as u32;
                encoder.resolve_query_set(queries, 0..count, resolved, 0);
                gpu.submit(encoder)?;
                let ticks: Vec<u64> = readback::read(gpu, resolved, count as usize)?;
                let milliseconds =
                    |pair: &[u64]| pair[1].saturating_sub(pair[0]) as f64 * f64::from(*period) * 1e-6;
                let labels = passes.iter().map(|(pass, _)| pass.label.clone());
                Ok(labels.zip(ticks.chunks_exact(2).map(milliseconds)).collect())
            }
        }
    }
}

/// The middle value, NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => (values[n / 2 - 1] + values[n / 2]) / 2.0,
    }
}
