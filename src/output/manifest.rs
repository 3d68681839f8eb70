//! `run.json`: what was run, on what, with which result, and what every file beside it is.

use std::path::PathBuf;

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::memory::peak_resident_bytes;
use super::recipe::{Recipe, hex};
use super::tally::Tally;
use super::{clock, disk};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::device::Identity;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::scene::model::SceneFile;

#[derive(Serialize)]
pub struct Manifest<'a> {
    pub program: &'static str,
    pub version: &'static str,
    #[serde(flatten)]
    pub status: Status,
    pub command_line: &'a [String],
    /// UTC, RFC 3339.
    pub started: String,
    /// UTC, RFC 3339; null while the run goes on.
    pub finished: Option<String>,
    #[serde(flatten)]
    pub tally: Tally,
    /// Of the program in this sitting; null where the system does not say.
    pub peak_resident_bytes: Option<u64>,
    pub files: Vec<Files>,
    pub adapter: Identity,
    pub particles: u32,
    pub seed: u64,
    pub fps: f64,
    pub step_s: f64,
    pub steps_per_frame: u32,
    pub step_limited_by: &'static str,
    /// Whether steps have lengths of their own; `step_s` and `steps_per_frame` are then what was expected.
    pub step_adaptive: bool,
    /// What was decided or dropped while the scene was read.
    pub notes: &'a [String],
    /// Of `scene`, as JSON without spaces.
    pub scene_sha256: String,
    pub scene: &'a SceneFile,
    /// For `sliceflow resume`; absent where nothing was simulated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recipe: Option<Recipe>,
    /// The run whose particles were drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn_from: Option<PathBuf>,
    pub plan: &'a Plan,
    #[serde(skip)]
    path: PathBuf,
}

#[derive(Debug, Clone, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
pub enum Status {
    Running,
    Finished,
    Interrupted,
    Failed { message: String },
}

/// One kind of file.
#[derive(Debug, Serialize)]
pub struct Files {
    pub name: String,
    pub about: String,
}

impl<'a> Manifest<'a> {
    pub fn new(
        path: PathBuf,
        scene: &'a Scene,
        plan: &'a Plan,
        gpu: &Gpu,
        command_line: &'a [String],
        files: Vec<Files>,
    ) -> Self {
        let text = serde_json::to_vec(&scene.file).expect("a validated scene has text keys");
        Self {
            program: env!("CARGO_PKG_NAME"),
            version: env!("CARGO_PKG_VERSION"),
            status: Status::Running,
            command_line,
            started: clock::now(),
            finished: None,
            tally: Tally::start(scene.time.frames),
            peak_resident_bytes: None,
            files,
            adapter: Identity::of(&gpu.adapter),
            particles: scene.capacity,
            seed: scene.file.seed,
            fps: scene.time.fps,
            step_s: scene.time.step,
            steps_per_frame: scene.time.steps_per_frame,
            step_limited_by: scene.time.limited_by,
            step_adaptive: scene.time.adaptive.is_some(),
            notes: &scene.notes,
            scene_sha256: hex(&Sha256::digest(text)),
            scene: &scene.file,
            recipe: None,
            drawn_from: None,
            plan,
            path,
        }
    }

    fn write(&mut self) -> Result<()> {
        self.peak_resident_bytes = peak_resident_bytes();
        let mut text = serde_json::to_vec_pretty(self).expect("keys are text");
        text.push(b'\n');
        disk::write_durably(&self.path, &text)
    }

    /// Writes how far the run has come.
    pub fn update(&mut self, tally: Tally) -> Result<()> {
        self.tally = tally;
        self.write()
    }

    /// Writes how the run ended.
    pub fn close(&mut self, tally: Tally, outcome: &Result<()>) -> Result<()> {
        self.tally = tally;
        self.finished = Some(clock::now());
        self.status = match outcome {
            Ok(()) => Status::Finished,
            Err(Error::Interrupted { .. }) => Status::Interrupted,
            Err(error) => Status::Failed {
                message: error.to_string(),
            },
        };
        self.write()
    }
}
