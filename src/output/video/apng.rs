//! Animated PNG (PNG, third edition): small, true colors, only the box that changes from picture to picture.

use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Seek as _, SeekFrom, Write as _};
use std::path::PathBuf;

use image::{DynamicImage, RgbaImage, imageops};

use super::small::{Change, Small, change};
use super::{Encoder, Start, create};
use crate::error::{Error, Result};
use crate::output::disk;

/// Where the chunk `acTL` has its data: behind the signature, `IHDR`, its own length and name.
const COUNT_AT: u64 = 8 + 25 + 8;

pub fn start(start: &Start) -> Result<Box<dyn Encoder>> {
    Ok(Box::new(Animation {
        small: Small::new(start.size, start.rate, start.frames),
        path: start.path.to_owned(),
        writer: None,
        shown: RgbaImage::default(),
        written: 0,
    }))
}

struct Animation {
    small: Small,
    path: PathBuf,
    /// From the first picture on.
    writer: Option<png::Writer<BufWriter<File>>>,
    /// What stands on the screen.
    shown: RgbaImage,
    written: u32,
}

impl Encoder for Animation {
    fn picture(&mut self, index: u32, picture: &RgbaImage) -> Result<()> {
        let Some(next) = self.small.kept(index, picture) else {
            return Ok(());
        };
        let path = self.path.clone();
        let failed =
            |reason: png::EncodingError| Error::file(&path, "encode", reason, "check that the disk has room");
        let part = if self.writer.is_some() {
            change(&self.shown, &next)
        } else {
            self.writer = Some(self.begin(&next)?);
            Change {
                left: 0,
                top: 0,
                size: next.dimensions().into(),
            }
        };
        let [width, height] = part.size;
        let pixels = imageops::crop_imm(&next, part.left, part.top, width, height).to_image();
        let pixels = DynamicImage::ImageRgba8(pixels).into_rgb8();
        if let Some(writer) = &mut self.writer {
            writer.reset_frame_position().map_err(failed)?;
            writer.set_frame_dimension(width, height).map_err(failed)?;
            writer.set_frame_position(part.left, part.top).map_err(failed)?;
            writer.write_image_data(&pixels).map_err(failed)?;
            self.written += 1;
        }
        imageops::replace(
            &mut self.shown,
            &pixels_of(&pixels),
            part.left.into(),
            part.top.into(),
        );
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        // Writes the end, whatever number of pictures was announced.
        drop(self.writer.take());
        if self.written == 0 || self.written == self.small.pictures() {
            return Ok(());
        }
        self.correct_count()
            .map_err(|reason| disk::failed(&self.path, "write", reason))
    }
}

impl Animation {
    fn begin(&mut self, first: &RgbaImage) -> Result<png::Writer<BufWriter<File>>> {
        let failed = |reason: png::EncodingError| {
            Error::file(&self.path, "encode", reason, "this is a defect, please report it")
        };
        let mut encoder = png::Encoder::new(create(&self.path)?, first.width(), first.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(self.small.pictures(), 0).map_err(failed)?;
        encoder
            .set_frame_delay((self.small.pause * 1000.0).round() as u16, 1000)
            .map_err(failed)?;
        self.shown = first.clone();
        encoder.write_header().map_err(failed)
    }

    /// A run that ended early has fewer pictures than were announced.
    fn correct_count(&self) -> std::io::Result<()> {
        let mut chunk = b"acTL".to_vec();
        chunk.extend(self.written.to_be_bytes());
        // Plays without end.
        chunk.extend(0u32.to_be_bytes());
        let mut sum = flate2::Crc::new();
        sum.update(&chunk);
        let mut file = OpenOptions::new().write(true).open(&self.path)?;
        file.seek(SeekFrom::Start(COUNT_AT))?;
        file.write_all(&chunk[4..])?;
        file.write_all(&sum.sum().to_be_bytes())
    }
}

fn pixels_of(rgb: &image::RgbImage) -> RgbaImage {
    DynamicImage::ImageRgb8(rgb.clone()).into_rgba8()
}
