//! Guards that look at a frame's figures before anything of it is written. Those that look at each particle in each step are
//! the device's (`shaders/physics/guard.wgsl`).

use serde::{Deserialize, Serialize};

use super::text::count;
use crate::error::Violation;
use crate::guards::GuardKind;
use crate::physics::layout::Convergence;
use crate::physics::model;
use crate::scene::Scene;
use crate::scene::model::{FluidSolver, Wall};
use crate::simulation::frame::{Frame, Statistics};

/// Deepest overlap of two grains, as a share of the radius: each has sunk by half a radius into the other; and where particles of
/// rigid bodies meet, a few of which carry the weight of all.
const DEEPEST_OVERLAP: f64 = 1.0;
const DEEPEST_OVERLAP_OF_BODIES: f64 = 1.5;
/// Largest |ρ/ρ₀ − 1|: a fluid of three times its density at rest, or less than none.
const LARGEST_DENSITY_ERROR: f64 = 2.0;
/// Steps in a row of which each stopped at `fluid.max_iterations`, with so large an error, a mean share of the density, and so
/// many times as large as asked for.
const UNCONVERGED_STEPS: u32 = 300;
const UNCONVERGED_ERROR: f64 = 0.01;
const UNCONVERGED_TIMES: f64 = 20.0;
/// Share of all particles that a search may find no slot for, on average over the searches of a frame.
const LARGEST_OVERFLOW: f64 = 0.05;
/// Energy that may come from nowhere, as a share of what there is to gain it from; where `dfsph` pushes particles apart that
/// stand too close, they gain height.
const LARGEST_GAIN: f64 = 0.25;
const LARGEST_GAIN_OF_DFSPH: f64 = 1.0;
/// Share of the motion's energy that single precision may lose or add where particles fall far.
const ROUNDING: f64 = 1e-3;
/// A start in which grains overlap more, as a share of the radius, or a fluid is denser holds energy of its own.
const STRAINED_OVERLAP: f64 = 0.05;
const STRAINED_DENSITY: f64 = 0.1;
/// Speed to which a fluid's pressure may bring it by itself, as a share of the expected one.
const OWN_SPEED: f64 = 0.1;

/// What guards remember from frame to frame; a part of checkpoints, so that a run that goes on is stopped where one that
/// nothing interrupted is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Guards {
    /// Energy may grow from here on; `None` until a frame is there.
    energy: Option<Energy>,
    /// Steps in a row that did not converge.
    unconverged: u32,
    /// Whether the scene has a source of energy, once somebody asked.
    #[serde(skip)]
    has_source: Option<bool>,
}

/// Joules.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Energy {
    frame: u32,
    /// At that frame.
    total: f64,
    /// What motion can gain energy from.
    scale: f64,
    particles: u32,
}

/// A guard, and figures for what it found.
type Found = (GuardKind, String);

impl Guards {
    /// Looks at the next frame.
    pub fn check(&mut self, scene: &Scene, frame: &Frame) -> Option<Violation> {
        let unconverged = frame
            .convergence
            .as_ref()
            .and_then(|convergence| self.unconverged(scene, convergence));
        let figures = frame.statistics.as_ref();
        let found = overflow(scene, frame)
            .or_else(|| figures.and_then(not_finite))
            .or_else(|| figures.and_then(|figures| strained(scene, frame.index, figures)))
            .or(unconverged)
            .or_else(|| figures.and_then(|figures| self.energy(scene, frame, figures)));
        let (guard, detail) = found?;
        Some(Violation {
            guard,
            family: model(&scene.matter).family,
            detail,
            frame: frame.index,
            step: frame.steps,
            time: frame.time,
            step_s: frame.step_s,
            step_limited_by: frame.step_limited_by,
            particle: None,
        })
    }

    /// A pressure solver that has given up step after step, far from what it looks for.
    fn unconverged(&mut self, scene: &Scene, convergence: &Convergence) -> Option<Found> {
        let fluid = scene.fluid()?;
        let density = f64::from(convergence.density_error);
        let divergence = f64::from(convergence.divergence_error);
        let is_far = |unconverged: u32, error: f64, largest: f64| {
            let is_all = convergence.steps > 0 && unconverged == convergence.steps;
            is_all && error > UNCONVERGED_ERROR.max(UNCONVERGED_TIMES * largest)
        };
        let of_density = (convergence.density_unconverged, density, fluid.max_density_error);
        let of_divergence = (
            convergence.divergence_unconverged,
            divergence,
            fluid.max_divergence_error,
        );
        let is_far = [of_density, of_divergence]
            .into_iter()
            .any(|(unconverged, error, largest)| is_far(unconverged, error, largest));
        match is_far {
            true => self.unconverged += convergence.steps,
            false => self.unconverged = 0,
        }
        (self.unconverged >= UNCONVERGED_STEPS).then(|| {
            let detail = format!(
                "in {} steps in a row; errors of density and divergence are {density:.1e} and {divergence:.1e}, {:.1e} and \
                 {:.1e} are asked for",
                count(self.unconverged.into()),
                fluid.max_density_error,
                fluid.max_divergence_error
            );
            (GuardKind::Unconverged, detail)
        })
    }

    /// Energy that grows although nothing adds any.
    fn energy(&mut self, scene: &Scene, frame: &Frame, figures: &Statistics) -> Option<Found> {
        if *self.has_source.get_or_insert_with(|| has_source(scene)) {
            return None;
        }
        let total = figures.kinetic_energy + figures.potential_energy;
        let Some(begun) = self.energy.filter(|begun| !is_new(scene, begun, frame)) else {
            self.energy = Some(Energy {
                frame: frame.index,
                total,
                scale: scale(scene, frame, figures),
                particles: frame.particles,
            });
            return None;
        };
        let gain = total - begun.total;
        let share = match is_dfsph(scene) {
            true => LARGEST_GAIN_OF_DFSPH,
            false => LARGEST_GAIN,
        };
        let allowed = share * begun.scale + ROUNDING * figures.kinetic_energy;
        (gain > allowed).then(|| {
            let detail = format!(
                "motion and height together have {gain:.3e} J more than at frame {}, where there were {:.3e} J to gain it \
                 from; steps have {:.3e} s",
                begun.frame, begun.scale, frame.step_s
            );
            (GuardKind::Energy, detail)
        })
    }
}

/// Whether what was remembered is of a scene that has changed since: by an event, or by new particles.
fn is_new(scene: &Scene, begun: &Energy, frame: &Frame) -> bool {
    let since = f64::from(begun.frame) / scene.time.fps;
    let happened = |time: f64| time >= since && time < frame.time;
    begun.particles != frame.particles || scene.schedule.iter().any(|due| happened(due.time))
}

/// Whether something besides gravity adds energy, or takes what figures do not count: moving walls and obstacles, pulling
/// grains, space that repeats downwards.
fn has_source(scene: &Scene) -> bool {
    let moves = scene
        .colliders
        .iter()
        .any(|collider| !collider.path.is_empty() || collider.spin != glam::Vec3::ZERO);
    let slides = scene
        .boundary
        .side_velocity
        .iter()
        .flatten()
        .any(|v| *v != glam::Vec3::ZERO)
        || scene
            .boundary
            .surface_velocity
            .iter()
            .any(|v| *v != glam::Vec3::ZERO);
    let repeats = |axis: usize| scene.domain.sides[axis].contains(&Wall::Periodic);
    let falls_forever = scene
        .gravities()
        .any(|gravity| (0..3).any(|axis| repeats(axis) && gravity[axis] != 0.0));
    let pulls = scene
        .matters()
        .filter_map(|matter| matter.grains())
        .any(|grains| {
            let contact = &grains.contact;
            contact.attraction > 0.0
                || contact
                    .friction
                    .as_ref()
                    .is_some_and(|friction| friction.cohesion_range > 0.0)
        });
    moves || slides || falls_forever || pulls
}

/// What motion can gain energy from, joules: what it has, height above the domain's lowest corner, a fluid's own pressure
/// and surface, what contacts are pressed. Endless where a strained start holds energy that no figure tells.
fn scale(scene: &Scene, frame: &Frame, figures: &Statistics) -> f64 {
    let density = figures.density_error.map_or(0.0, |[_, most]| most);
    // Pressures of an incompressible fluid hold no energy.
    if figures.max_overlap > STRAINED_OVERLAP || density > STRAINED_DENSITY && !is_dfsph(scene) {
        return f64::MAX;
    }
    let particles = f64::from(frame.particles);
    let mass = (model(&scene.matter).particle_mass)(scene) * scene.mean_mass_share() * particles;
    let extent = (scene.domain.max - scene.domain.min).as_dvec3();
    let upwards = scene
        .gravities()
        .map(|gravity| gravity.as_dvec3().max(glam::DVec3::ZERO).dot(extent));
    let below = upwards.fold(0.0, f64::max) * mass;
    let own = scene.fluid().map_or(0.0, |fluid| {
        let tension = fluid.materials.iter().map(|material| material.surface_tension);
        let faces = fluid.spacing.powi(scene.dimensions.count() as i32 - 1);
        0.5 * mass * (OWN_SPEED * fluid.max_speed).powi(2) + tension.fold(0.0, f64::max) * faces * particles
    });
    // Contacts hold ½ k δ² each, of which all may become motion; a grain has a share of three in a dense packing.
    let pressed = scene.grains().map_or(0.0, |grains| {
        let overlap = figures.max_overlap * grains.radius;
        3.0 * particles * 0.5 * grains.contact.spring * overlap.powi(2) / LARGEST_GAIN
    });
    figures.kinetic_energy + (figures.potential_energy + below).max(0.0) + own + pressed
}

fn is_dfsph(scene: &Scene) -> bool {
    scene
        .fluid()
        .is_some_and(|fluid| fluid.solver == FluidSolver::Dfsph)
}

fn not_finite(figures: &Statistics) -> Option<Found> {
    let [mean, most] = figures.density_error.unwrap_or_default();
    let all = [
        figures.kinetic_energy,
        figures.potential_energy,
        figures.max_speed,
        mean,
        most,
    ];
    all.iter()
        .any(|figure| !figure.is_finite())
        .then(|| (GuardKind::NotFinite, "in sums over the particles".into()))
}

/// Grains that lie in one another, and fluid that is far denser than at rest. A start may be so; what follows may not.
fn strained(scene: &Scene, frame: u32, figures: &Statistics) -> Option<Found> {
    let density = figures.density_error.map_or(0.0, |[_, most]| most);
    let deepest = match scene.rigid_bodies.is_empty() {
        true => DEEPEST_OVERLAP,
        false => DEEPEST_OVERLAP_OF_BODIES,
    };
    if frame > 0 && scene.grains().is_some() && figures.max_overlap > deepest {
        let detail = format!(
            "the deepest overlap is {:.2} of their radius",
            figures.max_overlap
        );
        return Some((GuardKind::Overlap, detail));
    }
    (frame > 0 && density > LARGEST_DENSITY_ERROR).then(|| {
        let detail = format!("|ρ/ρ₀ − 1| is {density:.2} somewhere in the fluid");
        (GuardKind::Density, detail)
    })
}

/// A pool that is too small for many particles.
fn overflow(scene: &Scene, frame: &Frame) -> Option<Found> {
    let searches = f64::from(frame.searches.max(1));
    let each = frame.overflow as f64 / searches;
    let all = frame.particles + frame.boundary_particles;
    (frame.index > 0 && each > LARGEST_OVERFLOW * f64::from(all)).then(|| {
        let detail = format!(
            "voxels have {} slots; a search finds none for {} of {} particles",
            scene.neighbors.slots,
            each.round(),
            count(all.into())
        );
        (GuardKind::Overflow, detail)
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const GRAINS: &str = r#"{
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1] },
        "gravity": [0, -10],
        "grains": { "radius": 0.05, "density": 1000, "spring": 1e5, "restitution": 0.5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.5] } }],
        "events": [{ "at": 1, "set": { "gravity": [0, -20] } }]
    }"#;
    const FLUID: &str = r#"{
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1] },
        "gravity": [0, -10],
        "fluid": { "spacing": 0.1 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.5] } }]
    }"#;

    fn scene(text: &str) -> Scene {
        crate::scene::load::parse(text, "test.json", Path::new("."), &[]).unwrap()
    }

    /// A frame of 25 particles with these figures.
    fn frame(index: u32, figures: Statistics) -> Frame {
        Frame {
            index,
            time: f64::from(index) / 30.0,
            particles: 25,
            steps: 10 * u64::from(index),
            searches: 10,
            statistics: Some(figures),
            ..Frame::default()
        }
    }

    fn energies(kinetic_energy: f64, potential_energy: f64) -> Statistics {
        Statistics {
            kinetic_energy,
            potential_energy,
            ..Statistics::default()
        }
    }

    /// The guard that stops the last of these frames; none stops one before.
    fn stopped(scene: &Scene, frames: Vec<Frame>) -> Option<GuardKind> {
        let mut guards = Guards::default();
        let last = frames.len() - 1;
        let mut found = None;
        for (place, frame) in frames.into_iter().enumerate() {
            found = guards.check(scene, &frame);
            assert!(found.is_none() || place == last, "frame {place}: {found:?}");
            // What a checkpoint holds is all that there is to remember.
            let text = serde_json::to_string(&guards).unwrap();
            guards = serde_json::from_str(&text).unwrap();
        }
        found.map(|violation| violation.guard)
    }

    #[test]
    fn energy_may_change_its_form_and_not_grow() {
        let scene = scene(GRAINS);
        let falls = || vec![frame(0, energies(0.0, 100.0)), frame(1, energies(60.0, 30.0))];
        let and = |last: Frame| [falls(), vec![last]].concat();
        assert_eq!(stopped(&scene, and(frame(2, energies(100.0, 20.0)))), None);
        assert_eq!(
            stopped(&scene, and(frame(2, energies(100.0, 26.0)))),
            Some(GuardKind::Energy)
        );
        // An event has doubled the weight.
        assert_eq!(stopped(&scene, and(frame(31, energies(100.0, 200.0)))), None);
        // More particles have come.
        let more = Frame {
            particles: 50,
            ..frame(2, energies(100.0, 200.0))
        };
        assert_eq!(stopped(&scene, and(more)), None);
        assert_eq!(
            stopped(&scene, and(frame(2, energies(f64::NAN, 0.0)))),
            Some(GuardKind::NotFinite)
        );
    }

    #[test]
    fn a_start_that_is_strained_may_gain_energy() {
        let scene = scene(GRAINS);
        let strained = Statistics {
            max_overlap: 0.3,
            ..energies(0.0, 100.0)
        };
        let frames = vec![frame(0, strained), frame(1, energies(1e5, 100.0))];
        assert_eq!(stopped(&scene, frames), None);
    }

    #[test]
    fn contacts_that_are_pressed_a_little_may_push_grains_apart() {
        let scene = scene(
            &GRAINS
                .replace(r#""gravity": [0, -10]"#, r#""gravity": [0, 0]"#)
                .replace("[0, -20]", "[0, 0]"),
        );
        let pressed = Statistics {
            max_overlap: 1e-4,
            ..Statistics::default()
        };
        // ½ k δ² in 75 contacts.
        let all = 75.0 * 0.5 * 1e5 * (1e-4 * 0.05_f64).powi(2);
        let frames = |energy: f64| vec![frame(0, pressed), frame(1, energies(energy, 0.0))];
        assert_eq!(stopped(&scene, frames(0.9 * all)), None);
        assert_eq!(stopped(&scene, frames(1.1 * all)), Some(GuardKind::Energy));
    }

    #[test]
    fn what_moves_adds_energy() {
        let moving = GRAINS.replace(
            r#""events""#,
            r#""colliders": [{ "shape": { "kind": "sphere", "center": [0.8, 0.8], "radius": 0.1 },
               "path": [{ "at": 0, "offset": [0, 0] }, { "at": 1, "offset": [0, 0.1] }] }], "events""#,
        );
        let frames = || vec![frame(0, energies(0.0, 100.0)), frame(1, energies(1e3, 0.0))];
        assert_eq!(stopped(&scene(&moving), frames()), None);
        assert_eq!(stopped(&scene(GRAINS), frames()), Some(GuardKind::Energy));
    }

    #[test]
    fn overlaps_and_densities_have_bounds_behind_the_start() {
        let with = |max_overlap: f64, density: f64| Statistics {
            max_overlap,
            density_error: Some([0.0, density]),
            ..Statistics::default()
        };
        let two = |figures: Statistics| vec![frame(0, figures), frame(1, figures)];
        assert_eq!(stopped(&scene(GRAINS), two(with(0.9, 0.0))), None);
        assert_eq!(
            stopped(&scene(GRAINS), two(with(1.1, 0.0))),
            Some(GuardKind::Overlap)
        );
        assert_eq!(stopped(&scene(FLUID), two(with(0.0, 1.5))), None);
        assert_eq!(
            stopped(&scene(FLUID), two(with(0.0, 2.5))),
            Some(GuardKind::Density)
        );
    }

    #[test]
    fn a_pool_may_miss_a_few() {
        let with = |overflow: u64| Frame {
            overflow,
            ..frame(1, Statistics::default())
        };
        // Ten searches of 25 particles each.
        assert_eq!(stopped(&scene(GRAINS), vec![with(10)]), None);
        assert_eq!(stopped(&scene(GRAINS), vec![with(20)]), Some(GuardKind::Overflow));
    }

    #[test]
    fn a_solver_may_fail_now_and_then() {
        let scene = scene(FLUID);
        let with = |index: u32, unconverged: u32, error: f32| Frame {
            convergence: Some(Convergence {
                steps: 100,
                density_unconverged: unconverged,
                density_error: error,
                ..Convergence::default()
            }),
            ..frame(index, Statistics::default())
        };
        let row = |frames: [(u32, f32); 4]| {
            let all = frames.into_iter().zip(0..);
            all.map(|((unconverged, error), index)| with(index, unconverged, error))
                .collect()
        };
        assert_eq!(
            stopped(&scene, row([(100, 0.05), (100, 0.05), (99, 0.05), (100, 0.05)])),
            None
        );
        assert_eq!(stopped(&scene, row([(100, 0.005); 4])), None);
        let late = row([(0, 0.0), (100, 0.05), (100, 0.05), (100, 0.05)]);
        assert_eq!(stopped(&scene, late), Some(GuardKind::Unconverged));
    }

    #[test]
    fn gravity_that_turns_along_space_that_repeats_is_a_source() {
        let sides = r#""max": [1, 1], "sides": { "x_min": "periodic", "x_max": "periodic" } }"#;
        let chute = FLUID.replace(r#""max": [1, 1] }"#, sides);
        assert!(!has_source(&scene(&chute)));
        let event = r#""events": [{ "at": 1, "set": { "gravity": [3, -9] } }], "fluid""#;
        assert!(has_source(&scene(&chute.replace(r#""fluid""#, event))));
    }
}
