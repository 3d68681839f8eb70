//! Bounds for animations that stand in a README: some of the frames, scaled down.

use image::RgbaImage;
use image::imageops::{FilterType, resize};

/// Pixels.
const WIDEST: u32 = 640;
/// Pictures a second.
const FASTEST: f64 = 15.0;
const MOST_PICTURES: u32 = 150;
/// What counts as the same color as before, steps of 255.
const SAME: u8 = 3;

/// What is kept of a run.
pub struct Small {
    size: [u32; 2],
    /// Of frames 0, 1, 2, … every n-th is kept.
    every: u32,
    /// Seconds.
    pub pause: f64,
    frames: u32,
    is_scaled: bool,
}

impl Small {
    pub fn new([width, height]: [u32; 2], rate: f64, frames: u32) -> Self {
        let every = ((rate / FASTEST).ceil() as u32)
            .max(frames.div_ceil(MOST_PICTURES))
            .max(1);
        let kept = width.min(WIDEST);
        let scaled = (f64::from(height) * f64::from(kept) / f64::from(width))
            .round()
            .max(1.0);
        Self {
            size: [kept, scaled as u32],
            every,
            pause: f64::from(every) / rate,
            frames,
            is_scaled: kept < width,
        }
    }

    pub fn told(&self) -> Option<String> {
        let [width, height] = self.size;
        let mut parts = Vec::new();
        if self.every > 1 {
            parts.push(
                format!("every {}th frame", self.every)
                    .replace(" 2th", " 2nd")
                    .replace(" 3th", " 3rd"),
            );
        }
        if self.is_scaled {
            parts.push(format!("scaled to {width}×{height}"));
        }
        (!parts.is_empty()).then(|| parts.join(", "))
    }

    /// Pictures that a whole run gives.
    pub fn pictures(&self) -> u32 {
        self.frames.div_ceil(self.every)
    }

    /// The picture as it is kept, or `None` for a frame that is left out.
    pub fn kept(&self, index: u32, picture: &RgbaImage) -> Option<RgbaImage> {
        let [width, height] = self.size;
        index.is_multiple_of(self.every).then(|| match self.is_scaled {
            true => resize(picture, width, height, FilterType::Triangle),
            false => picture.clone(),
        })
    }
}

/// What changes from one picture to the next.
pub struct Change {
    pub left: u32,
    pub top: u32,
    pub size: [u32; 2],
}

/// Whether two pixels look the same.
pub fn is_same(a: image::Rgba<u8>, b: image::Rgba<u8>) -> bool {
    a.0.iter().zip(b.0).all(|(a, b)| a.abs_diff(b) <= SAME)
}

/// The box around pixels that differ; one pixel where none do, since an animation's frame is not empty.
pub fn change(shown: &RgbaImage, next: &RgbaImage) -> Change {
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    for (x, y, pixel) in next.enumerate_pixels() {
        if !is_same(*shown.get_pixel(x, y), *pixel) {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x + 1), high[1].max(y + 1)];
        }
    }
    if low[0] == u32::MAX {
        (low, high) = ([0; 2], [1; 2]);
    }
    Change {
        left: low[0],
        top: low[1],
        size: [high[0] - low[0], high[1] - low[1]],
    }
}
