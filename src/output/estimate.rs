//! How much a run will write.

use super::Outputs;
use super::keeper::{Checkpoints, Every};
use super::passes;
use crate::scene::Scene;
use crate::simulation::state::state_bytes;

/// Bytes that a pixel of a compressed picture takes, at most, in the scenes that ship.
const PICTURE_BYTES_PER_PIXEL: f64 = 1.0;
/// One line of `stats.jsonl`.
const STATISTICS_BYTES: f64 = 700.0;

/// Header and checksum of a checkpoint.
const CHECKPOINT_BYTES: u64 = 1000;

/// How many checkpoints a run leaves at most, and the bytes of one at the run's end.
pub fn checkpoints(scene: &Scene, outputs: &Outputs) -> (u32, u64) {
    let Checkpoints { every, keep } = outputs.checkpoints;
    let made = match every {
        Every::Never => 0,
        Every::Frames(n) => (scene.time.frames - 1).div_ceil(n).max(1),
        Every::Seconds(_) => scene.time.frames,
    };
    (
        made.min(keep),
        state_bytes(scene, scene.capacity) + CHECKPOINT_BYTES,
    )
}

/// Bytes on disk when a run has written every frame; a guess for pictures, an upper bound for particle files.
pub fn disk_bytes(scene: &Scene, outputs: &Outputs) -> u64 {
    let pixels: f64 = scene.render.size.map(f64::from).iter().product();
    let picture = if outputs.pictures {
        pixels * PICTURE_BYTES_PER_PIXEL + passes::frame_bytes(scene)
    } else {
        0.0
    };
    let statistics = if outputs.statistics { STATISTICS_BYTES } else { 0.0 };
    let particles = outputs.particles.as_ref().map_or(0.0, |particles| {
        f64::from(particles.frames(scene.time.frames)) * particles.frame_bytes(scene.capacity)
    });
    let video = outputs.video.as_ref().map_or(0.0, |video| video.bytes(scene));
    let recordings = outputs
        .rerun
        .as_ref()
        .map_or(0, |rerun| rerun.disk_bytes(scene, outputs.pictures));
    let (count, checkpoint) = checkpoints(scene, outputs);
    // While the newest is written, the oldest is still there.
    let checkpoints = u64::from(count) * checkpoint + if count > 0 { checkpoint } else { 0 };
    (f64::from(scene.time.frames) * (picture + statistics) + particles + video) as u64
        + recordings
        + checkpoints
}
