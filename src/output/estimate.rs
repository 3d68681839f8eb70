//! How much a run will write.

use super::Outputs;
use crate::scene::Scene;
use crate::scene::column::VECTORS;

/// Bytes that a pixel of a compressed picture takes, at most, in the scenes that ship.
const PICTURE_BYTES_PER_PIXEL: f64 = 1.0;
/// One line of `stats.jsonl`.
const STATISTICS_BYTES: f64 = 700.0;

/// Bytes on disk when a run has written every frame; a guess for pictures, an upper bound for particle files.
pub fn disk_bytes(scene: &Scene, outputs: &Outputs) -> u64 {
    let pixels: f64 = scene.render.size.map(f64::from).iter().product();
    let picture = if outputs.pictures {
        pixels * PICTURE_BYTES_PER_PIXEL
    } else {
        0.0
    };
    let statistics = if outputs.statistics { STATISTICS_BYTES } else { 0.0 };
    let row: usize = outputs
        .particles
        .iter()
        .map(|column| {
            if VECTORS.contains(column) {
                8 * scene.dimensions.count()
            } else {
                4
            }
        })
        .sum();
    let particles = f64::from(scene.capacity) * row as f64;
    let recordings = outputs
        .rerun
        .as_ref()
        .map_or(0, |rerun| rerun.disk_bytes(scene, outputs.pictures));
    (f64::from(scene.time.frames) * (picture + statistics + particles)) as u64 + recordings
}
