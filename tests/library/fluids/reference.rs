//! Fluids against f64 on the CPU, and through every grid.

use sliceflow::scene::Particles;

use super::{SOLVERS, particles, simulated, stirred};
use crate::common;
use crate::fluid_reference::Reference;

#[test]
fn every_solver_follows_the_reference_in_f64() {
    for dimensions in [2, 3] {
        for (row, solver) in SOLVERS.into_iter().enumerate() {
            // Each solver meets both kinds of sides, one of them in 2D and one in 3D.
            let walls = ["domain.walls=particles", "domain.walls=periodic"][(row + dimensions) % 2];
            let bodies = match dimensions {
                2 => "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.3,0.25]}}]",
                _ => "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0,0],\"max\":[0.15,0.15,0.2]}}]",
            };
            let mut overrides = solver.to_vec();
            overrides.extend([walls, bodies]);
            let mut scene = stirred(dimensions, 10, &overrides);
            if scene.fluid().is_some_and(|fluid| fluid.materials.len() == 2) {
                for (k, material) in scene.particles.material.iter_mut().enumerate() {
                    *material = k as u32 % 2;
                }
            }
            let mut reference = Reference::new(&scene);
            for _ in 0..10 {
                reference.advance();
            }
            let simulation = simulated(&scene, 1);
            let found = simulation.particles().expect("particles");
            let pressures = simulation.pressures().expect("pressures");
            let fluid = scene.fluid().expect("a fluid");
            let stiffness = fluid.materials[0].density * fluid.sound_speed.powi(2);
            let travelled = fluid.max_speed * 10.0 * scene.time.step;
            for (i, &pressure) in pressures.iter().enumerate() {
                let told = format!("{dimensions}D {overrides:?}, particle {i}");
                let moved = (found.position[i].as_dvec3() - reference.position[i]).length();
                let moved = moved.min((moved - scene.domain.period().max_element() as f64).abs());
                assert!(moved < 1e-4 * travelled, "{told}: position off by {moved}");
                let sped = (found.velocity[i].as_dvec3() - reference.velocity[i]).length();
                assert!(sped < 2e-4 * fluid.max_speed, "{told}: velocity off by {sped}");
                let pressed = (f64::from(pressure) - reference.pressure[i]).abs();
                assert!(pressed < 1e-5 * stiffness, "{told}: pressure off by {pressed}");
            }
        }
    }
}

#[test]
fn every_grid_gives_the_same_flow() {
    for dimensions in [2, 3] {
        let mut expected: Option<Particles> = None;
        let grids = if dimensions == 2 {
            common::grids_in_turn(0)
        } else {
            common::grids_by_query()
        };
        for (addressing, storage) in grids {
            let skins: &[&str] = match (storage.sorts, dimensions) {
                // Lists are made of particles in order.
                (false, _) => &["0"],
                (true, 2) => &["0.1"],
                (true, _) => &["0", "0.1"],
            };
            for skin in skins {
                let (addressing, storage) = (addressing.name, storage.name);
                let grid = [
                    format!("neighbors.addressing={addressing}"),
                    format!("neighbors.storage={storage}"),
                    format!("neighbors.skin={skin}"),
                ];
                let mut overrides: Vec<&str> = grid.iter().map(String::as_str).collect();
                overrides.extend(["neighbors.slots=64", "fluid.artificial_viscosity=0.2"]);
                let found = particles(&stirred(dimensions, 20, &overrides), 1);
                let expected = expected.get_or_insert_with(|| found.clone());
                for (i, (a, b)) in found.velocity.iter().zip(&expected.velocity).enumerate() {
                    let off = a.distance(*b);
                    assert!(
                        off < 1e-3,
                        "{dimensions}D {grid:?}: velocity of {i} off by {off} m/s"
                    );
                }
            }
        }
    }
}
