//! What a run leaves behind. Each [`Sink`] turns finished frames into files; [`run()`] drives them.

mod bar;
mod bodies;
mod checkpoint;
mod clock;
pub mod compare;
mod configuration;
mod disk;
mod disk_budget;
mod drive;
mod estimate;
mod exr;
mod folder;
mod forecast;
mod frame_range;
mod given_color;
mod guards;
mod health;
pub mod interrupt;
mod keeper;
mod manifest;
mod measure;
mod memory;
pub mod npy;
mod particles;
mod passes;
#[cfg(feature = "plots")]
pub mod plot;
mod png;
mod post_mortem;
pub mod progress;
mod read_back;
mod record;
mod redraw;
pub mod rerun;
mod resume;
mod retry;
mod rewind;
mod run;
mod sensors;
mod statistics;
mod stopping;
#[cfg(feature = "surface")]
pub mod surface;
mod tally;
pub mod text;
pub mod usd;
#[cfg(feature = "video")]
mod video;
#[cfg(not(feature = "video"))]
#[path = "video/absent.rs"]
mod video;
mod workers;

use std::sync::Arc;

pub use checkpoint::Checkpoint;
pub use clock::now;
pub use configuration::Recorded;
pub use disk::write as write_file;
pub use estimate::{checkpoints as checkpoint_estimate, disk_bytes};
pub use frame_range::FrameRange;
pub use guards::Guards;
pub use keeper::{Checkpoints, Every};
pub use manifest::schema as manifest_schema;
pub use measure::{Measured, measure};
pub use particles::{
    DEFAULT_COLUMNS, FORMATS as PARTICLE_FORMATS, Format as ParticleFormat, ParticleOutput, columns_named,
};
pub use png::{compose as compose_picture, encode as encode_png};
pub use post_mortem::schema as post_mortem_schema;
pub use progress::Progress;
pub use redraw::redraw;
pub use resume::{branch, resume};
pub use retry::OnInstability;
pub use run::{Outputs, Settings, run};
pub use sensors::from_files::measure_files;
pub use statistics::schema as statistics_schema;
pub use tally::Tally;
pub use video::VideoOutput;

use crate::error::Result;
use crate::simulation::frame::Frame;

/// Turns finished frames into something outside.
pub trait Sink {
    /// Takes a frame; returns before it is on disk, or waits while too many are on their way there. An error may be
    /// that of an earlier frame.
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()>;

    /// Called once, before the first frame, in a run that goes on: `frame` is the first that this sink gets, and the
    /// folder holds nothing of it and of later ones. A sink that writes files of single frames, or that appends, has
    /// nothing to do. One whose file cannot be appended to either makes it anew from what the folder holds of earlier
    /// frames, or begins a second file and says so in a warning.
    fn resume_from(&mut self, _frame: u32) -> Result<()> {
        Ok(())
    }

    /// Waits until every frame taken is written, since a checkpoint is about to say so; more may follow. Files of
    /// single frames are then saved from power cuts by [`folder::Folder::save`]. A sink whose output is none of the
    /// run's folder has nothing to do.
    fn flush(&mut self) -> Result<()> {
        Ok(())
    }

    /// Waits until every frame taken is on disk. Called once, also after a failure.
    fn finish(&mut self) -> Result<()>;

    /// What went wrong without a reason to stop, since the last call.
    fn warnings(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Where somebody may still be looking after the end, so that the program waits.
    fn serving(&self) -> Option<String> {
        None
    }
}
