//! Keys that have no effect on what the scene is made of: a user who writes them expects something.

use super::changes;
use super::frame::Report;
use super::model::{
    ColliderShape, Fluid, FluidSolver, Integrator, Kernel, NegativePressure, PressureForce, SceneFile, Slip,
    StartPressure,
};

/// A problem for each.
pub fn check(file: &SceneFile, report: &mut Report) {
    if file.grains.is_some() {
        of_fluids(file, report);
    }
    for (i, collider) in file.colliders.iter().enumerate() {
        let round = matches!(
            collider.shape,
            ColliderShape::Sphere { .. } | ColliderShape::Cylinder { .. }
        );
        if collider.spin.is_some() && !round {
            report.problem(
                format!("colliders[{i}].spin"),
                "only a sphere or a cylinder can turn and stay where it is",
                "leave it out, or make the shape a sphere or a cylinder",
            );
        }
    }
    if file.fluid.is_some() {
        of_materials(file, report);
    }
    if let Some(fluid) = &file.fluid
        && fluid.contact_angle.is_some()
        && fluid.surface_tension == 0.0
        && fluid
            .materials
            .iter()
            .all(|material| material.surface_tension == 0.0)
        && changes::greatest_tension(file) == 0.0
    {
        report.problem(
            "fluid.contact_angle",
            "has no effect without surface tension",
            "leave it out, or give fluid.surface_tension (0.0728 N/m for water)",
        );
    }
    if let Some(fluid) = file
        .fluid
        .as_ref()
        .filter(|fluid| fluid.solver == FluidSolver::Dfsph)
    {
        of_compressible_fluids(file, fluid, report);
    }
    if let Some(fluid) = &file.fluid
        && fluid.wall_friction > 0.0
        && fluid.slip == Slip::NoSlip
    {
        report.problem(
            "fluid.wall_friction",
            "has no effect on walls that the fluid sticks to",
            "leave it out, or set fluid.slip to `free_slip`",
        );
    }
    if let Some(fluid) = &file.fluid
        && fluid.negative_pressure == NegativePressure::Control
        && fluid.pressure_force != PressureForce::Symmetric
    {
        report.problem(
            "fluid.negative_pressure",
            "`control` is a change of the symmetric pressure force",
            "choose `keep` or `clamp`, or set fluid.pressure_force to `symmetric`",
        );
    }
}

/// Those that only compressible fluids have.
fn of_compressible_fluids(file: &SceneFile, fluid: &Fluid, report: &mut Report) {
    let given = [
        ("sound_speed", fluid.sound_speed.is_some()),
        ("gamma", fluid.gamma.is_some()),
        ("background_pressure", fluid.background_pressure > 0.0),
        ("density_from", fluid.density_from.is_some()),
        ("density_diffusion", fluid.density_diffusion.is_some()),
        ("pressure_force", fluid.pressure_force != PressureForce::default()),
        (
            "negative_pressure",
            fluid.negative_pressure != NegativePressure::default(),
        ),
        ("gradient_correction", fluid.gradient_correction),
        ("shifting", fluid.shifting.is_some_and(|s| s > 0.0)),
        ("wall_friction", fluid.wall_friction > 0.0),
        ("viscosity_form", fluid.viscosity_form.is_some()),
        ("surface_tension", fluid.surface_tension > 0.0),
        ("materials", !fluid.materials.is_empty()),
    ];
    for (key, _) in given.into_iter().filter(|(_, given)| *given) {
        report.problem(
            format!("fluid.{key}"),
            "the solver `dfsph` does not know it",
            "leave it out, or set fluid.solver to `wcsph`",
        );
    }
    if file.time.integrator() != Integrator::SymplecticEuler {
        report.problem(
            "time.integrator",
            "the solver `dfsph` has an integrator of its own",
            "leave it out",
        );
    }
    if fluid.kernel == Some(Kernel::Muller) {
        report.problem(
            "fluid.kernel",
            "`muller` has one kernel for density and another for forces, which `dfsph` cannot use",
            "leave it out, or choose `wendland_c2`",
        );
    }
}

/// Materials of walls, which only grains know.
fn of_materials(file: &SceneFile, report: &mut Report) {
    let colliders = file.colliders.iter().enumerate();
    let colliders = colliders
        .filter(|(_, collider)| collider.material.is_some())
        .map(|(i, _)| format!("colliders[{i}].material"));
    let sides = file.domain.side_materials.all();
    let sides = sides.iter().flatten().filter(|(_, given)| given.is_some());
    let sides = sides.map(|(side, _)| format!("domain.side_materials.{side}"));
    for path in colliders.chain(sides) {
        report.problem(
            path,
            "has no effect on fluids",
            "leave it out; fluid.slip and fluid.wall_friction say how a fluid meets walls",
        );
    }
}

/// Those that only fluids have, in a scene of grains.
fn of_fluids(file: &SceneFile, report: &mut Report) {
    let mut problem = |path: String| {
        report.problem(
            path,
            "has no effect on grains",
            "leave it out, or make the scene's particles a `fluid`",
        );
    };
    for (i, body) in file.bodies.iter().enumerate() {
        let given = [
            ("flow", body.flow.is_some()),
            ("pressure", body.pressure != StartPressure::Rest),
        ];
        for (key, _) in given.into_iter().filter(|(_, given)| *given) {
            problem(format!("bodies[{i}].{key}"));
        }
    }
    for (name, _) in file
        .domain
        .side_velocities
        .all()
        .iter()
        .flatten()
        .filter(|(_, given)| given.is_some())
    {
        problem(format!("domain.side_velocities.{name}"));
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::{Value, json};

    use crate::scene::load::parse;

    /// Paths of what is wrong with a scene.
    fn problems(scene: &Value) -> String {
        match parse(&scene.to_string(), "test.json", Path::new("."), &[]) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn what_only_fluids_have_is_told_in_a_scene_of_grains() {
        let scene = |matter: &str, value: Value| {
            json!({
                "dimensions": 2,
                "domain": { "min": [0, 0], "max": [1, 1], "side_velocities": { "y_max": [1, 0] } },
                matter: value,
                "bodies": [{
                    "shape": { "kind": "box", "min": [0, 0], "max": [0.3, 0.3] },
                    "flow": { "kind": "taylor_green", "speed": 1, "wavelength": 1 },
                    "pressure": "hydrostatic",
                }],
                "colliders": [{ "shape": { "kind": "sphere", "center": [0.7, 0.7], "radius": 0.1 }, "spin": 1 }],
            })
        };
        let told = problems(&scene(
            "grains",
            json!({ "radius": 0.02, "spring": 1e4, "restitution": 0.5 }),
        ));
        for path in [
            "bodies[0].flow",
            "bodies[0].pressure",
            "domain.side_velocities.y_max",
        ] {
            assert!(told.contains(path), "{path}: {told}");
        }
        assert_eq!(problems(&scene("fluid", json!({ "spacing": 0.05 }))), "");
    }

    #[test]
    fn choices_that_do_not_go_together_are_told() {
        let told = problems(&json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [1, 1] },
            "fluid": { "solver": "wcsph", "spacing": 0.05, "negative_pressure": "control", "pressure_force": "monaghan" },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.3, 0.3] } }],
            "colliders": [{ "shape": { "kind": "box", "min": [0.6, 0.6], "max": [0.8, 0.8] }, "spin": 1 }],
        }));
        for path in ["fluid.negative_pressure", "colliders[0].spin"] {
            assert!(told.contains(path), "{path}: {told}");
        }
    }
}
