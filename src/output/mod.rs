//! What a run leaves behind. Each [`Sink`] turns finished frames into files; [`run()`] drives them.

mod clock;
mod disk;
mod estimate;
mod folder;
mod health;
mod interrupt;
mod manifest;
pub mod npy;
mod particles;
pub mod plot;
mod png;
pub mod progress;
pub mod rerun;
mod run;
mod statistics;
mod tally;
pub mod text;
mod workers;

use std::sync::Arc;

pub use disk::write as write_file;
pub use estimate::disk_bytes;
pub use particles::{DEFAULT_COLUMNS, columns_named};
pub use png::{compose as compose_picture, encode as encode_png};
pub use progress::Progress;
pub use run::{Outputs, Settings, run};
pub use tally::Tally;

use crate::error::Result;
use crate::simulation::frame::Frame;

/// Turns finished frames into something outside.
pub trait Sink {
    /// Takes a frame; returns before it is on disk, or waits while too many are on their way there. An error may be
    /// that of an earlier frame.
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()>;

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
