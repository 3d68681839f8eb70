//! A run: frames from the simulation to the sinks.

use std::path::PathBuf;
use std::sync::Arc;

use super::folder::Folder;
use super::health::Health;
use super::manifest::{Files, Manifest};
use super::particles::ParticleFiles;
use super::png::Pictures;
use super::progress::{self, Progress};
use super::statistics::StatisticsFile;
use super::tally::Tally;
use super::text::{bytes, seconds, short};
use super::{Sink, disk_bytes, interrupt, rerun};
use crate::error::{Error, Result};
use crate::gpu::device::describe;
use crate::gpu::{AdapterChoice, Gpu};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::Scene;
use crate::scene::column::Column;
use crate::simulation::Simulation;
use crate::simulation::frame::Frame;

/// Which sinks a run has.
#[derive(Debug, Clone)]
pub struct Outputs {
    pub pictures: bool,
    pub statistics: bool,
    /// Columns of particle files; empty for no files.
    pub particles: Vec<Column>,
    /// Recordings for the Rerun viewer.
    pub rerun: Option<rerun::Settings>,
}

impl Outputs {
    /// What these sinks need from the device.
    pub fn wanted(&self, scene: &Scene) -> Wanted {
        let mut wanted = Wanted {
            statistics: self.statistics,
            columns: self.particles.clone(),
            view: self.pictures.then_some(scene.render.view),
            ..Wanted::default()
        };
        if let Some(rerun) = &self.rerun {
            rerun.want(scene, self.pictures, &mut wanted);
        }
        wanted
    }

    fn files(&self, scene: &Scene) -> Vec<Files> {
        let [width, height] = scene.render.size;
        let names: Vec<_> = self.particles.iter().map(|column| column.name).collect();
        let mut files = vec![Files {
            name: "run.json",
            about: "this file".into(),
        }];
        if self.pictures {
            let about = format!(
                "picture of a frame, {width}×{height}, {} frames a simulated second",
                scene.time.fps
            );
            files.push(Files {
                name: "frame_NNNNNN.png",
                about,
            });
        }
        if self.statistics {
            let about = "one JSON object a frame; units are in its keys".into();
            files.push(Files {
                name: "stats.jsonl",
                about,
            });
        }
        if !self.particles.is_empty() {
            let about = format!(
                "NumPy arrays of a frame, rows in order of id: {}",
                names.join(", ")
            );
            files.push(Files {
                name: "particles_NNNNNN/COLUMN.npy",
                about,
            });
        }
        files
    }

    fn sinks(
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
        }
        if self.statistics {
            sinks.push(Box::new(StatisticsFile::create(folder.statistics())?));
        }
        if !self.particles.is_empty() {
            sinks.push(Box::new(ParticleFiles::new(folder.clone(), &self.particles)));
        }
        if let Some(rerun) = &self.rerun {
            sinks.extend(rerun.sinks(scene, plan, self.pictures, progress)?);
        }
        Ok(sinks)
    }
}

/// Everything about a run that is not the scene.
#[derive(Debug, Clone)]
pub struct Settings {
    pub folder: PathBuf,
    /// Whether an earlier run in the folder may be replaced.
    pub force: bool,
    pub outputs: Outputs,
    /// Milliseconds a pass, in the statistics and at the end.
    pub timings: bool,
    pub adapter: AdapterChoice,
    pub progress: progress::Style,
    /// For the manifest.
    pub command_line: Vec<String>,
}

/// Simulates a scene and writes what `settings` ask for.
pub fn run(scene: &Scene, settings: &Settings) -> Result<()> {
    if let Some(rerun) = &settings.outputs.rerun {
        rerun.check(scene, settings.outputs.pictures, settings.force)?;
    }
    let folder = Arc::new(Folder::open(&settings.folder, settings.force)?);
    let progress = Progress::new(settings.progress, scene.time.frames);
    let gpu = Gpu::open(&settings.adapter, false)?;
    if gpu.is_software() {
        progress.warn(&format!(
            "software adapter {} computes on the processor, which is slow",
            describe(&gpu.adapter)
        ));
    }
    if settings.timings && !gpu.has_timestamps {
        progress.warn("this adapter cannot time passes, so --timings has no effect");
    }
    let plan = Plan::new(scene, &gpu.limits, &settings.outputs.wanted(scene))?;
    for note in scene.notes.iter().chain(&plan.notes) {
        progress.note(note);
    }
    progress.note(&format!(
        "{} frames, about {} in {}",
        scene.time.frames,
        bytes(disk_bytes(scene, &settings.outputs)),
        folder.path().display()
    ));
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    simulation.set_timings(settings.timings);

    if let Some(told) = folder.clear()? {
        progress.note(&told);
    }
    let sinks = settings.outputs.sinks(scene, &plan, &folder, &progress)?;
    let files = settings.outputs.files(scene);
    let mut manifest = Manifest::new(
        folder.manifest(),
        scene,
        &plan,
        simulation.gpu(),
        &settings.command_line,
        files,
    );
    manifest.write()?;

    interrupt::listen();
    let mut run = Run {
        sinks,
        progress,
        health: Health::default(),
        tally: Tally::start(scene.time.frames),
        pass_ms: Vec::new(),
    };
    let simulated = run.simulate(&mut simulation);
    // Sinks are finished in any case: frames before a failure stay.
    let outcome = run.finish_sinks(simulated);
    run.tell_end(&folder, &outcome);
    let closed = manifest.close(run.tally, &outcome);
    if outcome.is_ok() {
        run.serve();
    }
    outcome.and(closed)
}

struct Run {
    sinks: Vec<Box<dyn Sink>>,
    progress: Progress,
    health: Health,
    tally: Tally,
    /// Sums over the run, by pass.
    pass_ms: Vec<(String, f64)>,
}

impl Run {
    fn simulate(&mut self, simulation: &mut Simulation) -> Result<()> {
        for _ in 0..self.tally.frames {
            if interrupt::asked() {
                break;
            }
            if let Some(frame) = simulation.next_frame()? {
                self.take(frame)?;
            }
        }
        while let Some(frame) = simulation.finish_frame()? {
            self.take(frame)?;
        }
        match self.tally.frames_done {
            done if done < self.tally.frames => Err(Error::Interrupted { frames_done: done }),
            _ => Ok(()),
        }
    }

    fn take(&mut self, frame: Frame) -> Result<()> {
        let frame = Arc::new(frame);
        for sink in &mut self.sinks {
            sink.frame(&frame)?;
        }
        self.pass_warnings();
        self.tally.add(&frame);
        for (label, ms) in &frame.pass_ms {
            match self.pass_ms.iter_mut().find(|(known, _)| known == label) {
                Some((_, sum)) => *sum += ms,
                None => self.pass_ms.push((label.clone(), *ms)),
            }
        }
        for warning in self.health.check(&frame) {
            self.progress.warn(&warning);
        }
        self.progress.frame(&frame, &self.tally);
        Ok(())
    }

    /// The first thing that went wrong, while simulating or while writing.
    fn finish_sinks(&mut self, simulated: Result<()>) -> Result<()> {
        let finished: Vec<_> = self.sinks.iter_mut().map(|sink| sink.finish()).collect();
        self.pass_warnings();
        finished.into_iter().fold(simulated, Result::and)
    }

    fn pass_warnings(&mut self) {
        for warning in self.sinks.iter_mut().flat_map(|sink| sink.warnings()) {
            self.progress.warn(&warning);
        }
    }

    /// Keeps servers open until Ctrl-C.
    fn serve(&self) {
        let places: Vec<_> = self.sinks.iter().filter_map(|sink| sink.serving()).collect();
        if !places.is_empty() {
            self.progress
                .note(&format!("still there until Ctrl-C: {}", places.join(", ")));
            interrupt::wait();
        }
    }

    fn tell_end(&mut self, folder: &Folder, outcome: &Result<()>) {
        self.tally.stop_clock();
        if let Some(summary) = self.health.summary() {
            self.progress.warn(&summary);
        }
        if let Some(note) = self.health.note() {
            self.progress.note(&note);
        }
        if !self.pass_ms.is_empty() {
            let frames = f64::from(self.tally.frames_done.max(1));
            let times: Vec<_> = self
                .pass_ms
                .iter()
                .map(|(label, ms)| format!("{label} {:.3}", ms / frames))
                .collect();
            self.progress
                .note(&format!("milliseconds a frame: {}", times.join(", ")));
        }
        let frames = self.tally.frames_done;
        let end = if outcome.is_ok() {
            format!("done: {frames} frames")
        } else {
            format!("stopped after {frames} frames")
        };
        self.progress.finish(
            &format!(
                "{end} in {} ({}, {} particle steps/s)",
                folder.path().display(),
                seconds(self.tally.wall_s),
                short(self.tally.particle_steps_per_s)
            ),
            &self.tally,
        );
    }
}
