//! What a run that a guard stopped leaves for whoever looks for the reason: `post_mortem/` in its folder, with a report, a
//! close-up picture, and a checkpoint of the last good frame from which the run can be replayed.

mod close_up;
mod neighborhood;
mod report;

use std::sync::Arc;

pub use report::schema;

use super::checkpoint::Checkpoint;
use super::disk;
use super::folder::{Folder, POST_MORTEM};
use super::manifest::Files;
use super::progress::Progress;
use super::run::Settings;
use crate::error::{Result, Violation};
use crate::plan::Plan;
use crate::scene::Scene;
use neighborhood::Neighborhood;
use report::Report;

/// Names of the files, in the run's folder.
const REPORT: &str = "post_mortem/report.json";
const PICTURE: &str = "post_mortem/neighborhood.png";

/// What is known when a run was stopped.
pub struct Autopsy<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub settings: &'a Settings,
    pub folder: &'a Arc<Folder>,
    pub progress: &'a Progress,
    pub violation: &'a Violation,
    /// The state after the last frame that was written; `None` where there was none, or where it could not be reached.
    pub last_good: Option<&'a Checkpoint>,
}

/// For the manifest.
pub fn files() -> [Files; 2] {
    [
        Files {
            name: REPORT.into(),
            about: "what a guard found when it stopped the run, and where".into(),
        },
        Files {
            name: PICTURE.into(),
            about: "close-up of the particle that went wrong, after the last good frame".into(),
        },
    ]
}

impl Autopsy<'_> {
    /// Writes the folder, and says what to do with it.
    pub fn write(&self) -> Result<()> {
        let folder = self.folder.path().join(POST_MORTEM);
        disk::create_folder(&folder)?;
        let state = self.last_good.map(|checkpoint| &checkpoint.state);
        let neighborhood = state.and_then(|state| Neighborhood::new(self.scene, state, self.violation));
        let picture = neighborhood
            .as_ref()
            .map(|around| close_up::draw(self.scene, self.settings, around))
            .transpose();
        let picture = picture.and_then(|bytes| match bytes {
            Some(bytes) => disk::write(&self.folder.path().join(PICTURE), &bytes).map(|()| true),
            None => Ok(false),
        });
        if let Err(error) = &picture {
            self.progress
                .warn(&format!("the post-mortem has no picture: {error}"));
        }
        let report = Report::new(
            self,
            neighborhood.as_ref(),
            picture.unwrap_or(false).then_some(PICTURE),
        );
        let mut text = serde_json::to_vec_pretty(&report).expect("keys are text");
        text.push(b'\n');
        disk::write(&self.folder.path().join(REPORT), &text)?;
        self.progress.note(&format!(
            "the post-mortem is in {}; replay what happened with `{}`, and try a change with `{}`",
            folder.display(),
            report.replay,
            report.try_a_change,
        ));
        Ok(())
    }
}
