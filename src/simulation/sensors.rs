//! Samples of the sensors, on their way from the device to a frame.

use super::Simulation;
use crate::error::Result;
use crate::physics::layout::Reading;
use crate::physics::sensors;
use crate::scene::Scene;

/// What all sensors found at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Seconds of simulated time.
    pub time: f64,
    /// Steps since the run began, where they are known.
    pub step: Option<u64>,
    /// By sensor, in the order of its outputs, for a profile layer by layer. NaN where there is nothing to measure.
    pub values: Vec<Vec<f64>>,
}

impl Simulation {
    /// Has all sensors read. What they find waits on the device for the next frame.
    pub(super) fn sample(&mut self, time: f64) -> Result<()> {
        if self.scene.sensors.list.is_empty() {
            return Ok(());
        }
        let row = self.sampled.len() as u32;
        self.buffers.write(&self.gpu, "sample_row", 0, &[row])?;
        self.submit(&[&self.passes.sample])?;
        self.sampled.push(time);
        Ok(())
    }
}

/// Bytes that so many samples have in a frame.
pub(super) fn bytes(scene: &Scene, samples: usize) -> u64 {
    match samples {
        0 => 0,
        samples => sensors::sample_bytes(scene, samples),
    }
}

/// The samples in a frame's bytes; `times` has the time of each, seconds.
pub(super) fn samples(scene: &Scene, times: &[f64], bytes: &[u8]) -> Vec<Sample> {
    let readings: Vec<Reading> = bytemuck::pod_collect_to_vec(bytes);
    let rows = readings.chunks_exact(readings.len() / times.len().max(1));
    times
        .iter()
        .zip(rows)
        .map(|(&time, row)| {
            let (step, values) = sensors::values(scene, row);
            Sample {
                time,
                step: Some(step),
                values,
            }
        })
        .collect()
}
