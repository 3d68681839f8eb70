//! Drives a simulation: frames to the sinks, checkpoints between them.

use std::sync::Arc;
use std::time::Instant;

use super::checkpoint::{About, Checkpoint};
use super::configuration::Configuration;
use super::disk_budget::DiskBudget;
use super::folder::Folder;
use super::forecast::particles;
use super::guards::Guards;
use super::health::Health;
use super::keeper::{Every, Keeper};
use super::manifest::Manifest;
use super::post_mortem::{self, Autopsy};
use super::progress::Progress;
use super::record::Record;
use super::resume::{newest, reach};
use super::retry::{Retry, halved, halvings, is_of_use, shorten};
use super::run::{Settings, checkpoint_files};
use super::stopping::Stopping;
use super::tally::Tally;
use super::text::{bytes, quoted, seconds, short};
use super::{Sink, disk_bytes, interrupt};
use crate::error::{Error, Result, Violation};
use crate::gpu::device::describe;
use crate::gpu::{Gpu, driver};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::simulation::frame::Frame;
use crate::simulation::{Simulation, State};

const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Behind a frame that took so many seconds the state is kept in memory, so that Ctrl-C need not wait for the next one.
const LONG_FRAME_S: f64 = 1.0;

/// A run about to begin.
pub(super) struct Launch<'a> {
    pub scene: &'a Scene,
    pub settings: Settings,
    pub folder: Arc<Folder>,
    pub progress: Progress,
    pub configuration: Configuration,
    pub start: Start,
    /// Seconds that earlier sittings took.
    pub wall_s: f64,
    /// When the run went back with half the step.
    pub retries: Vec<Retry>,
}

/// Where a run begins.
pub(super) enum Start {
    /// In a folder that is cleared first.
    Beginning,
    /// The same run once more, since it has no checkpoint.
    Again,
    /// Behind a checkpoint of the same run.
    Behind(Box<Checkpoint>),
    /// With the frame of a state that another run came to.
    With(Box<State>),
}

impl Start {
    pub fn state(&self) -> Option<&State> {
        match self {
            Self::Beginning | Self::Again => None,
            Self::Behind(checkpoint) => Some(&checkpoint.state),
            Self::With(state) => Some(state),
        }
    }
}

pub(super) fn drive(launch: Launch) -> Result<()> {
    let Launch {
        scene,
        mut settings,
        folder,
        mut progress,
        configuration,
        mut start,
        wall_s,
        retries,
    } = launch;
    settings.outputs = settings.outputs.of(scene);
    let settings = &settings;
    let halvings = halvings(&retries, start.state().map(|state| state.frame));
    let shorter = (halvings > 0).then(|| halved(scene, halvings));
    let scene = shorter.as_ref().unwrap_or(scene);
    if let Start::Behind(checkpoint) = &mut start {
        shorten(checkpoint, halvings);
    }
    let first = configuration.first_frame;
    let frames = first..=scene.time.frames - 1;
    let mut files = settings.outputs.files(scene);
    if configuration.variant_of.is_some() && settings.outputs.checkpoints.every == Every::Never {
        // Its first one is written whatever was asked for.
        files.push(checkpoint_files());
    }
    if matches!(start, Start::Beginning | Start::With(_)) {
        folder.check_names(&Record::new(&files, frames.clone()))?;
    }
    let gpu = open(settings, &progress)?;
    let about = About {
        run_id: configuration.run_id.clone(),
        version: VERSION.into(),
        adapter: describe(&gpu.adapter),
        particle_steps: 0,
        health: Health::default(),
        guards: Guards::default(),
        halvings,
    };
    let plan = Plan::new(scene, &gpu.limits, &settings.outputs.wanted(scene))?;
    for note in scene.notes.iter().chain(&plan.notes) {
        progress.note(note);
    }
    if let Some(warning) = settings.outputs.particles.as_ref().and_then(|p| p.warning(scene)) {
        progress.warn(&warning);
    }
    if let Some(note) = settings.outputs.video.as_ref().and_then(|v| v.note(scene)) {
        progress.note(&note);
    }
    progress.note(&format!(
        "{} frames go to {}, about {}",
        scene.time.frames - first,
        folder.path().display(),
        bytes(disk_bytes(scene, &settings.outputs)),
    ));
    progress.expect(particles(scene).into_iter().skip(first as usize).collect());
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    simulation.set_timings(settings.timings);
    if let Some(state) = start.state() {
        simulation.restore(state)?;
    }

    for told in match &start {
        Start::Beginning | Start::With(_) => folder.clear()?,
        Start::Again => folder.rewind(None)?,
        Start::Behind(checkpoint) => folder.rewind(Some(checkpoint.state.frame))?,
    } {
        progress.note(&told);
    }
    let mut tally = Tally::start(scene.time.frames - first);
    let mut health = Health::default();
    let mut guards = Guards::default();
    if let Some(state) = start.state() {
        tally = tally.resume(0, state.steps(), 0, wall_s);
    }
    if let Start::Behind(checkpoint) = &start {
        let Checkpoint { about: was, state } = &**checkpoint;
        tally = tally.resume(state.frame + 1 - first, state.steps(), was.particle_steps, wall_s);
        health = was.health.clone();
        guards = was.guards.clone();
        warn_of_other_machine(was, &about, &progress);
    }
    let pinned = configuration.variant_of.is_some().then_some(first);
    let behind = match &start {
        Start::Behind(checkpoint) => Some(checkpoint.state.frame),
        _ => None,
    };
    let mut manifest = Manifest::new(
        folder.manifest(),
        scene,
        &plan,
        simulation.gpu(),
        &settings.command_line,
        files,
        frames,
    );
    manifest.configuration = Some(configuration);
    manifest.retries = retries;
    let stopping = Stopping::default();
    stopping.listen(&progress);
    // Before any other file: from here on a run that dies can be resumed.
    manifest.update(tally)?;
    let sinks = match open_sinks(settings, scene, &plan, &folder, &progress, behind) {
        Ok(sinks) => sinks,
        // Nothing was made yet that the next attempt would have to replace.
        Err(error) if matches!(start, Start::Beginning | Start::With(_)) => {
            folder.clear()?;
            return Err(error);
        }
        Err(error) => {
            let outcome = Err(error);
            manifest.close(tally, &outcome)?;
            return outcome;
        }
    };

    let mut run = Run {
        sinks,
        progress,
        about,
        keeper: Keeper::new(settings.outputs.checkpoints, folder.clone(), pinned, behind),
        manifest,
        folder,
        health,
        guards,
        scene,
        disk: DiskBudget::new(scene, settings),
        tally,
        stopping,
        held: None,
        pass_ms: Vec::new(),
        frames_timed: 0,
    };
    let simulated = run.simulate(
        &mut simulation,
        scene.time.frames,
        matches!(start, Start::With(_)),
    );
    // Sinks are finished in any case: frames before a failure stay.
    let outcome = run.finish_sinks(simulated);
    drop(simulation);
    if let Err(Error::Guard(violation)) = &outcome
        && !run.manifest.configuration.as_ref().is_some_and(|configuration| {
            is_of_use(
                settings,
                &run.manifest.retries,
                &run.folder,
                configuration,
                violation,
            )
        })
    {
        run.examine(violation, &plan, settings, first);
    }
    run.tell_end(&outcome);
    let closed = run.manifest.close(run.tally, &outcome);
    if outcome.is_ok() {
        run.serve();
    }
    outcome.and(closed)
}

/// The sinks of a run, ready for the frame after `behind`.
fn open_sinks(
    settings: &Settings,
    scene: &Scene,
    plan: &Plan,
    folder: &Arc<Folder>,
    progress: &Progress,
    behind: Option<u32>,
) -> Result<Vec<Box<dyn Sink>>> {
    let mut sinks = settings.outputs.sinks(scene, plan, folder, progress)?;
    if let Some(frame) = behind {
        for sink in &mut sinks {
            sink.resume_from(frame + 1)?;
        }
    }
    Ok(sinks)
}

/// Opens the device that a run asks for, and tells what is to be known about it.
pub(super) fn open(settings: &Settings, progress: &Progress) -> Result<Gpu> {
    let gpu = Gpu::open(&settings.adapter, false)?;
    if gpu.is_software() {
        progress.warn(&format!(
            "software adapter {} computes on the processor, which is slow",
            describe(&gpu.adapter)
        ));
    }
    if let Some(warning) = driver::slow(&gpu.adapter) {
        progress.warn(&warning);
    }
    if settings.timings && !gpu.has_timestamps {
        progress.warn("this adapter cannot time passes, so --timings has no effect");
    }
    Ok(gpu)
}

/// Bits depend on the adapter, its driver and the program.
fn warn_of_other_machine(was: &About, is: &About, progress: &Progress) {
    let pairs = [
        ("adapter", &was.adapter, &is.adapter),
        ("version", &was.version, &is.version),
    ];
    for (what, was, is) in pairs {
        if was != is {
            progress.warn(&format!(
                "the run began with {what} {was} and goes on with {is}: from here on its bits may differ from a run \
                 that was never interrupted"
            ));
        }
    }
}

struct Run<'a> {
    sinks: Vec<Box<dyn Sink>>,
    progress: Progress,
    /// Of checkpoints, but for what changes during the run.
    about: About,
    keeper: Keeper,
    manifest: Manifest<'a>,
    folder: Arc<Folder>,
    health: Health,
    guards: Guards,
    scene: &'a Scene,
    disk: Option<DiskBudget>,
    tally: Tally,
    stopping: Stopping,
    /// The state behind the last frame, where that took long and is in no file yet.
    held: Option<Checkpoint>,
    /// Sums over this sitting, by pass.
    pass_ms: Vec<(String, f64)>,
    frames_timed: u32,
}

impl Run<'_> {
    /// Makes frames up to `frames`; the present one too, if it is to be shown.
    fn simulate(&mut self, simulation: &mut Simulation, frames: u32, show: bool) -> Result<()> {
        if show {
            let oldest = simulation.show(simulation.next_index() - 1)?;
            oldest.map_or(Ok(()), |frame| self.take(frame))?;
            self.checkpoint_when_due(simulation, false)?;
        }
        let mut given_up = false;
        let mut used_up = self.look_at_disk()?;
        let mut took_s = None;
        while simulation.next_index() < frames && !given_up && used_up.is_none() && !interrupt::asked() {
            self.prepare_to_stop(simulation, took_s);
            let begun = Instant::now();
            match simulation.next_frame() {
                Ok(frame) => frame.map_or(Ok(()), |frame| self.take(frame))?,
                Err(Error::Interrupted { .. }) => given_up = true,
                Err(Error::Guard(found)) => {
                    // Frames on their way are from before that, or went wrong after it.
                    return Err(match self.receive_all(simulation) {
                        Err(Error::Guard(other)) if other.frame < found.frame => Error::Guard(other),
                        Ok(()) | Err(Error::Guard(_)) => Error::Guard(found),
                        Err(error) => error,
                    });
                }
                Err(error) => return Err(error),
            }
            used_up = self.look_when_due()?;
            took_s = Some(begun.elapsed().as_secs_f64());
            if !given_up {
                self.checkpoint_when_due(simulation, false)?;
                self.hold(simulation, took_s >= Some(LONG_FRAME_S))?;
            }
            if simulation.next_index() == 1 {
                // There is something to look at while the next frames are made.
                self.receive_all(simulation)?;
            }
        }
        self.stopping.files();
        self.receive_all(simulation)?;
        match self.held.take() {
            _ if used_up.is_some() => self.checkpoint_in_any_case(simulation)?,
            _ if !given_up => self.checkpoint_when_due(simulation, true)?,
            Some(held) => self.save(held)?,
            None => {}
        }
        match self.tally.frames_done {
            done if done < self.tally.frames && used_up.is_some() => used_up.map_or(Ok(()), Err),
            done if done < self.tally.frames => Err(Error::interrupted_after(done)),
            _ => Ok(()),
        }
    }

    /// The next frame is given up on Ctrl-C where nothing but itself is lost with it.
    fn prepare_to_stop(&self, simulation: &mut Simulation, usual_s: Option<f64>) {
        let index = simulation.next_index();
        let is_safe = |last| self.held.is_some() || self.keeper.has(last);
        if index.checked_sub(1).is_none_or(is_safe) {
            simulation.stop_when(Some(interrupt::asked));
            self.stopping.nothing();
        } else {
            simulation.stop_when(None);
            self.stopping.frame(index, usual_s, self.keeper.last());
        }
    }

    fn receive_all(&mut self, simulation: &mut Simulation) -> Result<()> {
        while let Some(frame) = simulation.finish_frame()? {
            self.take(frame)?;
        }
        Ok(())
    }

    /// Writes a checkpoint if one is due.
    fn checkpoint_when_due(&mut self, simulation: &mut Simulation, at_end: bool) -> Result<()> {
        let Some(frame) = simulation.next_index().checked_sub(1) else {
            return Ok(());
        };
        if !self.keeper.is_due(frame, at_end) {
            return Ok(());
        }
        let checkpoint = self.checkpoint(simulation)?;
        self.save(checkpoint)
    }

    /// Writes a checkpoint behind the frame made last, whatever was asked for.
    fn checkpoint_in_any_case(&mut self, simulation: &mut Simulation) -> Result<()> {
        if self.keeper.last() == simulation.next_index().checked_sub(1) {
            return Ok(());
        }
        self.manifest.add_files([checkpoint_files()]);
        let checkpoint = self.checkpoint(simulation)?;
        self.save(checkpoint)
    }

    /// Looks at the disk when a frame has been made and it is time to, where a run's files may take so much and no more.
    fn look_when_due(&mut self) -> Result<Option<Error>> {
        match self.disk.as_mut().is_some_and(DiskBudget::is_look_due) {
            true => self.look_at_disk(),
            false => Ok(None),
        }
    }

    /// Why the run has to stop, where there is no more room.
    fn look_at_disk(&mut self) -> Result<Option<Error>> {
        let Some(disk) = &mut self.disk else {
            return Ok(None);
        };
        for sink in &mut self.sinks {
            sink.flush()?;
        }
        match disk.look() {
            Ok(()) => Ok(None),
            Err(error @ Error::Budget { .. }) => Ok(Some(error)),
            Err(error) => Err(error),
        }
    }

    /// Goes back to the last good frame of a run that a guard has stopped, keeps its state, and looks for the reason. That
    /// this fails changes nothing about the run.
    fn examine(&mut self, violation: &Violation, plan: &Plan, settings: &Settings, first: u32) {
        let last_good = (first + self.tally.frames_done).checked_sub(1);
        let last_good = last_good.filter(|_| self.tally.frames_done > 0);
        let reached = last_good.map(|frame| self.go_back(frame, settings)).transpose();
        let reached = reached.unwrap_or_else(|error| {
            self.progress.warn(&format!(
                "the post-mortem knows no neighbors, since the last good frame could not be reached again: {error}"
            ));
            None
        });
        self.manifest.add_files(post_mortem::files());
        let autopsy = Autopsy {
            scene: self.scene,
            plan,
            settings,
            folder: &self.folder,
            progress: &self.progress,
            violation,
            last_good: reached.as_ref(),
        };
        if let Err(error) = autopsy.write() {
            self.progress.warn(&format!("there is no post-mortem: {error}"));
        }
    }

    /// The state of a frame that was written, from which `resume` then goes on.
    fn go_back(&mut self, frame: u32, settings: &Settings) -> Result<Checkpoint> {
        let configuration = self.manifest.configuration.as_ref().expect("a run has one");
        let mut scene = self.scene.clone();
        let found = newest(self.folder.path(), configuration, &scene, frame, &self.progress)?;
        let halvings = self.about.halvings;
        let state = reach(&mut scene, found, frame, halvings, settings, &self.progress)?;
        let checkpoint = Checkpoint {
            about: self.about_now(),
            state,
        };
        // Behind the first state alone, the run begins anew as well.
        if frame > 0 && self.keeper.last() != Some(frame) {
            self.manifest.add_files([checkpoint_files()]);
            self.folder.save(self.keeper.unsaved(frame))?;
            self.keeper.write(&checkpoint)?;
        }
        Ok(checkpoint)
    }

    /// Holds the state behind the frame made last, if that was a `long` one without a checkpoint, and no other.
    fn hold(&mut self, simulation: &mut Simulation, long: bool) -> Result<()> {
        self.held = None;
        let last = simulation.next_index().saturating_sub(1);
        if long && !self.keeper.has(last) {
            self.held = Some(self.checkpoint(simulation)?);
        }
        Ok(())
    }

    /// The state behind the frame made last, when all frames so far are sound.
    fn checkpoint(&mut self, simulation: &mut Simulation) -> Result<Checkpoint> {
        self.receive_all(simulation)?;
        Ok(Checkpoint {
            about: self.about_now(),
            state: simulation.save_state()?,
        })
    }

    fn about_now(&self) -> About {
        About {
            particle_steps: self.tally.particle_steps,
            health: self.health.clone(),
            guards: self.guards.clone(),
            ..self.about.clone()
        }
    }

    /// Writes a checkpoint when all frames so far are safe on disk. That it cannot be written is no reason to stop.
    fn save(&mut self, checkpoint: Checkpoint) -> Result<()> {
        let frame = checkpoint.state.frame;
        for sink in &mut self.sinks {
            sink.flush()?;
        }
        self.folder.save(self.keeper.unsaved(frame))?;
        let written = self.keeper.write(&checkpoint);
        if let Err(error) = written.and_then(|()| self.manifest.update(self.tally)) {
            self.progress.warn(&format!(
                "no checkpoint was written after frame {frame}, and the run goes on: {error}"
            ));
        }
        Ok(())
    }

    fn take(&mut self, frame: Frame) -> Result<()> {
        let mut guards = self.guards.clone();
        if let Some(violation) = guards.check(self.scene, &frame) {
            return Err(Error::Guard(Box::new(violation)));
        }
        self.guards = guards;
        let frame = Arc::new(frame);
        for sink in &mut self.sinks {
            sink.frame(&frame)?;
        }
        self.pass_warnings();
        self.tally.add(&frame);
        self.frames_timed += 1;
        for (label, ms) in &frame.pass_ms {
            match self.pass_ms.iter_mut().find(|(known, _)| known == label) {
                Some((_, sum)) => *sum += ms,
                None => self.pass_ms.push((label.clone(), *ms)),
            }
        }
        for warning in self.health.check(&frame, self.scene.sound_speed()) {
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
                .note(&format!("serving until Ctrl-C: {}", places.join(", ")));
            interrupt::wait();
        }
    }

    fn tell_end(&mut self, outcome: &Result<()>) {
        self.tally.stop_clock();
        if let Some(summary) = self.health.summary() {
            self.progress.warn(&summary);
        }
        if let Some(note) = self.health.note() {
            self.progress.note(&note);
        }
        if !self.pass_ms.is_empty() {
            let frames = f64::from(self.frames_timed.max(1));
            let times: Vec<_> = self
                .pass_ms
                .iter()
                .map(|(label, ms)| format!("{label} {:.3}", ms / frames))
                .collect();
            self.progress.note(&format!(
                "milliseconds of a step's passes, and of a frame's own: {}",
                times.join(", ")
            ));
        }
        let frames = self.tally.frames_done;
        let end = if outcome.is_ok() {
            format!("done: {frames} frames")
        } else {
            format!("stopped after {frames} frames")
        };
        // Where a guard stopped it, going on would come to the same; the post-mortem says more.
        if matches!(outcome, Err(error) if !matches!(error, Error::Guard(_))) {
            self.progress.note(&format!(
                "go on with `sliceflow resume {}`",
                quoted(self.folder.path())
            ));
        }
        self.progress.finish(
            &format!(
                "{end} in {} ({}, {} particle steps/s)",
                self.folder.path().display(),
                seconds(self.tally.wall_s),
                short(self.tally.particle_steps_per_s)
            ),
            &self.tally,
        );
    }
}
