//! Arguments for recordings that the Rerun viewer shows.

use std::path::PathBuf;

use crate::output::rerun::{DEFAULT_BUDGET, Settings, Target};

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
    #[arg(long, value_name = "SIZE", default_value = "500MB", value_parser = size, help_heading = HEADING)]
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

/// A number of bytes with a unit: 500MB, 2 GB, 64MiB.
fn size(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let unit_at = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_at);
    let factor = match unit.to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "kb" | "k" => 1e3,
        "mb" | "m" => 1e6,
        "gb" | "g" => 1e9,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => return Err("units are kB, MB, GB, KiB, MiB and GiB: 500MB".into()),
    };
    match number.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number * factor < 1e15 => Ok((number * factor) as u64),
        _ => Err(format!("write a size, as in {}MB", DEFAULT_BUDGET / 1_000_000)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("500MB"), Ok(DEFAULT_BUDGET));
        assert_eq!(size("2 GB"), Ok(2_000_000_000));
        assert_eq!(size("1.5MiB"), Ok(1_572_864));
        assert_eq!(size("4096"), Ok(4096));
        for wrong in ["", "MB", "0", "-1MB", "5 apples", "1e99"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

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
