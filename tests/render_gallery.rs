//! Pictures for looking at: `cargo test --release --test render_gallery -- --ignored --nocapture`; they go to `out/`.

#[path = "render/stage.rs"]
#[allow(dead_code)]
mod stage;

use std::path::Path;
use std::time::Instant;

use glam::Vec3;
use sliceflow::gpu::{AdapterChoice, Gpu, readback};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::render::{Caption, Overlay, Renderer};
use sliceflow::scene::load;
use sliceflow::scene::model::{Background, View};
use sliceflow::scene::{Collider, ColliderShape, Dimensions, Particles, Scene};
use sliceflow::simulation::Simulation;

fn save(name: &str, gpu: &Gpu, scene: &Scene, particles: &Particles) {
    let mut buffers = stage::buffers(gpu, scene, particles);
    let variant = stage::variant(scene);
    let renderer = Renderer::new(gpu, scene, &variant, &mut buffers, View::Scene).unwrap();
    let count = particles.len() as u32;
    let offsets = vec![Vec3::ZERO; scene.colliders.len()];
    stage::frame(gpu, &renderer, &buffers, count, &offsets);
    let start = Instant::now();
    let pixels = stage::frame(gpu, &renderer, &buffers, count, &offsets);
    println!(
        "{name}: {count} particles, {:.0} ms",
        start.elapsed().as_secs_f64() * 1e3
    );
    let splat: Vec<u32> =
        readback::read(gpu, buffers.get("splat", "(test)").unwrap(), particles.len()).unwrap();
    println!("  {} hidden", splat.iter().filter(|&&look| look == 0).count());
    let caption = Caption {
        frame: 0,
        time: 1.234,
        particles: count,
        voxels: None,
    };
    let image = Overlay::new(scene, View::Scene)
        .unwrap()
        .finish(pixels, &caption)
        .unwrap();
    std::fs::create_dir_all("out/render").unwrap();
    image.save(format!("out/render/{name}.png")).unwrap();
}

fn sphere(center: Vec3, radius: f32) -> Collider {
    Collider {
        name: String::new(),
        shape: ColliderShape::Sphere { center, radius },
        path: Vec::new(),
        color: [0.54, 0.56, 0.6],
        visible: true,
    }
}

#[test]
#[ignore = "writes pictures to look at"]
fn gallery() {
    let gpu = Gpu::open(&AdapterChoice::Best, false).unwrap();
    let size = [1280, 720];
    for (name, radius, count) in [("heap20k", 0.0185, 20_000), ("heap65k", 0.0125, 65_536)] {
        let mut scene = stage::scene(
            Dimensions::Three,
            Vec3::splat(-1.0),
            Vec3::new(1.0, 0.6, 1.0),
            radius,
            size,
        );
        let particles = stage::heap(&scene, count);
        scene.capacity = particles.len() as u32;
        scene.name = name.into();
        save(name, &gpu, &scene, &particles);
        if name == "heap20k" {
            scene.colliders.push(sphere(Vec3::new(0.62, -0.7, 0.62), 0.3));
            scene.colliders.push(Collider {
                shape: ColliderShape::Box {
                    min: Vec3::new(-0.95, -1.0, 0.3),
                    max: Vec3::new(-0.6, -0.5, 0.8),
                },
                color: [0.75, 0.45, 0.3],
                ..sphere(Vec3::ZERO, 1.0)
            });
            for (label, background) in [
                ("studio", Background::Studio),
                ("dark", Background::Dark),
                ("white", Background::White),
                ("black", Background::Black),
            ] {
                scene.render.background = background;
                save(&format!("colliders_{label}"), &gpu, &scene, &particles);
            }
        }
    }
    let mut few = stage::scene(Dimensions::Three, Vec3::splat(-1.0), Vec3::splat(1.0), 0.12, size);
    let particles = stage::heap(&few, 300);
    few.capacity = particles.len() as u32;
    save("few", &gpu, &few, &particles);
}

/// The last of `frames` frames of a scene that ships.
fn simulated(name: &str, scene: &str, overrides: &[&str], view: View, frames: u32) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/scenes/{scene}.json"));
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    let scene = load::load(&file, &overrides).unwrap();
    let gpu = Gpu::open(&AdapterChoice::Best, false).unwrap();
    let wanted = Wanted {
        statistics: true,
        view: Some(view),
        ..Wanted::default()
    };
    let plan = Plan::new(&scene, &gpu.limits, &wanted).unwrap();
    let mut simulation = Simulation::new(gpu, &scene, &plan).unwrap();
    let mut last = None;
    for _ in 0..frames {
        last = simulation.next_frame().unwrap().or(last);
    }
    while let Some(frame) = simulation.finish_frame().unwrap() {
        last = Some(frame);
    }
    let frame = last.unwrap();
    let voxels = frame.statistics.map(|s| s.voxels_allocated);
    let caption = Caption {
        frame: frame.index,
        time: frame.time,
        particles: frame.particles,
        voxels,
    };
    let image = Overlay::new(&scene, view)
        .unwrap()
        .finish(frame.pixels.unwrap(), &caption)
        .unwrap();
    image.save(format!("out/render/{name}.png")).unwrap();
}

#[test]
#[ignore = "writes pictures to look at"]
fn shipped_column() {
    simulated("column", "column_2d", &[], View::Scene, 12);
}

#[test]
#[ignore = "writes pictures to look at"]
fn shipped_scenes() {
    std::fs::create_dir_all("out/render").unwrap();
    let wide = "render.size=[1280,720]";
    simulated("harada", "harada_figure_2_small", &[], View::Scene, 10);
    simulated("harada_both", "harada_figure_2_small", &[wide], View::Both, 10);
    simulated(
        "harada_pool",
        "harada_figure_2_small",
        &[wide, "render.background=dark"],
        View::Pool,
        10,
    );
    simulated(
        "harada_3d",
        "harada_figure_2_small",
        &[wide, "render.camera={}", "render.background=studio"],
        View::Scene,
        10,
    );
}
