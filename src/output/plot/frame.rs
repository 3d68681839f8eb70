//! What every chart has around its data: title, axes with ticks and units, grid lines, legend, remarks.

use super::axis::Axis;
use super::canvas::{Anchor, At, Canvas, Color, FAINT, GRID, INK, Shape, text_width};

const TITLE: f64 = 24.0;
const LABEL: f64 = 18.0;
const TICK: f64 = 16.0;
const SPACE: f64 = 12.0;
/// Names of a legend beside the data take at most this share of the width; longer ones stand below.
const BESIDE: f64 = 0.35;
/// From one line of a legend to the next.
const LEGEND_LINE: f64 = 1.55 * TICK;
/// Of lines and markers.
const STROKE: f64 = 2.5;
const MARKER: f64 = 5.0;

/// Okabe and Ito's palette, which people with every kind of color vision can tell apart, the lightest color last.
const COLORS: [Color; 8] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [24, 26, 30],
    [86, 180, 233],
    [173, 160, 30],
];

/// How series number `index` looks; after eight, colors return with another marker.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    pub color: Color,
    marker: usize,
}

pub fn look(index: usize) -> Look {
    Look {
        color: COLORS[index % COLORS.len()],
        marker: index / COLORS.len() + index % COLORS.len(),
    }
}

impl Look {
    pub fn mark(self, canvas: &mut Canvas, (x, y): At) {
        let r = MARKER;
        let corners = match self.marker % 4 {
            0 => {
                return canvas.add(Shape::Disc {
                    center: (x, y),
                    radius: r,
                    color: self.color,
                });
            }
            1 => vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
            2 => vec![(x, y - 1.3 * r), (x + 1.2 * r, y + r), (x - 1.2 * r, y + r)],
            _ => vec![
                (x, y - 1.4 * r),
                (x + 1.4 * r, y),
                (x, y + 1.4 * r),
                (x - 1.4 * r, y),
            ],
        };
        canvas.add(Shape::Area {
            corners,
            color: self.color,
            opacity: 1.0,
        });
    }

    /// Two strokes across each other.
    pub fn cross(self, canvas: &mut Canvas, (x, y): At) {
        let r = 1.4 * MARKER;
        for side in [r, -r] {
            canvas.line(vec![(x - r, y - side), (x + r, y + side)], self.color, STROKE);
        }
    }

    pub fn stroke(self, canvas: &mut Canvas, points: Vec<At>) {
        canvas.line(points, self.color, STROKE);
    }
}

/// How an entry of the legend is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sample {
    Line,
    MarkedLine,
    Marker,
    Bar,
    /// Across the data, for comparison.
    Dashes,
    Band,
}

pub struct Entry {
    pub name: String,
    pub look: Look,
    pub sample: Sample,
}

/// Words around the data.
pub struct Words<'a> {
    pub title: &'a str,
    pub x: &'a str,
    pub y: &'a str,
    pub remark: Option<String>,
}

/// The rectangle that holds the data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Field {
    pub fn x(&self, place: f64) -> f64 {
        self.left + place * (self.right - self.left)
    }

    pub fn y(&self, place: f64) -> f64 {
        self.bottom - place * (self.bottom - self.top)
    }
}

/// Draws everything but the data; says where the data goes. `named` are ticks along x in place of the axis' own, at
/// their places from 0 to 1.
pub fn draw(
    canvas: &mut Canvas,
    words: &Words,
    axes: (&Axis, &Axis),
    ticks: &Ticks,
    legend: &[Entry],
) -> Field {
    let (x_axis, y_axis) = axes;
    let y_ticks = y_axis.ticks(8);
    let widest = |labels: &mut dyn Iterator<Item = &str>, size: f64| {
        labels.map(|label| text_width(label, size)).fold(0.0, f64::max)
    };
    let y_labels = widest(&mut y_ticks.iter().map(|(_, label)| label.as_str()), TICK);
    let names = widest(&mut legend.iter().map(|entry| entry.name.as_str()), TICK);
    let beside = !legend.is_empty() && names <= BESIDE * canvas.width;
    let lines = if beside { 0 } else { legend.len() };
    let remark = if words.remark.is_some() { TICK + SPACE } else { 0.0 };
    let field = Field {
        left: SPACE + LABEL + SPACE + y_labels + SPACE,
        right: canvas.width
            - if beside {
                names + 4.0 * SPACE + 34.0
            } else {
                2.0 * SPACE
            },
        top: TITLE + 2.5 * SPACE,
        bottom: canvas.height
            - remark
            - LEGEND_LINE * lines as f64
            - LABEL
            - 2.0 * SPACE
            - ticks.depth()
            - SPACE,
    };
    canvas.text(
        (SPACE, SPACE + TITLE / 2.0),
        words.title,
        TITLE,
        INK,
        Anchor::Left,
    );
    for (value, label) in &y_ticks {
        let y = field.y(y_axis.place(*value));
        canvas.line(vec![(field.left, y), (field.right, y)], GRID, 1.0);
        canvas.text((field.left - SPACE, y), label.as_str(), TICK, INK, Anchor::Right);
    }
    ticks.draw(canvas, x_axis, field);
    canvas.line(
        vec![
            (field.left, field.top),
            (field.left, field.bottom),
            (field.right, field.bottom),
        ],
        INK,
        1.5,
    );
    let middle = ((field.left + field.right) / 2.0, (field.top + field.bottom) / 2.0);
    let below = field.bottom + SPACE + ticks.depth() + LABEL / 2.0 + SPACE / 2.0;
    canvas.text((middle.0, below), words.x, LABEL, INK, Anchor::Middle);
    canvas.text(
        (SPACE + LABEL / 2.0, middle.1),
        words.y,
        LABEL,
        INK,
        Anchor::Upwards,
    );
    if let Some(remark) = &words.remark {
        let y = canvas.height - SPACE - TICK / 2.0;
        canvas.text((SPACE, y), remark.as_str(), TICK, FAINT, Anchor::Left);
    }
    let corner = if beside {
        (field.right + 2.0 * SPACE, field.top)
    } else {
        (field.left, below + LABEL / 2.0 + SPACE / 2.0)
    };
    draw_legend(canvas, legend, corner);
    field
}

/// What stands below the data.
pub enum Ticks {
    /// The axis' own values.
    Values,
    /// Names in place of values, at their places from 0 to 1.
    Names(Vec<(f64, String)>),
}

impl Ticks {
    /// Pixels that the labels need below the axis.
    fn depth(&self) -> f64 {
        let lines = match self {
            Self::Values => 1,
            Self::Names(names) => names
                .iter()
                .map(|(_, name)| name.lines().count())
                .max()
                .unwrap_or(1),
        };
        TICK * 1.25 * lines as f64
    }

    fn draw(&self, canvas: &mut Canvas, axis: &Axis, field: Field) {
        let write = |canvas: &mut Canvas, x: f64, text: &str| {
            for (line, text) in text.lines().enumerate() {
                let y = field.bottom + SPACE + TICK * (0.4 + 1.25 * line as f64);
                canvas.text((x, y), text, TICK, INK, Anchor::Middle);
            }
        };
        match self {
            Self::Names(names) => {
                for (place, name) in names {
                    write(canvas, field.x(*place), name);
                }
            }
            Self::Values => {
                for (value, label) in axis.ticks(8) {
                    let x = field.x(axis.place(value));
                    write(canvas, x, &label);
                    canvas.line(vec![(x, field.bottom), (x, field.bottom + 5.0)], INK, 1.5);
                }
            }
        }
    }
}

fn draw_legend(canvas: &mut Canvas, legend: &[Entry], (left, top): At) {
    for (index, entry) in legend.iter().enumerate() {
        let y = top + 0.7 * TICK + LEGEND_LINE * index as f64;
        let ends = vec![(left, y), (left + 34.0, y)];
        let middle = (left + 17.0, y);
        match entry.sample {
            Sample::Line => entry.look.stroke(canvas, ends),
            Sample::MarkedLine => {
                entry.look.stroke(canvas, ends);
                entry.look.mark(canvas, middle);
            }
            Sample::Marker => entry.look.mark(canvas, middle),
            Sample::Dashes => dashes(canvas, ends[0], ends[1]),
            Sample::Bar => canvas.rectangle(
                (left + 8.0, y - 8.0),
                (left + 26.0, y + 8.0),
                entry.look.color,
                1.0,
            ),
            Sample::Band => canvas.rectangle((left, y - 8.0), (left + 34.0, y + 8.0), FAINT, 0.18),
        }
        canvas.text(
            (left + 34.0 + SPACE / 1.5, y),
            entry.name.as_str(),
            TICK,
            INK,
            Anchor::Left,
        );
    }
}

/// A dashed line for comparison.
pub fn dashes(canvas: &mut Canvas, from: At, to: At) {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    let along = |s: f64| {
        let part = (s / length).min(1.0);
        (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1))
    };
    let mut start = 0.0;
    while start < length {
        canvas.line(vec![along(start), along(start + 8.0)], FAINT, 1.5);
        start += 13.0;
    }
}
