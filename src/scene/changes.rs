//! Parameters that events may change: which solvers have which, and what is wrong with a change.

use super::fluid;
use super::frame::Report;
use super::model::{Change, ContactLaw, FluidSolver, NegativePressure, SceneFile, Slip};
use super::text::list;

/// A key of `events[].set`.
struct Changeable {
    key: &'static str,
    is_given: fn(&Change) -> bool,
    /// Who has such a parameter.
    of: &'static [Of],
}

/// Who has parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    Grains(ContactLaw),
    Fluid(FluidSolver),
}

const GRAINS: &[Of] = &[
    Of::Grains(ContactLaw::SpringDashpot),
    Of::Grains(ContactLaw::Linear),
    Of::Grains(ContactLaw::Hertz),
];
const SPRINGS: &[Of] = &[
    Of::Grains(ContactLaw::SpringDashpot),
    Of::Grains(ContactLaw::Linear),
];
const SPRING_DASHPOT: &[Of] = &[Of::Grains(ContactLaw::SpringDashpot)];
const FLUIDS: &[Of] = &[
    Of::Fluid(FluidSolver::Sph),
    Of::Fluid(FluidSolver::Wcsph),
    Of::Fluid(FluidSolver::Dfsph),
];
const COMPRESSIBLE: &[Of] = &[Of::Fluid(FluidSolver::Sph), Of::Fluid(FluidSolver::Wcsph)];

const fn row(key: &'static str, of: &'static [Of], is_given: fn(&Change) -> bool) -> Changeable {
    Changeable { key, is_given, of }
}

/// Every parameter besides gravity, which all scenes have. The step is as short as each of the values demands.
const CHANGEABLE: &[Changeable] = &[
    row("spring", SPRINGS, |change| change.spring.is_some()),
    row("damping", SPRING_DASHPOT, |change| change.damping.is_some()),
    row("restitution", GRAINS, |change| change.restitution.is_some()),
    row("shear", SPRING_DASHPOT, |change| change.shear.is_some()),
    row("attraction", SPRING_DASHPOT, |change| change.attraction.is_some()),
    row("global_damping", GRAINS, |change| change.global_damping.is_some()),
    row("viscosity", FLUIDS, |change| change.viscosity.is_some()),
    row("artificial_viscosity", FLUIDS, |change| {
        change.artificial_viscosity.is_some()
    }),
    row("surface_tension", COMPRESSIBLE, |change| {
        change.surface_tension.is_some()
    }),
    row("sound_speed", COMPRESSIBLE, |change| change.sound_speed.is_some()),
    row("wall_friction", COMPRESSIBLE, |change| {
        change.wall_friction.is_some()
    }),
    row("material", COMPRESSIBLE, |change| change.material.is_some()),
];

/// Reports what is wrong with a change. Returns the index of the material that it is about, if it names one.
pub(super) fn check(path: &str, change: &Change, file: &SceneFile, report: &mut Report) -> Option<usize> {
    let law = file.grains.as_ref().map(|grains| grains.law).unwrap_or_default();
    let of = file
        .fluid
        .as_ref()
        .map_or(Of::Grains(law), |fluid| Of::Fluid(fluid.solver));
    for row in CHANGEABLE.iter().filter(|row| (row.is_given)(change)) {
        if !row.of.contains(&of) {
            let own = CHANGEABLE.iter().filter(|row| row.of.contains(&of));
            let own = std::iter::once("gravity").chain(own.map(|row| row.key));
            report.problem(
                format!("{path}.{}", row.key),
                match of {
                    Of::Grains(ContactLaw::SpringDashpot) => "has no effect on grains",
                    Of::Grains(_) => "has no effect on grains of this contact law",
                    Of::Fluid(FluidSolver::Dfsph) => "the solver `dfsph` does not know it",
                    Of::Fluid(_) => "has no effect on a fluid",
                },
                format!("leave it out; what can change here: {}", list(own)),
            );
        }
    }
    let given = file.fluid.as_ref()?;
    if change.wall_friction.is_some_and(|friction| friction > 0.0) && given.slip == Slip::NoSlip {
        report.problem(
            format!("{path}.wall_friction"),
            "has no effect on walls that the fluid sticks to",
            "leave it out, or set fluid.slip to `free_slip`",
        );
    }
    if change.surface_tension.is_some_and(|tension| tension > 0.0)
        && given.negative_pressure == NegativePressure::Clamp
    {
        report.notes.push(format!(
            "{path}.surface_tension cannot hold drops together while pressure is clamped: set fluid.negative_pressure to \
             `keep`"
        ));
    }
    let name = change.material.as_deref()?;
    if change.viscosity.is_none() && change.surface_tension.is_none() {
        report.problem(
            format!("{path}.material"),
            "names a material of which nothing changes",
            "add `viscosity` or `surface_tension`, or leave it out",
        );
    }
    Some(fluid::material(&format!("{path}.material"), Some(name), file, report) as usize)
}

/// The greatest surface tension that events set, N/m.
pub(super) fn greatest_tension(file: &SceneFile) -> f64 {
    let set = file.events.iter().filter_map(|event| event.set.as_ref());
    set.filter_map(|change| change.surface_tension)
        .fold(0.0, f64::max)
}

/// The greatest viscosity of a scene with one fluid, at its start or by events, Pa·s.
pub(super) fn greatest_viscosity(file: &SceneFile) -> f64 {
    let own = file.fluid.as_ref().map_or(0.0, |fluid| fluid.viscosity);
    let set = file.events.iter().filter_map(|event| event.set.as_ref());
    set.filter_map(|change| change.viscosity).fold(own, f64::max)
}
