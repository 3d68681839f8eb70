//! Arguments for recordings that the Rerun viewer shows.

use std::path::PathBuf;

use super::scene_args::bytes;
use crate::output::rerun::{Settings, Target};

/// Where a viewer on this machine listens.
const VIEWER_HERE: &str = "127.0.0.1:9876";
const HEADING: &str = "Rerun (https://rerun.io)";

#[derive(clap::Args)]
pub struct RerunArgs {
    /// Records the run into a file that the Rerun viewer opens
    #[arg(long, value_name = "FILE.rrd", value_parser = recording, help_heading = HEADING)]
    rerun: Option<PathBuf>,
    /// Sends the run to a viewer that listens [default ADDR: 127.0.0.1:9876]
    #[arg(long, value_name = "ADDR", num_args = 0..=1, default_missing_value = VIEWER_HERE, value_parser = address, help_heading = HEADING)]
    rerun_connect: Option<String>,
    /// Starts a viewer with a window and sends the run to it (needs `rerun`, from `pip install rerun-sdk`)
    #[arg(long, conflicts_with = "rerun_serve", help_heading = HEADING)]
    rerun_spawn: bool,
    /// Shows the run to browsers on this machine, until Ctrl-C (needs `rerun`, from `pip install rerun-sdk`)
    #[arg(long, help_heading = HEADING)]
    rerun_serve: bool,
    /// Most bytes of a recording; where more is there, fewer particles, pictures and frames are recorded, and a note says so
    #[arg(long, value_name = "SIZE", default_value = "500MB", value_parser = bytes, help_heading = HEADING)]
    rerun_budget: u64,
}

impl RerunArgs {
    /// `None` where nobody wants a recording.
    pub fn settings(&self) -> Option<Settings> {
        let mut targets = Vec::new();
        targets.extend(self.rerun.clone().map(Target::File));
        targets.extend(self.rerun_connect.clone().map(Target::Viewer));
        targets.extend(self.rerun_spawn.then_some(Target::Spawn));
        targets.extend(self.rerun_serve.then_some(Target::Serve));
        (!targets.is_empty()).then_some(Settings {
            targets,
            budget: self.rerun_budget,
        })
    }
}

fn recording(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(ending) if ending == "rrd" => Ok(path),
        _ => Err("recordings end in .rrd: out/run.rrd".into()),
    }
}

/// HOST:PORT, also out of the address that viewers print (`rerun+http://HOST:PORT/proxy`).
fn address(text: &str) -> Result<String, String> {
    let inner = text.strip_prefix("rerun+http://").unwrap_or(text);
    let inner = inner.strip_suffix("/proxy").unwrap_or(inner);
    match inner.rsplit_once(':') {
        Some((host, port)) if !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0) => {
            Ok(inner.to_owned())
        }
        _ => Err(format!(
            "write HOST:PORT, as in {VIEWER_HERE}; give the scene before this flag"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses() {
        for given in ["127.0.0.1:9876", "rerun+http://127.0.0.1:9876/proxy"] {
            assert_eq!(address(given), Ok("127.0.0.1:9876".into()));
        }
        for wrong in ["green_cube", "localhost", ":9876", "here:0", "here:big"] {
            assert!(address(wrong).is_err(), "{wrong}");
        }
        assert!(recording("out/run.rrd").is_ok() && recording("green_cube").is_err());
    }
}
