//! Pictures: one PNG a frame.

use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;
use std::thread::available_parallelism;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ImageEncoder as _, RgbaImage};

use super::folder::Folder;
use super::workers::Workers;
use super::{Sink, disk};
use crate::error::{Error, Result};
use crate::render::{Caption, Overlay};
use crate::simulation::frame::Frame;

/// More threads than this do not help: the disk and the simulation want their turn.
const MOST_THREADS: usize = 8;

/// Draws legends and captions over pixels from the GPU, compresses and writes them, on threads of its own.
pub struct Pictures {
    folder: Arc<Folder>,
    overlay: Arc<Overlay>,
    workers: Workers,
}

impl Pictures {
    pub fn new(folder: Arc<Folder>, overlay: Overlay) -> Self {
        let threads = available_parallelism().map_or(1, |n| n.get().min(MOST_THREADS));
        Self {
            folder,
            overlay: Arc::new(overlay),
            workers: Workers::new(threads),
        }
    }
}

impl Sink for Pictures {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        let path = self.folder.picture(frame.index);
        let (frame, overlay) = (frame.clone(), self.overlay.clone());
        self.workers.submit(move || {
            let Some(picture) = compose(&frame, &overlay)? else {
                return Ok(());
            };
            disk::write(&path, &encode(picture, &path)?)
        })
    }

    fn flush(&mut self) -> Result<()> {
        self.workers.wait()
    }

    fn finish(&mut self) -> Result<()> {
        self.workers.finish()
    }
}

/// The finished picture of a frame that has pixels.
pub fn compose(frame: &Frame, overlay: &Overlay) -> Result<Option<RgbaImage>> {
    let Some(pixels) = frame.pixels.clone() else {
        return Ok(None);
    };
    let caption = Caption {
        frame: frame.index,
        time: frame.time,
        particles: frame.particles,
        voxels: frame.statistics.map(|s| s.voxels_allocated),
    };
    overlay.finish(pixels, &caption).map(Some)
}

/// PNG bytes, compressed fast; alpha is left out of pictures that are opaque. `path` is for the message.
pub fn encode(picture: RgbaImage, path: &Path) -> Result<Vec<u8>> {
    let (width, height) = picture.dimensions();
    let is_opaque = picture.pixels().all(|pixel| pixel.0[3] == 255);
    let picture = DynamicImage::ImageRgba8(picture);
    let picture = match is_opaque {
        true => DynamicImage::ImageRgb8(picture.into_rgb8()),
        false => picture,
    };
    let mut bytes = Cursor::new(Vec::with_capacity(picture.as_bytes().len() / 2));
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(picture.as_bytes(), width, height, picture.color().into())
        .map_err(|reason| Error::file(path, "encode", reason, "this is a defect, please report it"))?;
    Ok(bytes.into_inner())
}
