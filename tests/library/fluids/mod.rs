//! Fluids: what tests of them share.

mod flows;
mod lists;
mod reference;
mod walls;

use glam::Vec3;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Particles, Scene};
use sliceflow::simulation::Simulation;

use crate::common;

/// Simulates `frames` frame intervals.
fn simulated(scene: &Scene, frames: u32) -> Simulation {
    let mut simulation = common::simulate(scene, &Wanted::default());
    for _ in 0..=frames {
        simulation.next_frame().unwrap_or_else(|error| panic!("{error}"));
    }
    while simulation
        .finish_frame()
        .unwrap_or_else(|error| panic!("{error}"))
        .is_some()
    {}
    simulation
}

fn particles(scene: &Scene, frames: u32) -> Particles {
    simulated(scene, frames).particles().expect("particles")
}

/// Fluid thrown about a little, so that every term counts. A frame has `steps` steps.
fn stirred(dimensions: usize, steps: u32, overrides: &[&str]) -> Scene {
    let mut scene = common::fluid(dimensions, overrides);
    let spacing = scene.fluid().expect("a fluid").spacing as f32;
    for (k, (x, v)) in scene
        .particles
        .position
        .iter_mut()
        .zip(&mut scene.particles.velocity)
        .enumerate()
    {
        let wave = Vec3::new(
            (k as f32 * 1.7).sin(),
            (k as f32 * 2.3).cos(),
            (k as f32 * 3.1).sin(),
        );
        let wave = if dimensions == 2 { wave.with_z(0.0) } else { wave };
        *x += 0.1 * spacing * wave;
        *v += 0.3 * Vec3::new(wave.y, wave.x, wave.z);
    }
    scene.time.steps_per_frame = steps;
    scene.time.fps = 1.0 / (f64::from(steps) * scene.time.step);
    scene
}

const SOLVERS: [&[&str]; 14] = [
    &[],
    &["fluid.viscosity=5"],
    &[
        "time.integrator=velocity_verlet",
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
    ],
    &["fluid.solver=sph", "fluid.viscosity=5"],
    &[
        "fluid.density_from=summation",
        "fluid.pressure_force=monaghan",
        "fluid.kernel=cubic_spline",
    ],
    &[
        "fluid.negative_pressure=control",
        "fluid.artificial_viscosity=0.2",
        "fluid.kernel=wendland_c4",
    ],
    &["fluid.artificial_viscosity=0.2", "fluid.slip=free_slip"],
    &[
        "fluid.shifting=1",
        "fluid.slip=free_slip",
        "fluid.wall_friction=0.2",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=stress",
        "fluid.slip=free_slip",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
        "fluid.gradient_correction=true",
        "fluid.pressure_force=difference",
        "fluid.shifting=1",
        "fluid.negative_pressure=keep",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
        "fluid.gradient_correction=true",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=stress",
        "fluid.gradient_correction=true",
        "fluid.pressure_force=difference",
        "fluid.shifting=1",
        "fluid.kernel=quintic_spline",
        "fluid.negative_pressure=keep",
    ],
    &[
        "fluid.materials=[{\"name\":\"water\",\"density\":1000,\"viscosity\":3},\
         {\"name\":\"oil\",\"density\":500,\"viscosity\":10,\"surface_tension\":10}]",
        "fluid.negative_pressure=keep",
        "fluid.background_pressure=2000",
    ],
    &["fluid.surface_tension=20", "fluid.contact_angle=60"],
];
