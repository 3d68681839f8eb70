//! Sessions for the Rerun viewer (<https://rerun.io>): a run as a recording that one can turn, scrub and plot.
//!
//! The cargo feature `rerun`, on by default, brings the library; without it these settings are refused.

#[cfg(not(feature = "rerun"))]
mod absent;
#[cfg(feature = "rerun")]
mod blueprint;
#[cfg(feature = "rerun")]
mod budget;
#[cfg(feature = "rerun")]
mod camera;
#[cfg(feature = "rerun")]
mod events;
#[cfg(feature = "rerun")]
mod file;
#[cfg(feature = "rerun")]
mod frames;
#[cfg(feature = "rerun")]
mod present;
#[cfg(feature = "rerun")]
mod sensors;
#[cfg(feature = "rerun")]
mod series;
#[cfg(feature = "rerun")]
mod server;
#[cfg(feature = "rerun")]
mod session;
#[cfg(feature = "rerun")]
mod statics;
#[cfg(feature = "rerun")]
mod target;

use std::fmt;
use std::path::{Path, PathBuf};

use super::manifest::Files;

/// Viewers and servers listen to this machine alone.
pub const LOCALHOST: &str = "127.0.0.1";
/// Where viewers listen for recordings.
pub const GRPC_PORT: u16 = 9876;
/// Where browsers find the viewer.
pub const WEB_PORT: u16 = 9090;
/// Bytes of a recording, at most, unless the user says otherwise.
pub const DEFAULT_BUDGET: u64 = 500_000_000;

/// Recordings that a run makes.
#[derive(Debug, Clone)]
pub struct Settings {
    pub targets: Vec<Target>,
    /// Bytes of each recording, at most.
    pub budget: u64,
}

/// Where a recording goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// An `.rrd` file.
    File(PathBuf),
    /// A viewer that listens at HOST:PORT.
    Viewer(String),
    /// A viewer with a window on this machine, which is started.
    Spawn,
    /// A server with a viewer for browsers on this machine, which is started and ends with the run.
    Serve,
}

impl Settings {
    /// For the manifest.
    pub fn files(&self) -> impl Iterator<Item = Files> {
        self.targets.iter().filter_map(|target| match target {
            Target::File(path) => Some(Files {
                name: path.display().to_string(),
                about: "recording for the Rerun viewer".into(),
            }),
            _ => None,
        })
    }

    /// For a run that begins with frame `frame`: nothing can be appended to a recording, so the rest goes into a file of
    /// its own, `NAME_from_FRAME.rrd`, in the folder that `folder_of` says for a path.
    pub fn part_from(&self, frame: u32, folder_of: impl Fn(&Path) -> PathBuf) -> Self {
        let part = |target: &Target| match target {
            Target::File(path) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                Target::File(folder_of(path).join(format!("{name}_from_{frame}.rrd")))
            }
            other => other.clone(),
        };
        Self {
            targets: self.targets.iter().map(part).collect(),
            budget: self.budget,
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Viewer(address) => write!(f, "the Rerun viewer at {address}"),
            Self::Spawn => write!(f, "the Rerun viewer"),
            Self::Serve => write!(f, "the Rerun server"),
        }
    }
}
