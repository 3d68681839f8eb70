//! Camera paths, motion blur and depth of field against what a pinhole sees. Needs an adapter; software Vulkan will do.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use sliceflow::render::blur::moments;
use sliceflow::render::{Layout, Sight};
use sliceflow::scene::model::{Easing, Splat, View};
use sliceflow::scene::motion::eased;
use sliceflow::scene::{Dimensions, Particles, Scene};

use crate::common;
use crate::place::Place;
use crate::stage;

fn sight(scene: &Scene, time: f64) -> Sight {
    let layout = Layout::new(scene, View::Scene);
    Sight::new(scene, scene.render.size, layout.insets, time)
}

#[test]
fn paths_ease_and_look_at_their_targets() {
    let points = [
        (1.0, DVec3::ZERO),
        (2.0, DVec3::X),
        (4.0, DVec3::new(1.0, 2.0, 0.0)),
    ];
    for easing in [Easing::Smooth, Easing::Linear, Easing::Spline] {
        for (at, place) in points {
            assert!(eased(&points, easing, at).distance(place) < 1e-12, "{easing:?}");
        }
        assert_eq!(eased(&points, easing, 0.0), points[0].1);
        assert_eq!(eased(&points, easing, 9.0), points[2].1);
        assert_eq!(eased(&points[..1], easing, 9.0), points[0].1);
    }
    let speed = |easing, time: f64| {
        let step = 1e-5;
        (eased(&points, easing, time + step) - eased(&points, easing, time)).length() / step
    };
    // Half of the way in half of the time, and at rest at the ends.
    assert!((eased(&points, Easing::Smooth, 1.5).x - 0.5).abs() < 1e-12);
    assert!(speed(Easing::Smooth, 1.0) < 1e-3 && speed(Easing::Smooth, 2.0) < 1e-3);
    assert!((speed(Easing::Smooth, 1.5) - 1.5).abs() < 1e-3);
    assert!((speed(Easing::Linear, 1.0001) - 1.0).abs() < 1e-3);
    assert!(speed(Easing::Spline, 2.0) > 0.5);

    let scene = common::scene(
        3,
        &[
            r#"render.camera={"easing":"linear","path":[{"at":0,"eye":[0,0.2,3],"target":[0,0.2,0]},{"at":0.4,"eye":[3,0.2,0],"target":[0,0.6,0]}]}"#,
        ],
    );
    let half = sight(&scene, 0.2);
    assert!((half.eye + scene.origin).distance(DVec3::new(1.5, 0.2, 1.5)) < 1e-9);
    let toward = (DVec3::new(0.0, 0.4, 0.0) - DVec3::new(1.5, 0.2, 1.5)).normalize();
    assert!(half.forward.distance(toward) < 1e-9);
}

#[test]
fn paths_that_make_no_sense_are_refused() {
    let place = Place::new();
    for (camera, what) in [
        (r#"{"path":[{"at":0}]}"#, "neither `eye` nor `target`"),
        (
            r#"{"path":[{"at":0,"eye":[0,0,1]},{"at":0,"eye":[0,1,1]}]}"#,
            "not later than the point before",
        ),
        (
            r#"{"path":[{"at":0,"eye":[0,0,1]},{"at":1,"target":[0,1,1]}]}"#,
            "other keys than the first",
        ),
        (
            r#"{"eye":[1,1,1],"path":[{"at":0,"eye":[0,0,1]}]}"#,
            "`render.camera.eye`",
        ),
        (
            r#"{"path":[{"at":0,"eye":[0,0,1],"target":[0,0,1]}]}"#,
            "one point",
        ),
        (r#"{"axis":"z","aperture":0.1}"#, "no depth of field"),
    ] {
        let camera = format!("render.camera={camera}");
        let told = place.told(&mut place.sliceflow(&["run", "green_cube", "--set", &camera]), 2);
        assert!(told.contains(what), "{told}");
    }
}

/// A ball of 12 pixels before black, one sample a pixel, as an orthographic view along z sees it.
fn ball() -> (Scene, Particles) {
    let mut scene = stage::scene(
        Dimensions::Three,
        Vec3::splat(-1.0),
        Vec3::splat(1.0),
        0.1,
        [160, 120],
    );
    stage::bare(&mut scene, Splat::Sphere);
    scene.render.camera.height = Some(2.0);
    scene.render.camera.axis = Some(sliceflow::scene::model::Axis::Z);
    scene.render.camera.target = Some([0.0; 3]);
    let mut particles = Particles::default();
    particles.position.push(Vec3::ZERO);
    particles.velocity.push(Vec3::new(12.0, 0.0, 0.0));
    (scene, particles)
}

/// First and last column that is not black.
fn extent(image: &RgbaImage) -> (u32, u32) {
    let lit = |&x: &u32| (0..120).any(|y| image.get_pixel(x, y).0[..3].iter().any(|&c| c > 8));
    let mut columns = (0..160).filter(lit);
    let first = columns.next().unwrap();
    (first, columns.next_back().unwrap())
}

#[test]
fn what_moves_is_blurred_along_its_way_and_stays_where_it_is() {
    let gpu = stage::gpu();
    let (mut scene, particles) = ball();
    let sharp = extent(&stage::picture(&gpu, &scene, &particles));
    assert_eq!(sharp, (74, 85));
    // 12 m/s are 24 pixels from one frame to the next; the shutter is open for half of that.
    scene.render.shutter = 0.5;
    scene.render.subframes = 12;
    let times: Vec<f64> = moments(&scene)
        .iter()
        .map(|moment| moment.after_s * 720.0)
        .collect();
    let mut sorted = times.clone();
    sorted.sort_by(f64::total_cmp);
    for (k, time) in sorted.iter().enumerate() {
        assert!((time - (k as f64 - 5.5)).abs() < 1e-9, "{times:?}");
    }
    let image = stage::picture(&gpu, &scene, &particles);
    let (first, last) = extent(&image);
    assert!(
        first.abs_diff(74 - 6) <= 1 && last.abs_diff(85 + 6) <= 1,
        "{first} to {last}"
    );
    // The same again, to the bit: positions are put back.
    let mut buffers = stage::buffers(&gpu, &scene, &particles);
    let variant = stage::variant(&scene);
    let mut renderer =
        sliceflow::render::Renderer::new(&gpu, &scene, &variant, &mut buffers, View::Scene).unwrap();
    let frames = [0, 1].map(|_| stage::frame(&gpu, &mut renderer, &buffers, 1, &[]));
    assert!(frames[0] == frames[1], "two frames of the same state differ");
}

#[test]
fn what_is_out_of_focus_spreads_and_what_is_in_focus_does_not() {
    let gpu = stage::gpu();
    let (mut scene, particles) = ball();
    scene.render.camera.axis = None;
    scene.render.camera.eye = Some([0.0, 0.0, 5.0]);
    let width = |scene: &Scene| {
        let (first, last) = extent(&stage::picture(&gpu, scene, &particles));
        f64::from(last - first + 1)
    };
    let sharp = width(&scene);
    scene.render.subframes = 32;
    scene.render.camera.aperture = 0.4;
    // The target is in focus when nothing else is said.
    assert!((width(&scene) - sharp).abs() <= 1.0);
    // From a lens 0.4 m wide that is sharp at 10 m, a point at 5 m is a disc of 0.4 × (10 − 5) / 10 m at its own distance.
    scene.render.camera.focus = Some(10.0);
    let pixels_per_metre = 60.0 / (5.0 * 17.5_f64.to_radians().tan());
    let spread = width(&scene) - sharp;
    let expected = 0.2 * pixels_per_metre;
    assert!(
        (spread - expected).abs() <= 2.0,
        "{spread} instead of {expected} pixels"
    );
}

/// How many pixels more than the sharp picture a blurred one covers on the left and on the right.
fn blurred(scene: &mut Scene, particles: &Particles) -> [i64; 2] {
    let gpu = stage::gpu();
    let sharp = extent(&stage::picture(&gpu, scene, particles));
    scene.render.shutter = 0.5;
    scene.render.subframes = 12;
    let blurred = extent(&stage::picture(&gpu, scene, particles));
    [
        i64::from(sharp.0) - i64::from(blurred.0),
        i64::from(blurred.1) - i64::from(sharp.1),
    ]
}

// The frame is that at 0 s, where paths begin: half of the pictures, up to 11/24 of the 1/60 s that the shutter is open, are taken
// on the way.

#[test]
fn a_camera_that_moves_blurs_what_rests() {
    let (mut scene, mut particles) = ball();
    particles.velocity[0] = Vec3::ZERO;
    scene.render.camera = serde_json::from_value(serde_json::json!({
        "easing": "linear",
        "path": [
            { "at": 0, "eye": [0, 0, 5], "target": [0, 0, 0] },
            { "at": 0.1, "eye": [2.4, 0, 5], "target": [2.4, 0, 0] }
        ]
    }))
    .unwrap();
    // 24 m/s to the right, 5 m before the ball.
    let way = 24.0 * 11.0 / 24.0 / 60.0 * 60.0 / (5.0 * 17.5_f64.to_radians().tan());
    let [left, right] = blurred(&mut scene, &particles);
    assert!(
        (left as f64 - way).abs() <= 1.0 && right.abs() <= 1,
        "{left} and {right} pixels, not {way} on the left"
    );
}

#[test]
fn an_obstacle_that_moves_is_blurred_along_its_path() {
    // The ball rests inside and is not seen.
    let (mut scene, mut particles) = ball();
    particles.velocity[0] = Vec3::ZERO;
    let obstacle = r#"colliders=[{"shape":{"kind":"sphere","center":[0,0,0],"radius":0.3},
        "path":[{"at":0,"offset":[0,0,0]},{"at":0.1,"offset":[1.2,0,0]}]}]"#;
    scene.colliders = common::scene(3, &[obstacle, "domain.min=[-1,-1,-1]", "domain.max=[1,1,1]"]).colliders;
    // 12 m/s at 60 pixels a metre.
    let way = 12.0 * 11.0 / 24.0 / 60.0 * 60.0;
    let [left, right] = blurred(&mut scene, &particles);
    assert!(
        left.abs() <= 1 && (right as f64 - way).abs() <= 1.0,
        "{left} and {right} pixels, not {way} on the right"
    );
}
