//! Runs scenes for a study: states to start from, pictures, and times of several grids side by side.

use std::io::Write as _;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec3, Vec3};
use image::RgbaImage;
use serde_json::json;

use super::Settings;
use super::measure::Effort;
use super::page::{Cell, Page, Table};
use crate::error::{Error, Result};
use crate::gpu::device::{Identity, Limits};
use crate::gpu::{AdapterChoice, Gpu};
use crate::neighbors::{ADDRESSINGS, STORAGES};
use crate::output::{columns_named, compose_picture, interrupt};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::model::View;
use crate::scene::{Neighbors, Particles, Scene};
use crate::simulation::Simulation;
use crate::simulation::frame::{Frame, Values};

/// The adapter that a study uses, and what it tells.
pub struct Bench {
    pub choice: AdapterChoice,
    pub limits: Limits,
    identity: Identity,
    software: bool,
    quiet: bool,
    /// What is under way.
    now: Arc<Mutex<String>>,
}

impl Bench {
    /// From now on the first Ctrl-C ends the study with what was finished.
    pub fn open(settings: &Settings) -> Result<Self> {
        Self::of(&settings.adapter, settings.quiet)
    }

    /// The same of an adapter.
    pub fn of(adapter: &AdapterChoice, quiet: bool) -> Result<Self> {
        let now: Arc<Mutex<String>> = Arc::default();
        let under_way = now.clone();
        interrupt::listen(move || {
            let now = under_way.lock().unwrap_or_else(PoisonError::into_inner);
            if !quiet {
                tell(&format!(
                    "stopping; finished parts are kept ({now}); {}",
                    interrupt::AGAIN
                ));
            }
        });
        let gpu = Gpu::open(adapter, false)?;
        Ok(Self {
            quiet,
            now,
            choice: adapter.clone(),
            limits: gpu.limits,
            identity: Identity::of(&gpu.adapter),
            software: gpu.is_software(),
        })
    }

    /// Tells on standard error what is under way.
    pub fn tell(&self, text: &str) {
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = text.to_owned();
        // What comes after Ctrl-C is left out.
        if !self.quiet && !interrupt::heeded() {
            tell(text);
        }
    }

    /// An error where work was left undone because of Ctrl-C.
    pub fn check(&self) -> Result<()> {
        match interrupt::heeded() {
            true => Err(Error::interrupted("")),
            false => Ok(()),
        }
    }

    /// The device anew; none after Ctrl-C.
    pub fn gpu(&self) -> Result<Gpu> {
        match interrupt::asked() {
            true => Err(Error::interrupted("")),
            false => Gpu::open(&self.choice, false),
        }
    }

    /// A simulation that gives up after Ctrl-C.
    pub fn with_plan(&self, gpu: Gpu, scene: &Scene, plan: &Plan) -> Result<Simulation> {
        let mut simulation = Simulation::new(gpu, scene, plan)?;
        simulation.stop_when(Some(interrupt::asked));
        Ok(simulation)
    }

    /// Name, kind and driver of the adapter, in one line.
    pub fn adapter(&self) -> String {
        let identity = &self.identity;
        format!(
            "{} ({}, {} {})",
            identity.name, identity.backend, identity.driver, identity.driver_info
        )
    }

    /// Says on the page what measured.
    pub fn environment(&self, page: &mut Page) {
        let identity = &self.identity;
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let mut table = Table::new(["measured on", ""]);
        let mut row = |name: &str, value: String| table.row([Cell::text(name), Cell::text(value)]);
        row(
            "adapter",
            format!("{} ({}, {})", identity.name, identity.kind, identity.backend),
        );
        row("driver", format!("{} {}", identity.driver, identity.driver_info));
        row("processor threads", threads.to_string());
        row("Sliceflow", env!("CARGO_PKG_VERSION").to_owned());
        row(
            "buffer that can be bound",
            crate::output::text::bytes(self.limits.binding),
        );
        page.table("environment", &table);
    }

    /// Says on the page what measured, and how.
    pub fn describe(&self, page: &mut Page, effort: Effort) {
        self.environment(page);
        let clock = if self.software {
            "A pass is timed by the processor's clock, submitted alone and waited for, since a software adapter's own \
             stamps do not wait for a pass's threads; that adds some hundredths of a millisecond to each pass."
        } else {
            "A pass is timed by the device's timestamps."
        };
        page.paragraph(format!(
            "Times are medians of {1}. In each round every grid of a table has its turn (from the first to the \
             last, then from the last to the first), so that whatever else the machine does hits all alike. A step's \
             time is the wall time of {0} steps at once, divided by their number; construction is the \
             sum of the search's passes, each timed alone. With neighbor lists (`+lists`, skin {2}) the passes of a search \
             count by the share of steps that search, and the last of {0} steps always does. Single rounds on a shared machine differ by a factor of two and more: compare within a table.",
            effort.steps,
            rounds(effort.rounds),
            Neighbors::default().skin
        ));
        page.paragraph(clock);
        page.value(
            "effort",
            json!({ "rounds": effort.rounds, "steps": effort.steps }),
        );
    }

    pub fn simulation(&self, scene: &Scene, wanted: &Wanted) -> Result<Simulation> {
        let gpu = self.gpu()?;
        let plan = Plan::new(scene, &gpu.limits, wanted)?;
        if let Some(why) = &plan.lists_left_out {
            self.tell(&format!("{}: {why}", scene.name));
        }
        self.with_plan(gpu, scene, &plan)
    }

    /// Runs a scene; `each` sees every frame's time (seconds) and particles (local coordinates, in order of id).
    pub fn run(&self, scene: &Scene, mut each: impl FnMut(f64, Particles)) -> Result<()> {
        let wanted = Wanted {
            columns: columns_named(["position", "velocity"])?,
            ..Default::default()
        };
        let mut simulation = self.simulation(scene, &wanted)?;
        let mut take = |frame: Frame| each(frame.time, particles(scene.origin, &frame));
        for _ in 0..scene.time.frames {
            if let Some(frame) = simulation.next_frame()? {
                take(frame);
            }
        }
        while let Some(frame) = simulation.finish_frame()? {
            take(frame);
        }
        Ok(())
    }

    /// The picture of a scene's frame `index`, counted from 0.
    pub fn picture(&self, scene: &Scene, view: View, index: u32) -> Result<Option<RgbaImage>> {
        let wanted = Wanted {
            statistics: true,
            view: Some(view),
            ..Default::default()
        };
        let mut simulation = self.simulation(scene, &wanted)?;
        let mut last = None;
        for _ in 0..=index {
            last = simulation.next_frame()?.or(last);
        }
        while let Some(frame) = simulation.finish_frame()? {
            last = Some(frame);
        }
        match last {
            Some(frame) => compose_picture(&frame, &Overlay::new(scene, view)?),
            None => Ok(None),
        }
    }
}

/// Names of all grids, `ADDRESSING-STORAGE`.
pub fn grid_names() -> Vec<String> {
    let storages = |addressing: &'static str| {
        STORAGES
            .iter()
            .map(move |storage| format!("{addressing}-{}", storage.name))
    };
    ADDRESSINGS.iter().flat_map(|row| storages(row.name)).collect()
}

/// The grids that are measured with neighbor lists too; the first one is what scenes get that do not choose.
pub const LISTED: [&str; 3] = [
    "sliced-counting+lists",
    "bitmap-counting+lists",
    "uniform-counting+lists",
];

/// All grids, and those with lists.
pub fn timed_names() -> Vec<String> {
    let listed = LISTED.iter().map(|&name| name.to_owned());
    grid_names().into_iter().chain(listed).collect()
}

/// Every addressing with a pool and with counting, and those with lists.
pub fn main_names() -> Vec<String> {
    let mut names = timed_names();
    names.retain(|name| !name.ends_with("-radix") && !name.ends_with("-bitonic"));
    names
}

/// `1 round`, `7 rounds`
pub fn rounds(count: u32) -> String {
    if count == 1 {
        "1 round".into()
    } else {
        format!("{count} rounds")
    }
}

fn tell(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// What an error says first, for a table.
pub fn first_line(error: &crate::error::Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

/// Pairs of a frame that brings the column `contacts`, each from both sides: particles in reach of each other, grains and
/// walls that touch.
pub fn pairs(frame: &Frame) -> u64 {
    let column = frame.columns.iter().find(|column| column.name == "contacts");
    match column.map(|column| &column.values) {
        Some(Values::Unsigned(counts)) => counts.iter().map(|&count| u64::from(count)).sum(),
        _ => 0,
    }
}

/// A frame's particles in local coordinates.
pub fn particles(origin: DVec3, frame: &Frame) -> Particles {
    let mut particles = Particles::default();
    for column in &frame.columns {
        match &column.values {
            Values::Double { columns, values } => {
                let point = |v: &[f64]| DVec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0)) - origin;
                particles.position = values
                    .chunks_exact(*columns)
                    .map(|v| point(v).as_vec3())
                    .collect();
            }
            Values::Vector { columns, values } => {
                let vector = |v: &[f32]| Vec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0));
                particles.velocity = values.chunks_exact(*columns).map(vector).collect();
            }
            Values::Float(_) | Values::Unsigned(_) => {}
        }
    }
    particles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grid_has_a_name() {
        let names = grid_names();
        assert_eq!(names.len(), ADDRESSINGS.len() * STORAGES.len());
        assert!(names.contains(&"sliced-pool".to_owned()));
        assert_eq!(main_names().len(), 2 * ADDRESSINGS.len() + LISTED.len());
    }
}
