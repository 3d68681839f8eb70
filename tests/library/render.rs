//! Pictures against analytic projections, exact colors, repeatability. Needs an adapter; software Vulkan will do.

use glam::{DVec4, Vec3};
use image::{Rgba, RgbaImage};
use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::{Gpu, readback};
use sliceflow::neighbors::grid::Grid;
use sliceflow::render::{Caption, Layout, Overlay, POOL_COLORS, Renderer, Sight};
use sliceflow::scene::model::{Axis, Splat, View};
use sliceflow::scene::{Dimensions, Particles, Scene, color_maps};

use crate::stage;

const SIZE: [u32; 2] = [160, 120];

fn unit_scene(radius: f64) -> Scene {
    stage::scene(
        Dimensions::Three,
        Vec3::splat(-1.0),
        Vec3::splat(1.0),
        radius,
        SIZE,
    )
}

/// Resting particles at these places, with these speeds.
fn particles(places: &[Vec3], speeds: &[f32]) -> Particles {
    Particles {
        position: places.to_vec(),
        velocity: speeds.iter().map(|&speed| Vec3::X * speed).collect(),
        ..Particles::default()
    }
}

fn covered(image: &RgbaImage) -> Vec<(u32, u32)> {
    let lit = |pixel: &Rgba<u8>| pixel.0[..3].iter().any(|&c| c > 0);
    image
        .enumerate_pixels()
        .filter(|(_, _, pixel)| lit(pixel))
        .map(|(x, y, _)| (x, y))
        .collect()
}

#[test]
fn a_sphere_covers_its_perspective_projection() {
    let gpu = stage::gpu();
    let (radius, distance) = (0.4_f64, 3.0_f64);
    let mut scene = unit_scene(radius);
    stage::bare(&mut scene, Splat::Sphere);
    scene.render.camera.eye = Some([0.0, 0.0, distance]);
    scene.render.camera.target = Some([0.0; 3]);
    let focal = 60.0 / (scene.render.camera.field_of_view.to_radians() * 0.5).tan();
    for x in [0.0, 0.7] {
        let image = stage::picture(&gpu, &scene, &particles(&[Vec3::new(x, 0.0, 0.0)], &[1.0]));
        let pixels = covered(&image);
        // In the plane of the eye, the center and x, the tangent rays stand `half` beside the center's ray.
        let (away, turn) = (distance.hypot(f64::from(x)), f64::from(x).atan2(distance));
        let half = (radius / away).asin();
        let left = 80.0 + focal * (turn - half).tan();
        let right = 80.0 + focal * (turn + half).tan();
        let lowest = f64::from(pixels.iter().map(|p| p.0).min().unwrap());
        let highest = f64::from(pixels.iter().map(|p| p.0).max().unwrap()) + 1.0;
        assert!((lowest - left).abs() <= 1.0, "left {lowest} against {left}");
        assert!((highest - right).abs() <= 1.0, "right {highest} against {right}");
        if x == 0.0 {
            let area = std::f64::consts::PI * (right - left).powi(2) / 4.0;
            let share = pixels.len() as f64 / area;
            assert!((share - 1.0).abs() < 0.015, "area {share}");
        }
    }
}

/// The sphere in front at a pixel of an orthographic view along z: number and depth.
fn front(scene: &Scene, places: &[Vec3], pixel: (f64, f64)) -> Option<(usize, f64)> {
    let sight = sight(scene);
    let [width, height] = scene.render.size.map(f64::from);
    let at = sight.eye
        + sight.right * (sight.half.x * (2.0 * pixel.0 / width - 1.0 - sight.shift.x))
        + sight.up * (sight.half.y * (1.0 - 2.0 * pixel.1 / height - sight.shift.y));
    let hits = places.iter().enumerate().filter_map(|(i, place)| {
        let away = (place.as_dvec3() - at).truncate().length_squared();
        let depth2 = scene.radius().powi(2) - away;
        (depth2 > 0.0).then(|| (i, f64::from(place.z) + depth2.sqrt()))
    });
    hits.max_by(|a, b| a.1.total_cmp(&b.1))
}

fn sight(scene: &Scene) -> Sight {
    let layout = Layout::new(scene, View::Scene);
    Sight::new(scene, scene.render.size, layout.insets, 0.0)
}

#[test]
fn spheres_cut_each_other_where_they_meet() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.5);
    stage::bare(&mut scene, Splat::Sphere);
    scene.render.camera.axis = Some(Axis::Z);
    scene.capacity = 2;
    let places = [Vec3::new(-0.2, 0.1, 0.1), Vec3::new(0.25, -0.1, -0.1)];
    let image = stage::picture(&gpu, &scene, &particles(&places, &[0.0, 1.0]));
    let mut wrong = 0;
    let mut seen = [0, 0];
    for (x, y) in covered(&image) {
        let Some((expected, _)) = front(&scene, &places, (f64::from(x) + 0.5, f64::from(y) + 0.5)) else {
            continue;
        };
        seen[expected] += 1;
        // Viridis runs from violet to yellow.
        let [r, _, b, _] = image.get_pixel(x, y).0;
        wrong += usize::from(usize::from(r > b) != expected);
    }
    assert!(seen[0] > 500 && seen[1] > 200, "{seen:?}");
    assert!(wrong <= 12, "{wrong} pixels show the sphere behind");
}

#[test]
fn no_sphere_that_can_be_seen_is_left_out() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.06);
    scene.render.size = [480, 360];
    stage::bare(&mut scene, Splat::Sphere);
    scene.render.camera.axis = Some(Axis::Z);
    let mut random = stage::Random(3);
    let places: Vec<Vec3> = (0..4000)
        .map(|_| Vec3::new(random.next(), random.next(), random.next()) * 1.8 - 0.9)
        .collect();
    let heap = particles(&places, &[0.5; 4000]);
    scene.capacity = heap.len() as u32;
    let mut buffers = stage::buffers(&gpu, &scene, &heap);
    let mut renderer =
        Renderer::new(&gpu, &scene, &stage::variant(&scene), &mut buffers, View::Scene).unwrap();
    stage::frame(&gpu, &mut renderer, &buffers, scene.capacity, &[]);
    let splat: Vec<u32> = readback::read(&gpu, buffers.get("splat", "(test)").unwrap(), heap.len()).unwrap();
    let hidden = splat.iter().filter(|&&look| look == 0).count();
    assert!(hidden * 5 > heap.len(), "only {hidden} of {} hidden", heap.len());
    for y in 0..scene.render.size[1] {
        for x in 0..scene.render.size[0] {
            let pixel = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            if let Some((seen, _)) = front(&scene, &heap.position, pixel) {
                assert_ne!(splat[seen], 0, "sphere {seen} is in front at {pixel:?}");
            }
        }
    }
}

#[test]
fn discs_have_the_colors_of_the_map() {
    let gpu = stage::gpu();
    let mut scene = stage::scene(
        Dimensions::Two,
        Vec3::new(-1.0, -1.0, 0.0),
        Vec3::new(1.0, 1.0, 0.0),
        0.3,
        SIZE,
    );
    stage::bare(&mut scene, Splat::Disc);
    scene.capacity = 3;
    let map = color_maps::find("viridis").unwrap().at;
    let places = [Vec3::new(-0.6, 0.0, 0.0), Vec3::ZERO, Vec3::new(0.6, 0.0, 0.0)];
    let image = stage::picture(&gpu, &scene, &particles(&places, &[-1.0, 0.0, 5.0]));
    let to_clip = sight(&scene).view_projection();
    for (place, share) in places.iter().zip([1.0, 0.0, 1.0]) {
        let (x, y) = pixel_of(to_clip * place.extend(1.0));
        let found = image.get_pixel(x as u32, y as u32).0;
        for (channel, expected) in found.iter().zip(map(share)) {
            assert!(channel.abs_diff(expected) <= 1, "{found:?} at {share}");
        }
    }
}

fn pixel_of(clip: glam::Vec4) -> (f32, f32) {
    let x = (0.5 + 0.5 * clip.x / clip.w) * SIZE[0] as f32;
    let y = (0.5 - 0.5 * clip.y / clip.w) * SIZE[1] as f32;
    (x, y)
}

#[test]
fn the_domain_box_is_red_at_its_corners() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.01);
    stage::bare(&mut scene, Splat::Sphere);
    scene.render.show.domain = true;
    let image = stage::picture(&gpu, &scene, &particles(&[Vec3::ZERO], &[0.0]));
    let to_clip = sight(&scene).view_projection();
    for k in 0..8 {
        let sign = |bit: i32| if k & bit == 0 { -1.0 } else { 1.0 };
        let (x, y) = pixel_of(to_clip * Vec3::new(sign(1), sign(2), sign(4)).extend(1.0));
        let red = |dx: i32, dy: i32| {
            let [r, g, b, _] = image.get_pixel((x as i32 + dx) as u32, (y as i32 + dy) as u32).0;
            r > 150 && g < 90 && b < 90
        };
        let near = (-1..=1).any(|dx| (-1..=1).any(|dy| red(dx, dy)));
        assert!(near, "no red at corner {k}, pixel ({x}, {y})");
    }
}

#[test]
fn projection_keeps_the_whole_domain_inside() {
    for (eye, orbit, axis) in [(None, 0.0, None), (None, 30.0, None), (None, 0.0, Some(Axis::X))] {
        let mut scene = unit_scene(0.01);
        scene.domain.max = Vec3::new(4.0, 0.3, 1.0);
        scene.render.camera.eye = eye;
        scene.render.camera.orbit = orbit;
        scene.render.camera.axis = axis;
        let layout = Layout::new(&scene, View::Scene);
        for time in [0.0, 1.0, 4.0] {
            let sight = Sight::new(&scene, SIZE, layout.insets, time);
            for k in 0..8 {
                let pick = |bit: i32, a: f32, b: f32| if k & bit == 0 { a } else { b };
                let corner = Vec3::new(pick(1, -1.0, 4.0), pick(2, -1.0, 0.3), pick(4, -1.0, 1.0));
                let clip: DVec4 = (sight.view_projection() * corner.extend(1.0)).as_dvec4();
                let ndc = clip.truncate() / clip.w;
                assert!(
                    ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0 && (0.0..=1.0).contains(&ndc.z),
                    "{ndc}"
                );
            }
        }
    }
}

#[test]
fn two_draws_give_the_same_bytes_and_the_legend_shows() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.06);
    let heap = stage::heap(&scene, 400);
    scene.capacity = heap.len() as u32;
    let first = stage::picture(&gpu, &scene, &heap);
    assert_eq!(first, stage::picture(&gpu, &scene, &heap));
    scene.color.legend = false;
    let layout = Layout::new(&scene, View::Scene);
    assert!(layout.insets.right < Layout::new(&unit_scene(0.06), View::Scene).insets.right);
    let map = color_maps::find("viridis").unwrap().at;
    for share in [0.0, 1.0] {
        let [r, g, b] = map(share);
        let shown = |image: &RgbaImage| {
            image
                .enumerate_pixels()
                .any(|(x, _, p)| x > 120 && p.0[..3] == [r, g, b])
        };
        assert!(shown(&first), "the color bar lacks the color of {share}");
    }
}

fn heatmap(gpu: &Gpu, scene: &Scene, counts: &[u32]) -> (RgbaImage, [u32; 3]) {
    let mut buffers = stage::buffers(gpu, scene, &particles(&[Vec3::ZERO], &[0.0]));
    let grid = Grid {
        capacity: counts.len() as u32,
        ..Grid::default()
    };
    buffers
        .create(gpu, "grid", size_of::<Grid>() as u64, Usage::Uniform)
        .unwrap();
    buffers
        .create(gpu, "voxel_count", counts.len() as u64 * 4, Usage::Storage)
        .unwrap();
    buffers.write(gpu, "grid", 0, &[grid]).unwrap();
    buffers.write(gpu, "voxel_count", 0, counts).unwrap();
    let mut renderer = Renderer::new(gpu, scene, &stage::variant(scene), &mut buffers, View::Pool).unwrap();
    let pixels = stage::frame(gpu, &mut renderer, &buffers, 1, &[]);
    let caption = Caption {
        voxels: Some(counts.len() as u32),
        ..Caption::default()
    };
    let image = Overlay::new(scene, View::Pool)
        .unwrap()
        .finish(pixels, &caption)
        .unwrap();
    (image, Layout::new(scene, View::Pool).pool.unwrap().square)
}

#[test]
fn the_heatmap_shows_each_voxel_in_the_pools_order() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.1);
    scene.render.show.caption = false;
    // 23 voxels stand in a square of five by five; two texels stay empty of voxels.
    let counts: Vec<u32> = (0..23).map(|k| k % 6).collect();
    let (image, [x, y, room]) = heatmap(&gpu, &scene, &counts);
    let scale = room / 5;
    let background = image.get_pixel(0, 0).0;
    for texel in 0..25 {
        let corner = (x + texel % 5 * scale, y + texel / 5 * scale);
        for (dx, dy) in [(0, 0), (scale - 1, scale - 1), (scale / 2, 0)] {
            let found = image.get_pixel(corner.0 + dx, corner.1 + dy).0;
            match counts.get(texel as usize) {
                Some(&count) => assert_eq!(found[..3], POOL_COLORS[count as usize], "texel {texel}"),
                None => assert_eq!(found, background, "texel {texel}"),
            }
        }
    }
}

#[test]
fn a_large_pool_shows_the_fullest_of_each_block() {
    let gpu = stage::gpu();
    let mut scene = unit_scene(0.1);
    scene.render.show.caption = false;
    let [_, _, room] = Layout::new(&scene, View::Pool).pool.unwrap().square;
    let side = 2 * room;
    let mut counts = vec![0; (side * side) as usize];
    counts[(3 * side + 5) as usize] = 2;
    counts[(3 * side + 4) as usize] = 1;
    let (image, [x, y, _]) = heatmap(&gpu, &scene, &counts);
    assert_eq!(image.get_pixel(x + 2, y + 1).0[..3], POOL_COLORS[2]);
    assert_eq!(image.get_pixel(x + 3, y + 1).0[..3], POOL_COLORS[0]);
}
