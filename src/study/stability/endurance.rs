//! Still water and a resting pile over many steps.

use super::methods::{Method, SPACING, block, with_fixed_steps};
use super::trial::{Outcome, Trial, Trouble, lost, run};
use super::{Failures, Scale};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::output::text::count;
use crate::scene::Scene;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table, shown};

/// Intervals of a run; what happens in the first two of them is settling.
const INTERVALS: u32 = 20;
const SETTLED: usize = 2;
/// Particles of the water and of the pile, upwards.
const ROWS: u32 = 16;

/// Bounds: speed at the end over √(g H), center of mass and density over the settled part of the run.
const FASTEST: f64 = 0.02;
const LARGEST_DRIFT: f64 = 0.01;
const LARGEST_DENSITY_ERROR: f64 = 0.03;

pub fn rests(page: &mut Page, bench: &Bench, scale: &Scale, failures: &mut Failures) -> Result<()> {
    page.heading("Long rests");
    page.paragraph(format!(
        "Still water (between boundary particles, artificial viscosity 0.05) and a block of grains on the floor, {} steps \
         each, {ROWS} particles deep (H). The first tenth of a run is settling. It holds where nothing is lost, the \
         fastest particle at the end has at most {} √(g H), the center of mass has moved by at most {} H, and a \
         fluid's mean density is off by at most {} at the end.",
        count(scale.long.into()),
        shown(FASTEST),
        shown(LARGEST_DRIFT),
        shown(LARGEST_DENSITY_ERROR),
    ));
    let mut table = Table::new([
        "solver",
        "steps",
        "time step, µs",
        "kinetic energy, settled, J",
        "kinetic energy, end, J",
        "fastest over √(g H)",
        "center of mass, drift over H",
        "mean density error, settled",
        "mean density error, end",
        "lost",
        "verdict",
    ]);
    let mut chart = Plot::new("Kinetic energy at rest", "time, s", "kinetic energy, J").log_y();
    for method in with_fixed_steps() {
        bench.tell(&format!(
            "stability: {} rests for {} steps",
            method.name,
            count(scale.long.into())
        ));
        let scene = resting(method)?;
        let name = format!("{} at rest", method.name);
        let trial = match run(bench, &scene, scale.long.div_ceil(INTERVALS), INTERVALS)? {
            Ok(trial) => trial,
            Err(why) => {
                let mut row = vec![Cell::text(method.name)];
                row.resize(10, Cell::Nothing);
                row.push(failures.verdict(&name, &Err(why)));
                table.row(row);
                continue;
            }
        };
        let seen = Seen::of(&scene, &trial);
        let (settled, end) = (&trial.moments[SETTLED].figures, &seen.end.figures);
        let density = |figures: &crate::simulation::Statistics| {
            Cell::maybe(figures.density_error.map(|[mean, _]| mean))
        };
        table.row([
            Cell::text(method.name),
            Cell::count(scale.long.into()),
            Cell::number(scene.time.step * 1e6),
            Cell::number(settled.kinetic_energy),
            Cell::number(end.kinetic_energy),
            Cell::number(seen.speed),
            Cell::number(seen.drift),
            density(settled),
            density(end),
            Cell::count(seen.lost as u64),
            failures.verdict(&name, &seen.verdict()),
        ]);
        chart = chart.series(
            method.name,
            trial.moments.iter().map(|m| (m.time, m.figures.kinetic_energy)),
        );
    }
    page.table("rests", &table);
    page.picture("stability_rests.png", "Kinetic energy over time.", |path| {
        chart.save(path)
    })
}

fn resting(method: Method) -> Result<Scene> {
    let columns = 20;
    let mut body = block([0.0; 2], columns, ROWS);
    if method.begins_with_pressure {
        body["pressure"] = "hydrostatic".into();
    }
    method.scene(body, |file| {
        let width = f64::from(columns) * SPACING;
        file["domain"]["max"] = serde_json::json!([width, 0.6]);
    })
}

/// What a rest came to.
struct Seen<'a> {
    end: &'a super::trial::Moment,
    speed: f64,
    drift: f64,
    lost: usize,
}

impl<'a> Seen<'a> {
    fn of(scene: &Scene, trial: &'a Trial) -> Self {
        let gravity = f64::from(scene.gravity.length());
        let depth = f64::from(ROWS) * SPACING;
        let end = trial.moments.last().expect("frame 0 at least");
        // m g h
        let weight = gravity * total_mass(scene);
        let height = |m: &super::trial::Moment| m.figures.potential_energy / weight;
        Self {
            speed: end.figures.max_speed / (gravity * depth).sqrt(),
            drift: (height(end) - height(&trial.moments[SETTLED])) / depth,
            lost: lost(scene, &trial.last),
            end,
        }
    }

    fn verdict(&self) -> Outcome {
        let density = self.end.figures.density_error.map_or(0.0, |[mean, _]| mean);
        let mut why = Vec::new();
        if self.lost > 0 {
            why.push(format!("{} particles are lost", self.lost));
        }
        if self.speed > FASTEST {
            why.push(format!("a particle has {} √(g H)", shown(self.speed)));
        }
        if self.drift.abs() > LARGEST_DRIFT {
            why.push(format!("the center of mass moved by {} H", shown(self.drift)));
        }
        if density > LARGEST_DENSITY_ERROR {
            why.push(format!("density is off by {}", shown(density)));
        }
        if why.is_empty() {
            Ok(())
        } else {
            Err(Trouble::Wrong(why.join(", ")))
        }
    }
}

/// kg
fn total_mass(scene: &Scene) -> f64 {
    let each = (crate::physics::model(&scene.matter).particle_mass)(scene);
    each * scene.particles.len() as f64
}
