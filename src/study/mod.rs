//! Studies, on one page each: what the papers measured, measured again; errors against theory and experiment; what
//! solvers endure.

pub mod accuracy;
mod bench;
mod cpu_grid;
mod grains;
mod green;
mod harada;
pub(crate) mod measure;
mod page;
mod parts;
mod rojas;
mod scenes;
mod speed_error;
mod stability;
pub mod suite;

use std::path::PathBuf;

use crate::error::Result;
use crate::gpu::AdapterChoice;

/// A study. To add one: a row of [`STUDIES`].
pub struct Study {
    /// What `sliceflow study NAME` takes.
    pub name: &'static str,
    pub about: &'static str,
    /// Names of the parts that can be run alone.
    pub cases: fn() -> Vec<&'static str>,
    /// Gives the path of the page.
    pub run: fn(&Settings) -> Result<PathBuf>,
}

pub const STUDIES: &[Study] = &[
    Study {
        name: "harada",
        about: "Harada 2007: the sliced grid's memory and times",
        cases: || parts::names(harada::PARTS),
        run: harada::harada,
    },
    Study {
        name: "green",
        about: "Green 2012: atomics, scan and sort",
        cases: || parts::names(green::PARTS),
        run: green::green,
    },
    Study {
        name: "accuracy",
        about: "Errors against theory and experiment, beside what they cost",
        cases: || accuracy::cases::CASES.iter().map(|case| case.name).collect(),
        run: accuracy::accuracy,
    },
    Study {
        name: "speed-error",
        about: "Wall time against error of both solvers, and what each other choice costs",
        cases: || parts::names(speed_error::PARTS),
        run: speed_error::speed_error,
    },
    Study {
        name: "grains",
        about: "Grains that rotate and rub against closed forms; heaps of them",
        cases: || parts::names(grains::PARTS),
        run: grains::grains,
    },
    Study {
        name: "rojas",
        about: "Rojas 2013: real-time ratio of a dam break",
        cases: || parts::names(rojas::PARTS),
        run: rojas::rojas,
    },
    Study {
        name: "stability",
        about: "Longest stable steps, long rests and hard cases of every solver",
        cases: || parts::names(stability::PARTS),
        run: stability::stability,
    },
];

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Seconds; for tests.
    Tiny,
    /// Minutes on two cores.
    Small,
    /// The papers' own sizes.
    Full,
}

/// What a study is asked for.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Names of the parts to run; all where there is none.
    pub cases: Vec<String>,
    /// Of `accuracy`, as each case counts it; the case's own where there is none.
    pub resolutions: Vec<u32>,
    pub size: Size,
    pub folder: PathBuf,
    /// Of `speed-error`: Pythons that have other programs, to run those beside.
    pub peers: Vec<PathBuf>,
    /// Replaces an earlier study.
    pub force: bool,
    pub adapter: AdapterChoice,
    /// Whether nothing is told on the way.
    pub quiet: bool,
}
