//! Commands that this build was made without: they are there, take any arguments and say how to get them.

#[cfg(not(feature = "study"))]
pub mod study {
    use crate::error::{Error, Result};

    /// Measures what papers measured, errors against theory, or what solvers endure (not in this build)
    #[derive(clap::Args)]
    #[command(after_help = "Example, once it is built:\n  sliceflow study harada")]
    pub struct Args {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
        _any: Vec<std::ffi::OsString>,
    }

    pub fn main(_args: &Args) -> Result<()> {
        Err(Error::absent("this build has no studies"))
    }
}

#[cfg(not(feature = "study"))]
pub mod bench {
    use crate::error::{Error, Result};

    /// Measures how fast this machine computes a fixed set of scenes (not in this build)
    #[derive(clap::Args)]
    #[command(after_help = "Example, once it is built:\n  sliceflow bench --quick")]
    pub struct Args {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
        _any: Vec<std::ffi::OsString>,
    }

    pub fn main(_args: &Args) -> Result<()> {
        Err(Error::absent("this build has no benchmarks"))
    }
}

#[cfg(not(feature = "surface"))]
pub mod surface {
    use crate::error::{Error, Result};

    /// Turns a run's particles into surfaces, a mesh a frame (not in this build)
    #[derive(clap::Args)]
    #[command(after_help = "Example, once it is built:\n  sliceflow surface out/bunny")]
    pub struct Args {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
        _any: Vec<std::ffi::OsString>,
    }

    pub fn main(_args: &Args) -> Result<()> {
        Err(Error::absent("this build makes no surfaces"))
    }
}
