//! Runs that go on: the same run behind its newest checkpoint, or a variant from one of its frames.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;

use super::checkpoint::Checkpoint;
use super::configuration::{Configuration, Recorded};
use super::drive::{Launch, Start};
use super::folder::Folder;
use super::interrupt;
use super::progress::Progress;
use super::rerun::Target;
use super::retry::{self, Retry, halved, halvings, shorten};
use super::rewind::checkpoints;
use super::run::{Outputs, Settings};
use super::stopping::Stopping;
use super::text::count;
use crate::error::{Error, Result};
use crate::files;
use crate::gpu::Gpu;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;
use crate::simulation::{Simulation, State};

/// Goes on with a run where it stopped: in its own folder, behind its newest checkpoint that is whole. `more` are
/// overrides that make it longer or shorter (`time.duration`). Without a checkpoint it begins anew.
pub fn resume(recorded: &Recorded, more: &[String], settings: &Settings) -> Result<()> {
    let mut configuration = recorded.configuration()?.clone();
    let mut scene = configuration.scene_unchanged(more)?;
    configuration.overrides.extend_from_slice(more);
    let folder = Arc::new(Folder::existing(&recorded.folder)?);
    let progress = Progress::new(settings.progress, scene.time.frames);
    let first = configuration.first_frame;
    let frames = scene.time.frames;
    let newest = newest(&recorded.folder, &configuration, &scene, u32::MAX, &progress)?;
    let made = match &newest {
        Some(checkpoint) => checkpoint.state.frame + 1,
        None => first,
    };
    if frames < made {
        return Err(Error::usage(
            format!("the run has made {made} frames already, and {frames} are asked for"),
            "ask for more, or begin a new run",
        ));
    }
    if let Some(warning) = lost(&folder, &settings.outputs, first..made) {
        progress.warn(&warning);
    }
    if recorded.status == "finished" && frames == first.saturating_add(recorded.frames_done) {
        progress.note(&format!(
            "{} is finished: {frames} frames; make it longer with --frames, or start a variant with --branch-at",
            recorded.folder.display()
        ));
        return Ok(());
    }
    let start = match newest {
        Some(checkpoint) => {
            progress.note(&format!(
                "going on after frame {} of {frames}",
                checkpoint.state.frame
            ));
            scene.capacity = checkpoint.state.capacity(&scene);
            Start::Behind(Box::new(checkpoint))
        }
        None if configuration.variant_of.is_some() => {
            return Err(Error::usage(
                "the checkpoint that this variant began with is gone or damaged",
                "make the variant again with --branch-at",
            ));
        }
        None => {
            progress.note("no checkpoint: beginning with frame 0");
            Start::Again
        }
    };
    let behind = start.state().map(|state| state.frame);
    let mut retries = recorded.retries.clone();
    retries.retain(|retry| retry.from_frame <= behind);
    let next = behind.map_or(0, |frame| frame + 1);
    let settings = part_from(
        settings,
        next,
        configuration.variant_of.is_some(),
        &configuration,
        &progress,
    );
    if let Some(video) = &settings.outputs.video {
        // What an earlier attempt left of this part is made again.
        video.check(true)?;
    }
    check_outside(&settings)?;
    retry::drive(Launch {
        scene: &scene,
        settings,
        folder,
        progress,
        configuration,
        start,
        wall_s: recorded.wall_s,
        retries,
    })
}

/// Starts a variant of a run from its frame `frame`, changed by `overrides`, in the folder of `settings`.
pub fn branch(recorded: &Recorded, frame: u32, overrides: &[String], settings: &Settings) -> Result<()> {
    let configuration = recorded.configuration()?;
    let mut old = configuration.scene_unchanged(&[])?;
    let mut scene = configuration.scene(overrides)?;
    check_variant(configuration, &old, &scene, frame)?;
    let progress = Progress::new(settings.progress, scene.time.frames);
    let settings = part_from(settings, frame, true, configuration, &progress);
    if let Some(video) = &settings.outputs.video {
        video.check(settings.force)?;
    }
    if let Some(rerun) = &settings.outputs.rerun {
        rerun.check(&scene, settings.outputs.pictures, settings.force)?;
    }
    let folder = Arc::new(Folder::open(&settings.folder, settings.force)?);
    for warning in overruled(&old, &scene, frame) {
        progress.warn(&warning);
    }
    let newest = newest(&recorded.folder, configuration, &old, frame, &progress)?;
    if newest.is_none() && configuration.variant_of.is_some() {
        return Err(Error::usage(
            "the checkpoint that this run began with is gone or damaged",
            "branch from the run that it is a variant of",
        ));
    }
    let behind = newest.as_ref().map(|checkpoint| checkpoint.state.frame);
    let halvings = halvings(&recorded.retries, behind);
    old = halved(&old, halvings);
    let state = reach(&mut old, newest, frame, halvings, &settings, &progress)?.with_origin(scene.origin);
    // The variant keeps the steps of the run that it begins with.
    let kept = recorded
        .retries
        .iter()
        .filter(|retry| retry.from_frame <= Some(frame));
    let retries = kept.map(|retry| Retry {
        from_frame: None,
        ..retry.clone()
    });
    scene.capacity = state.capacity(&scene);
    let variant = Configuration::new(&scene, &configuration.arguments)?;
    let from = std::path::absolute(&recorded.folder).unwrap_or_else(|_| recorded.folder.clone());
    progress.note(&format!(
        "a variant of {} from frame {frame} on",
        recorded.folder.display()
    ));
    retry::drive(Launch {
        scene: &scene,
        settings,
        folder,
        progress,
        configuration: Configuration {
            working_folder: configuration.working_folder.clone(),
            first_frame: frame,
            variant_of: Some(from),
            ..variant
        },
        start: Start::With(Box::new(state)),
        wall_s: 0.0,
        retries: retries.collect(),
    })
}

/// Settings for a run that begins with frame `first`: what cannot be appended to gets another name, which is told. A
/// variant keeps all its files in its own folder.
pub(super) fn part_from(
    settings: &Settings,
    first: u32,
    is_variant: bool,
    configuration: &Configuration,
    progress: &Progress,
) -> Settings {
    let folder_of = |path: &Path| match path.parent() {
        Some(parent) if !is_variant => configuration.working_folder.join(parent),
        _ => settings.folder.clone(),
    };
    let mut part = settings.clone();
    if let Some(rerun) = &mut part.outputs.rerun {
        *rerun = rerun.part_from(first, folder_of);
        let targets: Vec<_> = rerun.targets.iter().map(ToString::to_string).collect();
        progress.note(&format!(
            "recording frames from {first} on into {}",
            targets.join(", ")
        ));
    }
    if let Some(video) = &mut part.outputs.video {
        *video = video.part_from(first, folder_of);
        progress.note(&format!(
            "the video of frames from {first} on is {}",
            video.path().display()
        ));
    }
    part
}

/// Files of frames that the run has made and that are there no longer, in words.
fn lost(folder: &Folder, outputs: &Outputs, frames: Range<u32>) -> Option<String> {
    let mut lost: Vec<PathBuf> = Vec::new();
    for frame in frames {
        if outputs.pictures {
            lost.push(folder.picture(frame));
        }
        if let Some(particles) = outputs
            .particles
            .as_ref()
            .filter(|p| frame.is_multiple_of(p.every))
        {
            let stem = folder.particles(frame);
            lost.extend(
                particles
                    .formats
                    .iter()
                    .map(|format| match Path::new(format.file).extension() {
                        Some(ending) if format.is_points => stem.with_extension(ending),
                        _ => stem.clone(),
                    }),
            );
        }
    }
    lost.retain(|path| !path.exists());
    let first = lost.first()?.file_name()?.display().to_string();
    Some(format!(
        "{} files of frames that the run has made are gone, the first of them {first}: they stay away; `sliceflow render` \
         draws pictures again where particle files or checkpoints are, and a new run makes all of them",
        count(lost.len() as u64)
    ))
}

/// Refuses to replace files outside of the run's folder unless told to: whoever wrote down the run's arguments may not be
/// who resumes it.
fn check_outside(settings: &Settings) -> Result<()> {
    let outputs = &settings.outputs;
    let recordings = outputs.rerun.iter().flat_map(|rerun| &rerun.targets);
    let recordings = recordings.filter_map(|target| match target {
        Target::File(path) => Some(path.as_path()),
        _ => None,
    });
    let videos = outputs.video.iter().map(|video| video.path());
    let run = settings.folder.canonicalize();
    let is_outside = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).canonicalize();
        !matches!((&run, folder), (Ok(run), Ok(folder)) if folder.starts_with(run))
    };
    let is_there = |path: &Path| path.exists() || files::is_link(path);
    match videos
        .chain(recordings)
        .find(|path| is_there(path) && is_outside(path))
    {
        Some(path) if !settings.force => Err(Error::usage(
            format!("{} is there already, outside of the run's folder", path.display()),
            "replace it with --force, or move it to another place",
        )),
        _ => Ok(()),
    }
}

fn check_variant(configuration: &Configuration, old: &Scene, scene: &Scene, frame: u32) -> Result<()> {
    let (first, last) = (configuration.first_frame, old.time.frames - 1);
    if !(first..=last).contains(&frame) {
        return Err(Error::usage(
            format!("the run has no frame {frame}"),
            format!("give --branch-at {first} to {last}"),
        ));
    }
    if frame >= scene.time.frames {
        return Err(Error::usage(
            format!(
                "the variant would end before frame {frame}: it has {} frames",
                scene.time.frames
            ),
            "give it more with --frames, or branch earlier",
        ));
    }
    if scene.dimensions != old.dimensions {
        return Err(Error::usage(
            "a variant cannot have another number of dimensions",
            "leave `dimensions` as it is, or start a new run",
        ));
    }
    if scene.time.fps != old.time.fps {
        return Err(Error::usage(
            format!("with another `time.fps`, frame {frame} would be another moment"),
            "leave it as it is, or start a new run",
        ));
    }
    Ok(())
}

/// Parameters that a variant changes in vain, since an event before its first frame has set them.
fn overruled(old: &Scene, scene: &Scene, frame: u32) -> Vec<String> {
    let json = |scene: &Scene| serde_json::to_value(&scene.file).unwrap_or_default();
    let (old, new) = (json(old), json(scene));
    let value = |scene: &Value, key: &str| match key {
        "gravity" => scene["gravity"].clone(),
        of_grains => scene["grains"][of_grains].clone(),
    };
    let begin = f64::from(frame) / scene.time.fps;
    let mut warnings = Vec::new();
    for (i, event) in scene.file.events.iter().enumerate() {
        let set = &new["events"][i]["set"];
        for key in set.as_object().into_iter().flatten().map(|(key, _)| key) {
            if event.at < begin && value(&old, key) != value(&new, key) {
                warnings.push(format!(
                    "{key} stays as events[{i}] has set it at {} s, before frame {frame}; change it there: \
                     --set 'events[{i}].set.{key}={}'",
                    event.at,
                    value(&new, key)
                ));
            }
        }
    }
    warnings
}

/// The newest whole checkpoint of a run at or before a frame; what is wrong with newer ones is told.
pub(super) fn newest(
    folder: &Path,
    configuration: &Configuration,
    scene: &Scene,
    until: u32,
    progress: &Progress,
) -> Result<Option<Checkpoint>> {
    for (frame, path) in checkpoints(folder)?.into_iter().rev() {
        if frame > until {
            continue;
        }
        let wrong = match Checkpoint::read(&path) {
            Ok(read) if read.about.run_id != configuration.run_id => "belongs to another run".to_owned(),
            Ok(read) if read.state.frame != frame => "has the name of another frame".to_owned(),
            Ok(_) if frame < configuration.first_frame => "is of a frame before the run's first".to_owned(),
            Ok(read) if !read.state.is_finite() => "has coordinates that are no numbers".to_owned(),
            Ok(read) => match read.state.check(scene) {
                Ok(()) => return Ok(Some(read)),
                Err(wrong) => wrong,
            },
            Err(wrong) => wrong,
        };
        progress.warn(&format!("{} {wrong}; looking for one before it", path.display()));
    }
    Ok(None)
}

/// The state of a run at a frame: that of a checkpoint, or simulated from there without writing anything, with steps that have
/// been halved so often.
pub(super) fn reach(
    scene: &mut Scene,
    from: Option<Checkpoint>,
    frame: u32,
    halvings: u32,
    settings: &Settings,
    progress: &Progress,
) -> Result<State> {
    let state = from.map(|mut checkpoint| {
        if checkpoint.state.frame != frame {
            shorten(&mut checkpoint, halvings);
        }
        checkpoint.state
    });
    if let Some(state) = &state {
        if state.frame == frame {
            return Ok(state.clone());
        }
        scene.capacity = state.capacity(scene);
    }
    let next = state.as_ref().map_or(0, |state| state.frame + 1);
    progress.note(&format!(
        "there is no checkpoint of frame {frame}: simulating frames {next} to {frame} again"
    ));
    let stopping = Stopping::default();
    stopping.listen(progress);
    // The run of the variant opens it again, and tells what is to be known about it.
    let gpu = Gpu::open(&settings.adapter, false)?;
    let plan = Plan::new(scene, &gpu.limits, &Wanted::default())?;
    if let Some(why) = &plan.lists_left_out {
        progress.note(why);
    }
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    simulation.stop_when(Some(interrupt::asked));
    if let Some(state) = &state {
        simulation.restore(state)?;
    }
    while simulation.next_index() <= frame {
        simulation.next_frame()?;
    }
    while simulation.finish_frame()?.is_some() {}
    simulation.save_state()
}
