//! Text on a finished picture.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use image::RgbaImage;

use super::backdrop::Rgb;
use crate::error::{Error, Result};

static INTER: &[u8] = include_bytes!("../../assets/fonts/Inter-Medium-Latin.ttf");

/// The font at one size.
pub struct Writer {
    font: FontRef<'static>,
    size: PxScale,
    color: Rgb,
}

impl Writer {
    /// `size` is the height of a line in pixels.
    pub fn new(size: f32, color: Rgb) -> Result<Self> {
        let font = FontRef::try_from_slice(INTER).map_err(|error| Error::Shader {
            message: format!("assets/fonts/Inter-Medium-Latin.ttf: {error}"),
        })?;
        Ok(Self {
            font,
            size: PxScale::from(size),
            color,
        })
    }

    /// Pixels between two lines.
    pub fn line(&self) -> f32 {
        self.size.y * 1.22
    }

    /// Height of a digit, pixels.
    pub fn digit(&self) -> f32 {
        self.size.y * 0.60
    }

    pub fn width(&self, text: &str) -> f32 {
        let scaled = self.font.as_scaled(self.size);
        let mut width = 0.0;
        let mut last = None;
        for id in text.chars().map(|c| self.font.glyph_id(c)) {
            width += last.map_or(0.0, |last| scaled.kern(last, id)) + scaled.h_advance(id);
            last = Some(id);
        }
        width
    }

    /// Writes with the left end of the base line at (`x`, `y`).
    pub fn write(&self, image: &mut RgbaImage, x: f32, y: f32, text: &str) {
        let scaled = self.font.as_scaled(self.size);
        let mut pen = x;
        let mut last = None;
        for id in text.chars().map(|c| self.font.glyph_id(c)) {
            pen += last.map_or(0.0, |last| scaled.kern(last, id));
            let glyph = id.with_scale_and_position(self.size, point(pen, y));
            if let Some(outline) = self.font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|dx, dy, cover| {
                    let at = (corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy));
                    blend(image, at, self.color, cover);
                });
            }
            pen += scaled.h_advance(id);
            last = Some(id);
        }
    }
}

/// Lays a color over a pixel; `cover` from 0 to 1. Outside the picture nothing happens.
pub fn blend(image: &mut RgbaImage, (x, y): (i64, i64), color: Rgb, cover: f32) {
    let inside = |v: i64, size: u32| u32::try_from(v).ok().filter(|&v| v < size);
    if let (Some(x), Some(y)) = (inside(x, image.width()), inside(y, image.height())) {
        let pixel = image.get_pixel_mut(x, y);
        let cover = cover.clamp(0.0, 1.0);
        let alpha = f32::from(pixel.0[3]) / 255.0;
        let joint = cover + alpha * (1.0 - cover);
        let share = if alpha == 1.0 {
            cover
        } else {
            cover / joint.max(1e-6)
        };
        for (old, new) in pixel.0.iter_mut().zip(color) {
            let mixed = f32::from(*old) + (f32::from(new) - f32::from(*old)) * share;
            *old = mixed.round() as u8;
        }
        pixel.0[3] = (joint * 255.0).round() as u8;
    }
}

/// Lays a picture that has alpha over white.
pub fn over_white(image: &mut RgbaImage) {
    for pixel in image.pixels_mut() {
        let alpha = f32::from(pixel.0[3]) / 255.0;
        for channel in &mut pixel.0[..3] {
            *channel = (255.0 + (f32::from(*channel) - 255.0) * alpha).round() as u8;
        }
        pixel.0[3] = 255;
    }
}

/// Fills whole pixels from (`x`, `y`).
pub fn fill(image: &mut RgbaImage, x: i64, y: i64, width: i64, height: i64, color: Rgb) {
    for dy in 0..height {
        for dx in 0..width {
            blend(image, (x + dx, y + dy), color, 1.0);
        }
    }
}
