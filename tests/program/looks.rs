//! Looks of pictures: splats, spheres, water, meshes, clay, sand; transparent pictures, and pictures without text. Needs an
//! adapter; software Vulkan will do.

use std::fs;

use glam::{DVec2, DVec3};
use image::RgbaImage;
use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::{Buffers, Gpu, readback};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::render::{Caption, Layout, Overlay, Renderer, Sight};
use sliceflow::scene::Scene;
use sliceflow::scene::model::View;
use sliceflow::simulation::Simulation;

use crate::common;
use crate::place::Place;
use crate::stage;

/// A tank that is filled to a height of 0.3 m, seen as water.
fn tank(overrides: &[&str]) -> Scene {
    let tank = [
        "render.look=water",
        "render.size=[160,120]",
        "render.antialias=1",
        "render.show.overlay=false",
        "render.show.domain=false",
        "colliders=[]",
        r#"bodies=[{"shape":{"kind":"box","min":[0,0,0],"max":[0.6,0.3,0.4]}}]"#,
    ];
    common::fluid(3, &[&tank, overrides].concat())
}

/// Draws the particles that a scene has at the start, each with so many neighbors.
fn picture(gpu: &Gpu, scene: &Scene, neighbors: u32) -> (RgbaImage, Buffers) {
    let count = scene.particles.len() as u32;
    let mut buffers = stage::buffers(gpu, scene, &scene.particles);
    buffers
        .create(gpu, "contacts", u64::from(count) * 4, Usage::Storage)
        .unwrap();
    buffers
        .write(gpu, "contacts", 0, &vec![neighbors; count as usize])
        .unwrap();
    let mut renderer = Renderer::new(gpu, scene, &stage::variant(scene), &mut buffers, View::Scene).unwrap();
    let pixels = stage::frame(gpu, &mut renderer, &buffers, count, &[]);
    let overlay = Overlay::new(scene, View::Scene).unwrap();
    (overlay.finish(pixels, &Caption::default()).unwrap(), buffers)
}

/// Neighbors of particles that belong to the water and are seen.
fn inside(scene: &Scene) -> u32 {
    (0.8 * scene.usual_neighbors(1.0)) as u32
}

/// The same with a mesh for its surface, which needs a search; and the device's buffers.
fn picture_of_mesh(scene: &Scene) -> (RgbaImage, Simulation) {
    let wanted = Wanted {
        view: Some(View::Scene),
        ..Default::default()
    };
    let mut simulation = common::simulate(scene, &wanted);
    let frame = common::frames(&mut simulation, 0).pop().unwrap();
    let overlay = Overlay::new(scene, View::Scene).unwrap();
    let image = overlay
        .finish(frame.pixels.unwrap(), &Caption::default())
        .unwrap();
    (image, simulation)
}

/// What the tank's water may be made of.
const MESHES: [&[&str]; 2] = [
    &["render.water.surface=mesh"],
    &["render.water.surface=mesh", "render.mesh.kernel=anisotropic"],
];

const FROM_ABOVE: [&str; 2] = [
    "render.camera.eye=[0.3,1.2,1.6]",
    "render.camera.target=[0.3,0.2,0.2]",
];

/// Whether the water of the tank, seen from above, ends in a plane at its height; `flat` is the least height of a normal.
fn check_surface(gpu: &Gpu, scene: &Scene, image: &RgbaImage, buffers: &Buffers, flat: f64) {
    let [width, height] = scene.render.size.map(|side| side as usize);
    let surface: Vec<f32> = readback::read(
        gpu,
        buffers.get("water_surface", "(test)").unwrap(),
        width * height,
    )
    .unwrap();
    let sight = Sight::new(
        scene,
        scene.render.size,
        Layout::new(scene, View::Scene).insets,
        0.0,
    );
    let point = |x: usize, y: usize| {
        let share = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / DVec2::new(width as f64, height as f64);
        let ndc = DVec2::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y) - sight.shift;
        let ray = sight.forward + sight.right * ndc.x * sight.half.x + sight.up * ndc.y * sight.half.y;
        // In the scene's coordinates.
        sight.eye + ray * f64::from(surface[y * width + x]) + scene.origin
    };
    let inside = |p: DVec3| (p.x - 0.3).abs() < 0.2 && (p.z - 0.2).abs() < 0.1 && (p.y - 0.3).abs() < 0.04;
    let mut found = 0;
    let mut steepest = 1.0_f64;
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            if surface[y * width + x] > 1e6 || !inside(point(x, y)) {
                continue;
            }
            found += 1;
            let across = point(x + 1, y) - point(x - 1, y);
            let down = point(x, y + 1) - point(x, y - 1);
            steepest = steepest.min(down.cross(across).normalize().y);
            // The floor is light grey, and water takes red away.
            let [r, g, b, _] = image.get_pixel(x as u32, y as u32).0;
            assert!(b > r && g > r, "({x}, {y}) is {r} {g} {b}");
        }
    }
    println!("{found} samples, a normal's height is {steepest}");
    assert!(found > 400, "{found} samples");
    assert!(steepest > flat, "a normal's height is {steepest}");
    let [r, g, b, _] = image.get_pixel(4, 116).0;
    assert!(r.abs_diff(g) < 8 && g.abs_diff(b) < 8, "the floor is {r} {g} {b}");
}

#[test]
fn a_tank_at_rest_has_a_flat_surface_that_faces_up_and_is_not_floor() {
    let gpu = stage::gpu();
    let scene = tank(&FROM_ABOVE);
    let (image, buffers) = picture(&gpu, &scene, inside(&scene));
    check_surface(&gpu, &scene, &image, &buffers, 0.98);
}

#[test]
fn so_has_one_whose_surface_is_a_mesh_and_the_same_bytes_again() {
    for mesh in MESHES {
        let scene = tank(&[&FROM_ABOVE[..], mesh].concat());
        let (image, simulation) = picture_of_mesh(&scene);
        check_surface(simulation.gpu(), &scene, &image, simulation.buffers(), 0.98);
        assert!(image == picture_of_mesh(&scene).0, "{mesh:?}");
    }
}

/// Metres of water between the eye and the tank's back, by the light that passes it: what differs between pictures on white
/// and on black.
fn thickness(surface: &[&str], draw: impl Fn(&Scene) -> RgbaImage) -> f64 {
    // 0.4 m of water along z, after which a quarter of the light would be left.
    let shared = [
        "render.camera.axis=z",
        "render.show.floor=false",
        "render.water.color=#898989",
        "render.water.absorption_length=0.4",
    ];
    let light = |background: &str| {
        let background = format!("render.background={background}");
        let image = draw(&tank(&[&shared[..], &[&background], surface].concat()));
        let byte = f64::from(image.get_pixel(80, 74).0[1]) / 255.0;
        ((byte + 0.055) / 1.055).powf(2.4)
    };
    let passed = light("white") - light("black");
    let quarter = ((f64::from(0x89) / 255.0 + 0.055) / 1.055).powf(2.4);
    0.4 * passed.ln() / quarter.ln()
}

#[test]
fn thickness_is_that_of_the_water_along_the_view() {
    let gpu = stage::gpu();
    let of_spheres = thickness(&[], |scene| picture(&gpu, scene, inside(scene)).0);
    assert!((of_spheres / 0.4 - 1.0).abs() < 0.06, "{of_spheres} m of water");
    for mesh in MESHES {
        let of_mesh = thickness(mesh, |scene| picture_of_mesh(scene).0);
        println!("{mesh:?}: {of_mesh}");
        assert!(
            (of_mesh / 0.4 - 1.0).abs() < 0.06,
            "{mesh:?}: {of_mesh} m of water"
        );
    }
}

/// A layer of particles, 0.05 m, that is seen from above.
#[test]
fn thin_water_absorbs_as_a_film_of_two_and_a_half_spacings() {
    let gpu = stage::gpu();
    let layer = [
        "render.camera.axis=y",
        r#"bodies=[{"shape":{"kind":"box","min":[0,0,0],"max":[0.6,0.05,0.4]}}]"#,
    ];
    let film = thickness(&layer, |scene| picture(&gpu, scene, inside(scene)).0);
    assert!((film / 0.125 - 1.0).abs() < 0.1, "{film} m of water");
}

#[test]
fn particles_without_neighbors_are_white_and_small() {
    let gpu = stage::gpu();
    let looks = ["render.background=black", "render.show.floor=false"];
    let one = r#"bodies=[{"shape":{"kind":"box","min":[0.25,0.2,0.15],"max":[0.3,0.25,0.2]}}]"#;
    let near = ["render.camera.axis=z", "render.camera.height=0.2", one];
    // Lit pixels, and how much bluer than red they are in the mean.
    let seen = |spray: &str, alone: bool| {
        let spray = format!("render.water.spray={spray}");
        let scene = tank(&[&looks[..], &near, &[&spray]].concat());
        assert_eq!(scene.particles.len(), 1);
        let neighbors = if alone { 0 } else { inside(&scene) };
        let (image, _) = picture(&gpu, &scene, neighbors);
        let lit: Vec<_> = image.pixels().filter(|p| p.0[2] > 40).collect();
        let blue = lit.iter().map(|p| f64::from(p.0[2]) - f64::from(p.0[0]));
        (lit.len(), blue.sum::<f64>() / lit.len().max(1) as f64)
    };
    let (drop, white) = seen("true", true);
    let (_, clear) = seen("false", true);
    let (whole, _) = seen("true", false);
    assert!(
        drop > 50 && 4 * drop < whole,
        "{drop} pixels alone, {whole} inside"
    );
    assert!(white < 12.0 && clear > white + 12.0, "{white} and {clear}");
}

#[test]
fn only_water_needs_waters_textures_and_passes() {
    let wanted = Wanted {
        view: Some(View::Scene),
        ..Default::default()
    };
    let plan = |look: &str| {
        let look = format!("render.look={look}");
        Plan::new(
            &common::fluid(3, &[&look]),
            &sliceflow::gpu::Limits::PROMISED,
            &wanted,
        )
        .unwrap()
    };
    let names = |plan: &Plan| -> Vec<String> {
        let buffers = plan.buffers.iter().map(|buffer| buffer.name.clone());
        let textures = plan.textures.iter().map(|texture| texture.name.clone());
        let draws = plan.draws.iter().map(|draw| draw.label.clone());
        buffers.chain(textures).chain(draws).collect()
    };
    let has = |look: &str, part: &str| names(&plan(look)).iter().any(|name| name.contains(part));
    for look in ["splats", "spheres", "clay", "sand"] {
        assert!(!has(look, "water") && !has(look, "behind"), "{look}");
    }
    for part in ["water_depth", "water_thickness", "smooth_rows", "resolve_water"] {
        assert!(has("water", part), "{part}");
    }
    for part in ["mesh_triangle", "cast_mesh", "color_mesh", "place_mesh"] {
        assert!(has("mesh", part) && !has("water", part), "{part}");
    }
    for part in ["splat", "occluder_depth", "color_map"] {
        assert!(!names(&plan("water")).iter().any(|name| name == part), "{part}");
    }
}

const DAM: &str = r#"{
  "domain": { "min": [0, 0, 0], "max": [0.6, 0.4, 0.3] },
  "fluid": { "spacing": 0.05, "solver": "dfsph" },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.3, 0.3, 0.3] } }],
  "time": { "duration": 0.2, "fps": 10 },
  "render": { "size": [160, 120] }
}"#;

/// Runs the dam into `out` and returns its last picture's bytes.
fn run(place: &Place, out: &str, more: &[&str]) -> Vec<u8> {
    fs::write(place.path("dam.json"), DAM).unwrap();
    place.told(
        &mut place.sliceflow(&[&["run", "dam.json", "-o", out], more].concat()),
        0,
    );
    fs::read(place.path(out).join("frame_000002.png")).unwrap()
}

#[test]
fn looks_have_the_same_bytes_again_and_from_files() {
    let place = Place::new();
    let first = run(&place, "first", &["--look", "water", "--particles", "npy"]);
    assert!(
        first == run(&place, "second", &["--look", "water"]),
        "two runs differ"
    );
    place.told(&mut place.sliceflow(&["render", "first", "-o", "again"]), 0);
    let again = fs::read(place.path("again/frame_000002.png")).unwrap();
    assert!(first == again, "drawn from files it differs");
    // A run that was drawn as splats can be drawn as water.
    let splats = run(&place, "splats", &["--particles", "npy"]);
    for look in ["clay", "sand"] {
        place.told(
            &mut place.sliceflow(&["render", "splats", "--look", look, "-o", look]),
            0,
        );
        let drawn = fs::read(place.path(look).join("frame_000002.png")).unwrap();
        let simulated = run(&place, &format!("simulated_{look}"), &["--look", look]);
        assert!(drawn == simulated, "{look}");
    }
    place.told(
        &mut place.sliceflow(&["render", "splats", "--look", "water", "-o", "water"]),
        0,
    );
    assert!(first == fs::read(place.path("water/frame_000002.png")).unwrap());
    assert!(splats == run(&place, "same", &["--look", "splats"]));
    assert!(
        splats
            == run(
                &place,
                "spheres",
                &["--look", "spheres", "--set", "render.splat=disc"]
            )
    );
    assert!(splats != run(&place, "discs", &["--set", "render.splat=disc"]));
}

/// Two grains side by side as `look` draws them, lit from the eye: the colors of the square in the middle of each, row by row.
fn two_grains(look: &str) -> [Vec<[f64; 3]>; 2] {
    let scene = tank(&[
        "render.camera.axis=z",
        "render.camera.height=0.15",
        "render.color.map=sand",
        "render.light=[0,0,1]",
        "render.background=black",
        "render.show.floor=false",
        r#"bodies=[{"shape":{"kind":"box","min":[0.25,0.2,0.15],"max":[0.35,0.25,0.2]}}]"#,
        &format!("render.look={look}"),
    ]);
    assert_eq!(scene.particles.len(), 2);
    let gpu = stage::gpu();
    let (image, _) = picture(&gpu, &scene, 0);
    let [width, height] = scene.render.size.map(f64::from);
    let sight = Sight::new(
        &scene,
        scene.render.size,
        Layout::new(&scene, View::Scene).insets,
        0.0,
    );
    let half = (0.6 * scene.radius() * height / 0.15) as i64;
    [0, 1].map(|grain| {
        let center = scene.particles.position[grain].as_dvec3() - sight.eye;
        let ndc = DVec2::new(center.dot(sight.right), center.dot(sight.up)) / sight.half + sight.shift;
        let middle = (DVec2::new(ndc.x, -ndc.y) + 1.0) / 2.0 * DVec2::new(width, height);
        let pixel = |x: i64, y: i64| {
            let at = middle + DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let [r, g, b, _] = image.get_pixel(at.x as u32, at.y as u32).0;
            [r, g, b].map(f64::from)
        };
        let rows = -half..half;
        rows.flat_map(|y| (-half..half).map(move |x| (x, y)))
            .map(|(x, y)| pixel(x, y))
            .collect()
    })
}

/// Mean of a grain's colors.
fn mean(grain: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|c| grain.iter().map(|color| color[c]).sum::<f64>() / grain.len() as f64)
}

/// How much the left half of a grain differs from the right half, as a share of its brightness: a smooth one does not.
fn lopsided(grain: &[[f64; 3]]) -> f64 {
    let side = grain.len().isqrt();
    let mirrored = grain
        .chunks_exact(side)
        .flat_map(|row| row.iter().zip(row.iter().rev()));
    let apart = mirrored
        .map(|(left, right)| (left[1] - right[1]).abs())
        .sum::<f64>();
    apart / grain.len() as f64 / mean(grain)[1]
}

#[test]
fn grains_of_clay_and_sand_are_matte_and_each_has_a_color_and_a_surface_of_its_own() {
    for look in ["spheres", "clay", "sand"] {
        let grains = two_grains(look);
        let [one, other] = [mean(&grains[0]), mean(&grains[1])];
        let apart = (0..3).map(|c| (one[c] - other[c]).abs()).fold(0.0, f64::max);
        let unlike = lopsided(&grains[0]).min(lopsided(&grains[1]));
        // A highlight is where light comes back to the eye, in the middle of a grain.
        let brightest = grains[0].iter().map(|color| color[1]).fold(0.0, f64::max) / one[1];
        let told =
            format!("{look}: {apart} apart, {unlike} lopsided, the brightest pixel {brightest} of the mean");
        match look {
            "spheres" => assert!(apart < 1.0 && unlike < 0.002 && brightest > 1.2, "{told}"),
            _ => assert!(apart > 15.0 && unlike > 0.01 && brightest < 1.15, "{told}"),
        }
    }
}

#[test]
fn a_mesh_has_the_same_bytes_again_and_from_files_and_covers_what_spheres_cover() {
    let place = Place::new();
    let plain = [
        "--no-overlay",
        "--set",
        "render.show.domain=false",
        "--set",
        "render.background=transparent",
    ];
    let mesh = [&plain[..], &["--look", "mesh"]].concat();
    let first = run(&place, "first", &[&mesh[..], &["--particles", "npy"]].concat());
    assert!(first == run(&place, "second", &mesh), "two runs differ");
    place.told(&mut place.sliceflow(&["render", "first", "-o", "again"]), 0);
    let again = fs::read(place.path("again/frame_000002.png")).unwrap();
    assert!(first == again, "drawn from files it differs");
    // Shadows are less opaque than what casts them.
    let solid = |bytes: &[u8]| -> Vec<bool> {
        let image = image::load_from_memory(bytes).unwrap().to_rgba8();
        image.pixels().map(|pixel| pixel.0[3] > 200).collect()
    };
    let spheres = run(&place, "spheres", &[&plain[..], &["--look", "spheres"]].concat());
    let (mesh, spheres) = (solid(&first), solid(&spheres));
    let covered = spheres.iter().filter(|&&is_solid| is_solid).count();
    let differ = mesh.iter().zip(&spheres).filter(|(a, b)| a != b).count();
    assert!(covered > 1000 && 5 * differ < covered, "{differ} of {covered}");
}

#[test]
fn transparent_pictures_have_alpha_and_no_overlay_has_no_text() {
    let place = Place::new();
    let transparent = ["--set", "render.background=transparent", "--no-overlay"];
    for look in ["splats", "water"] {
        let bytes = run(&place, look, &[&transparent[..], &["--look", look]].concat());
        let image = image::load_from_memory(&bytes).unwrap();
        assert_eq!(image.color(), image::ColorType::Rgba8);
        let image = image.to_rgba8();
        // Nothing stands in the upper corners, and text in the lower ones.
        for (x, y) in [(0, 0), (159, 0), (12, 115)] {
            assert!(image.get_pixel(x, y).0[3] < 60, "{look} at ({x}, {y})");
        }
        let opaque = image.pixels().filter(|p| p.0[3] > 200).count();
        let shadows = image.pixels().filter(|p| (20..150).contains(&p.0[3])).count();
        assert!(opaque > 1000 && shadows > 100, "{look}: {opaque}, {shadows}");
    }
    // What is left out is text: the caption's corner and the color bar.
    let plain = run(&place, "plain", &["--no-overlay"]);
    let keys = [
        "--set",
        "render.show.caption=false",
        "--set",
        "render.color.legend=false",
    ];
    assert!(plain == run(&place, "keys", &keys));
    assert!(plain != run(&place, "text", &[]));
}

#[test]
fn words_that_do_not_exist_and_scenes_without_water_are_refused() {
    let place = Place::new();
    let told = |args: &[&str]| place.told(&mut place.sliceflow(args), 2);
    let wrong = told(&["run", "green_cube", "--look", "watter"]);
    assert!(wrong.contains("splats, spheres, water, mesh"), "{wrong}");
    let wrong = told(&["run", "harada_dam", "--set", "render.look=sphere"]);
    assert!(
        wrong.contains("render.look") && wrong.contains("spheres"),
        "{wrong}"
    );
    let flat = told(&["run", "dam_break_2d", "--look", "water"]);
    assert!(flat.contains("render.look") && flat.contains("2D"), "{flat}");
    let grains = told(&["run", "green_cube", "--look", "water"]);
    assert!(grains.contains("grains are no `water`"), "{grains}");
    let flat = told(&["run", "dam_break_2d", "--look", "mesh"]);
    assert!(flat.contains("`mesh` is drawn in 3D"), "{flat}");
    let grains = told(&["run", "green_cube", "--look", "mesh"]);
    assert!(grains.contains("grains have no `mesh`"), "{grains}");
    let color = told(&["run", "harada_dam", "--set", "render.water.color=blue"]);
    assert!(color.contains("render.water.color"), "{color}");
    let length = told(&["run", "harada_dam", "--set", "render.water.absorption_length=0"]);
    assert!(length.contains("render.water.absorption_length"), "{length}");
}

/// Text is as high as a line's share of the picture.
#[test]
fn text_grows_with_the_picture() {
    let caption = |size: &str| {
        let scene = common::fluid(3, &[&format!("render.size={size}"), "render.color.legend=false"]);
        let [width, height] = scene.render.size;
        let blank = vec![255; (width * height * 4) as usize];
        let image = Overlay::new(&scene, View::Scene)
            .unwrap()
            .finish(blank, &Caption::default())
            .unwrap();
        let rows = (0..height).filter(|&y| (0..width).any(|x| image.get_pixel(x, y).0[0] < 128));
        rows.count() as f64 / f64::from(height)
    };
    let [small, large] = ["[1280,720]", "[1920,1080]"].map(caption);
    assert!(
        (large / small - 1.0).abs() < 0.1,
        "{small} and {large} of the height"
    );
    assert!(large > 0.015);
}

#[test]
fn a_moving_camera_sees_the_same_water() {
    let gpu = stage::gpu();
    // From twice as far with half the angle of view, the water's surface stands where it did.
    let heights = ["0.8", "1.6"].map(|height| {
        let height = format!("render.camera.height={height}");
        let scene = tank(&["render.camera.axis=y", &height]);
        let (_, buffers) = picture(&gpu, &scene, inside(&scene));
        let surface: Vec<f32> =
            readback::read(&gpu, buffers.get("water_surface", "(test)").unwrap(), 160 * 120).unwrap();
        f64::from(surface[60 * 160 + 80])
    });
    assert!((heights[0] - heights[1]).abs() < 0.1 * 0.05, "{heights:?}");
}
