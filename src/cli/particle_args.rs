//! Arguments that ask for particle files.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser as _};

use crate::error::Result;
use crate::output::{DEFAULT_COLUMNS, PARTICLE_FORMATS, ParticleFormat, ParticleOutput, columns_named};

#[derive(clap::Args)]
pub struct ParticleArgs {
    /// Writes particle files in these formats
    #[arg(
        long,
        value_name = "FORMAT,…",
        value_delimiter = ',',
        value_parser = PossibleValuesParser::new(PARTICLE_FORMATS.iter().map(|f| PossibleValue::new(f.name).help(f.about)))
            .map(format),
    )]
    particles: Vec<&'static ParticleFormat>,
    /// Of frames 0, 1, 2, … every N-th gets particle files
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..),
        requires = "particles",
    )]
    particles_every: u32,
    /// Columns of particle files (see `sliceflow scenes --columns`); files of points hold positions in any case
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', requires = "particles")]
    columns: Vec<String>,
}

impl ParticleArgs {
    /// `None` where no files are asked for.
    pub fn output(&self) -> Result<Option<ParticleOutput>> {
        if self.particles.is_empty() {
            return Ok(None);
        }
        let columns = if self.columns.is_empty() {
            columns_named(DEFAULT_COLUMNS.iter().copied())?
        } else {
            columns_named(self.columns.iter().map(|name| name.trim()))?
        };
        let mut formats: Vec<&ParticleFormat> = Vec::new();
        for format in &self.particles {
            if !formats.iter().any(|known| known.name == format.name) {
                formats.push(format);
            }
        }
        Ok(Some(ParticleOutput::new(formats, columns, self.particles_every)))
    }
}

/// The row of a name that clap has found among them.
fn format(name: String) -> &'static ParticleFormat {
    PARTICLE_FORMATS
        .iter()
        .find(|format| format.name == name)
        .expect("one of the possible values")
}
