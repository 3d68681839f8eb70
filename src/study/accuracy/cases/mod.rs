//! What is measured: a row of the table [`CASES`] for each case.

pub(in crate::study) mod channel;
mod collision;
pub mod columns;
pub mod dem;
mod elliptical_drop;
mod fastest_particle;
mod fluid;
mod gas;
mod lid_cavity;
pub(in crate::study) mod lobovsky_dam;
pub(in crate::study) mod martin_moyce;
mod rotating_square;
mod spheric_2;
mod standing_wave;
pub(in crate::study) mod still_water;
mod taylor_couette;
pub(in crate::study) mod taylor_green_2d;
mod taylor_green_3d;

use super::published::Published;
use super::record::Record;
use crate::error::Result;
use crate::study::bench::Bench;
use crate::study::{Size, parts};

/// One case, which runs at several resolutions.
#[derive(Clone, Copy)]
pub struct Case {
    /// For `--case`.
    pub name: &'static str,
    pub title: &'static str,
    /// For the page: truth, set-up, measure, sources.
    pub about: &'static str,
    /// What a resolution counts: `particles across`.
    pub resolution: &'static str,
    /// A resolution in words: `100²`.
    pub label: fn(u32) -> String,
    pub resolutions: fn(Size) -> &'static [u32],
    /// Name of the figure that diagrams show.
    pub figure: &'static str,
    pub published: &'static [Published],
    /// All methods at one resolution.
    pub run: fn(&Bench, Size, u32) -> Result<Vec<Record>>,
}

pub const CASES: &[Case] = &[
    taylor_green_2d::CASE,
    channel::POISEUILLE,
    channel::COUETTE,
    still_water::CASE,
    taylor_couette::CASE,
    lid_cavity::RE_100,
    lid_cavity::RE_400,
    martin_moyce::CASE,
    lobovsky_dam::CASE,
    taylor_green_3d::CASE,
    spheric_2::CASE,
    rotating_square::CASE,
    elliptical_drop::CASE,
    standing_wave::CASE,
    fastest_particle::CASE,
    collision::CASE,
    gas::CASE,
];

/// The cases of these names, all where none is named.
pub fn named(names: &[String]) -> Result<Vec<&'static Case>> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let find = |name: &String| {
        CASES.iter().find(|case| case.name == name).ok_or_else(|| {
            let known: Vec<_> = CASES.iter().map(|case| case.name).collect();
            parts::unknown("accuracy", name, &known)
        })
    };
    names.iter().map(find).collect()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::study::accuracy::published;

    /// A case that never runs.
    pub fn vortices() -> Case {
        Case {
            name: "vortices",
            title: "Taylor–Green vortices, Re 100",
            about: "Vortices decay.",
            resolution: "particles across",
            label: |n| format!("{n}²"),
            resolutions: |_| &[25, 50, 100],
            figure: "L1 of speed",
            published: published::TAYLOR_GREEN,
            run: |_, _, _| Ok(Vec::new()),
        }
    }

    #[test]
    fn cases_are_found_by_name() {
        assert_eq!(named(&[]).unwrap().len(), CASES.len());
        assert_eq!(named(&["gas".into()]).unwrap()[0].name, "gas");
        let told = named(&["cavity7".into()]).map(|_| ()).unwrap_err();
        assert_eq!(told.exit_code(), 2);
        assert!(told.to_string().contains("collision"), "{told}");
    }

    #[test]
    fn names_are_unique_and_larger_studies_hold_more() {
        for case in CASES {
            assert_eq!(CASES.iter().filter(|other| other.name == case.name).count(), 1);
            let [tiny, small, full] = [Size::Tiny, Size::Small, Size::Full].map(case.resolutions);
            assert!(!tiny.is_empty() && tiny.len() <= small.len() && small.len() <= full.len());
        }
    }
}
