//! Frames that are the mean of several pictures: what moves while the shutter is open is blurred, and so is what the lens does
//! not hold in focus. Each picture has particles, obstacles and camera where they are at a moment of its own, seen through a
//! place of its own on the lens; so every look that is drawn from particles can be blurred.

use glam::DVec2;

use super::needs::Needs;
use super::stages::{dispatch, upload};
use super::style::Style;
use crate::error::Result;
use crate::gpu::{Buffers, Gpu, Kernel, Pass, Variant};
use crate::scene::Scene;
use crate::scene::field::Kind;
use crate::shared_struct;

shared_struct! {
    /// See `shaders/render/subframe.wgsl`.
    pub struct Subframe {
        pub after_s: f32,
        pub share: f32,
        pub count: u32,
        pub reserved: u32,
    }
}

/// When a picture is taken, and through which place of the lens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// From the frame's own time, seconds.
    pub after_s: f64,
    /// From the middle of the lens to the right and up, metres.
    pub lens: DVec2,
}

/// The pictures that a frame is the mean of: evenly over the time and over the lens.
pub fn moments(scene: &Scene) -> Vec<Moment> {
    let render = &scene.render;
    let count = render.subframes;
    let open_s = render.shutter / scene.time.fps;
    // A place on the lens must not tell the time: steps by a number without a common divisor reach every moment once.
    let stride = (count * 5 / 8..).find(|&n| n > 0 && gcd(n, count) == 1);
    let stride = stride.unwrap_or(1);
    (0..count)
        .map(|k| {
            let share = (f64::from(k) + 0.5) / f64::from(count);
            let turn = f64::from(k * stride % count) + 0.5;
            let golden_angle = 2.399_963;
            Moment {
                after_s: open_s * (turn / f64::from(count) - 0.5),
                lens: DVec2::from_angle(golden_angle * f64::from(k))
                    * (0.5 * render.camera.aperture * share.sqrt()),
            }
        })
        .collect()
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Buffers and passes of frames of which the scene takes `size` pixels.
pub fn add(needs: &mut Needs, scene: &Scene, style: &Style, size: [u32; 2]) {
    if !style.blurred {
        return;
    }
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let capacity = u64::from(scene.capacity.max(1));
    let position = Kind::Vector.bytes(scene);
    needs.storage("blur_sum", pixels, 16, "the sum of a frame's pictures");
    needs.storage(
        "still_position",
        capacity,
        position,
        "where particles are at the frame's time",
    );
    needs.storage(
        "subframe",
        1,
        size_of::<Subframe>() as u64,
        "when a picture is taken",
    );
    for (label, why) in [
        ("move_particles", "particles at the time of a picture"),
        ("finish_blur", "the mean of the pictures"),
    ] {
        needs.draw(true, label, None, &format!("render/{label}"), why);
    }
}

pub struct Blur {
    pub moments: Vec<Moment>,
    position: wgpu::Buffer,
    still_position: wgpu::Buffer,
    sum: wgpu::Buffer,
    subframe: wgpu::Buffer,
    move_particles: Pass,
    finish: Pass,
}

impl Blur {
    pub fn new(gpu: &Gpu, scene: &Scene, variant: &Variant, buffers: &Buffers) -> Result<Self> {
        let pass =
            |label: &str| Kernel::load(gpu, &format!("render/{label}"), variant, label)?.pass(gpu, buffers);
        let buffer = |name: &str| buffers.get(name, "render/move_particles.wgsl").cloned();
        Ok(Self {
            moments: moments(scene),
            position: buffer("position")?,
            still_position: buffer("still_position")?,
            sum: buffer("blur_sum")?,
            subframe: buffer("subframe")?,
            move_particles: pass("move_particles")?,
            finish: pass("finish_blur")?,
        })
    }

    /// Before the first picture.
    pub fn begin(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.sum, 0, None);
        let bytes = self.position.size().min(self.still_position.size());
        encoder.copy_buffer_to_buffer(&self.position, 0, &self.still_position, 0, bytes);
    }

    /// Before each picture: moves `count` particles.
    pub fn go_to(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        moment: Moment,
        count: u32,
    ) -> Result<()> {
        let subframe = Subframe {
            after_s: moment.after_s as f32,
            share: 1.0 / self.moments.len() as f32,
            count,
            reserved: 0,
        };
        upload(gpu, encoder, &self.subframe, bytemuck::bytes_of(&subframe))?;
        dispatch(encoder, &self.move_particles, count);
        Ok(())
    }

    /// After the last picture: particles are again where they were, to the bit.
    pub fn end(&self, encoder: &mut wgpu::CommandEncoder, pixels: u32) {
        let bytes = self.position.size().min(self.still_position.size());
        encoder.copy_buffer_to_buffer(&self.still_position, 0, &self.position, 0, bytes);
        dispatch(encoder, &self.finish, pixels);
    }
}
