//! Extra images for compositing, read back from their files and held to what rays find in f64. Needs an adapter; software Vulkan
//! will do.

use std::fs;

use glam::{DVec2, DVec3};

use crate::place::Place;

#[path = "../common/exr.rs"]
mod exr;

use exr::Image;

const NOTHING: f64 = 1e10;
const ALL: &str = "color,depth,normal,id,velocity,motion";

/// A ball and a box that both move, seen from the front. There is no floor.
const BALL: &str = r#"{
  "domain": { "min": [-1, -1, -1], "max": [1, 1, 1] },
  "gravity": [0, 0, 0],
  "grains": { "radius": 0.3, "density": 1000, "spring": 20000, "restitution": 0.5 },
  "bodies": [{ "shape": { "kind": "box", "min": [-0.2, -0.3, -0.1], "max": [0.4, 0.3, 0.5] }, "velocity": [0.5, 0.25, -1] }],
  "colliders": [{ "name": "box", "shape": { "kind": "box", "min": [-0.9, -0.9, -0.9], "max": [-0.5, 0.9, -0.5] },
    "path": [{ "at": 0, "offset": [0, 0, 0] }, { "at": 1, "offset": [0, 0.6, 0] }] }],
  "time": { "duration": 0.1, "fps": 30 },
  "render": {
    "size": [160, 120], "camera": { "eye": [0, 0, 4], "target": [0, 0, 0] }, "background": "transparent",
    "show": { "domain": false, "overlay": false }
  }
}"#;
const EYE: DVec3 = DVec3::new(0.0, 0.0, 4.0);
const CENTER: DVec3 = DVec3::new(0.1, 0.0, 0.2);
const VELOCITY: DVec3 = DVec3::new(0.5, 0.25, -1.0);
const RADIUS: f64 = 0.3;

fn write(place: &Place, name: &str, scene: &str) {
    fs::write(place.path(name), scene).unwrap();
}

fn read(place: &Place, name: &str) -> Image {
    exr::read(&fs::read(place.path(name)).unwrap())
}

impl Image {
    fn at(&self, channel: &str, pixel: usize) -> f64 {
        self.channels[channel][pixel]
    }

    fn vector(&self, layer: &str, pixel: usize) -> DVec3 {
        DVec3::from(["X", "Y", "Z"].map(|axis| self.at(&format!("{layer}.{axis}"), pixel)))
    }
}

/// Where the camera sees a point, in pixels from the lower left corner.
fn seen(point: DVec3) -> DVec2 {
    let tangent = 17.5_f64.to_radians().tan();
    let away = EYE.z - point.z;
    DVec2::new(
        80.0 + 60.0 * point.x / (away * tangent),
        60.0 + 60.0 * point.y / (away * tangent),
    )
}

#[test]
fn a_ball_and_a_box_are_where_rays_meet_them() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let run = ["run", "ball.json", "--frames", "1", "-o", "ball", "--passes", ALL];
    place.told(&mut place.sliceflow(&run), 0);
    let image = read(&place, "ball/frame_000000.exr");
    assert_eq!([image.width, image.height], [160, 120]);
    let picture = image::open(place.path("ball/frame_000000.png"))
        .unwrap()
        .to_rgba8();
    let tangent = 17.5_f64.to_radians().tan();
    let (mut of_ball, mut of_box, mut steepest) = (0, 0, 1.0_f64);
    for pixel in 0..160 * 120 {
        let (x, y) = (pixel % 160, pixel / 160);
        let ray = DVec3::new(
            (x as f64 - 79.5) / 60.0 * tangent,
            (59.5 - y as f64) / 60.0 * tangent,
            -1.0,
        );
        let along = ray.normalize();
        let beside = (CENTER - EYE) - along * (CENTER - EYE).dot(along);
        // Where what is drawn agrees with the ray's square root, clear of the rim.
        let is_rim = (beside.length() - RADIUS).abs() < 1e-4;
        let depth = image.at("Z", pixel);
        match image.at("id", pixel) {
            1.0 => {
                of_ball += 1;
                assert!(beside.length() < RADIUS + 1e-4);
                let point = EYE
                    + along
                        * ((CENTER - EYE).dot(along)
                            - (RADIUS.powi(2) - beside.length_squared()).max(0.0).sqrt());
                let normal = (point - CENTER) / RADIUS;
                if is_rim {
                    continue;
                }
                assert!(
                    (depth - (EYE.z - point.z)).abs() < 2e-4,
                    "({x}, {y}): {depth} instead of {}",
                    EYE.z - point.z
                );
                let found = image.vector("normal", pixel);
                assert!(
                    found.distance(normal) < 3e-3,
                    "({x}, {y}): {found} instead of {normal}"
                );
                steepest = steepest.min(found.dot(-along));
                assert_eq!(image.vector("velocity", pixel), VELOCITY);
                let moved = seen(point + VELOCITY / 30.0) - seen(point);
                let motion = DVec2::new(image.at("motion.X", pixel), image.at("motion.Y", pixel));
                assert!(
                    motion.distance(moved) < 2e-3,
                    "({x}, {y}): {motion} instead of {moved}"
                );
            }
            4_294_967_295.0 => {
                of_box += 1;
                // Its front, and its side towards the ball.
                let normal = image.vector("normal", pixel);
                match normal == DVec3::Z {
                    true => assert!((depth - 4.5).abs() < 1e-4, "({x}, {y}) {depth}"),
                    false => assert_eq!(normal, DVec3::X),
                }
                assert!(
                    image
                        .vector("velocity", pixel)
                        .distance(DVec3::new(0.0, 0.6, 0.0))
                        < 1e-3
                );
                let moved = 60.0 * 0.6 / 30.0 / (depth * tangent);
                assert!((image.at("motion.Y", pixel) - moved).abs() < 2e-3, "({x}, {y})");
            }
            other => {
                assert_eq!((other, depth), (0.0, NOTHING), "({x}, {y})");
                assert!(beside.length() > RADIUS - 1e-4, "({x}, {y})");
                assert_eq!(image.vector("normal", pixel), DVec3::ZERO);
            }
        }
        // Linear light multiplied by alpha is what the picture shows as sRGB, where rounding is no matter.
        let alpha = image.at("A", pixel);
        let [r, _, _, a] = picture.get_pixel(x as u32, y as u32).0;
        assert!((alpha * 255.0 - f64::from(a)).abs() <= 0.6, "({x}, {y})");
        if a == 255 {
            let share = f64::from(r) / 255.0;
            let linear = if share <= 0.04045 {
                share / 12.92
            } else {
                ((share + 0.055) / 1.055).powf(2.4)
            };
            assert!((image.at("R", pixel) - linear).abs() < 0.006, "({x}, {y})");
        }
    }
    assert!(of_ball > 600 && of_box > 1000, "{of_ball} and {of_box} pixels");
    assert!(steepest < 0.2, "no pixel sees the ball's rim: {steepest}");
    let manifest = place.manifest("ball");
    let told = manifest["files"]
        .as_array()
        .unwrap()
        .iter()
        .find(|file| file["name"] == "frame_NNNNNN.exr")
        .unwrap();
    assert!(told["about"].as_str().unwrap().contains("m/s"), "{told}");
}

/// The floor goes on behind everything else that is drawn.
#[test]
fn depths_in_pngs_reach_as_far_as_the_floor() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let run = |kind: &str| {
        let set = [
            "--set",
            "render.background=studio",
            "--set",
            "render.camera.eye=[0,2,4]",
        ];
        let run = ["run", "ball.json", "--frames", "1", "--passes", "depth"];
        let files = ["--pass-files", kind, "-o", kind];
        place.told(&mut place.sliceflow(&[&run[..], &set, &files].concat()), 0);
    };
    run("exr");
    run("png");
    let image = read(&place, "exr/frame_000000.exr");
    let png = image::open(place.path("png/frame_000000.depth.png")).unwrap();
    let numbers = png.into_luma16().into_raw();
    let depths = (0..160 * 120).map(|pixel| image.at("Z", pixel));
    let seen: Vec<(f64, u16)> = depths
        .zip(numbers)
        .filter(|(depth, _)| *depth != NOTHING)
        .collect();
    let farthest = seen.iter().map(|(depth, _)| *depth).fold(0.0, f64::max);
    let nearest = seen.iter().map(|(depth, _)| *depth).fold(f64::MAX, f64::min);
    assert!(farthest > 1.8 * nearest, "{nearest} to {farthest}: no floor");
    let largest = seen.iter().map(|(_, number)| *number).max().unwrap();
    assert!(largest < 65534, "the farthest depth, {farthest} m, is cut off");
}

#[test]
fn pngs_hold_the_same_and_nothing_is_overwritten() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let first = [
        "run",
        "ball.json",
        "--frames",
        "2",
        "--particles",
        "npy",
        "-o",
        "first",
        "--passes",
        ALL,
    ];
    place.told(&mut place.sliceflow(&first), 0);
    let image = read(&place, "first/frame_000001.exr");
    let names = "color,depth,normal,id,motion";
    let pngs = [
        "render",
        "first",
        "--passes",
        names,
        "--pass-files",
        "png",
        "-o",
        "pngs",
        "--frames",
        "1",
    ];
    place.told(&mut place.sliceflow(&pngs), 0);
    let png = |name: &str| image::open(place.path(&format!("pngs/frame_000001.{name}.png"))).unwrap();
    let manifest = place.manifest("pngs");
    let about = |name: &str| {
        let files = manifest["files"].as_array().unwrap();
        let file = files
            .iter()
            .find(|file| file["name"] == format!("frame_NNNNNN.{name}.png"));
        file.unwrap()["about"].as_str().unwrap().to_owned()
    };
    let range: f64 = about("depth")
        .split_once("65534 is ")
        .unwrap()
        .1
        .split_once(' ')
        .unwrap()
        .0
        .parse()
        .unwrap();
    let [depth, normal, id, motion, color] = ["depth", "normal", "id", "motion", "color"].map(png);
    assert_eq!(
        [depth.color(), normal.color()],
        [image::ColorType::L16, image::ColorType::Rgb16]
    );
    let (depth, color) = (depth.into_luma16(), color.into_rgba16());
    let [normal, id, motion] = [normal, id, motion].map(|image| image.into_rgb16());
    for pixel in 0..160 * 120 {
        let (x, y) = (pixel as u32 % 160, pixel as u32 / 160);
        let was = image.at("Z", pixel);
        match depth.get_pixel(x, y).0[0] {
            u16::MAX => assert_eq!(was, NOTHING),
            number => assert!(
                (f64::from(number) / 65534.0 * range - was).abs() < range / 65534.0,
                "{was}"
            ),
        }
        let unit = |number: u16| (f64::from(number) - 32768.0) / 32767.0;
        assert!(
            DVec3::from(normal.get_pixel(x, y).0.map(unit)).distance(image.vector("normal", pixel)) < 1e-4
        );
        let [low, high, _] = id.get_pixel(x, y).0.map(f64::from);
        assert_eq!(low + 65536.0 * high, image.at("id", pixel));
        let [right, up, _] = motion
            .get_pixel(x, y)
            .0
            .map(|number| (f64::from(number) - 32768.0) / 16.0);
        assert!(
            (right - image.at("motion.X", pixel)).abs() < 0.04
                && (up - image.at("motion.Y", pixel)).abs() < 0.04
        );
        let alpha = f64::from(color.get_pixel(x, y).0[3]) / 65535.0;
        assert!((alpha - image.at("A", pixel)).abs() < 1e-3);
    }
    // The same from files, and never over others unasked.
    place.told(&mut place.sliceflow(&["render", "first", "-o", "again"]), 0);
    let bytes = |run: &str| fs::read(place.path(run).join("frame_000001.exr")).unwrap();
    assert!(bytes("first") == bytes("again"), "drawn from files it differs");
    let told = place.told(&mut place.sliceflow(&first), 2);
    assert!(
        told.contains("2 frames, 2 files of extra images") && told.contains("--force"),
        "{told}"
    );
    fs::create_dir(place.path("mine")).unwrap();
    fs::write(place.path("mine/frame_000000.exr"), "mine").unwrap();
    let mine = [
        "run",
        "ball.json",
        "--frames",
        "1",
        "-o",
        "mine",
        "--passes",
        "depth",
        "--force",
    ];
    let told = place.told(&mut place.sliceflow(&mine), 2);
    assert!(told.contains("frame_000000.exr"), "{told}");
    assert_eq!(fs::read(place.path("mine/frame_000000.exr")).unwrap(), b"mine");
}

#[test]
fn a_run_that_goes_on_writes_them_too() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let whole = [
        "run",
        "ball.json",
        "--frames",
        "3",
        "-o",
        "whole",
        "--passes",
        "depth,id",
    ];
    place.told(&mut place.sliceflow(&whole), 0);
    let short = [
        "run",
        "ball.json",
        "--frames",
        "2",
        "-o",
        "short",
        "--passes",
        "depth,id",
    ];
    place.told(&mut place.sliceflow(&short), 0);
    place.told(&mut place.sliceflow(&["resume", "short", "--frames", "3"]), 0);
    place.assert_same("whole", "short", "resumed");
    assert!(place.path("short/frame_000002.exr").exists());
}

/// Still water fills a tank to 0.3 m. Each pixel that looks into it sees a flat surface that faces up.
#[test]
fn water_has_the_depth_of_its_smooth_surface() {
    let place = Place::new();
    write(
        &place,
        "tank.json",
        r#"{
          "domain": { "min": [0, 0, 0], "max": [0.6, 0.5, 0.4] },
          "fluid": { "spacing": 0.04, "solver": "dfsph" },
          "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.6, 0.3, 0.4] } }],
          "time": { "duration": 0.1, "fps": 10 },
          "render": {
            "size": [120, 90], "look": "water", "camera": { "eye": [0.3, 1.3, 0.9], "target": [0.3, 0.3, 0.2] },
            "show": { "domain": false, "overlay": false }
          }
        }"#,
    );
    let run = [
        "run",
        "tank.json",
        "--frames",
        "1",
        "-o",
        "tank",
        "--passes",
        "depth,normal,id,velocity",
    ];
    place.told(&mut place.sliceflow(&run), 0);
    let image = read(&place, "tank/frame_000000.exr");
    let eye = DVec3::new(0.3, 1.3, 0.9);
    let forward = (DVec3::new(0.3, 0.3, 0.2) - eye).normalize();
    let up = DVec3::X.cross(forward);
    let scale = 17.5_f64.to_radians().tan() / 45.0;
    let mut found = 0;
    let particles = place.manifest("tank")["particles"].as_f64().unwrap();
    for pixel in 0..120 * 90 {
        let (x, y) = ((pixel % 120) as f64 - 59.5, 44.5 - (pixel / 120) as f64);
        let ray = forward + (DVec3::X * x + up * y) * scale;
        let point = eye + ray * image.at("Z", pixel);
        let is_inside = (point.x - 0.3).abs() < 0.2 && (point.z - 0.2).abs() < 0.1;
        if !is_inside || image.at("id", pixel) == 0.0 {
            continue;
        }
        found += 1;
        assert!((point.y - 0.3).abs() < 0.04, "{point}");
        assert!(
            image.vector("normal", pixel).y > 0.95,
            "{point}: {}",
            image.vector("normal", pixel)
        );
        assert!(image.at("id", pixel) <= particles);
        assert_eq!(image.vector("velocity", pixel), DVec3::ZERO);
    }
    assert!(found > 300, "{found} pixels");
    // The floor around the tank faces up and is nobody's.
    let corner = 89 * 120 + 2;
    assert_eq!(
        (image.at("id", corner), image.vector("normal", corner)),
        (0.0, DVec3::Y)
    );
    let ray = forward + (DVec3::X * -57.5 + up * -44.5) * scale;
    assert!((eye + ray * image.at("Z", corner)).y.abs() < 2e-3);
}

/// Seen in perspective, where the depth of a sphere or of a plane through the scene differs from pixel to pixel.
#[test]
fn discs_have_the_depth_of_their_centers_and_face_the_eye() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let run = ["run", "ball.json", "--frames", "1", "-o", "flat"];
    let disc = ["--passes", "depth,normal,id", "--set", "render.splat=disc"];
    place.told(&mut place.sliceflow(&[&run[..], &disc].concat()), 0);
    let image = read(&place, "flat/frame_000000.exr");
    let toward_eye = (EYE - CENTER).normalize();
    let mut found = 0;
    for pixel in (0..160 * 120).filter(|&pixel| image.at("id", pixel) == 1.0) {
        found += 1;
        let depth = image.at("Z", pixel);
        assert!((depth - (EYE.z - CENTER.z)).abs() < 1e-5, "{depth}");
        let normal = image.vector("normal", pixel);
        assert!(normal.distance(toward_eye) < 1e-3, "{normal}");
    }
    assert!(found > 600, "{found} pixels");
}

#[test]
fn what_cannot_be_made_is_refused() {
    let place = Place::new();
    write(&place, "ball.json", BALL);
    let told = |args: &[&str]| place.told(&mut place.sliceflow(args), 2);
    let wrong = told(&["run", "ball.json", "--passes", "dept"]);
    assert!(
        wrong.contains("color, depth, normal, id, velocity, motion"),
        "{wrong}"
    );
    let view = told(&["run", "ball.json", "--passes", "depth", "--view", "both"]);
    assert!(view.contains("render.passes") && view.contains("scene"), "{view}");
    let png = told(&["run", "ball.json", "--passes", "velocity", "--pass-files", "png"]);
    assert!(
        png.contains("PNG files cannot hold `velocity`") && png.contains("exr"),
        "{png}"
    );
    let none = told(&["run", "ball.json", "--passes", "depth", "--no-pictures"]);
    assert!(none.contains("--no-pictures"), "{none}");
    let still = [
        "run",
        "ball.json",
        "--frames",
        "1",
        "--no-pictures",
        "--particles",
        "npy",
        "--columns",
        "position",
        "-o",
        "still",
    ];
    place.told(
        &mut place.sliceflow(&[&still[..], &["--checkpoint-every", "0"]].concat()),
        0,
    );
    let velocity = told(&[
        "render",
        "still",
        "--passes",
        "motion",
        "--set",
        "render.color.by=y",
    ]);
    assert!(velocity.contains("--columns position,velocity"), "{velocity}");
    let blur = told(&[
        "render",
        "still",
        "--shutter",
        "0.5",
        "--set",
        "render.color.by=y",
    ]);
    assert!(blur.contains("--columns position,velocity"), "{blur}");
}
