//! What charts are drawn with: shapes in pixels from the upper left corner, painted as PNG or SVG.

use std::path::Path;
use std::sync::Once;

use image::imageops::{FilterType, resize};
use image::{DynamicImage, RgbImage};
use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea as _};
use plotters::element::{Circle, PathElement, Polygon, Rectangle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color as _, FontFamily, FontStyle, FontTransform, IntoFont as _, RGBColor, ShapeStyle, TextStyle,
    register_font,
};

use crate::error::{Error, Result};
use crate::output::{disk, encode_png};

/// What an SVG asks its viewer for, and the name under which PNGs find the font that Sliceflow ships.
const FONT: &str = "Inter, sans-serif";
static INTER: &[u8] = include_bytes!("../../../assets/fonts/Inter-Medium-Latin.ttf");
/// PNGs are painted so many times larger and then made smaller, which smooths edges.
const SUPERSAMPLING: u32 = 3;
/// The bitmap painter's texts stand this share of their size above the middle.
const BITMAP_DROP: f64 = 0.2;

pub const INK: Color = [24, 26, 30];
pub const FAINT: Color = [96, 101, 110];
pub const GRID: Color = [226, 229, 233];
pub const PAPER: Color = [255, 255, 255];

/// sRGB bytes.
pub type Color = [u8; 3];
/// Pixels from the left and from the top.
pub type At = (f64, f64);

/// Where a text stands: its left end, its middle or its right end at the given place, centered in height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Left,
    Middle,
    Right,
    /// Middle, read from below to above.
    Upwards,
}

#[derive(Debug, Clone)]
pub enum Shape {
    Line {
        points: Vec<At>,
        color: Color,
        width: f64,
    },
    /// Corners, filled; `opacity` from 0 to 1.
    Area {
        corners: Vec<At>,
        color: Color,
        opacity: f64,
    },
    Disc {
        center: At,
        radius: f64,
        color: Color,
    },
    Text {
        at: At,
        text: String,
        size: f64,
        color: Color,
        anchor: Anchor,
    },
}

/// A list of shapes, painted in order.
pub struct Canvas {
    pub width: f64,
    pub height: f64,
    shapes: Vec<Shape>,
}

impl Canvas {
    pub fn new((width, height): (u32, u32)) -> Self {
        register();
        Self {
            width: width.into(),
            height: height.into(),
            shapes: Vec::new(),
        }
    }

    pub fn add(&mut self, shape: Shape) {
        self.shapes.push(shape);
    }

    pub fn line(&mut self, points: Vec<At>, color: Color, width: f64) {
        self.add(Shape::Line { points, color, width });
    }

    pub fn rectangle(&mut self, (x0, y0): At, (x1, y1): At, color: Color, opacity: f64) {
        self.add(Shape::Area {
            corners: vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1)],
            color,
            opacity,
        });
    }

    pub fn text(&mut self, at: At, text: impl Into<String>, size: f64, color: Color, anchor: Anchor) {
        self.add(Shape::Text {
            at,
            text: text.into(),
            size,
            color,
            anchor,
        });
    }

    /// Writes PNG or SVG, by the path's ending.
    pub fn save(&self, path: &Path) -> Result<()> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let bytes = match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => self.svg(path)?,
            Some("png") => encode_png(DynamicImage::ImageRgb8(self.pixels(path)?).into_rgba8(), path)?,
            _ => {
                return Err(Error::usage(
                    format!("a plot cannot be written to {}", path.display()),
                    "let the name end in .png or .svg",
                ));
            }
        };
        disk::write(path, &bytes)
    }

    fn svg(&self, path: &Path) -> Result<Vec<u8>> {
        let mut text = String::new();
        let area =
            SVGBackend::with_string(&mut text, (self.width as u32, self.height as u32)).into_drawing_area();
        self.paint(&area, 1.0, 0.0)
            .map_err(|reason| Error::file(path, "draw", reason, "this is a defect, please report it"))?;
        drop(area);
        Ok(text.into_bytes())
    }

    fn pixels(&self, path: &Path) -> Result<RgbImage> {
        let size = (
            self.width as u32 * SUPERSAMPLING,
            self.height as u32 * SUPERSAMPLING,
        );
        let mut large = RgbImage::new(size.0, size.1);
        let area = BitMapBackend::with_buffer(&mut large, size).into_drawing_area();
        self.paint(&area, f64::from(SUPERSAMPLING), BITMAP_DROP)
            .map_err(|reason| Error::file(path, "draw", reason, "this is a defect, please report it"))?;
        drop(area);
        Ok(resize(
            &large,
            self.width as u32,
            self.height as u32,
            FilterType::Triangle,
        ))
    }

    /// `drop` lowers texts by that share of their size.
    fn paint<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: f64,
        drop: f64,
    ) -> std::result::Result<(), String> {
        let place = |(x, y): At| ((x * scale).round() as i32, (y * scale).round() as i32);
        let told = |error: &dyn std::fmt::Display| error.to_string();
        area.fill(&rgb(PAPER)).map_err(|e| told(&e))?;
        for shape in &self.shapes {
            match shape {
                Shape::Line { points, color, width } => {
                    let style = ShapeStyle {
                        color: rgb(*color).to_rgba(),
                        filled: false,
                        stroke_width: (width * scale).round().max(1.0) as u32,
                    };
                    // One segment at a time: long paths of the bitmap painter have spikes at sharp turns.
                    for pair in points.windows(2) {
                        let ends = [place(pair[0]), place(pair[1])];
                        area.draw(&PathElement::new(ends, style)).map_err(|e| told(&e))?;
                    }
                }
                Shape::Area {
                    corners,
                    color,
                    opacity,
                } => {
                    let style = rgb(*color).mix(*opacity).filled();
                    let corners: Vec<_> = corners.iter().copied().map(place).collect();
                    let painted = match corners[..] {
                        [a, b, c, _] if a.1 == b.1 && b.0 == c.0 => area.draw(&Rectangle::new([a, c], style)),
                        _ => area.draw(&Polygon::new(corners, style)),
                    };
                    painted.map_err(|e| told(&e))?;
                }
                Shape::Disc {
                    center,
                    radius,
                    color,
                } => area
                    .draw(&Circle::new(
                        place(*center),
                        (radius * scale).round() as i32,
                        rgb(*color).filled(),
                    ))
                    .map_err(|e| told(&e))?,
                Shape::Text {
                    at,
                    text,
                    size,
                    color,
                    anchor,
                } => {
                    let style = text_style(size * scale, *color, *anchor);
                    let lower = drop * size;
                    let at = match anchor {
                        Anchor::Upwards => (at.0 + lower, at.1),
                        _ => (at.0, at.1 + lower),
                    };
                    area.draw_text(text, &style, place(at)).map_err(|e| told(&e))?;
                }
            }
        }
        area.present().map_err(|e| told(&e))
    }
}

/// Width of a text in pixels.
pub fn text_width(text: &str, size: f64) -> f64 {
    register();
    // Measured large, since the font's answer is a whole number.
    let large = (FONT, size * 8.0).into_font();
    large
        .box_size(text)
        .map_or(0.0, |(width, _)| f64::from(width) / 8.0)
}

fn text_style(size: f64, color: Color, anchor: Anchor) -> TextStyle<'static> {
    let (h_pos, transform) = match anchor {
        Anchor::Left => (HPos::Left, FontTransform::None),
        Anchor::Middle => (HPos::Center, FontTransform::None),
        Anchor::Right => (HPos::Right, FontTransform::None),
        Anchor::Upwards => (HPos::Center, FontTransform::Rotate270),
    };
    let font = (FontFamily::Name(FONT), size).into_font().transform(transform);
    TextStyle {
        color: rgb(color).to_backend_color(),
        pos: Pos::new(h_pos, VPos::Center),
        ..TextStyle::from(font)
    }
}

fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let registered = register_font(FONT, FontStyle::Normal, INTER);
        assert!(
            registered.is_ok(),
            "assets/fonts/Inter-Medium-Latin.ttf is no font"
        );
    });
}

fn rgb([r, g, b]: Color) -> RGBColor {
    RGBColor(r, g, b)
}
