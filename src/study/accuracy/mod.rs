//! `sliceflow study accuracy`: cases with a known truth, the error of each, and what it costs.
//!
//! To add a case: a file in `src/study/accuracy/cases/` with a [`cases::Case`], and its row in [`cases::CASES`]. It runs
//! scenes with [`run::run`], compares frames with [`theory`] or with a table of [`reference`] through [`norms`],
//! [`series`] and [`sampler`], and hands back [`record::Record`]s.

pub mod cases;
mod least_squares;
pub mod norms;
mod page;
pub mod published;
pub mod record;
pub mod reference;
pub mod run;
pub mod sampler;
pub mod series;
pub mod theory;
pub mod work_precision;

use std::path::PathBuf;

use super::Settings;
use super::bench::{Bench, progress};
use super::page::Page;
use crate::error::{Error, Result};

/// Which cases run, and how fine.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Choice {
    /// Names; all cases where there is none.
    pub cases: Vec<String>,
    /// As each case counts it; the case's own where there is none.
    pub resolutions: Vec<u32>,
}

/// Runs cases and writes the page.
pub fn accuracy(settings: &Settings, choice: &Choice) -> Result<PathBuf> {
    let cases = cases::named(&choice.cases)?;
    if choice.resolutions.contains(&0) {
        return Err(Error::usage(
            "a resolution of 0",
            "give 1 or more with --resolution",
        ));
    }
    let page = Page::create(
        &settings.folder,
        "accuracy",
        "Accuracy: Sliceflow against theory and experiment",
        settings.force,
    )?;
    let bench = Bench::open(&settings.adapter)?;
    let mut records = Vec::new();
    for case in &cases {
        let own = (case.resolutions)(settings.size);
        let resolutions = if choice.resolutions.is_empty() {
            own
        } else {
            &choice.resolutions
        };
        for &resolution in resolutions {
            for record in (case.run)(&bench, settings.size, resolution)? {
                for figure in record.figures.iter().filter(|figure| figure.name == case.figure) {
                    progress(&page::line(case, &record, figure));
                }
                records.push(record);
            }
        }
    }
    page::write(page, &cases, &records)
}
