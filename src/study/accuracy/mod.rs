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
pub mod spread;
pub mod theory;
pub mod work_precision;

use std::path::PathBuf;

use super::bench::Bench;
use super::page::Page;
use super::{Settings, parts};
use crate::error::{Error, Result};
use crate::output::interrupt;
use cases::Case;
use record::Record;

/// Runs cases and writes the page.
pub fn accuracy(settings: &Settings) -> Result<PathBuf> {
    let cases = cases::named(&settings.cases)?;
    if settings.resolutions.contains(&0) {
        return Err(Error::usage(
            "a resolution of 0",
            "give 1 or more with --resolution",
        ));
    }
    let mut page = Page::create(
        &settings.folder,
        "accuracy",
        "Accuracy: Sliceflow against theory and experiment",
        settings.force,
    )?;
    let bench = Bench::open(settings)?;
    let begin = page.mark();
    let mut records = Vec::new();
    let mut path = PathBuf::new();
    for (number, case) in cases.iter().enumerate() {
        let ran = run_case(&bench, settings, case, &mut records);
        page.back_to(begin);
        // A case that was interrupted is shown as far as it came.
        let shown = number + usize::from(records.iter().any(|record| record.case == case.name));
        if shown > 0 {
            page::write(&mut page, &cases[..shown], &records)?;
        }
        let finished = number + usize::from(ran.is_ok());
        let is_last = number + 1 == cases.len();
        match ran {
            Ok(()) if is_last || !interrupt::asked() => path = page.save()?,
            stopped => {
                let error = stopped.err().unwrap_or(Error::interrupted(""));
                let names: Vec<_> = cases.iter().map(|case| case.name).collect();
                // Finished resolutions of the first case are worth a page too.
                let done = &names[..finished.max(shown)];
                return Err(parts::keep(page, done, &names[finished..], error, |_| {}));
            }
        }
    }
    Ok(path)
}

/// Runs a case at all of its resolutions; those that were finished are among the records when it fails.
fn run_case(bench: &Bench, settings: &Settings, case: &Case, records: &mut Vec<Record>) -> Result<()> {
    let resolutions = match &settings.resolutions[..] {
        [] => (case.resolutions)(settings.size),
        given => given,
    };
    for &resolution in resolutions {
        for record in (case.run)(bench, settings.size, resolution)? {
            for figure in record.figures.iter().filter(|figure| figure.name == case.figure) {
                bench.tell(&page::line(case, &record, figure));
            }
            records.push(record);
        }
    }
    Ok(())
}
