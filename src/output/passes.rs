//! Extra images for compositing, as files: one OpenEXR file per frame, or 16-bit PNGs.

use std::io::{self, Cursor};
use std::path::Path;
use std::sync::Arc;
use std::thread::available_parallelism;

use half::f16;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _};

use super::exr::{self, Channel, Kind};
use super::folder::Folder;
use super::manifest::Files;
use super::workers::Workers;
use super::{Sink, disk};
use crate::error::{Error, Result};
use crate::render::passes::{NOTHING, images};
use crate::render::{depth_range, passes};
use crate::scene::Scene;
use crate::scene::model::{ImagePass, PassFiles};
use crate::simulation::frame::Frame;

const MOST_THREADS: usize = 8;
/// Of an id in a PNG, below and above which half it is.
const HALF: u32 = 1 << 16;
/// Steps of a pixel in which PNGs hold motions.
const MOTION_STEPS: f32 = 16.0;
/// Bytes that a pixel takes in a file, per byte on the device, at most, in the scenes that ship.
const COMPRESSED: f64 = 0.6;

/// What files say of an image.
struct Layer {
    pass: ImagePass,
    /// In names of PNGs.
    name: &'static str,
    channels: &'static [(&'static str, Kind, usize)],
    about: &'static str,
}

#[rustfmt::skip]
const LAYERS: [Layer; 6] = [
    Layer {
        pass: ImagePass::Color,
        name: "color",
        channels: &[("R", Kind::Half, 0), ("G", Kind::Half, 2), ("B", Kind::Half, 4), ("A", Kind::Half, 6)],
        about: "linear light multiplied by alpha (R, G, B, A)",
    },
    Layer {
        pass: ImagePass::Depth,
        name: "depth",
        channels: &[("Z", Kind::Float, 0)],
        about: "distance along the view's axis, metres, 1e10 where nothing is (Z)",
    },
    Layer {
        pass: ImagePass::Normal,
        name: "normal",
        channels: &[("normal.X", Kind::Half, 0), ("normal.Y", Kind::Half, 2), ("normal.Z", Kind::Half, 4)],
        about: "unit normal in the scene's axes (normal.X, .Y, .Z)",
    },
    Layer {
        pass: ImagePass::Id,
        name: "id",
        channels: &[("id", Kind::Unsigned, 0)],
        about: "1 + the particle's id, 4294967295 - the obstacle's number, or 0 (id)",
    },
    Layer {
        pass: ImagePass::Velocity,
        name: "velocity",
        channels: &[("velocity.X", Kind::Float, 0), ("velocity.Y", Kind::Float, 4), ("velocity.Z", Kind::Float, 8)],
        about: "velocity in the scene's axes, m/s (velocity.X, .Y, .Z)",
    },
    Layer {
        pass: ImagePass::Motion,
        name: "motion",
        channels: &[("motion.X", Kind::Float, 0), ("motion.Y", Kind::Float, 4)],
        about: "pixels to the right and up until the next frame (motion.X, .Y)",
    },
];

fn layer(pass: ImagePass) -> &'static Layer {
    let found = LAYERS.iter().find(|layer| layer.pass == pass);
    found.expect("every extra image has a layer")
}

/// For the manifest.
pub fn files(scene: &Scene) -> Vec<Files> {
    let layers: Vec<_> = images(&scene.render).map(|image| layer(image.pass)).collect();
    match scene.render.pass_files {
        _ if layers.is_empty() => Vec::new(),
        PassFiles::Exr => {
            let about: Vec<_> = layers.iter().map(|layer| layer.about).collect();
            vec![Files {
                name: "frame_NNNNNN.exr".into(),
                about: format!("extra images of a frame: {}", about.join("; ")),
            }]
        }
        PassFiles::Png => {
            let file = |layer: &&Layer| Files {
                name: format!("frame_NNNNNN.{}.png", layer.name),
                about: about_png(layer.pass, scene),
            };
            layers.iter().map(file).collect()
        }
    }
}

fn about_png(pass: ImagePass, scene: &Scene) -> String {
    match pass {
        ImagePass::Color => "the picture without text, 16-bit sRGB with alpha".into(),
        ImagePass::Depth => format!(
            "distance along the view's axis: 65534 is {} m, 65535 is nothing",
            depth_range(scene)
        ),
        ImagePass::Normal => "unit normal in the scene's axes: n as 32768 + 32767 n".into(),
        ImagePass::Id => {
            "1 + the particle's id, 4294967295 - the obstacle's number, or 0: red + 65536 green".into()
        }
        ImagePass::Velocity => "no PNG can hold it".into(),
        ImagePass::Motion => format!(
            "pixels until the next frame, to the right in red, up in green: p as 32768 + {MOTION_STEPS} p"
        ),
    }
}

/// Bytes that a frame's extra images take on disk; a guess.
pub fn frame_bytes(scene: &Scene) -> f64 {
    let pixels: f64 = scene.render.size.map(f64::from).iter().product();
    let each: f64 = images(&scene.render)
        .map(|image| image.bytes_per_pixel as f64)
        .sum();
    COMPRESSED * pixels * each
}

/// Writes the extra images of each frame, on threads of its own.
pub struct PassImages {
    folder: Arc<Folder>,
    writer: Writer,
    workers: Workers,
}

#[derive(Clone, Copy)]
struct Writer {
    size: [u32; 2],
    files: PassFiles,
    /// Metres.
    depth_range: f64,
}

impl PassImages {
    pub fn new(folder: Arc<Folder>, scene: &Scene) -> Self {
        let threads = available_parallelism().map_or(1, |n| n.get().min(MOST_THREADS));
        Self {
            folder,
            writer: Writer {
                size: scene.render.size,
                files: scene.render.pass_files,
                depth_range: depth_range(scene),
            },
            workers: Workers::new(threads),
        }
    }
}

impl Sink for PassImages {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        let (frame, writer) = (frame.clone(), self.writer);
        let picture = self.folder.picture(frame.index);
        self.workers.submit(move || writer.write(&frame, &picture))
    }

    fn flush(&mut self) -> Result<()> {
        self.workers.wait()
    }

    fn finish(&mut self) -> Result<()> {
        self.workers.finish()
    }
}

impl Writer {
    /// Beside the frame's picture, whether there is one or not.
    fn write(&self, frame: &Frame, picture: &Path) -> Result<()> {
        let put = |ending: &str, bytes: io::Result<Vec<u8>>| {
            let path = picture.with_extension(ending);
            let failed = |reason| Error::file(&path, "encode", reason, "this is a defect, please report it");
            disk::write(&path, &bytes.map_err(failed)?)
        };
        if frame.passes.is_empty() {
            return Ok(());
        }
        match self.files {
            PassFiles::Exr => put("exr", self.exr(frame)),
            PassFiles::Png => frame.passes.iter().try_for_each(|(pass, pixels)| {
                let ending = format!("{}.png", layer(*pass).name);
                put(&ending, self.png(*pass, pixels))
            }),
        }
    }

    fn exr(&self, frame: &Frame) -> io::Result<Vec<u8>> {
        let mut channels = Vec::new();
        for (pass, pixels) in &frame.passes {
            let own = layer(*pass).channels.iter();
            channels.extend(own.map(|&(name, kind, offset)| Channel {
                name,
                kind,
                pixels,
                stride: passes::bytes_per_pixel(*pass),
                offset,
            }));
        }
        exr::encode(self.size, channels)
    }

    fn png(&self, pass: ImagePass, pixels: &[u8]) -> io::Result<Vec<u8>> {
        let each = pixels.chunks_exact(passes::bytes_per_pixel(pass));
        let float = |bytes: &[u8]| bytemuck::pod_read_unaligned::<f32>(bytes);
        let halves = |bytes: &[u8]| -> [f32; 4] {
            std::array::from_fn(|k| f16::from_le_bytes([bytes[2 * k], bytes[2 * k + 1]]).to_f32())
        };
        let (kind, numbers): (_, Vec<u16>) = match pass {
            ImagePass::Color => (
                ExtendedColorType::Rgba16,
                each.flat_map(|bytes| srgb(halves(bytes))).collect(),
            ),
            ImagePass::Depth => (
                ExtendedColorType::L16,
                each.map(|bytes| match float(bytes) {
                    NOTHING => u16::MAX,
                    depth => (f64::from(depth) / self.depth_range * 65534.0)
                        .round()
                        .min(65534.0) as u16,
                })
                .collect(),
            ),
            ImagePass::Normal => (
                ExtendedColorType::Rgb16,
                each.flat_map(|bytes| {
                    let [x, y, z, _] = halves(bytes);
                    [x, y, z].map(|n| (32768.0 + 32767.0 * n).round() as u16)
                })
                .collect(),
            ),
            ImagePass::Id => (
                ExtendedColorType::Rgb16,
                each.flat_map(|bytes| {
                    let id: u32 = bytemuck::pod_read_unaligned(bytes);
                    [(id % HALF) as u16, (id / HALF) as u16, 0]
                })
                .collect(),
            ),
            ImagePass::Motion => (
                ExtendedColorType::Rgb16,
                each.flat_map(|bytes| {
                    let step = |at: usize| (32768.0 + MOTION_STEPS * float(&bytes[at..at + 4])).round();
                    [step(0) as u16, step(4) as u16, 0]
                })
                .collect(),
            ),
            ImagePass::Velocity => return Err(io::Error::other("PNG files cannot hold velocities")),
        };
        let [width, height] = self.size;
        let mut file = Cursor::new(Vec::new());
        PngEncoder::new_with_quality(&mut file, CompressionType::Fast, FilterType::Adaptive)
            .write_image(bytemuck::cast_slice(&numbers), width, height, kind)
            .map_err(io::Error::other)?;
        Ok(file.into_inner())
    }
}

/// 16-bit sRGB, not multiplied by alpha, of linear light that is (IEC 61966-2-1).
fn srgb([r, g, b, a]: [f32; 4]) -> [u16; 4] {
    let encode = |light: f32| {
        let c = (light / a.max(1e-6)).clamp(0.0, 1.0);
        match c {
            c if c <= 0.003_130_8 => 12.92 * c,
            c => 1.055 * c.powf(1.0 / 2.4) - 0.055,
        }
    };
    [encode(r), encode(g), encode(b), a.clamp(0.0, 1.0)].map(|c| (65535.0 * c).round() as u16)
}
