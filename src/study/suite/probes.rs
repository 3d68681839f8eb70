//! What the adapter can do at best, measured by two small shaders: copying, and multiplying and adding.

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::gpu::buffers::Usage;
use crate::gpu::timing::{Timer, median};
use crate::gpu::{Buffers, Gpu, Groups, Kernel, Pass, Variant};

/// What the probes reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probes {
    /// Bytes read and bytes written a second, together.
    pub copy_bytes_per_s: f64,
    /// Of the buffer that was copied.
    pub copied_bytes: u64,
    /// Floating-point operations a second in 32 bits; a fused multiplication and addition counts two.
    pub operations_per_s: f64,
}

/// How large the probes are.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Most bytes to copy; more than caches hold.
    pub copied_bytes: u64,
    /// Milliseconds that the arithmetic takes at least.
    pub least_ms: f64,
}

const ROUNDS: usize = 5;
/// Threads of the arithmetic.
const THREADS: u32 = 1 << 18;
const MOST_TURNS: u32 = 1 << 20;
/// Of a turn of a thread in `shaders/probes/arithmetic.wgsl`: eight vectors of four, multiplied and added.
const OPERATIONS: f64 = 64.0;
const VECTOR_BYTES: u64 = 16;

/// Probes an adapter; `None` where it has no clock for passes.
///
/// # Errors
///
/// Where the device fails.
pub fn probe(gpu: &Gpu, scale: Scale) -> Result<Option<Probes>> {
    let Some(timer) = Timer::new(gpu, 1) else {
        return Ok(None);
    };
    let copied_bytes = scale.copied_bytes.min(gpu.limits.largest()) / VECTOR_BYTES * VECTOR_BYTES;
    Ok(Some(Probes {
        copy_bytes_per_s: copy(gpu, &timer, copied_bytes)?,
        copied_bytes,
        operations_per_s: multiply_and_add(gpu, &timer, scale.least_ms)?,
    }))
}

fn copy(gpu: &Gpu, timer: &Timer, bytes: u64) -> Result<f64> {
    let mut buffers = Buffers::default();
    buffers.create(gpu, "copied_from", bytes, Usage::Storage)?;
    buffers.create(gpu, "copied_to", bytes, Usage::Storage)?;
    let pass = Kernel::load(gpu, "probes/copy", &Variant::default(), "copy")?.pass(gpu, &buffers)?;
    let items = Groups::For((bytes / VECTOR_BYTES) as u32);
    let time = || milliseconds(gpu, timer, &pass, items);
    // The first run touches the memory and compiles.
    time()?;
    let times: Vec<f64> = (0..ROUNDS).map(|_| time()).collect::<Result<_>>()?;
    Ok(2.0 * bytes as f64 / (median(times) * 1e-3))
}

fn multiply_and_add(gpu: &Gpu, timer: &Timer, least_ms: f64) -> Result<f64> {
    let mut buffers = Buffers::default();
    buffers.create(gpu, "computed", u64::from(THREADS) * VECTOR_BYTES, Usage::Storage)?;
    buffers.create(gpu, "turns", 4, Usage::Uniform)?;
    let kernel = Kernel::load(gpu, "probes/arithmetic", &Variant::default(), "multiply_and_add")?;
    let pass = kernel.pass(gpu, &buffers)?;
    let time = |turns: u32| {
        buffers.write(gpu, "turns", 0, &[turns])?;
        milliseconds(gpu, timer, &pass, Groups::For(THREADS))
    };
    time(1)?;
    let mut turns = 16;
    while time(turns)? < least_ms && turns < MOST_TURNS {
        turns *= 2;
    }
    let times: Vec<f64> = (0..ROUNDS).map(|_| time(turns)).collect::<Result<_>>()?;
    let operations = f64::from(THREADS) * f64::from(turns) * OPERATIONS;
    Ok(operations / (median(times) * 1e-3))
}

fn milliseconds(gpu: &Gpu, timer: &Timer, pass: &Pass, groups: Groups<'_>) -> Result<f64> {
    Ok(timer.run(gpu, &[(pass, groups)])?.iter().map(|(_, ms)| ms).sum())
}
