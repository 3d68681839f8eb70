//! Charts as PNG or SVG, in one style.
//!
//! ```no_run
//! use sliceflow::output::plot::Plot;
//!
//! Plot::new("Construction", "particles", "milliseconds")
//!     .series("GPU", [(1e4, 0.4), (1e5, 2.9), (1e6, 31.0)])
//!     .series("CPU", [(1e4, 0.9), (1e5, 9.8), (1e6, 120.0)])
//!     .log_x()
//!     .log_y()
//!     .save("out/construction.png".as_ref())?;
//! # Ok::<(), sliceflow::error::Error>(())
//! ```

mod axis;
mod bars;
mod canvas;
mod frame;

use std::path::Path;

pub use bars::Bars;

use crate::error::Result;
use axis::{Axis, Scale};
use canvas::{Anchor, At, Canvas, FAINT, INK};
use frame::{Entry, Sample, Ticks, Words, dashes, look};

/// Pixels of a chart unless it says otherwise.
const SIZE: (u32, u32) = (1000, 600);
/// Series with more points than this have no markers.
const MOST_MARKERS: usize = 24;
/// Of labels beside points, and their distance from them.
const LABEL: f64 = 14.0;
const APART: (f64, f64) = (8.0, -10.0);

/// Lines over two axes.
#[derive(Debug, Clone)]
pub struct Plot {
    title: String,
    x_label: String,
    y_label: String,
    series: Vec<Series>,
    x_scale: Scale,
    y_scale: Scale,
    /// Whether linear axes begin at zero.
    zero: (bool, bool),
    marks: Vec<Mark>,
    size: (u32, u32),
}

#[derive(Debug, Clone)]
struct Series {
    name: String,
    points: Vec<At>,
    joined: bool,
    /// Texts beside points, as many as there are.
    labels: Vec<(At, String)>,
    /// Where something came to nothing.
    crosses: Vec<At>,
}

/// Something to compare with.
#[derive(Debug, Clone)]
enum Mark {
    X(f64, String),
    Y(f64, String),
    Band(f64, f64, String),
}

impl Plot {
    /// Axis labels carry the unit: `time, s`.
    pub fn new(title: impl Into<String>, x_label: impl Into<String>, y_label: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            series: Vec::new(),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            zero: (false, true),
            marks: Vec::new(),
            size: SIZE,
        }
    }

    /// Points joined by lines, with markers where they are few. A value that is not finite leaves a gap.
    pub fn series(self, name: impl Into<String>, points: impl IntoIterator<Item = At>) -> Self {
        self.with_series(name, points, true)
    }

    /// Markers alone.
    pub fn points(self, name: impl Into<String>, points: impl IntoIterator<Item = At>) -> Self {
        self.with_series(name, points, false)
    }

    fn with_series(
        mut self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = At>,
        joined: bool,
    ) -> Self {
        self.series.push(Series {
            name: name.into(),
            points: points.into_iter().collect(),
            joined,
            labels: Vec::new(),
            crosses: Vec::new(),
        });
        self
    }

    /// Texts beside the points of the series that was added last, in their order.
    pub fn labelled<S: Into<String>>(mut self, labels: impl IntoIterator<Item = S>) -> Self {
        if let Some(series) = self.series.last_mut() {
            let places = series.points.iter().copied();
            series
                .labels
                .extend(places.zip(labels.into_iter().map(Into::into)));
        }
        self
    }

    /// Crosses in the color of the series that was added last, each with a text beside it: runs that failed, say.
    pub fn crosses<S: Into<String>>(mut self, places: impl IntoIterator<Item = (At, S)>) -> Self {
        if let Some(series) = self.series.last_mut() {
            for (place, label) in places {
                series.crosses.push(place);
                series.labels.push((place, label.into()));
            }
        }
        self
    }

    pub fn log_x(mut self) -> Self {
        self.x_scale = Scale::Log;
        self
    }

    pub fn log_y(mut self) -> Self {
        self.y_scale = Scale::Log;
        self
    }

    /// Lets a linear y axis begin near the lowest value instead of at zero.
    pub fn from_lowest(mut self) -> Self {
        self.zero.1 = false;
        self
    }

    /// A dashed vertical line.
    pub fn mark_x(mut self, value: f64, name: impl Into<String>) -> Self {
        self.marks.push(Mark::X(value, name.into()));
        self
    }

    /// A dashed horizontal line.
    pub fn mark_y(mut self, value: f64, name: impl Into<String>) -> Self {
        self.marks.push(Mark::Y(value, name.into()));
        self
    }

    /// A shaded band between two values of y.
    pub fn band(mut self, low: f64, high: f64, name: impl Into<String>) -> Self {
        self.marks.push(Mark::Band(low, high, name.into()));
        self
    }

    /// Pixels, 1000 × 600 unless asked.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.size = (width, height);
        self
    }

    /// Writes PNG or SVG, by the ending of `path`.
    pub fn save(&self, path: &Path) -> Result<()> {
        self.draw().save(path)
    }

    fn draw(&self) -> Canvas {
        let mut canvas = Canvas::new(self.size);
        let points = || {
            let all = |series: &'_ Series| {
                series
                    .points
                    .iter()
                    .chain(&series.crosses)
                    .copied()
                    .collect::<Vec<_>>()
            };
            self.series.iter().flat_map(all)
        };
        let xs = points()
            .map(|p| p.0)
            .chain(self.marks.iter().flat_map(|mark| match mark {
                Mark::X(x, _) => Some(*x),
                _ => None,
            }));
        let ys = points()
            .map(|p| p.1)
            .chain(self.marks.iter().flat_map(|mark| match mark {
                Mark::X(..) => vec![],
                Mark::Y(y, _) => vec![*y],
                Mark::Band(low, high, _) => vec![*low, *high],
            }));
        let x_axis = Axis::covering(xs, self.x_scale, self.zero.0);
        let y_axis = Axis::covering(ys, self.y_scale, self.zero.1);
        let shown = |&(x, y): &At| x_axis.shows(x) && y_axis.shows(y);
        let hidden = points()
            .filter(|point| !shown(point) && point.0.is_finite() && point.1.is_finite())
            .count();
        let words = Words {
            title: &self.title,
            x: &self.x_label,
            y: &self.y_label,
            remark: (hidden > 0).then(|| format!("{hidden} values of zero or below are not shown")),
        };
        let field = frame::draw(
            &mut canvas,
            &words,
            (&x_axis, &y_axis),
            &Ticks::Values,
            &self.legend(),
        );
        let place = |&(x, y): &At| (field.x(x_axis.place(x)), field.y(y_axis.place(y)));
        // Among several dashed lines each says which it is.
        let lines = self.marks.iter().filter(|mark| matches!(mark, Mark::Y(..)));
        let several = lines.count() > 1;
        for mark in &self.marks {
            match mark {
                Mark::X(x, _) => {
                    let x = field.x(x_axis.place(*x));
                    dashes(&mut canvas, (x, field.bottom), (x, field.top));
                }
                Mark::Y(y, name) => {
                    let y = field.y(y_axis.place(*y));
                    dashes(&mut canvas, (field.left, y), (field.right, y));
                    if several {
                        let at = (field.left - APART.1, y + APART.1);
                        canvas.text(at, name.as_str(), LABEL, FAINT, Anchor::Left);
                    }
                }
                Mark::Band(low, high, _) => {
                    let (low, high) = (field.y(y_axis.place(*low)), field.y(y_axis.place(*high)));
                    canvas.rectangle((field.left, high), (field.right, low), FAINT, 0.18);
                }
            }
        }
        for (index, series) in self.series.iter().enumerate() {
            let look = look(index);
            if series.joined {
                for run in series.points.split(|point| !shown(point)) {
                    look.stroke(&mut canvas, run.iter().map(place).collect());
                }
            }
            if series.marked() {
                for point in series.points.iter().filter(|point| shown(point)) {
                    look.mark(&mut canvas, place(point));
                }
            }
            for point in series.crosses.iter().filter(|point| shown(point)) {
                look.cross(&mut canvas, place(point));
            }
            for (point, label) in series.labels.iter().filter(|(point, _)| shown(point)) {
                let (x, y) = place(point);
                canvas.text((x + APART.0, y + APART.1), label, LABEL, INK, Anchor::Left);
            }
        }
        canvas
    }

    fn legend(&self) -> Vec<Entry> {
        let series = self.series.iter().enumerate().map(|(index, series)| Entry {
            name: series.name.clone(),
            look: look(index),
            sample: match (series.joined, series.marked()) {
                (true, true) => Sample::MarkedLine,
                (true, false) => Sample::Line,
                (false, _) => Sample::Marker,
            },
        });
        let marks = self.marks.iter().map(|mark| {
            let (name, sample) = match mark {
                Mark::X(_, name) | Mark::Y(_, name) => (name, Sample::Dashes),
                Mark::Band(_, _, name) => (name, Sample::Band),
            };
            Entry {
                name: name.clone(),
                look: look(0),
                sample,
            }
        });
        let entries: Vec<_> = series.chain(marks).collect();
        // One series needs no name beside the title.
        if entries.len() > 1 { entries } else { Vec::new() }
    }
}

impl Series {
    fn marked(&self) -> bool {
        !self.joined || self.points.len() <= MOST_MARKERS
    }
}

#[cfg(test)]
mod tests;
