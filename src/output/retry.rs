//! Runs that a guard stops, and that go back to the last good checkpoint with a smaller step where the user wants that.

use std::sync::Arc;
use std::time::Instant;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checkpoint::Checkpoint;
use super::configuration::Configuration;
use super::drive::{self, Launch, Start};
use super::folder::Folder;
use super::progress::Progress;
use super::record::names;
use super::resume::{newest, part_from};
use super::run::Settings;
use crate::error::{Error, Result, Violation};
use crate::physics::layout::StepControl;
use crate::scene::Scene;

/// Steps are halved so often at most in a run.
const MOST_HALVINGS: u32 = 5;

/// What a run does that a guard has stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum OnInstability {
    /// It ends, with a post-mortem folder.
    #[default]
    Stop,
    /// It goes back to the last good checkpoint with half the step, five times at most.
    Retry,
}

/// A time that a run went back with half the step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Retry {
    /// The frame of the checkpoint that the run went on from; null where it began anew.
    pub from_frame: Option<u32>,
    /// The guard that had stopped it, in one word.
    pub guard: String,
    /// What the guard had found, and where.
    pub message: String,
    /// Frame that was about to be written then.
    pub frame: u32,
    /// Steps until then, since the run began.
    pub step: u64,
    /// Length of the steps then, seconds.
    pub step_s: f64,
    /// How often steps have been halved with this retry.
    pub halvings: u32,
}

/// How often steps had been halved for the frames that follow a checkpoint, or a beginning.
pub fn halvings(retries: &[Retry], behind: Option<u32>) -> u32 {
    let before = retries.iter().filter(|retry| retry.from_frame <= behind);
    before.map(|retry| retry.halvings).max().unwrap_or(0)
}

/// The scene with steps of half the length, so many times.
pub fn halved(scene: &Scene, halvings: u32) -> Scene {
    let mut scene = scene.clone();
    let share = 0.5_f64.powi(halvings as i32);
    let time = &mut scene.time;
    time.steps_per_frame <<= halvings;
    time.step *= share;
    if let Some(limits) = &mut time.adaptive {
        limits.expected *= share;
        limits.constant.0 *= share;
        limits.courant_distance *= share;
        // A step is the square root of this over an acceleration.
        limits.fall *= share * share;
    }
    scene
}

/// Shortens the adaptive step that comes after a checkpoint to what steps are that have been halved so often.
pub fn shorten(checkpoint: &mut Checkpoint, halvings: u32) {
    let more = halvings.saturating_sub(checkpoint.about.halvings);
    checkpoint.about.halvings = halvings;
    let mut buffers = checkpoint.state.buffers.iter_mut();
    let found = buffers.find(|(name, _)| name == "step_control");
    if let Some((_, bytes)) = found {
        let mut control: StepControl = bytemuck::pod_read_unaligned(bytes);
        control.wanted *= 0.5_f32.powi(more as i32);
        *bytes = bytemuck::bytes_of(&control).to_vec();
    }
}

/// Drives a run to its end, or until a guard stops it for good.
pub(super) fn drive(mut launch: Launch) -> Result<()> {
    // As the user gave them: each attempt writes its video to a file of its own.
    let settings = launch.settings.clone();
    loop {
        let again = Again::of(&launch, settings.clone());
        match drive::drive(launch) {
            Err(Error::Guard(violation)) if again.is_of_use(&violation) => {
                launch = again.launch(violation)?;
            }
            outcome => return outcome,
        }
    }
}

/// Whether smaller steps may help a run that a guard has stopped, and can be tried.
pub(super) fn is_of_use(
    settings: &Settings,
    retries: &[Retry],
    folder: &Folder,
    configuration: &Configuration,
    violation: &Violation,
) -> bool {
    let has_checkpoint =
        || names(folder.path()).is_ok_and(|names| names.iter().any(|name| name.starts_with("checkpoint_")));
    settings.on_instability == OnInstability::Retry
        && halvings(retries, Some(u32::MAX)) < MOST_HALVINGS
        && violation.guard.row().may_come_of_steps
        // A variant begins with a state of another run, which this one does not have any more.
        && (configuration.variant_of.is_none() || has_checkpoint())
}

/// What of a launch the next one needs.
struct Again<'a> {
    scene: &'a Scene,
    settings: Settings,
    folder: Arc<Folder>,
    configuration: Configuration,
    retries: Vec<Retry>,
    wall_s: f64,
    begun: Instant,
}

impl<'a> Again<'a> {
    fn of(launch: &Launch<'a>, settings: Settings) -> Self {
        Self {
            scene: launch.scene,
            settings,
            folder: launch.folder.clone(),
            configuration: launch.configuration.clone(),
            retries: launch.retries.clone(),
            wall_s: launch.wall_s,
            begun: Instant::now(),
        }
    }

    fn is_of_use(&self, violation: &Violation) -> bool {
        let Self {
            settings,
            folder,
            configuration,
            retries,
            ..
        } = self;
        is_of_use(settings, retries, folder, configuration, violation)
    }

    /// The run once more, from its newest checkpoint on.
    fn launch(mut self, violation: Box<Violation>) -> Result<Launch<'a>> {
        let halvings = halvings(&self.retries, Some(u32::MAX)) + 1;
        let progress = Progress::new(self.settings.progress, self.scene.time.frames);
        progress.warn(&violation.to_string());
        let found = newest(
            self.folder.path(),
            &self.configuration,
            self.scene,
            u32::MAX,
            &progress,
        )?;
        let is_variant = self.configuration.variant_of.is_some();
        if found.is_none() && is_variant {
            // Its checkpoints are damaged.
            return Err(Error::Guard(violation));
        }
        let from_frame = found.as_ref().map(|checkpoint| checkpoint.state.frame);
        self.retries.push(Retry {
            from_frame,
            guard: violation.guard.row().word.into(),
            message: violation.to_string(),
            frame: violation.frame,
            step: violation.step,
            step_s: violation.step_s,
            halvings,
        });
        let place = match from_frame {
            Some(frame) => format!("after frame {frame}"),
            None => "at the beginning".to_owned(),
        };
        progress.warn(&format!(
            "retrying {place} with steps of half the length ({halvings} of {MOST_HALVINGS} times)"
        ));
        let start = match found {
            Some(checkpoint) => Start::Behind(Box::new(checkpoint)),
            None => Start::Again,
        };
        let next = start.state().map_or(0, |state| state.frame + 1);
        let settings = part_from(&self.settings, next, is_variant, &self.configuration, &progress);
        Ok(Launch {
            scene: self.scene,
            settings,
            folder: self.folder,
            progress,
            configuration: self.configuration,
            start,
            wall_s: self.wall_s + self.begun.elapsed().as_secs_f64(),
            retries: self.retries,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::output::checkpoint::About;
    use crate::simulation::State;

    const SCENE: &str = r#"{
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1] },
        "fluid": { "solver": "wcsph", "spacing": 0.1, "max_speed": 1 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.5] } }]
    }"#;

    fn scene(overrides: &[&str]) -> Scene {
        let overrides: Vec<String> = overrides.iter().map(|&one| one.to_owned()).collect();
        crate::scene::load::parse(SCENE, "test.json", Path::new("."), &overrides).unwrap()
    }

    #[test]
    fn steps_are_halved_and_frames_stay() {
        for overrides in [&[][..], &["time.adaptive=true"]] {
            let whole = scene(overrides);
            let short = halved(&whole, 2);
            let frame = |scene: &Scene| scene.time.step * f64::from(scene.time.steps_per_frame);
            assert_eq!(short.time.steps_per_frame, 4 * whole.time.steps_per_frame);
            assert!((frame(&short) - frame(&whole)).abs() < 1e-12);
            assert_eq!(short.time.frames, whole.time.frames);
            let Some((short, whole)) = short.time.adaptive.zip(whole.time.adaptive) else {
                assert!(overrides.is_empty());
                continue;
            };
            // By speed and by acceleration.
            assert_eq!(short.courant_distance, whole.courant_distance / 4.0);
            assert_eq!(short.fall.sqrt(), whole.fall.sqrt() / 4.0);
            assert_eq!(
                (short.constant.0, short.expected),
                (whole.constant.0 / 4.0, whole.expected / 4.0)
            );
        }
    }

    #[test]
    fn an_adaptive_step_is_shortened_once() {
        let control = StepControl {
            wanted: 0.8,
            ..StepControl::default()
        };
        let mut checkpoint = Checkpoint {
            about: About {
                run_id: String::new(),
                version: String::new(),
                adapter: String::new(),
                particle_steps: 0,
                health: Default::default(),
                guards: Default::default(),
                halvings: 1,
            },
            state: State {
                frame: 3,
                particles: 0,
                dimensions: crate::scene::Dimensions::Two,
                origin: glam::DVec3::ZERO,
                lists_left_out: None,
                buffers: vec![("step_control".into(), bytemuck::bytes_of(&control).to_vec())],
            },
        };
        for halvings in [3, 3] {
            shorten(&mut checkpoint, halvings);
            let bytes = checkpoint.state.buffer("step_control").unwrap();
            let found: StepControl = bytemuck::pod_read_unaligned(bytes);
            assert_eq!((found.wanted, checkpoint.about.halvings), (0.2, 3));
        }
    }

    #[test]
    fn halvings_hold_behind_the_checkpoint_that_a_run_went_back_to() {
        let retry = |from_frame: Option<u32>, halvings: u32| Retry {
            from_frame,
            guard: "energy".into(),
            message: String::new(),
            frame: 9,
            step: 90,
            step_s: 1e-3,
            halvings,
        };
        let retries = [retry(None, 1), retry(Some(4), 2), retry(Some(8), 3)];
        let behind = |frame: Option<u32>| halvings(&retries, frame);
        assert_eq!(
            [None, Some(3), Some(4), Some(7), Some(8)].map(behind),
            [1, 1, 2, 2, 3]
        );
        assert_eq!(halvings(&[], Some(5)), 0);
    }
}
