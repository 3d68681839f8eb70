//! The one error type. Every message says what is wrong, where, and what to do next.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::guards::{Family, GuardKind};

pub type Result<T> = std::result::Result<T, Error>;

/// One thing wrong with a scene: where, what, and what helps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Place in the scene file, as a JSON path: `bodies[2].shape.radius`; empty for the whole file.
    pub path: String,
    pub what: String,
    pub help: String,
}

impl Problem {
    pub fn new(path: impl Into<String>, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            what: what.into(),
            help: help.into(),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = if self.path.is_empty() {
            "(whole scene)"
        } else {
            &self.path
        };
        write!(f, "{place}: {}\n    help: {}", self.what, self.help)
    }
}

/// What a guard found wrong in a run, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    pub guard: GuardKind,
    /// Of the solver whose particles they are.
    pub family: Family,
    /// Figures that belong to the likely cause.
    pub detail: String,
    /// The first frame behind it, which is not written.
    pub frame: u32,
    /// Steps since the run began.
    pub step: u64,
    /// Seconds of simulated time.
    pub time: f64,
    /// Length of the steps there, seconds.
    pub step_s: f64,
    /// What limited that length.
    pub step_limited_by: &'static str,
    /// The particle that went wrong, where the guard watches particles one by one.
    pub particle: Option<Caught>,
}

/// A particle that the device's guard caught. Of many in one step it is the same one in every run.
#[derive(Debug, Clone, PartialEq)]
pub struct Caught {
    pub id: u32,
    /// Metres, in the scene's own coordinates.
    pub position: [f64; 3],
    /// Metres per second.
    pub velocity: [f32; 3],
    /// Particles caught by the time the host looked.
    pub count: u32,
}

#[derive(Debug)]
pub enum Error {
    /// The scene file holds mistakes; all of them are listed.
    Scene { file: String, problems: Vec<Problem> },
    /// A file or folder could not be read or written.
    File {
        path: PathBuf,
        doing: &'static str,
        reason: String,
        help: String,
    },
    /// No adapter, no such adapter, or a lost device.
    Device { what: String, help: String },
    /// The scene needs more than the adapter has.
    Limit { what: String, help: String },
    /// A shader does not compile: a defect of Sliceflow, reported with the author's file and line.
    Shader { message: String },
    /// A guard stopped the simulation: it blew up, or soon would have.
    Guard(Box<Violation>),
    /// A run has used up what it may write, and can go on where it may write more.
    Budget { what: String, help: String },
    /// The command line asks for something that cannot be done.
    Usage { what: String, help: String },
    /// Two runs that were compared differ.
    Different,
    /// Two runs cannot be compared.
    Incomparable(Box<Error>),
    /// Ctrl-C; `kept` says what was finished.
    Interrupted { kept: String },
}

impl Error {
    pub fn file(
        path: &Path,
        doing: &'static str,
        reason: impl fmt::Display,
        help: impl Into<String>,
    ) -> Self {
        Self::File {
            path: path.to_owned(),
            doing,
            reason: reason.to_string(),
            help: help.into(),
        }
    }

    pub fn usage(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Usage {
            what: what.into(),
            help: help.into(),
        }
    }

    /// For what this build was made without: `what` says what is missing.
    pub fn absent(what: impl Into<String>) -> Self {
        Self::usage(
            what,
            "build all of Sliceflow with `cargo build --release`, or start it with ./sliceflow, which builds what it needs",
        )
    }

    pub fn device(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Device {
            what: what.into(),
            help: help.into(),
        }
    }

    pub fn interrupted(kept: impl Into<String>) -> Self {
        Self::Interrupted { kept: kept.into() }
    }

    /// Ctrl-C after so many frames.
    pub fn interrupted_after(frames: u32) -> Self {
        Self::interrupted(match frames {
            0 => "no frame was finished".to_owned(),
            1 => "one finished frame is on disk".to_owned(),
            _ => format!("{frames} finished frames are on disk"),
        })
    }

    /// Exit status of the program: 2 for what the user can correct in the input and for runs that cannot be compared, 130
    /// after Ctrl-C, 1 otherwise.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene { .. } | Self::Usage { .. } | Self::Incomparable(_) => 2,
            Self::Interrupted { .. } => 130,
            _ => 1,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene { file, problems } => {
                let s = if problems.len() == 1 { "" } else { "s" };
                write!(f, "{file}: {} problem{s} in the scene", problems.len())?;
                for problem in problems {
                    write!(f, "\n  {problem}")?;
                }
                Ok(())
            }
            Self::File {
                path,
                doing,
                reason,
                help,
            } => {
                write!(f, "cannot {doing} {}: {reason}\n  help: {help}", path.display())
            }
            Self::Device { what, help }
            | Self::Limit { what, help }
            | Self::Budget { what, help }
            | Self::Usage { what, help } => {
                write!(f, "{what}\n  help: {help}")
            }
            Self::Shader { message } => write!(
                f,
                "a shader of Sliceflow does not compile; this is a defect, please report it\n{message}"
            ),
            Self::Guard(violation) => write!(f, "{violation}\n  what was written before stays"),
            Self::Different => write!(f, "the runs differ"),
            Self::Incomparable(reason) => reason.fmt(f),
            Self::Interrupted { kept } if kept.is_empty() => write!(f, "interrupted"),
            Self::Interrupted { kept } => write!(f, "interrupted; {kept}"),
        }
    }
}

impl Violation {
    pub fn what(&self) -> &'static str {
        self.guard.row().what
    }

    pub fn likely_cause(&self) -> String {
        format!("{} ({})", self.guard.row().cause, self.detail)
    }

    /// What to change.
    pub fn help(&self) -> &'static str {
        self.guard.row().help(self.family)
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} at frame {}, step {}, t = {:.6} s",
            self.what(),
            self.frame,
            self.step,
            self.time
        )?;
        if let Some(caught) = &self.particle {
            let [x, y, z] = caught.position;
            let [u, v, w] = caught.velocity;
            write!(
                f,
                ": particle {} at ({x:.6}, {y:.6}, {z:.6}) m with velocity ({u:.4}, {v:.4}, {w:.4}) m/s; {} such \
                 accidents until the frame ended",
                caught.id, caught.count
            )?;
        }
        write!(
            f,
            "\n  likely cause: {}\n  help: {}",
            self.likely_cause(),
            self.help()
        )
    }
}

impl std::error::Error for Error {}
