//! Arguments of the commands that make frames.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::device_args::DeviceArgs;
use super::quiet_args::QuietArgs;
use crate::error::{Error, Result};
use crate::gpu::AdapterChoice;
use crate::output::{OnInstability, Outputs, Settings, progress};

#[derive(clap::Args)]
pub struct SittingArgs {
    #[command(flatten)]
    device: DeviceArgs,
    /// How progress is shown
    #[arg(long, value_name = "STYLE", default_value = "bar", conflicts_with = "quiet")]
    progress: progress::Style,
    #[command(flatten)]
    quiet: QuietArgs,
}

impl SittingArgs {
    pub fn adapter(&self) -> AdapterChoice {
        self.device.adapter()
    }

    pub fn settings(
        &self,
        folder: PathBuf,
        force: bool,
        outputs: Outputs,
        timings: bool,
    ) -> Result<Settings> {
        Ok(Settings {
            folder,
            force,
            outputs,
            timings,
            adapter: self.adapter(),
            on_instability: OnInstability::default(),
            max_disk: None,
            progress: self.quiet.style(self.progress),
            command_line: command_line()?,
        })
    }
}

/// The program's arguments, which the record of a run keeps.
fn command_line() -> Result<Vec<String>> {
    let text = |argument: OsString| {
        argument.into_string().map_err(|other| {
            Error::usage(
                format!("the argument {other:?} is not UTF-8 text, which the run's record needs"),
                "rename that file or folder, or give a path to it that is text",
            )
        })
    };
    std::env::args_os().map(text).collect()
}

/// The folder RUN_SUFFIX beside a run's.
pub fn beside(run: &Path, suffix: &str) -> Result<PathBuf> {
    let name = run.file_name().ok_or_else(|| {
        Error::usage(
            format!("{} has no name to call the new folder after", run.display()),
            "give a folder with --out",
        )
    })?;
    Ok(run.with_file_name(format!("{}_{suffix}", name.to_string_lossy())))
}
