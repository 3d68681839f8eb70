//! Keys of grains that their contact law does not know, or lacks.

use super::Dimensions;
use super::field::MOST_KEYS;
use super::frame::{Frame, Report};
use super::model::{ContactLaw, Dashpot, Grains, SceneFile, Wall};
use super::text::number;
use super::{friction, grain_materials};

/// A key, and whether a scene gives it.
type Key = (&'static str, fn(&Grains) -> bool);

const OF_SPRING_DASHPOT: &[Key] = &[
    ("damping", |grains| grains.damping.is_some()),
    ("dashpot", |grains| grains.dashpot != Dashpot::default()),
    ("shear", |grains| grains.shear > 0.0),
    ("attraction", |grains| grains.attraction > 0.0),
];
const OF_FRICTION: &[Key] = &[
    ("friction", |grains| grains.friction.is_some()),
    ("wall_friction", |grains| grains.wall_friction.is_some()),
    ("rolling_friction", |grains| grains.rolling_friction.is_some()),
    ("rolling_resistance", |grains| grains.rolling_resistance.is_some()),
    ("cohesion", |grains| grains.cohesion.is_some()),
    ("cohesion_range", |grains| grains.cohesion_range.is_some()),
    ("materials", |grains| !grains.materials.is_empty()),
    ("pairs", |grains| !grains.pairs.is_empty()),
];
const OF_LINEAR: &[Key] = &[
    ("contact_time", |grains| grains.contact_time.is_some()),
    ("tangential_stiffness", |grains| {
        grains.tangential_stiffness.is_some()
    }),
];
const OF_HERTZ: &[Key] = &[
    ("young_modulus", |grains| grains.young_modulus.is_some()),
    ("poisson_ratio", |grains| grains.poisson_ratio.is_some()),
];
const SPRING: &[Key] = &[("spring", |grains| grains.spring.is_some())];

/// A problem for each.
pub fn check(file: &SceneFile, frame: &Frame, report: &mut Report) {
    let Some(grains) = &file.grains else { return };
    let mut has_no = |keys: &[&[Key]], law: &str, help: &str| {
        for (key, _) in keys
            .iter()
            .copied()
            .flatten()
            .filter(|(_, is_given)| is_given(grains))
        {
            report.problem(
                format!("grains.{key}"),
                format!("the law `{law}` does not know it"),
                help,
            );
        }
    };
    match grains.law {
        ContactLaw::SpringDashpot => {
            let help =
                "leave it out, or set grains.law to `linear` or `hertz`, with which grains rotate and rub";
            has_no(&[OF_FRICTION, OF_LINEAR, OF_HERTZ], "spring_dashpot", help);
            if grains.spring.is_none() {
                report.problem("grains.spring", "is missing", "add \"spring\", in N/m");
            }
            return;
        }
        ContactLaw::Linear => {
            let help =
                "leave it out: `linear` is given by `spring` or `contact_time`, `restitution` and `friction`";
            has_no(&[OF_SPRING_DASHPOT, OF_HERTZ], "linear", help);
            match (grains.spring, grains.contact_time) {
                (None, None) => report.problem(
                    "grains",
                    "neither `spring` nor `contact_time` is given",
                    "add \"spring\" in N/m, or \"contact_time\" in seconds",
                ),
                (Some(_), Some(_)) => report.problem(
                    "grains",
                    "both `spring` and `contact_time` are given, and each sets the spring",
                    "remove one of them",
                ),
                _ => {}
            }
        }
        ContactLaw::Hertz => {
            let help = "leave it out: `hertz` is given by `young_modulus`, `poisson_ratio`, `restitution` and `friction`";
            has_no(&[OF_SPRING_DASHPOT, OF_LINEAR, SPRING], "hertz", help);
            if grains.young_modulus.is_none() {
                report.problem(
                    "grains.young_modulus",
                    "is missing",
                    "add it in Pa: 5e6 to 1e8 for soft grains that allow long steps, 5e10 for glass",
                );
            }
            if frame.dimensions == Dimensions::Two {
                report.problem(
                    "grains.law",
                    "`hertz` is of spheres, and grains of a 2D scene are discs",
                    "set it to `linear`, or `dimensions` to 3",
                );
            }
        }
    }
    if grains.restitution.is_none() {
        report.problem(
            "grains.restitution",
            "is missing",
            "add \"restitution\": 0.5 (1 loses nothing)",
        );
    }
    grain_materials::check(grains, report);
    if grains.cohesion_range.is_some() && !friction::sticks(grains) {
        report.problem(
            "grains.cohesion_range",
            "has no effect without cohesion",
            "add \"cohesion\", in N, or leave it out",
        );
    }
    if grains.cohesion_range.is_some_and(|range| range > grains.radius) {
        report.problem(
            "grains.cohesion_range",
            format!(
                "reaches farther than a grain's radius, {} m",
                number(grains.radius)
            ),
            "shorten it: neighbors are not searched farther",
        );
    }
    if grains.rolling_resistance.is_some() && !friction::rolls(grains) {
        report.problem(
            "grains.rolling_resistance",
            "has no effect without rolling friction",
            "add \"rolling_friction\": 0.2, or leave it out",
        );
    }
    let axes = frame.dimensions.count();
    if frame.sides[..axes]
        .iter()
        .flatten()
        .any(|&side| side == Wall::Clamp)
    {
        report.problem(
            "domain.walls",
            "walls that clamp know no friction",
            "choose `contact` walls, or set grains.law to `spring_dashpot`",
        );
    }
    if file.time.integrator == Some(super::model::Integrator::SymplecticEuler) {
        report.problem(
            "time.integrator",
            "grains that rotate are moved by velocity Verlet",
            "leave it out",
        );
    }
}

/// A problem where contacts could not tell grains apart.
pub fn check_count(particles: u32, report: &mut Report) {
    if u64::from(particles) > MOST_KEYS {
        report.problem(
            "grains.law",
            format!("contacts of {particles} grains cannot be told apart: there are at most {MOST_KEYS} that rotate"),
            "take fewer grains, or set it to `spring_dashpot`",
        );
    }
}
