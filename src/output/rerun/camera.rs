//! The scene's camera as Rerun has it, with the picture that it took.

use std::io::Cursor;

use ::rerun::components::ViewCoordinates;
use ::rerun::{EncodedImage, Pinhole, Transform3D};
use glam::{DVec2, DVec3};
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, crop_imm, resize};
use image::{DynamicImage, RgbaImage};

use super::budget::PictureShare;
use crate::render::{Layout, Rectangle, Sight};
use crate::scene::Scene;
use crate::scene::model::View;

/// Qualities to try, best first, until a picture is small enough.
const QUALITIES: [u8; 4] = [88, 70, 45, 20];
/// Where the picture hangs, as a share of the distance from the eye to the middle of the domain.
const PLANE: f64 = 0.3;

/// The part of a frame that shows the scene, seen through a pinhole.
pub struct Camera {
    layout: Layout,
    place: Rectangle,
    share: PictureShare,
    /// Whether it moves.
    pub turns: bool,
}

impl Camera {
    /// `None` where frames show the index pool alone.
    pub fn new(scene: &Scene, view: View, share: PictureShare) -> Option<Self> {
        let layout = Layout::new(scene, view);
        Some(Self {
            place: layout.scene?,
            layout,
            share,
            turns: scene.render.camera.moves(),
        })
    }

    fn sight(&self, scene: &Scene, time: f64) -> Sight {
        let size = [self.place.width, self.place.height];
        Sight::new(scene, size, self.layout.insets, time)
    }

    /// Lens and pose at `time` seconds; `origin` is where local coordinates have their zero.
    ///
    /// Rerun knows pinholes only: an orthographic view becomes one that sees the same of the plane through the middle
    /// of the domain.
    pub fn place(&self, scene: &Scene, time: f64, origin: DVec3) -> (Pinhole, Transform3D) {
        let sight = self.sight(scene, time);
        let middle = (scene.domain.min + scene.domain.max).as_dvec3() * 0.5;
        let distance = (middle - sight.eye).dot(sight.forward).abs().max(1e-9);
        let tangent = if sight.perspective {
            sight.half
        } else {
            sight.half / distance
        };
        let size = DVec2::from(self.size().map(f64::from));
        let focal = size / (2.0 * tangent);
        // NDC has y up, pictures have it down.
        let center = (DVec2::ONE + sight.shift * DVec2::new(1.0, -1.0)) * size * 0.5;
        let pinhole =
            Pinhole::from_focal_length_and_resolution(focal.as_vec2().to_array(), size.as_vec2().to_array())
                .with_principal_point(center.as_vec2().to_array())
                .with_camera_xyz(ViewCoordinates::RDF)
                .with_image_plane_distance((PLANE * distance) as f32);
        let axes = [sight.right, -sight.up, sight.forward].map(|axis| axis.as_vec3().to_array());
        let eye = (sight.eye + origin).as_vec3().to_array();
        let pose = Transform3D::from_translation(eye).with_mat3x3(axes);
        (pinhole, pose)
    }

    /// Width and height of the picture, pixels.
    fn size(&self) -> [u32; 2] {
        [self.place.width, self.place.height].map(|side| (side / self.share.shrink).max(1))
    }

    /// The camera's part of a finished frame, as JPEG; `None` where none is small enough.
    pub fn picture(&self, frame: &RgbaImage) -> Option<EncodedImage> {
        let Rectangle { x, y, width, height } = self.place;
        let part = crop_imm(frame, x, y, width, height);
        let [width, height] = self.size();
        let part = match self.share.shrink {
            1 => part.to_image(),
            _ => resize(&*part, width, height, FilterType::Triangle),
        };
        let opaque = DynamicImage::ImageRgba8(part).into_rgb8();
        QUALITIES.into_iter().find_map(|quality| {
            let mut bytes = Cursor::new(Vec::new());
            let encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
            opaque.write_with_encoder(encoder).ok()?;
            let bytes = bytes.into_inner();
            let fits = bytes.len() as u64 <= self.share.bytes;
            fits.then(|| EncodedImage::from_file_contents(bytes))
        })
    }
}
