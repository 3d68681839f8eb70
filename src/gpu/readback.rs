//! Bringing bytes to the host without stalling the device: a ring of staging buffers.

use std::collections::VecDeque;

use crate::error::{Error, Result};
use crate::gpu::Gpu;

/// A ring of staging buffers; each copy carries a tag that comes back with its bytes.
///
/// While copies are on their way the device goes on. When the ring is full, sending waits for the oldest copy, so
/// memory stays bounded.
pub struct Ring<T> {
    depth: usize,
    free: Vec<wgpu::Buffer>,
    under_way: VecDeque<Copy<T>>,
}

struct Copy<T> {
    buffer: wgpu::Buffer,
    bytes: u64,
    submission: wgpu::SubmissionIndex,
    tag: T,
}

impl<T> Ring<T> {
    pub fn new(depth: usize) -> Self {
        Self {
            depth,
            free: Vec::new(),
            under_way: VecDeque::new(),
        }
    }

    /// Submits `encoder` after `fill` has added its copies into a staging buffer of `bytes` bytes. Returns the oldest
    /// copy when the ring is full.
    pub fn send(
        &mut self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        bytes: u64,
        tag: T,
        fill: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::Buffer),
    ) -> Result<Option<(Vec<u8>, T)>> {
        let oldest = if self.is_full() { self.receive(gpu)? } else { None };
        let size = bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        let fits = self.free.iter().position(|buffer| buffer.size() == size);
        let buffer = match fits {
            Some(index) => self.free.swap_remove(index),
            None => gpu.make(
                || format!("buffer `staging` of {size} bytes"),
                |device| {
                    device.create_buffer(&wgpu::BufferDescriptor {
                        label: Some("staging"),
                        size,
                        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                        mapped_at_creation: false,
                    })
                },
            )?,
        };
        fill(&mut encoder, &buffer);
        let submission = gpu.submit(encoder)?;
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.under_way.push_back(Copy {
            buffer,
            bytes,
            submission,
            tag,
        });
        Ok(oldest)
    }

    /// Whether sending would wait for the oldest copy.
    pub fn is_full(&self) -> bool {
        self.under_way.len() == self.depth
    }

    /// Waits for the oldest copy; `None` when nothing is under way.
    pub fn receive(&mut self, gpu: &Gpu) -> Result<Option<(Vec<u8>, T)>> {
        let mut bytes = Vec::new();
        let tag = self.receive_with(gpu, |mapped, _| bytes = mapped.to_vec())?;
        Ok(tag.map(|tag| (bytes, tag)))
    }

    /// Waits for the oldest copy and shows its bytes, which are aligned for any number, where they are.
    pub fn receive_with(&mut self, gpu: &Gpu, show: impl FnOnce(&[u8], &T)) -> Result<Option<T>> {
        let Some(copy) = self.under_way.pop_front() else {
            return Ok(None);
        };
        gpu.wait(Some(copy.submission))?;
        let mapped = copy.buffer.slice(..copy.bytes).get_mapped_range();
        let mapped = mapped.map_err(|error| {
            Error::device(
                format!("results cannot be read back: {error}"),
                "run again; finished frames are on disk",
            )
        })?;
        show(&mapped, &copy.tag);
        drop(mapped);
        copy.buffer.unmap();
        self.free.push(copy.buffer);
        Ok(Some(copy.tag))
    }
}

/// Reads the first `count` elements of a buffer and waits for them; for tests and one-off answers.
pub fn read<T: bytemuck::Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, count: usize) -> Result<Vec<T>> {
    let bytes = (count * size_of::<T>()) as u64;
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let mut ring = Ring::new(1);
    let encoder = gpu.device.create_command_encoder(&Default::default());
    ring.send(gpu, encoder, bytes, (), |encoder, staging| {
        encoder.copy_buffer_to_buffer(buffer, 0, staging, 0, bytes);
    })?;
    let mut values = Vec::new();
    ring.receive_with(gpu, |mapped, ()| values = bytemuck::pod_collect_to_vec(mapped))?;
    Ok(values)
}
