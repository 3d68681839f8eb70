//! Hard cases: what lies in one place, what is alone, what is in perfect order, and what comes far too fast.

use glam::Vec3;
use serde_json::json;

use super::arrangements::{self, ARRANGEMENTS};
use super::methods::{EXPECTED, METHODS, Method, SPACING, block, block_of};
use super::trial::{Moment, Outcome, Trouble, lost, run};
use super::{Failures, Scale};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::model::Integrator;
use crate::study::bench::Bench;
use crate::study::page::Cell;
use crate::study::page::{Page, Table, shown};

/// Particles that began in one place have come apart by this share of the spacing.
const APART: f64 = 0.2;
/// A lattice at rest stays slower than this share of the expected speed.
const STILL: f64 = 1e-3;
/// Largest error of a free fall, as a share of its way.
const FALL: f64 = 1e-4;
/// Energy that an impact may gain.
const GAIN: f64 = 0.02;

pub type Case = fn(&Bench, Tried, u32) -> Result<Outcome>;

/// A solver with steps of one length or with adaptive ones.
#[derive(Clone, Copy)]
pub struct Tried {
    pub method: Method,
    pub adaptive: bool,
}

const CASES: [(&str, Case); 6] = [
    ("coincident particles", coincident),
    ("coincident particles in 3D", coincident_in_3d),
    ("one isolated particle", isolated),
    ("a perfect lattice", lattice),
    ("impact at ten times the expected speed", impact),
    ("two blocks that meet at twenty times", clash),
];

pub fn cases(page: &mut Page, bench: &Bench, scale: &Scale, failures: &mut Failures) -> Result<()> {
    page.heading("Hard cases");
    page.paragraph(format!(
        "As long as {} steps of the scene's own length, with such steps and with adaptive ones. *Coincident*: one of the particles of a block of 8 × 8 begins where \
         another is; it holds where they come apart by {} spacings. *Isolated*: a single particle falls; its way is off \
         by at most {} of itself from what the integrator gives exactly. *Lattice*: no gravity, nothing to do; at most {} of \
         the expected speed. *Impact*: a block of 8 × 8 hits the floor at ten times the speed that the speed of \
         sound or the spring is made for; no particle is lost and energy grows by at most {}. *Blocks that meet*: two \
         such blocks without walls and gravity, each at twenty times that speed, by the same measure.",
        scale.short,
        shown(APART),
        shown(FALL),
        shown(STILL),
        shown(GAIN),
    ));
    page.paragraph(arrangements::about());
    page.paragraph("The cases from *pair* on are tried with adaptive steps, and `dfsph` has no others.");
    let mut table = Table::new(["solver", "case", "fixed steps", "adaptive steps"]);
    for method in METHODS {
        bench.tell(&format!("stability: hard cases of {}", method.name));
        let by_speed = CASES.map(|(name, case)| (name, case, method.has_fixed_steps));
        let by_place = ARRANGEMENTS.map(|(name, case)| (name, case, false));
        for (name, case, has_fixed_steps) in by_speed.into_iter().chain(by_place) {
            let mut row = vec![Cell::text(method.name), Cell::text(name)];
            for (adaptive, steps) in [(false, "fixed steps"), (true, "adaptive steps")] {
                if !adaptive && !has_fixed_steps {
                    row.push(Cell::Nothing);
                    continue;
                }
                let outcome = case(bench, Tried { method, adaptive }, scale.short)?;
                row.push(failures.verdict(&format!("{}, {name}, {steps}", method.name), &outcome));
            }
            table.row(row);
        }
    }
    page.table("hard", &table);
    Ok(())
}

fn coincident(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried
        .method
        .scene(block([0.4, 0.0], 8, 8), |file| tried.expect(file))?;
    part(bench, scene, [27, 28], Vec3::ZERO, steps)
}

fn coincident_in_3d(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried
        .method
        .solid_scene(block_of([0.4, 0.0, 0.4], [6; 3]), |file| tried.expect(file))?;
    part(bench, scene, [86, 87], Vec3::ZERO, steps)
}

/// Whether two particles come apart, the first of which begins where the second is but for a little.
pub fn part(bench: &Bench, mut scene: Scene, [a, b]: [usize; 2], aside: Vec3, steps: u32) -> Result<Outcome> {
    scene.particles.position[a] = scene.particles.position[b] + aside;
    Ok(run(bench, &scene, steps, 1)?.and_then(|trial| {
        let apart = trial.last.position[a].distance(trial.last.position[b]);
        let apart = f64::from(apart) / SPACING;
        match apart > APART {
            true => Ok(()),
            false => Err(Trouble::Wrong(format!(
                "they are {} spacings apart",
                shown(apart)
            ))),
        }
    }))
}

fn isolated(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let mut scene = tried.method.scene(block([0.5, 0.5], 1, 1), |file| {
        tried.expect(file);
        file["domain"]["walls"] = "open".into();
    })?;
    scene.particles.velocity[0] = Vec3::ZERO;
    // Frames often enough for adaptive steps to have about one length in each.
    let frames = 20;
    Ok(
        run(bench, &scene, steps.div_ceil(frames), frames)?.and_then(|trial| {
            let time = trial.moments.last().map_or(f64::NAN, |m| m.time);
            let gravity = f64::from(scene.gravity.length());
            // Symplectic Euler falls by g Σ Δt² / 2 more.
            let ahead = match scene.time.integrator {
                Integrator::SymplecticEuler => {
                    let squares = |pair: &[Moment]| (pair[1].time - pair[0].time) * pair[1].step;
                    trial.moments.windows(2).map(squares).sum::<f64>() / time
                }
                Integrator::VelocityVerlet => 0.0,
            };
            let expected = gravity * time * (time + ahead) / 2.0;
            let way = f64::from(scene.particles.position[0].y - trial.last.position[0].y);
            let off = (way - expected).abs() / expected;
            match off < FALL {
                true => Ok(()),
                false => Err(Trouble::Wrong(format!(
                    "its way is off by {} of itself",
                    shown(off)
                ))),
            }
        }),
    )
}

fn lattice(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried.method.scene(block([0.0; 2], 20, 20), |file| {
        tried.expect(file);
        file["domain"]["max"] = json!([20.0 * SPACING, 20.0 * SPACING]);
        file["gravity"] = json!([0, 0]);
        if tried.method.is_fluid {
            file["domain"]["walls"] = "periodic".into();
        }
    })?;
    Ok(run(bench, &scene, steps, 1)?.and_then(|trial| {
        let fastest = trial.moments.last().map_or(f64::NAN, |m| m.figures.max_speed) / EXPECTED;
        match fastest < STILL {
            true => Ok(()),
            false => Err(Trouble::Wrong(format!(
                "it moves at {} of the expected speed",
                shown(fastest)
            ))),
        }
    }))
}

fn impact(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let mut body = block([0.4, SPACING], 8, 8);
    body["velocity"] = json!([0, -10.0 * EXPECTED]);
    let scene: Scene = tried.method.scene(body, |file| tried.expect(file))?;
    kept(bench, &scene, steps)
}

fn clash(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let block = |left: f64, speed: f64| {
        let mut body = block([left, 0.4], 8, 8);
        body["velocity"] = json!([speed, 0]);
        body
    };
    let (left, right) = (block(0.25, 20.0 * EXPECTED), block(0.55, -20.0 * EXPECTED));
    let scene = tried.method.scene(left, |file| {
        tried.expect(file);
        file["bodies"].as_array_mut().expect("bodies").push(right);
        file["gravity"] = json!([0, 0]);
        file["domain"]["walls"] = "open".into();
    })?;
    kept(bench, &scene, steps)
}

/// Whether all particles stay, and no energy comes from nowhere.
pub fn kept(bench: &Bench, scene: &Scene, steps: u32) -> Result<Outcome> {
    // Frames often enough to see a gain.
    let trial = match run(bench, scene, steps.div_ceil(10), 10)? {
        Ok(trial) => trial,
        Err(why) => return Ok(Err(why)),
    };
    let first = trial.moments[0].energy();
    let most = trial.moments.iter().map(|m| m.energy() / first);
    let most = most.fold(0.0, f64::max);
    let open = scene.domain.is_open();
    Ok(match (lost(scene, &trial.last), most > 1.0 + GAIN) {
        (lost, _) if lost > 0 && !open => Err(Trouble::Wrong(format!("{lost} particles are lost"))),
        (_, true) => Err(Trouble::Wrong(format!(
            "energy becomes {} times the first",
            shown(most)
        ))),
        _ => Ok(()),
    })
}

impl Tried {
    /// The speed that a fluid's sound follows from; grains have theirs in the spring.
    pub fn expect(self, file: &mut serde_json::Value) {
        file["time"]["adaptive"] = self.adaptive.into();
        if self.method.is_fluid {
            file["fluid"]["max_speed"] = EXPECTED.into();
        }
    }
}
