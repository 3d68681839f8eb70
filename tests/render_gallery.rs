//! Pictures for looking at: `cargo test --release --test render_gallery -- --ignored --nocapture`; they go to `out/`.

#[path = "render/stage.rs"]
mod stage;

use std::time::Instant;

use glam::Vec3;
use sliceflow::gpu::{AdapterChoice, Gpu, readback};
use sliceflow::render::{Caption, Overlay, Renderer};
use sliceflow::scene::model::{Background, View};
use sliceflow::scene::{Collider, ColliderShape, Dimensions, Particles, Scene};

fn save(name: &str, gpu: &Gpu, scene: &Scene, particles: &Particles) {
    let mut buffers = stage::buffers(gpu, scene, particles);
    let variant = stage::variant(scene);
    let renderer = Renderer::new(gpu, scene, &variant, &mut buffers, View::Scene).unwrap();
    let count = particles.len() as u32;
    let offsets = vec![Vec3::ZERO; scene.colliders.len()];
    stage::frame(gpu, &renderer, &buffers, count, &offsets);
    let start = Instant::now();
    let pixels = stage::frame(gpu, &renderer, &buffers, count, &offsets);
    println!("{name}: {count} particles, {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    let splat: Vec<u32> = readback::read(gpu, buffers.get("splat", "(test)").unwrap(), particles.len()).unwrap();
    println!("  {} hidden", splat.iter().filter(|&&look| look == 0).count());
    let caption = Caption { frame: 0, time: 1.234, particles: count, voxels: None };
    let image = Overlay::new(scene, View::Scene).unwrap().finish(pixels, &caption).unwrap();
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
        let mut scene =
            stage::scene(Dimensions::Three, Vec3::splat(-1.0), Vec3::new(1.0, 0.6, 1.0), radius, size);
        let particles = stage::heap(&scene, count);
        scene.capacity = particles.len() as u32;
        scene.name = name.into();
        save(name, &gpu, &scene, &particles);
        if name == "heap20k" {
            scene.colliders.push(sphere(Vec3::new(0.62, -0.7, 0.62), 0.3));
            scene.colliders.push(Collider {
                shape: ColliderShape::Box { min: Vec3::new(-0.95, -1.0, 0.3), max: Vec3::new(-0.6, -0.5, 0.8) },
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
