//! `run.json`: what was run, on what, with which result, and what every file beside it is.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::configuration::{Configuration, hex};
use super::memory::peak_resident_bytes;
use super::retry::Retry;
use super::tally::Tally;
use super::{clock, disk};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::device::Identity;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::scene::model::SceneFile;

/// A run: what was run, on what, with which result, and what every file is.
#[derive(Serialize, JsonSchema)]
pub struct Manifest<'a> {
    /// `sliceflow`.
    pub program: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// How the run went.
    pub status: Status,
    /// The error, where it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// The program's arguments, as they were given.
    pub command_line: &'a [String],
    /// When the run began, in UTC (RFC 3339).
    pub started: String,
    /// When the run ended, in UTC (RFC 3339); null while it goes on.
    pub finished: Option<String>,
    #[serde(flatten)]
    pub tally: Tally,
    /// The most memory that the program took, bytes, since the run was started or resumed; null where the system does not
    /// say.
    pub peak_resident_bytes: Option<u64>,
    /// When a guard stopped the run, and it went back with half the step (`--on-instability retry`).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub retries: Vec<Retry>,
    /// Every kind of file that the run writes.
    pub files: Vec<Files>,
    /// Number of the first frame in the folder.
    pub first_frame: u32,
    /// Number of the last frame that is to be in the folder.
    pub last_frame: u32,
    /// The adapter that computed.
    pub adapter: Identity,
    /// Particles when every emitter and event has happened, boundary particles apart.
    pub particles: u32,
    /// Particles of walls, which carry pressure and velocity of the fluid on.
    pub boundary_particles: u32,
    /// Seed of every random choice.
    pub seed: u64,
    /// Frames per simulated second.
    pub fps: f64,
    /// Length of a step, seconds.
    pub step_s: f64,
    /// Steps from one frame to the next.
    pub steps_per_frame: u32,
    /// What limits the length of a step.
    pub step_limited_by: &'static str,
    /// Whether the device chooses the length of each step; `step_s` and `steps_per_frame` are then what was expected.
    pub step_adaptive: bool,
    /// What was decided or left out while the scene was read.
    pub notes: &'a [String],
    /// SHA-256 of `scene`, as JSON without spaces.
    pub scene_sha256: String,
    /// The scene, with every value that was left out filled in.
    pub scene: &'a SceneFile,
    /// What `sliceflow resume` needs to make the run again; absent where nothing was simulated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub configuration: Option<Configuration>,
    /// Folder of the run whose particles `sliceflow render` drew; absent elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn_from: Option<PathBuf>,
    /// Every buffer and pass on the device.
    pub plan: &'a Plan,
    #[serde(skip)]
    path: PathBuf,
}

/// How the run went.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It goes on, or the program was killed.
    Running,
    /// Every frame is there.
    Finished,
    /// It was stopped by Ctrl-C or by `--max-disk`; what was finished is on disk.
    Interrupted,
    /// It ended with an error.
    Failed,
}

/// One kind of file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Files {
    /// Its name; NNNNNN stands for the number of a frame.
    pub name: String,
    /// What it holds.
    pub about: String,
}

/// The JSON schema of `run.json`.
pub fn schema() -> Value {
    let written = SchemaSettings::draft2020_12().for_serialize();
    written
        .into_generator()
        .into_root_schema_for::<Manifest>()
        .to_value()
}

impl<'a> Manifest<'a> {
    pub fn new(
        path: PathBuf,
        scene: &'a Scene,
        plan: &'a Plan,
        gpu: &Gpu,
        command_line: &'a [String],
        files: Vec<Files>,
        frames: RangeInclusive<u32>,
    ) -> Self {
        let text = serde_json::to_vec(&scene.file).expect("a validated scene has text keys");
        Self {
            program: env!("CARGO_PKG_NAME"),
            version: env!("CARGO_PKG_VERSION"),
            status: Status::Running,
            message: None,
            command_line,
            started: clock::now(),
            finished: None,
            tally: Tally::start(scene.time.frames),
            peak_resident_bytes: None,
            retries: Vec::new(),
            files,
            first_frame: *frames.start(),
            last_frame: *frames.end(),
            adapter: Identity::of(&gpu.adapter),
            particles: scene.first_boundary(),
            boundary_particles: scene.boundary.len() as u32,
            seed: scene.file.seed,
            fps: scene.time.fps,
            step_s: scene.time.step,
            steps_per_frame: scene.time.steps_per_frame,
            step_limited_by: scene.time.limited_by,
            step_adaptive: scene.time.adaptive.is_some(),
            notes: &scene.notes,
            scene_sha256: hex(&Sha256::digest(text)),
            scene: &scene.file,
            configuration: None,
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

    /// Names kinds of files that the run was not expected to write.
    pub fn add_files(&mut self, files: impl IntoIterator<Item = Files>) {
        for file in files {
            if self.files.iter().all(|known| known.name != file.name) {
                self.files.push(file);
            }
        }
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
            Err(error @ Error::Budget { .. }) => {
                self.message = Some(error.to_string());
                Status::Interrupted
            }
            Err(error) => {
                self.message = Some(error.to_string());
                Status::Failed
            }
        };
        self.write()
    }
}
