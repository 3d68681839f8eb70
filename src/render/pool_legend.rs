//! The legend beside the index pool's heatmap.

use image::RgbaImage;

use super::backdrop::{POOL_COLORS, Rgb};
use super::layout::PoolPlace;
use super::text::{Writer, fill};
use super::ticks::grouped;
use crate::scene::Scene;
use crate::scene::model::Storage;

pub struct PoolLegend {
    place: PoolPlace,
    text: Rgb,
    rows: Vec<(Rgb, String)>,
}

/// Side of the heatmap in voxels, voxels along a pixel's side; the same arithmetic as `shaders/storage/fold.wgsl`.
pub fn folding(voxels: u32, room: u32) -> (u32, u32) {
    let mut side = f64::from(voxels).sqrt().ceil() as u32;
    side = side.max(1);
    (side, side.div_ceil(room.max(1)))
}

impl PoolLegend {
    pub fn new(scene: &Scene, place: PoolPlace, text: Rgb) -> Self {
        let slots = scene.neighbors.slots;
        let bounded = scene.neighbors.storage == Storage::Pool;
        let highest = if bounded { slots } else { u32::MAX };
        let mut rows = Vec::new();
        for (count, &color) in POOL_COLORS.iter().enumerate().take(5) {
            let count = count as u32;
            if count > highest {
                continue;
            }
            rows.push((
                color,
                match count {
                    0 => "empty".into(),
                    1 => "1 particle".into(),
                    4 if highest > 4 => "4 or more".into(),
                    _ => format!("{count} particles"),
                },
            ));
        }
        if bounded {
            rows.push((POOL_COLORS[5], format!("over {slots}: no slot left")));
        }
        Self { place, text, rows }
    }

    pub fn draw(&self, image: &mut RgbaImage, writer: &Writer, scale: f32, voxels: Option<u32>) {
        let [x, y] = self.place.legend.map(|v| v as f32);
        let mut line = y + writer.digit();
        writer.write(image, x, line, "index pool");
        line += writer.line() * 1.15;
        let swatch = (13.0 * scale).max(5.0).round();
        for (color, what) in &self.rows {
            let (left, upper) = (
                x as i64,
                (line - writer.digit() * 0.5 - swatch * 0.5).round() as i64,
            );
            let side = swatch as i64;
            fill(image, left - 1, upper - 1, side + 2, side + 2, self.text);
            fill(image, left, upper, side, side, *color);
            writer.write(image, x + swatch + 9.0 * scale, line, what);
            line += writer.line();
        }
        let Some(voxels) = voxels else { return };
        line += writer.line() * 0.15;
        let (_, block) = folding(voxels, self.place.square[2]);
        let note = if block == 1 {
            "1 texel = 1 voxel".to_owned()
        } else {
            format!("1 texel = {} voxels, fullest shown", block * block)
        };
        writer.write(image, x, line, &format!("{} voxels", grouped(voxels)));
        writer.write(image, x, line + writer.line(), &note);
    }
}
