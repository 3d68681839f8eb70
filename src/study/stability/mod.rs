//! `sliceflow study stability`: how long steps may be, and what long runs and hard cases do to each solver.

mod arrangements;
mod endurance;
mod hard;
mod methods;
mod steps;
mod theory;
mod trial;

use std::path::PathBuf;

use super::bench::Bench;
use super::page::{Cell, Page};
use super::parts::{self, Part};
use super::{Settings, Size};
use crate::error::Result;

pub struct Scale {
    /// Halvings of the interval in which the longest stable step lies.
    halvings: u32,
    /// Simulated seconds of a dam that must not gain energy.
    dam_seconds: f64,
    /// Steps of still water and of a resting pile.
    long: u32,
    /// Steps of each hard case.
    short: u32,
}

fn scale(size: Size) -> Scale {
    let (halvings, dam_seconds, long, short) = match size {
        Size::Tiny => (3, 0.03, 100, 100),
        Size::Small => (7, 0.4, 2000, 500),
        Size::Full => (10, 1.0, 10_000, 2000),
    };
    Scale {
        halvings,
        dam_seconds,
        long,
        short,
    }
}

/// What did not meet its bound, in the order in which it was found.
#[derive(Default)]
pub struct Failures(Vec<String>);

impl Failures {
    /// A cell that says how it went; what failed is kept.
    fn verdict(&mut self, name: &str, outcome: &std::result::Result<(), String>) -> Cell {
        match outcome {
            Ok(()) => Cell::text("holds"),
            Err(why) => {
                self.0.push(format!("{name}: {why}"));
                Cell::text(format!("fails: {why}"))
            }
        }
    }
}

/// What parts share.
pub struct Shared {
    scale: Scale,
    /// Of the parts that were finished.
    failures: Failures,
}

impl Shared {
    /// Runs a part that judges; what it found counts when it was finished.
    fn judge(
        &mut self,
        page: &mut Page,
        bench: &Bench,
        part: fn(&mut Page, &Bench, &Scale, &mut Failures) -> Result<()>,
    ) -> Result<()> {
        let mut own = Failures::default();
        part(page, bench, &self.scale, &mut own)?;
        bench.check()?;
        self.failures.0.extend(own.0);
        Ok(())
    }
}

pub const PARTS: &[Part<Shared>] = &[
    Part {
        name: "steps",
        run: |page, bench, shared| steps::longest(page, bench, &shared.scale),
    },
    Part {
        name: "rests",
        run: |page, bench, shared| shared.judge(page, bench, endurance::rests),
    },
    Part {
        name: "hard_cases",
        run: |page, bench, shared| shared.judge(page, bench, hard::cases),
    },
];

pub fn stability(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("stability", PARTS, &settings.cases)?;
    let title = "What each solver endures";
    let mut page = Page::create(&settings.folder, "stability", title, settings.force)?;
    let bench = Bench::open(settings)?;
    page.paragraph(
        "Small 2D scenes: the longest stable time step beside theory, long rests, and hard cases. Everything that does \
         not hold its bound is listed at the end.",
    );
    bench.environment(&mut page);
    let mut shared = Shared {
        scale: scale(settings.size),
        failures: Failures::default(),
    };
    parts::run(page, &bench, &mut shared, &parts, |page, shared| {
        page.heading("What fails");
        match &shared.failures.0[..] {
            [] => page.paragraph("Nothing that was tried here."),
            failed => {
                for one in failed {
                    page.paragraph(format!("- {one}"));
                }
            }
        }
        page.value("failing", shared.failures.0.clone());
    })
}
