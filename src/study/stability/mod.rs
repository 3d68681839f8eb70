//! `sliceflow study stability`: how long steps may be, and what long runs and hard cases do to each solver.

mod arrangements;
mod endurance;
mod guards;
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
use trial::{Outcome, Trouble};

pub struct Scale {
    /// Halvings of the interval in which the longest stable step lies.
    halvings: u32,
    /// Simulated seconds of a dam that must not gain energy.
    dam_seconds: f64,
    /// Steps of still water and of a resting pile.
    long: u32,
    /// Steps of each hard case.
    short: u32,
    /// Particles of the scenes that guards are timed in, and turns.
    timed: (u32, u32),
}

fn scale(size: Size) -> Scale {
    let (halvings, dam_seconds, long, short, timed) = match size {
        Size::Tiny => (3, 0.03, 100, 100, (500, 2)),
        Size::Small => (7, 0.4, 2000, 500, (4096, 100)),
        Size::Full => (10, 1.0, 10_000, 2000, (65_536, 40)),
    };
    Scale {
        halvings,
        dam_seconds,
        long,
        short,
        timed,
    }
}

/// What did not meet its bound, in the order in which it was found.
#[derive(Default)]
pub struct Failures {
    /// What a guard stopped.
    stopped: Vec<String>,
    /// What went wrong in silence.
    silent: Vec<String>,
}

impl Failures {
    /// A cell that says how it went; what did not hold is kept.
    fn verdict(&mut self, name: &str, outcome: &Outcome) -> Cell {
        match outcome {
            Ok(()) => Cell::text("holds"),
            Err(Trouble::Stopped(why)) => {
                self.stopped.push(format!("{name}: {why}"));
                Cell::text(format!("stopped by {why}"))
            }
            Err(Trouble::Wrong(why)) => {
                self.silent.push(format!("{name}: {why}"));
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
        self.failures.stopped.extend(own.stopped);
        self.failures.silent.extend(own.silent);
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
    Part {
        name: "guards",
        run: |page, bench, shared| guards::cost(page, bench, &shared.scale),
    },
];

pub fn stability(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("stability", PARTS, &settings.cases)?;
    let title = "What each solver endures";
    let mut page = Page::create(&settings.folder, "stability", title, settings.force)?;
    let bench = Bench::open(settings)?;
    page.paragraph(
        "Small 2D scenes: the longest stable time step beside theory, long rests, hard cases, and what guards cost. \
         Everything that does not hold its bound is listed at the end: what a guard stopped, with its word, and what nothing \
         told of.",
    );
    bench.environment(&mut page);
    let mut shared = Shared {
        scale: scale(settings.size),
        failures: Failures::default(),
    };
    parts::run(page, &bench, &mut shared, &parts, |page, shared| {
        let Failures { stopped, silent } = &shared.failures;
        for (heading, key, cases) in [
            ("What guards stop", "stopped", stopped),
            ("What fails without a word", "failing", silent),
        ] {
            page.heading(heading);
            if cases.is_empty() {
                page.paragraph("Nothing that was tried here.");
            }
            for case in cases {
                page.paragraph(format!("- {case}"));
            }
            page.value(key, cases.clone());
        }
    })
}
