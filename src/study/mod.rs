//! Studies, on one page each: what the papers measured, measured again; errors against theory and experiment; what
//! solvers endure.

pub mod accuracy;
mod bench;
mod cpu_grid;
mod green;
mod harada;
pub(crate) mod measure;
mod page;
mod rojas;
mod scenes;
mod stability;

use std::path::PathBuf;

pub use accuracy::accuracy;
pub use green::green;
pub use harada::harada;
pub use rojas::rojas;
pub use stability::stability;

use crate::gpu::AdapterChoice;

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

/// What a study is told.
#[derive(Debug, Clone)]
pub struct Settings {
    pub size: Size,
    pub folder: PathBuf,
    /// Replaces an earlier study.
    pub force: bool,
    pub adapter: AdapterChoice,
}
