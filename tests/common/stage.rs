//! Scenes and pictures for the tests of the renderer.

// Each test program uses a part.
#![allow(dead_code)]

use glam::{DVec3, Vec3};
use image::RgbaImage;
use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::{Buffers, Gpu, Variant, readback};
use sliceflow::neighbors::NO_VOXEL;
use sliceflow::physics::fields;
use sliceflow::render::{Caption, Overlay, Renderer};
use sliceflow::scene::field::FIELDS;
use sliceflow::scene::model::{
    Addressing, Dashpot, Integrator, Render, SceneFile, Splat, Storage, View, Wall,
};
use sliceflow::scene::{
    Coloring, Contact, Dimensions, Domain, Grains, Matter, Neighbors, Particles, Scene, Time, column,
};

use crate::common;

pub fn gpu() -> Gpu {
    common::gpu()
}

/// An empty scene of a box with default looks, `size` pixels.
pub fn scene(dimensions: Dimensions, min: Vec3, max: Vec3, radius: f64, size: [u32; 2]) -> Scene {
    let count = dimensions.count();
    let corner = |v: Vec3| v.to_array()[..count].to_vec();
    let file: SceneFile = serde_json::from_value(serde_json::json!({
        "dimensions": count,
        "domain": {"min": corner(min), "max": corner(max)},
        "grains": {"radius": radius, "spring": 1.0},
    }))
    .unwrap();
    Scene {
        name: "test".into(),
        file,
        dimensions,
        origin: DVec3::ZERO,
        domain: Domain {
            min,
            max,
            sides: [[Wall::Contact; 2]; 3],
            restitution: 0.5,
            materials: Default::default(),
        },
        gravity: Vec3::new(0.0, -9.81, 0.0),
        matter: Matter::Grains(Grains {
            mixed: false,
            radius,
            mass: 1.0,
            sizes: None,
            contact: Contact {
                spring: 1.0,
                damping: 0.0,
                wall_damping: 0.0,
                dashpot: Dashpot::Full,
                shear: 0.0,
                attraction: 0.0,
                global_damping: 0.0,
                friction: None,
                smallest: None,
            },
        }),
        boundary: Default::default(),
        particles: Particles::default(),
        capacity: 1,
        colliders: Vec::new(),
        rigid_bodies: Vec::new(),
        schedule: Vec::new(),
        more_fields: Vec::new(),
        sensors: Default::default(),
        neighbors: Neighbors {
            addressing: Addressing::Uniform,
            storage: Storage::Pool,
            ..Default::default()
        },
        time: Time {
            frames: 1,
            fps: 30.0,
            step: 1e-3,
            steps_per_frame: 1,
            integrator: Integrator::SymplecticEuler,
            contact_duration: None,
            limited_by: "",
            adaptive: None,
        },
        render: Render {
            size,
            ..Render::default()
        },
        color: Coloring {
            column: column::find("speed").unwrap(),
            map: "viridis".into(),
            range: [0.0, 1.0],
            legend: true,
        },
        notes: Vec::new(),
        written: Default::default(),
    }
}

/// Takes away everything but the particles: no lines, floor, text; a black backdrop; one sample a pixel.
pub fn bare(scene: &mut Scene, splat: Splat) {
    let render = &mut scene.render;
    render.splat = splat;
    render.antialias = 1;
    render.background = sliceflow::scene::model::Background::Black;
    render.show.domain = false;
    render.show.floor = false;
    render.show.caption = false;
    scene.color.legend = false;
}

/// The buffers of a simulation that holds these particles.
pub fn buffers(gpu: &Gpu, scene: &Scene, particles: &Particles) -> Buffers {
    let mut buffers = Buffers::default();
    let two = scene.dimensions == Dimensions::Two;
    for (name, values) in [
        ("position", &particles.position),
        ("velocity", &particles.velocity),
    ] {
        let packed: Vec<f32> = values
            .iter()
            .flat_map(|v| {
                if two {
                    vec![v.x, v.y]
                } else {
                    vec![v.x, v.y, v.z, 0.0]
                }
            })
            .collect();
        buffers
            .create(gpu, name, (packed.len() * 4) as u64, Usage::Storage)
            .unwrap();
        buffers.write(gpu, name, 0, &packed).unwrap();
    }
    let ids: Vec<u32> = (0..particles.len() as u32).collect();
    buffers
        .create(gpu, "id", (ids.len() * 4) as u64, Usage::Storage)
        .unwrap();
    buffers.write(gpu, "id", 0, &ids).unwrap();
    buffers
}

/// The plan's choices for a uniform grid with a pool.
pub fn variant(scene: &Scene) -> Variant {
    let mut variant = Variant::default();
    variant.modules.extend(fields::modules(FIELDS));
    variant
        .without(&[
            "boundary_particles",
            "bounded",
            "floating_bodies",
            "regions",
            "separated",
            "sizes",
        ])
        .constant("NO_VOXEL", NO_VOXEL)
        .constant("REGIONS_ALONG", 4)
        .flag("two_dimensional", scene.dimensions == Dimensions::Two)
        .constant("SLOTS", scene.neighbors.slots)
        .constant("REACH", 1)
        .role("addressing", "cells/uniform")
        .role("storage", "storage/pool/query");
    variant
}

/// One frame with everything laid over; `scene.capacity` must be the number of particles.
pub fn picture(gpu: &Gpu, scene: &Scene, particles: &Particles) -> RgbaImage {
    let mut buffers = buffers(gpu, scene, particles);
    let mut renderer = Renderer::new(gpu, scene, &variant(scene), &mut buffers, View::Scene).unwrap();
    let count = particles.len() as u32;
    let pixels = frame(
        gpu,
        &mut renderer,
        &buffers,
        count,
        &vec![Vec3::ZERO; scene.colliders.len()],
    );
    let caption = Caption {
        frame: 0,
        time: 0.0,
        particles: count,
        voxels: None,
    };
    Overlay::new(scene, View::Scene)
        .unwrap()
        .finish(pixels, &caption)
        .unwrap()
}

pub fn frame(gpu: &Gpu, renderer: &mut Renderer, buffers: &Buffers, count: u32, offsets: &[Vec3]) -> Vec<u8> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer
        .draw(gpu, buffers, &mut encoder, count, 0.0, offsets)
        .unwrap();
    gpu.queue.submit([encoder.finish()]);
    let [width, height] = renderer.size();
    let bytes = (width * height * 4) as usize;
    readback::read(gpu, buffers.get("frame_pixels", "(test)").unwrap(), bytes).unwrap()
}

/// A deterministic random number from 0 to 1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// A heap: `count` grains, packed below a hill in the middle of the box, jittered.
pub fn heap(scene: &Scene, count: usize) -> Particles {
    let mut random = Random(7);
    let mut particles = Particles::default();
    let diameter = 2.0 * scene.radius() as f32;
    let (min, max) = (scene.domain.min, scene.domain.max);
    let cells = ((max - min) / diameter).floor().as_ivec3();
    let middle = (min + max) * 0.5;
    let spread = (max.x - min.x) * 0.45;
    for y in 0..cells.y {
        for z in 0..cells.z {
            for x in 0..cells.x {
                let at = glam::IVec3::new(x, y, z).as_vec3() + 0.5;
                let stagger = Vec3::new((y & 1) as f32, 0.0, (y & 1) as f32) * 0.35;
                let jitter = Vec3::new(random.next(), random.next(), random.next()) * 0.3 - 0.15;
                let point = min + (at * Vec3::new(1.0, 0.86, 1.0) + stagger + jitter) * diameter;
                let away = Vec3::new(point.x - middle.x, 0.0, point.z - middle.z).length() / spread;
                let height = (1.0 - away).max(0.0) * (max.y - min.y) * 0.75;
                if point.y - min.y < height && particles.len() < count {
                    particles.position.push(point);
                    let speed = (point.y - min.y) / (max.y - min.y) * 1.2;
                    particles.velocity.push(Vec3::new(speed, 0.0, 0.0));
                }
            }
        }
    }
    particles
}
