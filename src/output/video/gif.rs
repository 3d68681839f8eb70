//! Animated GIF: small, and only what changes from picture to picture, with 255 colors of its own for each.

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use gif::{DisposalMethod, Frame, Repeat};
use image::{Rgba, RgbaImage, imageops};

use super::small::{Small, change, is_same};
use super::{Encoder, Start, create};
use crate::error::{Error, Result};

/// 1 is best, 30 fastest: gif's color reduction.
const SPEED: i32 = 10;

pub fn start(start: &Start) -> Result<Box<dyn Encoder>> {
    Ok(Box::new(Animation {
        small: Small::new(start.size, start.rate, start.frames),
        path: start.path.to_owned(),
        encoder: None,
        shown: RgbaImage::default(),
    }))
}

struct Animation {
    small: Small,
    path: PathBuf,
    /// From the first picture on.
    encoder: Option<gif::Encoder<BufWriter<File>>>,
    /// What stands on the screen, before its colors are reduced.
    shown: RgbaImage,
}

impl Encoder for Animation {
    fn picture(&mut self, index: u32, picture: &RgbaImage) -> Result<()> {
        let Some(next) = self.small.kept(index, picture) else {
            return Ok(());
        };
        let mut frame = match &self.encoder {
            None => {
                let (width, height) = (next.width() as u16, next.height() as u16);
                self.shown = next;
                Frame::from_rgba_speed(width, height, &mut self.shown.clone(), SPEED)
            }
            Some(_) => self.difference(&next),
        };
        frame.delay = (self.small.pause * 100.0).round().max(2.0) as u16;
        frame.dispose = DisposalMethod::Keep;
        let path = self.path.clone();
        let failed =
            |reason: gif::EncodingError| Error::file(&path, "encode", reason, "check that the disk has room");
        if self.encoder.is_none() {
            let mut encoder =
                gif::Encoder::new(create(&self.path)?, frame.width, frame.height, &[]).map_err(failed)?;
            encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
            self.encoder = Some(encoder);
        }
        self.encoder
            .as_mut()
            .map_or(Ok(()), |encoder| encoder.write_frame(&frame).map_err(failed))
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        let Some(encoder) = self.encoder.take() else {
            return Ok(());
        };
        let failed = |reason: &dyn std::fmt::Display| {
            Error::file(&self.path, "encode", reason, "check that the disk has room")
        };
        let file = encoder.into_inner().map_err(|reason| failed(&reason))?;
        file.into_inner().map_err(|reason| failed(&reason))?;
        Ok(())
    }
}

impl Animation {
    /// The box of what changes; pixels in it that do not are transparent. Updates what is shown.
    fn difference(&mut self, next: &RgbaImage) -> Frame<'static> {
        let change = change(&self.shown, next);
        let [width, height] = change.size;
        let mut part = imageops::crop_imm(next, change.left, change.top, width, height).to_image();
        for (x, y, pixel) in part.enumerate_pixels_mut() {
            let shown = self.shown.get_pixel_mut(change.left + x, change.top + y);
            if is_same(*shown, *pixel) {
                *pixel = Rgba([0; 4]);
            } else {
                *shown = *pixel;
            }
        }
        let mut frame = Frame::from_rgba_speed(width as u16, height as u16, &mut part, SPEED);
        (frame.left, frame.top) = (change.left as u16, change.top as u16);
        frame
    }
}
