//! `post_mortem/report.json`.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;

use super::Autopsy;
use super::neighborhood::{Neighbor, Neighborhood, Seen};
use crate::output::text::quoted;

/// What a guard found when it stopped a run.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Report {
    /// `sliceflow`.
    program: &'static str,
    /// Version of the program.
    version: &'static str,
    /// The guard, in one word ([which there are](guards.md)).
    guard: &'static str,
    /// What it found.
    what: &'static str,
    /// Why that happens most often.
    likely_cause: String,
    /// What to change.
    help: &'static str,
    /// The frame that was about to be written.
    frame: u32,
    /// Steps since the run began.
    step: u64,
    /// Simulated time, seconds.
    time_s: f64,
    /// Length of the steps there, seconds.
    step_s: f64,
    /// What limited that length.
    step_limited_by: &'static str,
    /// The particle that the guard caught, as it was then; null where a guard looks at all particles together.
    caught: Option<CaughtParticle>,
    /// That particle, or the one that stands out most, after the last good frame; null where no state was reached.
    particle: Option<Seen>,
    /// Its nearest neighbors then, the nearest first.
    neighbors: Vec<Neighbor>,
    /// The last frame that was written; null where there is none.
    last_good_frame: Option<u32>,
    /// The checkpoint that the run is replayed from; null where it is replayed from its beginning.
    last_good_checkpoint: Option<String>,
    /// The picture, in the run's folder; null where none could be made.
    picture: Option<&'static str>,
    /// Comes to the same guard in the same step.
    pub replay: String,
    /// Starts a variant from the last good frame; put the key to change in place of KEY=VALUE.
    pub try_a_change: String,
}

/// A particle that the device's guard caught.
#[derive(Debug, Serialize, JsonSchema)]
struct CaughtParticle {
    /// Its id.
    id: u32,
    /// Before the step that went wrong, metres.
    position_m: [f64; 3],
    /// After it, m/s; null where it is no number.
    velocity_m_per_s: [Option<f32>; 3],
    /// Its voxel before the step, along the directions u, s and w of the grid; null outside of it.
    voxel: Option<[i32; 3]>,
    /// Particles that were caught until the frame ended.
    caught: u32,
}

impl Report {
    pub fn new(autopsy: &Autopsy, around: Option<&Neighborhood>, picture: Option<&'static str>) -> Self {
        let Autopsy {
            scene,
            plan,
            violation,
            folder,
            ..
        } = autopsy;
        let run = quoted(folder.path());
        let last = autopsy.last_good.map(|checkpoint| checkpoint.state.frame);
        let path = last
            .map(|frame| folder.checkpoint(frame))
            .filter(|path| path.exists());
        let checkpoint = path.and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
        let caught = violation.particle.as_ref().map(|caught| CaughtParticle {
            id: caught.id,
            position_m: caught.position,
            velocity_m_per_s: caught.velocity.map(|v| v.is_finite().then_some(v)),
            voxel: {
                let local = (glam::DVec3::from(caught.position) - scene.origin).as_vec3();
                plan.grid.voxel(local)
            },
            caught: caught.count,
        });
        Self {
            program: env!("CARGO_PKG_NAME"),
            version: env!("CARGO_PKG_VERSION"),
            guard: violation.guard.row().word,
            what: violation.what(),
            likely_cause: violation.likely_cause(),
            help: violation.help(),
            frame: violation.frame,
            step: violation.step,
            time_s: violation.time,
            step_s: violation.step_s,
            step_limited_by: violation.step_limited_by,
            caught,
            particle: around.map(|around| Seen {
                voxel: plan.grid.voxel(around.local()),
                ..around.particle.clone()
            }),
            neighbors: around.map_or_else(Vec::new, |around| around.neighbors.clone()),
            last_good_frame: last,
            last_good_checkpoint: checkpoint,
            picture,
            replay: format!("sliceflow resume {run}"),
            try_a_change: format!(
                "sliceflow resume {run} --branch-at {} --set KEY=VALUE",
                last.unwrap_or(0)
            ),
        }
    }
}

/// The JSON schema of `post_mortem/report.json`.
pub fn schema() -> Value {
    let written = SchemaSettings::draft2020_12().for_serialize();
    written
        .into_generator()
        .into_root_schema_for::<Report>()
        .to_value()
}
