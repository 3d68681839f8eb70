//! Buffers by name: the same name in WGSL, on the host, as wgpu label and in the plan.

use std::collections::BTreeMap;

use crate::error::{Error, Result};
use crate::gpu::binding::Given;
use crate::gpu::parts::Contents;
use crate::gpu::{BufferPlan, Gpu};

/// How a buffer is used besides being bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Usage {
    Uniform,
    #[default]
    Storage,
    /// Storage that holds arguments of dispatches.
    Indirect,
}

/// The buffers of a simulation.
#[derive(Default)]
pub struct Buffers {
    by_name: BTreeMap<String, wgpu::Buffer>,
}

impl Buffers {
    /// Creates a zeroed buffer of `bytes` bytes.
    ///
    /// # Errors
    ///
    /// Where the adapter has no room for it.
    pub fn create(&mut self, gpu: &Gpu, name: &str, bytes: u64, usage: Usage) -> Result<()> {
        let binding = match usage {
            Usage::Uniform => wgpu::BufferUsages::UNIFORM,
            Usage::Storage => wgpu::BufferUsages::STORAGE,
            Usage::Indirect => wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT,
        };
        let descriptor = wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes,
            usage: binding | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let what = || format!("buffer `{name}` of {bytes} bytes");
        let buffer = gpu.make(what, |device| device.create_buffer(&descriptor))?;
        self.by_name.insert(name.to_owned(), buffer);
        Ok(())
    }

    /// Sees to it that a buffer has room for so many bytes. One that is large enough stays, with what it holds; one that has
    /// become too small is made anew, with a quarter more where the adapter has that.
    ///
    /// # Errors
    ///
    /// Where the adapter has no room for it.
    pub fn reserve(&mut self, gpu: &Gpu, name: &str, bytes: u64, usage: Usage) -> Result<()> {
        match self.by_name.get(name) {
            Some(buffer) if buffer.size() >= bytes => Ok(()),
            Some(_) => {
                let more = (bytes + bytes / 4).next_multiple_of(16).min(gpu.limits.largest());
                self.create(gpu, name, more.max(bytes), usage)
                    .or_else(|_| self.create(gpu, name, bytes, usage))
            }
            None => self.create(gpu, name, bytes, usage),
        }
    }

    /// Gives a buffer's memory back, once nothing binds it any more.
    pub fn remove(&mut self, name: &str) {
        self.by_name.remove(name);
    }

    /// Creates a buffer as planned, with what it begins with.
    pub fn make(&mut self, gpu: &Gpu, plan: &BufferPlan) -> Result<()> {
        self.create(gpu, &plan.name, plan.bytes, plan.usage)?;
        self.fill(gpu, plan)
    }

    /// Writes into a buffer what its plan says that it begins with.
    pub fn fill(&self, gpu: &Gpu, plan: &BufferPlan) -> Result<()> {
        match &plan.contents {
            Contents::Zeros => Ok(()),
            Contents::Pattern(pattern) => {
                let times = plan.bytes as usize / size_of_val(*pattern);
                self.write(gpu, &plan.name, 0, &pattern.repeat(times))
            }
            Contents::Bytes(bytes) => self.write(gpu, &plan.name, 0, bytes),
        }
    }

    /// The buffer that `user` asks for.
    pub fn get(&self, name: &str, user: &str) -> Result<&wgpu::Buffer> {
        self.by_name.get(name).ok_or_else(|| Error::Shader {
            message: format!("shaders/{user} binds `{name}`, but the plan has no such buffer"),
        })
    }

    /// All of them, to be given to passes that find other buffers elsewhere.
    pub fn bindings(&self) -> Vec<Given<'_>> {
        let all = self.by_name.iter();
        all.map(|(name, buffer)| (name.as_str(), buffer.as_entire_binding()))
            .collect()
    }

    pub fn contains(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// Writes `values` at element `first` of a buffer of such elements.
    pub fn write<T: bytemuck::NoUninit>(
        &self,
        gpu: &Gpu,
        name: &str,
        first: usize,
        values: &[T],
    ) -> Result<()> {
        if !values.is_empty() {
            let offset = (first * size_of::<T>()) as u64;
            let bytes: &[u8] = bytemuck::cast_slice(values);
            let buffer = self.get(name, "(host)")?;
            if offset + bytes.len() as u64 > buffer.size() {
                return Err(Error::Shader {
                    message: format!(
                        "{} bytes at byte {offset} do not fit into the {} of the buffer `{name}`",
                        bytes.len(),
                        buffer.size()
                    ),
                });
            }
            gpu.queue.write_buffer(buffer, offset, bytes);
        }
        Ok(())
    }
}
