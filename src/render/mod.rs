//! Stub: the real module comes from another branch.

use crate::error::Result;
use crate::scene::Scene;
use crate::scene::model::View;

pub struct Caption {
    pub frame: u32,
    pub time: f64,
    pub particles: u32,
}

pub struct Overlay {
    size: [u32; 2],
}

impl Overlay {
    pub fn new(scene: &Scene, _view: View) -> Result<Self> {
        Ok(Self {
            size: scene.render.size,
        })
    }

    pub fn finish(&self, pixels: Vec<u8>, _caption: &Caption) -> image::RgbaImage {
        image::RgbaImage::from_raw(self.size[0], self.size[1], pixels).expect("pixels of the picture's size")
    }
}
