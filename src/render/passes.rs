//! Extra images of a frame, for compositing. A draw marks what the middle of each pixel sees; from the marks come depths,
//! normals, ids and velocities, each by a pass of its own into a buffer of its own.

use super::camera::Sight;
use super::layout::Layout;
use super::needs::Needs;
use super::picture::Picture;
use super::stages::{Maker, Placed, STRIP, TRIANGLES, Target, dispatch, draw_all, upload};
use super::style::Style;
use crate::error::Result;
use crate::gpu::{Buffers, Gpu, Pass};
use crate::physics::collider::velocity_between;
use crate::scene::Scene;
use crate::scene::model::{ImagePass, Render};
use crate::shared_struct;

/// Depth where nothing is, as Blender writes it.
pub const NOTHING: f32 = 1e10;

shared_struct! {
    /// See `shaders/render/passes/images.wgsl`.
    pub struct Passes {
        pub next_view_projection: [[f32; 4]; 4],
        pub frame_s: f32,
        pub nothing: f32,
        pub reserved_a: f32,
        pub reserved_b: f32,
    }
}

/// An extra image on the device.
pub struct Image {
    pub pass: ImagePass,
    pub buffer: &'static str,
    pub bytes_per_pixel: u64,
    /// The entry point that writes it; `None` where the picture's own last pass does.
    entry: Option<&'static str>,
    why: &'static str,
}

const fn image(
    pass: ImagePass,
    buffer: &'static str,
    bytes_per_pixel: u64,
    entry: Option<&'static str>,
    why: &'static str,
) -> Image {
    Image {
        pass,
        buffer,
        bytes_per_pixel,
        entry,
        why,
    }
}

#[rustfmt::skip]
const IMAGES: [Image; 6] = [
    image(ImagePass::Color, "pass_color", 8, None, "linear light of each pixel"),
    image(ImagePass::Depth, "pass_depth", 4, Some("write_depth"), "distance of what each pixel sees"),
    image(ImagePass::Normal, "pass_normal", 8, Some("write_normal"), "normal of what each pixel sees"),
    image(ImagePass::Id, "pass_id", 4, Some("write_id"), "number of what each pixel sees"),
    image(ImagePass::Velocity, "pass_velocity", 12, Some("write_velocity"), "velocity of what each pixel sees"),
    image(ImagePass::Motion, "pass_motion", 8, Some("write_motion"), "pixels that it moves until the next frame"),
];

/// The extra images that a scene asks for, each once, in a fixed order.
pub fn images(render: &Render) -> impl Iterator<Item = &'static Image> {
    IMAGES.iter().filter(|image| render.passes.contains(&image.pass))
}

/// Bytes that a pixel of an extra image has on the device.
pub fn bytes_per_pixel(pass: ImagePass) -> usize {
    let image = IMAGES.iter().find(|image| image.pass == pass);
    image.map_or(0, |image| image.bytes_per_pixel as usize)
}

/// Whether some of them say what pixels see.
pub fn need_marks(render: &Render) -> bool {
    images(render).any(|image| image.entry.is_some())
}

/// What the extra images of a picture of `size` pixels need, behind all that the picture needs.
pub fn add(needs: &mut Needs, scene: &Scene, style: &Style, size: [u32; 2]) {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    for image in images(&scene.render) {
        needs.storage(image.buffer, pixels, image.bytes_per_pixel, image.why);
    }
    if !style.marks {
        return;
    }
    let why = "the camera in the next frame";
    needs.storage("passes", 1, size_of::<Passes>() as u64, why);
    if style.colliders {
        let colliders = scene.colliders.len() as u64;
        needs.storage("collider_motion", colliders, 16, "velocities of obstacles");
    }
    needs.mark_texture("pass_mark", size, "which particle or triangle each pixel sees");
    needs.depth_texture("pass_mark_depth", size, "which of them is in front");
    needs.draw(
        style.colliders,
        "place_marked_obstacle",
        Some("mark_obstacle"),
        "render/passes/mark_obstacles",
        "pixels that see obstacles",
    );
    let [vertex, fragment, shader] = particle_marks(style);
    needs.draw(true, vertex, Some(fragment), shader, "pixels that see particles");
    for image in images(&scene.render) {
        let entry = image.entry.unwrap_or_default();
        needs.draw(
            image.entry.is_some(),
            entry,
            None,
            "render/passes/images",
            image.why,
        );
    }
}

/// Entry points and file that mark particles.
fn particle_marks(style: &Style) -> [&'static str; 3] {
    match (style.water, style.spheres) {
        (true, _) => ["place_marked_water", "mark_water", "render/passes/mark_water"],
        (_, true) => ["place_marked_sphere", "mark_sphere", "render/passes/mark_spheres"],
        (_, false) => ["place_marked_disc", "mark_disc", "render/passes/mark_discs"],
    }
}

/// The passes that make extra images, behind those of the picture.
pub struct PassStages {
    uniforms: wgpu::Buffer,
    collider_motion: Option<wgpu::Buffer>,
    marks: (wgpu::TextureView, wgpu::TextureView),
    draws: Vec<Placed>,
    write: Vec<Pass>,
}

impl PassStages {
    /// `None` where no extra image says what pixels see.
    pub fn new(
        maker: &Maker,
        scene: &Scene,
        style: &Style,
        buffers: &Buffers,
        collider_vertices: u32,
    ) -> Result<Option<Self>> {
        if !style.marks {
            return Ok(None);
        }
        let user = "render/passes/images.wgsl";
        let mut draws = Vec::new();
        let mut collider_motion = None;
        if style.colliders {
            let draw = maker.mark("place_marked_obstacle", TRIANGLES)?;
            draws.push((draw, collider_vertices, Some(1)));
            collider_motion = Some(buffers.get("collider_motion", user)?.clone());
        }
        draws.push((maker.mark(particle_marks(style)[0], STRIP)?, 4, None));
        let entries = images(&scene.render).filter_map(|image| image.entry);
        Ok(Some(Self {
            uniforms: buffers.get("passes", user)?.clone(),
            collider_motion,
            marks: (maker.view("pass_mark"), maker.view("pass_mark_depth")),
            draws,
            write: entries.map(|entry| maker.compute(entry)).collect::<Result<_>>()?,
        }))
    }

    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        layout: &Layout,
        picture: &Picture,
        time: f64,
    ) -> Result<()> {
        let [_, _, width, height] = picture.rectangle;
        let frame_s = 1.0 / scene.time.fps;
        let next = Sight::new(scene, [width, height], layout.insets, time + frame_s);
        let uniforms = Passes {
            next_view_projection: next.view_projection().to_cols_array_2d(),
            frame_s: frame_s as f32,
            nothing: NOTHING,
            ..Default::default()
        };
        upload(gpu, encoder, &self.uniforms, bytemuck::bytes_of(&uniforms))?;
        if let Some(buffer) = &self.collider_motion {
            let velocities: Vec<[f32; 4]> = scene
                .colliders
                .iter()
                .map(|collider| velocity_between(&collider.path, time, time + frame_s))
                .map(|velocity| velocity.extend(0.0).to_array())
                .collect();
            upload(gpu, encoder, buffer, bytemuck::cast_slice(&velocities))?;
        }
        let (marks, depth) = &self.marks;
        let target = Target::Both(marks, depth);
        draw_all(encoder, "mark_pixels", target, &self.draws, picture.count);
        for pass in &self.write {
            dispatch(encoder, pass, width * height);
        }
        Ok(())
    }
}
