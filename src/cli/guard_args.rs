//! Arguments about what stops a run.

use super::scene_args::bytes;
use crate::output::{OnInstability, Settings};

#[derive(clap::Args, Clone, Copy)]
pub struct GuardArgs {
    /// What happens where a guard finds that the simulation blows up [default: stop]
    #[arg(long, value_name = "WHAT")]
    on_instability: Option<OnInstability>,
    /// Stops the run, so that `sliceflow resume` can go on, before its files take more than this
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    max_disk: Option<u64>,
}

impl GuardArgs {
    /// What is given here, and `otherwise` where nothing is.
    pub fn or(self, otherwise: Self) -> Self {
        Self {
            on_instability: self.on_instability.or(otherwise.on_instability),
            max_disk: self.max_disk.or(otherwise.max_disk),
        }
    }

    pub fn put(self, settings: Settings) -> Settings {
        Settings {
            on_instability: self.on_instability.unwrap_or_default(),
            max_disk: self.max_disk,
            ..settings
        }
    }
}
