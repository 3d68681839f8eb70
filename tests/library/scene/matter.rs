//! Numbers that follow from what grains and fluids are made of.

use std::f64::consts::PI;

use serde_json::json;
use sliceflow::scene::{Dimensions, library, load};

use super::{assert_near, ball_mass, block, valid};

/// Speed after over before a head-on contact: the oscillator m_eff x″ = −k x − η x′, integrated until it parts.
fn rebound(spring: f64, damping: f64, effective_mass: f64) -> (f64, f64) {
    let (mut x, mut v, mut time) = (0.0, 1.0, 0.0);
    let dt = 1e-4 * (effective_mass / spring).sqrt();
    let slope = |x: f64, v: f64| (-spring * x - damping * v) / effective_mass;
    loop {
        // Midpoint rule.
        let (half_x, half_v) = (x + v * dt / 2.0, v + slope(x, v) * dt / 2.0);
        let (next_x, next_v) = (x + half_v * dt, v + slope(half_x, half_v) * dt);
        if next_x < 0.0 {
            return (-next_v, time);
        }
        (x, v, time) = (next_x, next_v, time + dt);
    }
}

#[test]
fn restitution_and_duration_are_those_of_the_oscillator() {
    let mass = ball_mass();
    for e in [0.2, 0.5, 0.9] {
        let mut given = block();
        given["grains"]["restitution"] = json!(e);
        let scene = valid(&given, &[]);
        assert_near(scene.grains().unwrap().mass, mass);
        let contact = scene.grains().unwrap().contact.clone();
        let (after, duration) = rebound(contact.spring, contact.damping, mass / 2.0);
        assert!((after - e).abs() < 1e-3, "two grains: {after} for {e}");
        assert!((scene.time.contact_duration.unwrap() / duration - 1.0).abs() < 1e-3);
        let (after, _) = rebound(contact.spring, contact.wall_damping, mass);
        assert!((after - e).abs() < 1e-3, "wall: {after} for {e}");
    }
}

#[test]
fn a_damping_is_taken_as_given() {
    let mut given = block();
    given["grains"] = json!({ "radius": 0.05, "spring": 1000, "damping": 2.5 });
    let contact = valid(&given, &[]).grains().unwrap().contact.clone();
    assert_eq!((contact.damping, contact.wall_damping), (2.5, 2.5));
}

#[test]
fn a_disc_is_one_metre_thick() {
    let scene = valid(
        &json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [1, 1] },
            "gravity": [0, -1, 0],
            "grains": { "radius": 0.1, "density": 10, "spring": 1000, "restitution": 1 },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.4, 0.6] } }]
        }),
        &[],
    );
    assert_eq!(scene.dimensions, Dimensions::Two);
    assert_near(scene.grains().unwrap().mass, 10.0 * PI * 0.01);
    assert_eq!(scene.particles.len(), 6);
    assert_eq!((scene.domain.min.z, scene.domain.max.z), (0.0, 0.0));
    assert!(scene.particles.position.iter().all(|p| p.z == 0.0));
    assert_eq!(scene.grains().unwrap().contact.damping, 0.0);
}

#[test]
fn an_overdamped_contact_has_a_finite_duration() {
    let mut given = block();
    given["grains"] = json!({ "radius": 0.05, "density": 1000, "spring": 1000, "damping": 1000 });
    let scene = valid(&given, &[]);
    assert_near(
        scene.time.contact_duration.unwrap(),
        PI * ball_mass() / 2.0 / 1000.0,
    );
}

/// Where nothing is beside a particle, the fluid ends.
#[test]
fn free_surfaces_are_found() {
    let folder = library::folder().unwrap();
    let of = |name: &str, overrides: &[&str]| {
        let text = library::find(name).unwrap();
        let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
        let scene = load::parse(text, "test.json", &folder, &overrides).unwrap();
        scene.fluid().unwrap().free_surface
    };
    for name in [
        "taylor_green_2d",
        "lid_cavity",
        "poiseuille",
        "couette",
        "taylor_couette",
    ] {
        assert!(!of(name, &[]), "{name}");
    }
    assert!(!of("lid_cavity", &["domain.walls=planes"]));
    assert!(!of("taylor_green_3d", &["fluid.spacing=0.1"]));
    for name in [
        "still_water",
        "dam_break_2d",
        "rotating_square",
        "elliptical_drop",
    ] {
        assert!(of(name, &[]), "{name}");
    }
    assert!(of("still_water", &["domain.walls=planes"]));
}
