//! Pictures of a run's particles, drawn again without simulating.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use serde_json::Value;

use super::configuration::Recorded;
use super::drive::open;
use super::folder::Folder;
use super::frame_range::FrameRange;
use super::manifest::Manifest;
use super::progress::Progress;
use super::read_back::{ReadBack, Snapshot};
use super::record::Record;
use super::run::Settings;
use super::stopping::Stopping;
use super::tally::Tally;
use super::text::seconds;
use super::{bodies, given_color, interrupt};
use crate::error::{Error, Result};
use crate::physics;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;
use crate::scene::column::Source;
use crate::scene::floating;
use crate::scene::model::ImagePass;
use crate::simulation::frame::Frame;
use crate::simulation::{Simulation, State};

/// Keys of a scene that change pictures and nothing else.
const DRAWN: [&str; 6] = ["render", "neighbors", "name", "description", "source", "$schema"];
/// The same of a collider.
const DRAWN_OF_COLLIDERS: [&str; 2] = ["color", "visible"];
/// Warnings of one kind that are told one by one.
const MOST_WARNINGS: usize = 3;
/// No run has more.
const MOST_FRAMES: u32 = 1 << 21;
/// Columns that cannot be drawn without velocities.
const OF_VELOCITY: [&str; 5] = ["speed", "velocity_x", "velocity_y", "velocity_z", "pressure"];

/// Draws those frames of a run that lie in `range` and have particle files or checkpoints once more, with the scene
/// changed by `overrides`, into the folder of `settings`.
pub fn redraw(
    recorded: &Recorded,
    overrides: &[String],
    range: FrameRange,
    settings: &Settings,
) -> Result<()> {
    let configuration = recorded.configuration()?;
    let mut scene = configuration.scene(overrides)?;
    check_changes(&configuration.scene(&[])?, &scene)?;
    // Nothing is simulated that they could measure.
    scene.sensors = Default::default();
    if let Some(video) = &settings.outputs.video {
        video.check(settings.force)?;
    }
    let source = ReadBack::open(&recorded.folder)?;
    let mut frames = Vec::new();
    let mut is_given = true;
    let mut refusal = Ok(());
    let mut warnings = Vec::new();
    for frame in source.frames().filter(|&frame| range.contains(frame)) {
        if let Some(snapshot) = source.read(frame)?.filter(|s| s.column("position").is_some()) {
            let lost = lost(&snapshot);
            if lost > 0 {
                warnings.push(format!(
                    "frame {frame}: {lost} of {} particles have positions that are no numbers, and are not drawn",
                    snapshot.particles()
                ));
            }
            is_given &= given_color::values(&scene, &snapshot).is_some();
            refusal = refusal.and_then(|()| check_color(&scene, &snapshot, frame));
            check_passes(&scene, &snapshot, frame)?;
            check_radii(&scene, &snapshot, frame)?;
            if snapshot.state.is_none() {
                let free = scene.first_boundary().max(snapshot.particles() as u32);
                scene.capacity = free + scene.boundary.len() as u32;
            }
            frames.push(frame);
        }
    }
    // What the device finds by itself in any case is left to it.
    let column = scene.color.column;
    let is_found = !column.is_field() && refusal.is_ok();
    if is_given && !is_found && !frames.is_empty() {
        scene.color.column.source = Source::Given;
    } else {
        refusal?;
    }
    let end = configuration.first_frame.saturating_add(recorded.frames_done);
    let made = configuration.first_frame..end.min(MOST_FRAMES);
    if frames.is_empty() && !made.clone().any(|frame| range.contains(frame)) {
        return Err(Error::usage(
            "the run has none of these frames",
            format!("it has frames {} to {}", made.start, made.end.saturating_sub(1)),
        ));
    }
    let from = recorded.folder.display();
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else {
        return Err(Error::usage(
            format!(
                "{from} holds no particles to draw: neither particle files with positions nor checkpoints"
            ),
            "run it again with --particles vtk (or ply, bgeo, npy), or with --checkpoint-every 1 --keep-checkpoints 1000000",
        ));
    };
    let folder = Arc::new(Folder::open(&settings.folder, settings.force)?);
    let files = settings.outputs.files(&scene);
    folder.check_names(&Record::new(&files, *first..=*last))?;
    let progress = Progress::new(settings.progress, frames.len() as u32);
    for warning in warnings.iter().take(MOST_WARNINGS) {
        progress.warn(warning);
    }
    if warnings.len() > MOST_WARNINGS {
        progress.warn(&format!(
            "{} more frames have such positions",
            warnings.len() - MOST_WARNINGS
        ));
    }
    let wanted = made.filter(|&frame| range.contains(frame));
    let missing = wanted
        .filter(|frame| frames.binary_search(frame).is_err())
        .count();
    let missing = match missing {
        0 => String::new(),
        missing => format!("; {missing} others have neither particle files nor checkpoints"),
    };
    progress.note(&format!(
        "drawing {} frames of {from}, from {first} to {last}{missing}",
        frames.len()
    ));

    let gpu = open(settings, &progress)?;
    let wanted = Wanted {
        statistics: true,
        view: Some(scene.render.view),
        ..Default::default()
    };
    let plan = Plan::new(&scene, &gpu.limits, &wanted)?;
    if let Some(why) = &plan.lists_left_out {
        progress.note(why);
    }
    let mut simulation = Simulation::new(gpu, &scene, &plan)?;
    for told in folder.clear()? {
        progress.note(&told);
    }
    let shown = as_shown(&scene, &frames);
    if let Some(note) = settings
        .outputs
        .video
        .as_ref()
        .and_then(|video| video.note(&shown))
    {
        progress.note(&note);
    }
    let mut sinks = settings.outputs.sinks(&shown, &plan, &folder, &progress)?;
    let mut tally = Tally::start(frames.len() as u32);
    let mut manifest = Manifest::new(
        folder.manifest(),
        &scene,
        &plan,
        simulation.gpu(),
        &settings.command_line,
        files,
        *first..=*last,
    );
    manifest.drawn_from = Some(std::path::absolute(&recorded.folder).unwrap_or_default());
    manifest.update(tally)?;
    let stopping = Stopping::default();
    stopping.listen(&progress);

    let mut progress = progress;
    let mut take = |frame: Frame| -> Result<()> {
        let frame = Arc::new(frame);
        for sink in &mut sinks {
            sink.frame(&frame)?;
        }
        tally.add_drawn();
        progress.frame(&frame, &tally);
        Ok(())
    };
    let mut motions = None;
    let mut draw = || -> Result<()> {
        for &frame in &frames {
            if interrupt::asked() {
                break;
            }
            let Some(snapshot) = source.read(frame)? else {
                continue;
            };
            if scene.color.column.source == Source::Given
                && let Some(values) = given_color::values(&scene, &snapshot)
            {
                simulation.give_column(&values)?;
            }
            let is_whole = snapshot.state.is_some();
            let mut state = state(&scene, frame, snapshot);
            if floating::are_in(&scene) && !is_whole {
                let known = match motions.take() {
                    Some(known) => known,
                    None => bodies::read(&recorded.folder.join(bodies::NAME), scene.dimensions)?,
                };
                let of_frame = motions.insert(known).get(&frame).map_or(&[][..], Vec::as_slice);
                let states = physics::bodies::states(&scene, of_frame).ok_or_else(|| {
                    Error::usage(
                        format!("{} has not all rigid bodies of frame {frame}", bodies::NAME),
                        "draw from checkpoints (--checkpoint-every 1), or run again",
                    )
                })?;
                let bytes = bytemuck::cast_slice(&states).to_vec();
                state.buffers.push(("body_state".into(), bytes));
            }
            simulation.restore(&state)?;
            simulation.show(frame)?.map_or(Ok(()), &mut take)?;
        }
        while let Some(frame) = simulation.finish_frame()? {
            take(frame)?;
        }
        Ok(())
    };
    let drawn = draw();
    let finished: Vec<_> = sinks.iter_mut().map(|sink| sink.finish()).collect();
    let mut outcome = finished.into_iter().fold(drawn, Result::and);
    let done = tally.frames_done;
    if outcome.is_ok() && done < tally.frames {
        outcome = Err(Error::interrupted_after(done));
    }
    tally.stop_clock();
    progress.finish(
        &format!(
            "{done} frames in {} ({})",
            folder.path().display(),
            seconds(tally.wall_s)
        ),
        &tally,
    );
    let closed = manifest.close(tally, &outcome);
    outcome.and(closed)
}

/// Particles that are nowhere.
fn lost(snapshot: &Snapshot) -> usize {
    let position = snapshot.column("position");
    let rows = position
        .into_iter()
        .flat_map(|column| column.values.chunks_exact(column.width));
    rows.filter(|row| row.iter().any(|x| !x.is_finite())).count()
}

/// The scene as a video shows it, with the frames that are drawn and no others.
fn as_shown(scene: &Scene, frames: &[u32]) -> Scene {
    let mut shown = scene.clone();
    shown.time.frames = frames.len() as u32;
    if let [first, .., last] = frames {
        let distance = f64::from(last - first) / (frames.len() - 1) as f64;
        shown.time.fps /= distance.round().max(1.0);
    }
    shown
}

/// What the device starts from to draw a frame.
fn state(scene: &Scene, frame: u32, snapshot: Snapshot) -> State {
    let vectors = |name: &str| -> Vec<DVec3> {
        let column = snapshot.column(name);
        column.map_or_else(Vec::new, |c| {
            c.values.chunks_exact(c.width).map(DVec3::from_slice).collect()
        })
    };
    let position = vectors("position");
    let mut velocity: Vec<Vec3> = vectors("velocity").iter().map(|v| v.as_vec3()).collect();
    velocity.resize(position.len(), Vec3::ZERO);
    match snapshot.state {
        Some(state) => state.with_origin(scene.origin),
        None => {
            let radius = snapshot.column("radius").filter(|_| scene.has_field("radius"));
            let radius: Option<Vec<f32>> = radius.map(|c| c.values.iter().map(|&r| r as f32).collect());
            State::of_particles(scene, frame, &position, &velocity, radius.as_deref())
        }
    }
}

/// Refuses colors that the files do not hold and that cannot be measured again, as contacts and densities of grains can.
fn check_color(scene: &Scene, snapshot: &Snapshot, frame: u32) -> Result<()> {
    let column = scene.color.column.name;
    if OF_VELOCITY.contains(&column) && snapshot.column("velocity").is_none() {
        return Err(Error::usage(
            format!("frame {frame} cannot be colored by {column}: its particle files have no velocity"),
            "choose another color, such as --set render.color.by=y, or run again with --columns position,velocity",
        ));
    }
    let derived = physics::model(&scene.matter).from_state;
    let is_field = scene.color.column.source == Source::Field;
    let is_of_state = is_field || derived.iter().any(|derived| derived.column == column);
    if is_of_state && snapshot.state.is_none() {
        return Err(Error::usage(
            format!(
                "frame {frame} cannot be colored by {column}: its particle files have none, and positions do not tell"
            ),
            format!(
                "choose another color, such as --set render.color.by=speed, or run again with --columns velocity,{column}"
            ),
        ));
    }
    Ok(())
}

/// Refuses extra images and blur that need velocities where the files hold none.
fn check_passes(scene: &Scene, snapshot: &Snapshot, frame: u32) -> Result<()> {
    let of_velocity = [ImagePass::Velocity, ImagePass::Motion];
    let is_wanted = scene.render.passes.iter().any(|pass| of_velocity.contains(pass));
    if (is_wanted || scene.render.shutter > 0.0) && snapshot.column("velocity").is_none() {
        return Err(Error::usage(
            format!("frame {frame} tells no motion: its particle files have no velocity"),
            "leave `velocity` and `motion` out of --passes and set no --shutter, or run again with --columns \
             position,velocity",
        ));
    }
    Ok(())
}

/// Refuses frames of grains of several sizes whose files do not say how large they are.
fn check_radii(scene: &Scene, snapshot: &Snapshot, frame: u32) -> Result<()> {
    let is_missing = snapshot.state.is_none() && snapshot.column("radius").is_none();
    if scene.has_field("radius") && is_missing {
        return Err(Error::usage(
            format!(
                "frame {frame} does not tell how large its grains are: its particle files have no radius"
            ),
            "run it again: files of such grains have a column `radius`",
        ));
    }
    Ok(())
}

/// Refuses changes that would need a simulation.
fn check_changes(old: &Scene, new: &Scene) -> Result<()> {
    let json = |scene: &Scene| serde_json::to_value(&scene.file).unwrap_or_default();
    let mut changed = Vec::new();
    let (old, new) = (json(old), json(new));
    let simulated = |value: &Value, drawn: &[&str]| {
        let mut value = value.clone();
        if let Some(keys) = value.as_object_mut() {
            keys.retain(|key, _| !drawn.contains(&key.as_str()));
        }
        value
    };
    for (key, value) in new.as_object().into_iter().flatten() {
        let list = |colliders: &Value| -> Vec<Value> {
            let colliders = colliders.as_array().into_iter().flatten();
            colliders.map(|c| simulated(c, &DRAWN_OF_COLLIDERS)).collect()
        };
        let is_same = match key.as_str() {
            key if DRAWN.contains(&key) => true,
            "colliders" => list(value) == list(&old[key]),
            _ => *value == old[key],
        };
        if !is_same {
            changed.push(key.as_str());
        }
    }
    if changed.is_empty() {
        return Ok(());
    }
    Err(Error::usage(
        format!(
            "nothing is simulated, so `{}` cannot change",
            changed.join("`, `")
        ),
        "change `render`, `neighbors`, or a collider's color; `sliceflow resume RUN --branch-at FRAME` simulates",
    ))
}
