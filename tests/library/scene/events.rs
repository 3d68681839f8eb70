//! Events, emitters and paths.

use glam::Vec3;
use serde_json::{Value, json};
use sliceflow::scene::{Action, Contact, Scheduled};

use super::{assert_near, block, message, valid};

fn added(scheduled: &Scheduled) -> usize {
    match &scheduled.action {
        Action::Add(particles) => particles.len(),
        Action::SetParameters { .. } => 0,
    }
}

#[test]
fn events_keep_what_they_do_not_change() {
    let mut given = block();
    given["events"] = json!([
        { "at": 1.5, "set": { "gravity": [1, 0, 0] } },
        { "at": 0.5, "set": { "spring": 4000 } }
    ]);
    let scene = valid(&given, &[]);
    let parameters: Vec<(f64, Vec3, Contact)> = scene
        .schedule
        .iter()
        .filter_map(|scheduled| match &scheduled.action {
            Action::SetParameters { gravity, matter } => {
                Some((scheduled.time, *gravity, matter.grains()?.contact.clone()))
            }
            Action::Add(_) => None,
        })
        .collect();
    let [(first, gravity, ref stiff), (second, turned, ref later)] = parameters[..] else {
        panic!("{parameters:?}");
    };
    assert_eq!((first, second), (0.5, 1.5));
    assert_eq!(gravity, scene.gravity);
    assert_eq!(turned, Vec3::X);
    assert_eq!(stiff, later);
    assert_eq!(stiff.spring, 4000.0);
    // The restitution of 0.5 holds on.
    assert_near(stiff.damping, 2.0 * scene.grains().unwrap().contact.damping);
}

#[test]
fn events_change_what_a_solver_has_and_nothing_else() {
    let told = |matter: &str, value: Value, set: Value| {
        let mut given = block();
        given.as_object_mut().unwrap().remove("grains");
        given[matter] = value;
        given["events"] = json!([{ "at": 0.5, "set": set }]);
        message(&given, &[])
    };
    let grains = block()["grains"].clone();
    let told_of_grains = told("grains", grains, json!({ "viscosity": 1, "sound_speed": 20 }));
    for part in [
        "events[0].set.viscosity",
        "events[0].set.sound_speed",
        "has no effect on grains",
        "`gravity`, `spring`",
    ] {
        assert!(told_of_grains.contains(part), "{part}: {told_of_grains}");
    }
    let water = json!({ "spacing": 0.1, "solver": "dfsph" });
    let told_of_dfsph = told("fluid", water, json!({ "sound_speed": 20, "spring": 3 }));
    for part in [
        "events[0].set.sound_speed",
        "events[0].set.spring",
        "`gravity`, `viscosity`, `artificial_viscosity`",
    ] {
        assert!(told_of_dfsph.contains(part), "{part}: {told_of_dfsph}");
    }
    let water = json!({ "spacing": 0.1 });
    let told_of_water = told("fluid", water, json!({ "wall_friction": 0.1, "material": "oil" }));
    for part in [
        "wall_friction",
        "sticks to",
        "names a material of which nothing changes",
        "no material is called",
    ] {
        assert!(told_of_water.contains(part), "{part}: {told_of_water}");
    }
}

#[test]
fn a_drop_is_a_ball_of_grains() {
    let mut given = block();
    given["events"] =
        json!([{ "at": 1, "drop": { "center": [0, -0.5, 0], "radius": 0.15, "velocity": [0, -2, 0] } }]);
    let scene = valid(&given, &[]);
    let [
        Scheduled {
            time: 1.0,
            action: Action::Add(ball),
        },
    ] = &scene.schedule[..]
    else {
        panic!("{:?}", scene.schedule);
    };
    // Center and six neighbors at 0.1 m.
    assert_eq!(ball.len(), 7);
    assert!(
        ball.position
            .iter()
            .all(|p| p.distance(Vec3::new(0.0, -0.5, 0.0)) < 0.1001)
    );
    assert!(ball.velocity.iter().all(|v| *v == Vec3::new(0.0, -2.0, 0.0)));
    assert_eq!(scene.capacity, 71);
}

#[test]
fn an_emitter_lets_in_layers_until_it_is_switched_off() {
    let mut given = block();
    // A hexagon: the center and six around it, 0.125 m away; a layer every 0.125 s.
    given["emitters"] = json!([{
        "name": "tap", "center": [0, 0.8, 0], "radius": 0.18, "velocity": [0, -1, 0], "spacing": 0.125, "on": false
    }]);
    given["events"] = json!([
        { "at": 1.0, "emitter": { "name": "tap", "on": false } },
        { "at": 0.5, "emitter": { "name": "tap", "on": true } },
        { "at": 1.75, "emitter": { "name": "tap", "on": true } }
    ]);
    let scene = valid(&given, &[]);
    let times: Vec<f64> = scene.schedule.iter().map(|scheduled| scheduled.time).collect();
    assert_eq!(times, [0.5, 0.625, 0.75, 0.875, 1.75, 1.875]);
    assert!(scene.schedule.iter().all(|scheduled| added(scheduled) == 7));
    assert_eq!(scene.capacity, 64 + 42);
    let Action::Add(layer) = &scene.schedule[0].action else {
        panic!("not a layer");
    };
    for (i, point) in layer.position.iter().enumerate() {
        assert_eq!(point.y, 0.8);
        for other in &layer.position[..i] {
            assert!(point.distance(*other) > 0.1249);
        }
    }
}

#[test]
fn an_emitter_in_2d_is_a_line() {
    let scene = valid(
        &json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [2, 2] },
            "gravity": [0, 0],
            "grains": { "radius": 0.05, "spring": 1000, "restitution": 0.5 },
            "emitters": [{ "name": "slit", "center": [1, 1], "radius": 0.28, "velocity": [0.3, 0.4] }],
            "time": { "duration": 1, "fps": 10 }
        }),
        &[],
    );
    // 2.2 radii apart at 0.5 m/s: every 0.22 s.
    assert_eq!(scene.schedule.len(), 5);
    assert_near(scene.schedule[1].time, 0.22);
    let Action::Add(layer) = &scene.schedule[4].action else {
        panic!("not a layer");
    };
    assert_eq!(layer.len(), 5);
    for pair in layer.position.windows(2) {
        assert!((pair[0].distance(pair[1]) - 0.11).abs() < 1e-6);
        assert!((pair[1] - pair[0]).dot(Vec3::new(0.3, 0.4, 0.0)).abs() < 1e-6);
    }
}

#[test]
fn moves_go_on_from_where_the_collider_is() {
    let mut given = block();
    given["colliders"] = json!([{
        "name": "piston",
        "shape": { "kind": "sphere", "center": [-0.5, 0, 0], "radius": 0.1 },
        "path": [{ "at": 0, "offset": [0, 0, 0] }, { "at": 1, "offset": [0, 0.5, 0] }]
    }]);
    given["events"] = json!([
        { "at": 1.5, "move": { "collider": "piston", "by": [0, 0, 0.25], "during": 0.25 } },
        { "at": 0.5, "move": { "collider": "piston", "by": [0.5, 0, 0], "during": 0.25 } }
    ]);
    let path = &valid(&given, &[]).colliders[0].path;
    let expected = [
        (0.0, Vec3::ZERO),
        (0.5, Vec3::new(0.0, 0.25, 0.0)),
        (0.75, Vec3::new(0.5, 0.375, 0.0)),
        (1.0, Vec3::new(0.5, 0.5, 0.0)),
        (1.5, Vec3::new(0.5, 0.5, 0.0)),
        (1.75, Vec3::new(0.5, 0.5, 0.25)),
    ];
    assert_eq!(path[..], expected);
}
