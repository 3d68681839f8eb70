//! Where grains of several sizes are put, kept and drawn, and what does not know them.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::output::columns_named;
use sliceflow::plan::Wanted;
use sliceflow::scene::model::View;

use super::{R, radii_of, scene, sized};
use crate::common;
use crate::rotating::{empty, parse};

/// Grains of a log-normal distribution fall into a box: a body, an emitter and a ball that drops.
fn poured() -> Value {
    json!({
        "domain": { "min": [-0.1, 0, -0.06], "max": [0.1, 0.25, 0.06] },
        "seed": 5,
        "grains": {
            "radius": R, "law": "linear", "spring": 1e3, "restitution": 0.4, "friction": 0.5, "rolling_friction": 0.1,
            "sizes": { "kind": "log_normal", "smallest": R / 3.0, "mean": R / 2.0, "deviation": R / 8.0 }
        },
        "bodies": [{ "shape": { "kind": "box", "min": [-0.1, 0, -0.06], "max": [0.1, 0.05, 0.06] } }],
        "emitters": [{ "name": "spout", "center": [0, 0.2, 0], "radius": 0.03, "velocity": [0, -1, 0] }],
        "events": [{ "at": 0.05, "drop": { "center": [0.06, 0.15, 0], "radius": 0.02 } }],
        "time": { "duration": 0.2, "fps": 50 }
    })
}

#[test]
fn a_run_that_goes_on_is_the_run_that_was_never_interrupted() {
    let scene = parse(&poured()).unwrap();
    let wanted = Wanted {
        statistics: true,
        columns: columns_named([
            "position",
            "velocity",
            "angular_velocity",
            "radius",
            "contacts",
            "pressure",
        ])
        .unwrap(),
        ..Default::default()
    };
    let mut through = common::simulate(&scene, &wanted);
    let whole = common::frames(&mut through, 5);
    let mut first = common::simulate(&scene, &wanted);
    common::frames(&mut first, 2);
    let state = first.save_state().unwrap();
    let mut second = common::simulate(&scene, &wanted);
    second.restore(&state).unwrap();
    let rest = common::frames(&mut second, 5);
    assert_eq!(rest.last().unwrap().index, 5);
    for frame in rest {
        let other = &whole[frame.index as usize];
        assert_eq!(frame.statistics, other.statistics);
        assert!(
            frame.columns.iter().zip(&other.columns).all(|(a, b)| a == b),
            "frame {}",
            frame.index
        );
    }
    assert!(through.save_state().unwrap() == second.save_state().unwrap());
    // Each grain keeps its own radius.
    let radii = radii_of(whole.last().unwrap());
    assert!(
        radii.len() > scene.particles.len() + 20,
        "emitter and ball add some"
    );
    assert_eq!(radii[..scene.particles.len()], scene.particles.radius);
    // A state without radii does not fit, nor one of grains that the scene does not allow.
    let mut other = poured();
    other["grains"]["sizes"] = json!({ "kind": "uniform", "smallest": R / 2.0 });
    let other = parse(&other).unwrap();
    let mut other = common::simulate(&other, &wanted);
    assert!(other.restore(&state).is_err());
}

#[test]
fn grains_are_filled_in_without_order_overlap_or_chance() {
    let scene = parse(&poured()).unwrap();
    let again = parse(&poured()).unwrap();
    assert_eq!(scene.particles, again.particles);
    let (x, r) = (&scene.particles.position, &scene.particles.radius);
    let mut turned: f64 = 0.0;
    for i in 0..x.len() {
        for j in 0..i {
            assert!(
                x[i].distance(x[j]) > (r[i] + r[j]) * 0.9999,
                "{i} and {j} overlap"
            );
        }
        // Around a lattice's axes this would be 1.
        turned += (4.0 * f64::from((x[i].x - x[0].x).atan2(x[i].z - x[0].z))).cos();
    }
    let filled: f64 = r
        .iter()
        .map(|&r| 4.0 / 3.0 * PI * f64::from(r).powi(3))
        .sum::<f64>()
        / (0.2 * 0.05 * 0.12);
    println!(
        "{} grains fill {filled:.3}, {:.2}",
        x.len(),
        turned / x.len() as f64
    );
    assert!((0.45..0.501).contains(&filled));
}

#[test]
fn particle_files_bring_radii() {
    let folder = std::env::temp_dir().join("sliceflow_sizes");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("two.csv");
    let mut file = empty(
        0.1,
        sized(json!({ "law": "linear", "spring": 1e3, "restitution": 0.5 })),
    );
    file["bodies"] = json!([{ "shape": { "kind": "particles", "file": path } }]);
    std::fs::write(&path, "x,y,z,radius\n0,0,0,0.01\n0.0125,0,0,0.0025\n").unwrap();
    let scene = parse(&file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.particles.radius, [0.01, 0.0025]);
    assert_eq!(scene.particles.len(), 2, "they touch and do not overlap");
    file["bodies"][0]["shape"]["placement"] = json!({ "scale": 0.5 });
    std::fs::write(&path, "x,y,z,pscale\n0,0,0,0.02\n0.1,0,0,0.006\n").unwrap();
    assert_eq!(parse(&file).unwrap().particles.radius, [0.01, 0.003]);
    let refused = |text: &str, expected: &str| {
        std::fs::write(&path, text).unwrap();
        let message = parse(&file).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    refused("x,y,z\n0,0,0\n", "has no radii");
    refused("x,y,z,radius\n0,0,0,0.004\n", "a grain's radius is 0.002 m");
}

#[test]
fn what_does_not_know_sizes_says_so() {
    let good = poured();
    let refused = |path: &str, value: Value, expected: &str| {
        let mut file = good.clone();
        *file.pointer_mut(path).unwrap_or_else(|| panic!("{path}")) = value;
        let message = parse(&file)
            .err()
            .unwrap_or_else(|| panic!("{path} is refused"))
            .to_string();
        assert!(message.contains(expected), "{path}: {message}");
    };
    let sizes = "/grains/sizes";
    refused(
        sizes,
        json!({ "kind": "uniform", "smallest": 0.002 }),
        "radii differ by a factor of 5",
    );
    refused(
        sizes,
        json!({ "kind": "uniform", "smallest": 0.01 }),
        "is not below grains.radius",
    );
    refused(
        sizes,
        json!({ "kind": "normal", "smallest": 0.005, "mean": 0.02, "deviation": 0.001 }),
        "between the smallest and the largest radius",
    );
    let curve = |rows: [[f64; 2]; 3]| {
        let rows = rows.map(|[radius, passing]| json!({ "radius": radius, "passing": passing }));
        json!({ "kind": "sieve", "curve": rows })
    };
    refused(
        sizes,
        curve([[0.005, 0.0], [0.004, 0.5], [0.01, 1.0]]),
        "is not above the row before",
    );
    refused(
        sizes,
        curve([[0.005, 0.1], [0.008, 0.5], [0.01, 1.0]]),
        "from nothing to everything",
    );
    refused(
        "/bodies/0",
        json!({ "shape": good["bodies"][0]["shape"], "arrangement": "lattice" }),
        "on no lattice",
    );
    refused(
        "/bodies/0",
        json!({ "shape": good["bodies"][0]["shape"], "rigid": {} }),
        "particles of one size",
    );
    refused(
        "/grains",
        sized(json!({ "law": "spring_dashpot", "spring": 1e3, "damping": 1 })),
        "another restitution",
    );
    refused(
        "/domain",
        json!({ "min": [-0.1, 0, -0.06], "max": [0.1, 0.25, 0.06], "walls": "clamp" }),
        "walls that clamp know one radius",
    );
}

#[test]
fn grains_are_drawn_as_large_as_they_are() {
    let grains = [
        (DVec3::new(-0.02, 0.0, 0.0), DVec3::ZERO, R),
        (DVec3::new(0.02, 0.0, 0.0), DVec3::ZERO, R / 4.0),
    ];
    for look in ["splats", "spheres"] {
        let mut file = empty(
            0.05,
            sized(json!({ "law": "linear", "spring": 1e3, "restitution": 0.5 })),
        );
        file["render"] = json!({
            "size": [400, 400], "look": look, "background": "white",
            "camera": { "axis": "z", "height": 0.1 },
            "show": { "domain": false, "overlay": false, "floor": false },
            "color": { "by": "x", "map": "viridis", "range": [-0.02, 0.02], "legend": false }
        });
        let scene = scene(&file, &grains);
        let wanted = Wanted {
            view: Some(View::Scene),
            ..Default::default()
        };
        let frame = common::frames(&mut common::simulate(&scene, &wanted), 0)
            .pop()
            .unwrap();
        let pixels = frame.pixels.unwrap();
        // Their color is saturated, the background's is not.
        let is_colored = |x: usize, y: usize| {
            let pixel = &pixels[4 * (400 * y + x)..][..3];
            pixel.iter().max().unwrap() - pixel.iter().min().unwrap() > 40
        };
        let area = |from: usize, to: usize| {
            (0..400)
                .map(|y| (from..to).filter(|&x| is_colored(x, y)).count())
                .sum::<usize>() as f64
        };
        let [large, small] = [area(0, 200), area(200, 400)];
        println!("{look}: {large} and {small} pixels");
        assert!((large / (PI * 40.0 * 40.0) - 1.0).abs() < 0.15, "{look}: {large}");
        assert!((small / (PI * 10.0 * 10.0) - 1.0).abs() < 0.15, "{look}: {small}");
    }
}
