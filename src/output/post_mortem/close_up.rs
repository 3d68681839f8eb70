//! A picture of a particle and of what is around it, seen along z, without what lies in front of it.

use std::path::Path;

use glam::{DVec3, Vec3};
use image::RgbaImage;

use super::neighborhood::{Neighborhood, Role};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::output::encode_png;
use crate::output::run::Settings;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;
use crate::scene::column::Source;
use crate::scene::model::{Axis, Look, Projection, Splat, View};
use crate::simulation::{Simulation, State};

const SIZE: [u32; 2] = [640, 640];
/// Search radii from the bottom of the picture to its top.
const HEIGHT: f64 = 4.0;

/// PNG bytes. The particle is yellow, its neighbors are green, walls dark, all others blue.
pub fn draw(scene: &Scene, settings: &Settings, around: &Neighborhood) -> Result<Vec<u8>> {
    let center = around.local();
    let in_front = center.z + 0.01 * scene.radius() as f32;
    let mut shown: Vec<(Vec3, f32, Role)> = around.shown.clone();
    shown.retain(|(position, ..)| position.z <= in_front);
    let mut scene = framed(scene, center);
    let free = scene.first_boundary().max(shown.len() as u32);
    scene.capacity = free + scene.boundary.len() as u32;

    let gpu = Gpu::open(&settings.adapter, false)?;
    let wanted = Wanted {
        view: Some(View::Scene),
        ..Wanted::default()
    };
    let plan = Plan::new(&scene, &gpu.limits, &wanted)?;
    let mut simulation = Simulation::new(gpu, &scene, &plan)?;
    let mut colors: Vec<f32> = shown.iter().map(|(.., role)| color(*role)).collect();
    colors.resize(scene.capacity as usize, 0.0);
    simulation.give_column(&colors)?;
    let global: Vec<DVec3> = shown.iter().map(|(p, ..)| p.as_dvec3() + scene.origin).collect();
    let radius: Vec<f32> = shown.iter().map(|(_, radius, _)| *radius).collect();
    let radius = scene.has_field("radius").then_some(&radius[..]);
    let state = State::of_particles(&scene, 0, &global, &vec![Vec3::ZERO; global.len()], radius);
    simulation.restore(&state)?;
    let mut frame = simulation.show(0)?;
    while let Some(next) = simulation.finish_frame()? {
        frame = Some(next);
    }
    let [width, height] = SIZE;
    let pixels = frame.and_then(|frame| frame.pixels);
    let picture = pixels.and_then(|pixels| RgbaImage::from_raw(width, height, pixels));
    let picture = picture
        .ok_or_else(|| Error::device("the device drew no picture", "this is a defect, please report it"))?;
    encode_png(picture, Path::new(super::PICTURE))
}

fn color(role: Role) -> f32 {
    match role {
        Role::Particle => 1.0,
        Role::Neighbor => 0.65,
        Role::Other => 0.3,
        Role::Wall => 0.0,
    }
}

/// The scene as the close-up shows it.
fn framed(scene: &Scene, center: Vec3) -> Scene {
    let mut scene = scene.clone();
    let height = HEIGHT * scene.search_radius();
    let render = &mut scene.render;
    render.size = SIZE;
    render.view = View::Scene;
    render.look = Look::Splats;
    render.splat = Splat::default();
    render.splat_scale = 0.9;
    render.camera.projection = Projection::Orthographic;
    render.camera.axis = Some(Axis::Z);
    render.camera.eye = None;
    render.camera.target = Some(center.as_dvec3().to_array());
    render.camera.height = Some(height);
    render.camera.orbit = 0.0;
    render.show.overlay = false;
    scene.color.column.source = Source::Given;
    scene.color.map = "viridis".into();
    scene.color.range = [0.0, 1.0];
    scene.color.legend = false;
    for collider in &mut scene.colliders {
        collider.visible = false;
    }
    scene.sensors = Default::default();
    scene
}
