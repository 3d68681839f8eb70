//! A run: frames from the simulation to the sinks.

use std::path::PathBuf;
use std::sync::Arc;

use super::bodies::{self, BodyFile};
use super::configuration::Configuration;
use super::disk_budget::DiskBudget;
use super::drive::{Launch, Start};
use super::folder::Folder;
use super::keeper::{Checkpoints, Every};
use super::manifest::Files;
use super::particles::{ParticleFiles, ParticleOutput};
use super::passes::{self, PassImages};
use super::png::Pictures;
use super::progress::{self, Progress};
use super::retry::{self, OnInstability};
use super::sensors::{self, SensorFiles};
use super::statistics::StatisticsFile;
use super::video::{Video, VideoOutput};
use super::{Sink, rerun};
use crate::error::Result;
use crate::gpu::AdapterChoice;
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::{Scene, column};

/// Which sinks a run has.
#[derive(Debug, Clone)]
pub struct Outputs {
    pub pictures: bool,
    pub statistics: bool,
    pub particles: Option<ParticleOutput>,
    pub video: Option<VideoOutput>,
    /// Recordings for the Rerun viewer.
    pub rerun: Option<rerun::Settings>,
    pub checkpoints: Checkpoints,
}

impl Outputs {
    /// The same with radii in particle files, where the scene's grains are of several sizes: positions alone do not say where
    /// they touch.
    pub fn of(mut self, scene: &Scene) -> Self {
        if let Some(particles) = self.particles.as_mut().filter(|_| scene.has_field("radius")) {
            particles.add(*column::RADIUS);
        }
        self
    }

    /// What these sinks need from the device.
    pub fn wanted(&self, scene: &Scene) -> Wanted {
        let mut wanted = Wanted {
            statistics: self.statistics,
            columns: self
                .particles
                .as_ref()
                .map_or_else(Vec::new, |p| p.columns.clone()),
            columns_every: self.particles.as_ref().map_or(0, |p| p.every),
            sensors: !scene.sensors.list.is_empty(),
            view: (self.pictures || self.video.is_some()).then_some(scene.render.view),
            ..Wanted::default()
        };
        if let Some(rerun) = &self.rerun {
            wanted.columns_every = 0;
            rerun.want(scene, self.pictures, &mut wanted);
        }
        wanted
    }

    /// Whether there is a table of rigid bodies, which belongs to the figures of a run.
    fn writes_bodies(&self, scene: &Scene) -> bool {
        self.statistics && !scene.rigid_bodies.is_empty()
    }

    pub(super) fn files(&self, scene: &Scene) -> Vec<Files> {
        let [width, height] = scene.render.size;
        let mut files = vec![Files {
            name: "run.json".into(),
            about: "this file".into(),
        }];
        if self.pictures {
            let about = format!(
                "picture of a frame, {width}×{height}, {} frames per simulated second",
                scene.time.fps
            );
            files.push(Files {
                name: "frame_NNNNNN.png".into(),
                about,
            });
            files.extend(passes::files(scene));
        }
        if self.statistics {
            let about = "one JSON object per frame; units are in its keys".into();
            files.push(Files {
                name: "stats.jsonl".into(),
                about,
            });
        }
        if self.writes_bodies(scene) {
            files.push(Files {
                name: bodies::NAME.into(),
                about: "a row for each rigid body in each frame; units are in the first line".into(),
            });
        }
        for profile in sensors::tables(scene) {
            files.push(match profile {
                None => Files {
                    name: "sensors.csv".into(),
                    about: "a row for each sample of the sensors; units are in the first line".into(),
                },
                Some(number) => Files {
                    name: format!("sensor_{}.csv", scene.sensors.list[number].name),
                    about: "a row for each layer of each sample of a profile".into(),
                },
            });
        }
        if let Some(particles) = &self.particles {
            files.extend(particles.files());
        }
        if self.checkpoints.every != Every::Never {
            files.push(checkpoint_files());
        }
        files.extend(self.video.as_ref().map(VideoOutput::files));
        files.extend(self.rerun.iter().flat_map(rerun::Settings::files));
        files
    }

    pub(super) fn sinks(
        &self,
        scene: &Scene,
        plan: &Plan,
        folder: &Arc<Folder>,
        progress: &Progress,
    ) -> Result<Vec<Box<dyn Sink>>> {
        let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
        if self.pictures {
            let overlay = Overlay::new(scene, scene.render.view)?;
            sinks.push(Box::new(Pictures::new(folder.clone(), overlay)));
            if !scene.render.passes.is_empty() {
                sinks.push(Box::new(PassImages::new(folder.clone(), scene)));
            }
        }
        if self.statistics {
            sinks.push(Box::new(StatisticsFile::open(folder.statistics())?));
        }
        if self.writes_bodies(scene) {
            sinks.push(Box::new(BodyFile::open(folder.bodies(), scene.dimensions)?));
        }
        if !scene.sensors.list.is_empty() {
            sinks.push(Box::new(SensorFiles::open(folder.clone(), scene)?));
        }
        if let Some(particles) = &self.particles {
            let files = ParticleFiles::new(folder.clone(), particles.clone(), scene);
            sinks.push(Box::new(files));
        }
        if let Some(video) = &self.video {
            let pictures = self.pictures.then(|| folder.path());
            sinks.push(Box::new(Video::new(video.clone(), scene, pictures)?));
        }
        if let Some(rerun) = &self.rerun {
            sinks.extend(rerun.sinks(scene, plan, self.pictures, progress)?);
        }
        Ok(sinks)
    }
}

/// For the manifest.
pub(super) fn checkpoint_files() -> Files {
    Files {
        name: "checkpoint_NNNNNN.bin".into(),
        about: "state after a frame, for `sliceflow resume`".into(),
    }
}

/// Everything about a run that is not the scene.
#[derive(Debug, Clone)]
pub struct Settings {
    pub folder: PathBuf,
    /// Whether an earlier run in the folder may be replaced.
    pub force: bool,
    pub outputs: Outputs,
    /// Milliseconds of each pass, in the statistics and at the end.
    pub timings: bool,
    pub adapter: AdapterChoice,
    /// What happens where a guard stops the run.
    pub on_instability: OnInstability,
    /// Bytes that the run's files may take.
    pub max_disk: Option<u64>,
    pub progress: progress::Style,
    /// For the manifest.
    pub command_line: Vec<String>,
}

/// Simulates a scene and writes what `settings` ask for.
pub fn run(scene: &Scene, settings: &Settings) -> Result<()> {
    if let Some(rerun) = &settings.outputs.rerun {
        rerun.check(scene, settings.outputs.pictures, settings.force)?;
    }
    if let Some(video) = &settings.outputs.video {
        video.check(settings.force)?;
    }
    let too_much = DiskBudget::check(scene, settings)?;
    let folder = Arc::new(Folder::open(&settings.folder, settings.force)?);
    let progress = Progress::new(settings.progress, scene.time.frames);
    if let Some(warning) = too_much {
        progress.warn(&warning);
    }
    let configuration = Configuration::new(scene, &settings.command_line)?;
    retry::drive(Launch {
        scene,
        settings: settings.clone(),
        folder,
        progress,
        configuration,
        start: Start::Beginning,
        wall_s: 0.0,
        retries: Vec::new(),
    })
}
