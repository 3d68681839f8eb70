//! What is drawn on a finished picture by the processor: color bar, caption, the heatmap's legend.

use image::RgbaImage;

use super::backdrop::{Rgb, backdrop};
use super::layout::{Layout, Rectangle};
use super::pool_legend::PoolLegend;
use super::text::{Writer, blend, fill};
use super::ticks::{grouped, labels, ticks};
use crate::error::{Error, Result};
use crate::scene::model::View;
use crate::scene::{Scene, color_maps};

/// What a caption tells about a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Caption {
    pub frame: u32,
    /// Seconds.
    pub time: f64,
    pub particles: u32,
    /// Voxels that have memory, where the view shows the pool.
    pub voxels: Option<u32>,
}

/// Everything that overlays need, so that encoder threads can share it.
pub struct Overlay {
    layout: Layout,
    writer: Writer,
    text: Rgb,
    name: Option<String>,
    bar: Option<ColorBar>,
    pool: Option<PoolLegend>,
}

struct ColorBar {
    colors: Vec<Rgb>,
    title: String,
    unit: String,
    /// Share of the bar's height, and what stands there.
    ticks: Vec<(f32, String)>,
}

impl Overlay {
    pub fn new(scene: &Scene, view: View) -> Result<Self> {
        let layout = Layout::new(scene, view);
        let text = backdrop(scene.render.background).text;
        let bar = match layout.scene {
            Some(_) if scene.color.legend => Some(ColorBar::new(scene)?),
            _ => None,
        };
        Ok(Self {
            layout,
            writer: Writer::new((17.0 * layout.scale).max(9.0), text)?,
            text,
            name: scene.render.show.caption.then(|| scene.name.clone()),
            bar,
            pool: layout
                .pool
                .filter(|_| scene.render.show.overlay)
                .map(|place| PoolLegend::new(scene, place, text)),
        })
    }

    /// The device's pixels (rows of RGBA bytes without padding) with everything laid over.
    pub fn finish(&self, pixels: Vec<u8>, caption: &Caption) -> Result<RgbaImage> {
        let [width, height] = self.layout.frame;
        let mut image = RgbaImage::from_raw(width, height, pixels).ok_or_else(|| {
            Error::device(
                format!("a frame of {width}×{height} pixels came back incomplete"),
                "run again; finished frames are on disk",
            )
        })?;
        if let (Some(bar), Some(place)) = (&self.bar, self.layout.scene) {
            bar.draw(&mut image, &self.writer, self.text, place, self.layout.scale);
        }
        if let Some(pool) = &self.pool {
            pool.draw(&mut image, &self.writer, self.layout.scale, caption.voxels);
        }
        if let Some(name) = &self.name {
            self.caption(&mut image, name, caption);
        }
        Ok(image)
    }

    fn caption(&self, image: &mut RgbaImage, name: &str, caption: &Caption) {
        let place = self.layout.scene.or(self.layout.pool.map(|pool| pool.panel));
        let Some(place) = place else { return };
        let s = if caption.particles == 1 { "" } else { "s" };
        let time = format!("t = {:.3} s", caption.time);
        let count = format!("{} particle{s}", grouped(caption.particles));
        let parts: Vec<&str> = [name, &time, &count]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect();
        let x = place.x as f32 + 20.0 * self.layout.scale;
        let y = (place.y + place.height) as f32 - 18.0 * self.layout.scale;
        self.writer.write(image, x, y, &parts.join("  ·  "));
    }
}

impl ColorBar {
    fn new(scene: &Scene) -> Result<Self> {
        let color = &scene.color;
        let map = color_maps::find(&color.map).ok_or_else(|| {
            Error::usage(
                format!("there is no color map `{}`", color.map),
                "see `sliceflow scenes --color-maps`",
            )
        })?;
        let [low, high] = color.range;
        let values = ticks(low, high, 6);
        let share = |v: &f64| ((v - low) / (high - low)) as f32;
        Ok(Self {
            colors: (0..256).map(|k| (map.at)(f64::from(k) / 255.0)).collect(),
            title: color.column.name.replace('_', " "),
            unit: color.column.unit.to_owned(),
            ticks: values.iter().map(share).zip(labels(&values)).collect(),
        })
    }

    fn draw(&self, image: &mut RgbaImage, writer: &Writer, text: Rgb, place: Rectangle, scale: f32) {
        let widest = self
            .ticks
            .iter()
            .map(|(_, label)| writer.width(label))
            .fold(0.0, f32::max);
        let (bar, mark, gap) = (14.0 * scale, 5.0 * scale, 5.0 * scale);
        let head = writer.width(&self.title).max(writer.width(&self.unit));
        let wide = (bar + mark + gap + widest).max(head);
        let right = (place.x + place.width) as f32 - 20.0 * scale;
        let x = (right - wide).round();
        let tall = (0.44 * place.height as f32).round();
        let top = (place.y as f32 + 0.5 * (place.height as f32 - tall)).round();
        let width = bar.max(3.0).round() as i64;
        let frame = 1.max(scale.round() as i64);
        let (left, upper, height) = (x as i64, top as i64, tall as i64);
        fill(
            image,
            left - frame,
            upper - frame,
            width + 2 * frame,
            height + 2 * frame,
            text,
        );
        for row in 0..height {
            let share = (height - 1 - row) as f32 / (height - 1).max(1) as f32;
            let color = self.colors[(share * 255.0).round() as usize];
            fill(image, left, upper + row, width, 1, color);
        }
        for (share, label) in &self.ticks {
            let y = top + (1.0 - share) * (tall - 1.0);
            for dx in 0..mark.round() as i64 {
                for dy in 0..frame {
                    blend(
                        image,
                        (left + width + frame + dx, y.round() as i64 + dy),
                        text,
                        1.0,
                    );
                }
            }
            writer.write(image, x + bar + mark + gap, y + writer.digit() * 0.55, label);
        }
        let mut line = top - 12.0 * scale;
        if !self.unit.is_empty() {
            writer.write(image, x, line, &self.unit);
            line -= writer.line();
        }
        writer.write(image, x, line, &self.title);
    }
}
