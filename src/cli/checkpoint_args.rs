//! Arguments about checkpoints.

use crate::output::{Checkpoints, Every};

#[derive(clap::Args, Clone)]
pub struct CheckpointArgs {
    /// How often checkpoints are written, for `sliceflow resume`: 10 (frames), 30s, 5min, 1h of wall-clock time; 0 for none
    /// [default: 60s, and when the run ends]
    #[arg(long, value_name = "N|TIME")]
    checkpoint_every: Option<Every>,
    /// How many checkpoints stay, the newest ones [default: 2]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    keep_checkpoints: Option<u32>,
}

impl CheckpointArgs {
    /// What is given here, and `otherwise` where nothing is.
    pub fn or(&self, otherwise: Checkpoints) -> Checkpoints {
        Checkpoints {
            every: self.checkpoint_every.unwrap_or(otherwise.every),
            keep: self.keep_checkpoints.unwrap_or(otherwise.keep),
        }
    }
}
