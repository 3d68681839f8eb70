//! Bars in groups.

use std::path::Path;

use super::SIZE;
use super::axis::{Axis, Scale, has_place};
use super::canvas::Canvas;
use super::frame::{self, Entry, Sample, Ticks, Words, dashes, look};
use crate::error::Result;

/// One group of bars for each name, one bar of a group for each series.
#[derive(Debug, Clone)]
pub struct Bars {
    title: String,
    y_label: String,
    groups: Vec<String>,
    series: Vec<(String, Vec<f64>)>,
    scale: Scale,
    marks: Vec<(f64, String)>,
    size: (u32, u32),
}

impl Bars {
    /// A group's name may have several lines. The label carries the unit: `step, ms`.
    pub fn new<S: Into<String>>(
        title: impl Into<String>,
        y_label: impl Into<String>,
        groups: impl IntoIterator<Item = S>,
    ) -> Self {
        Self {
            title: title.into(),
            y_label: y_label.into(),
            groups: groups.into_iter().map(Into::into).collect(),
            series: Vec::new(),
            scale: Scale::Linear,
            marks: Vec::new(),
            size: SIZE,
        }
    }

    /// One value a group; one that is not finite leaves a gap.
    pub fn series(mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.series.push((name.into(), values.into_iter().collect()));
        self
    }

    pub fn log_y(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// A dashed horizontal line.
    pub fn mark_y(mut self, value: f64, name: impl Into<String>) -> Self {
        self.marks.push((value, name.into()));
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

    pub(super) fn draw(&self) -> Canvas {
        let mut canvas = Canvas::new(self.size);
        let values = || self.series.iter().flat_map(|(_, values)| values.iter().copied());
        let marked = self.marks.iter().map(|(value, _)| *value);
        // On a log axis the lowest bar has a height too.
        let below = values().map(|value| value / 2.0);
        let y_axis = Axis::covering(values().chain(marked).chain(below), self.scale, true);
        let x_axis = Axis::covering([0.0, 1.0], Scale::Linear, true);
        let hidden = values()
            .filter(|v| v.is_finite() && !has_place(*v, self.scale))
            .count();
        let words = Words {
            title: &self.title,
            x: "",
            y: &self.y_label,
            remark: (hidden > 0).then(|| format!("{hidden} values of zero or below are not shown")),
        };
        let groups = self.groups.len().max(1) as f64;
        let names = self.groups.iter().enumerate();
        let ticks = Ticks::Names(
            names
                .map(|(group, name)| ((group as f64 + 0.5) / groups, name.clone()))
                .collect(),
        );
        let field = frame::draw(&mut canvas, &words, (&x_axis, &y_axis), &ticks, &self.legend());
        let width = (field.right - field.left) / groups;
        let bar = width * 0.8 / self.series.len().max(1) as f64;
        let base = match self.scale {
            Scale::Linear => field.y(y_axis.place(0.0)),
            Scale::Log => field.bottom,
        };
        for (index, (_, values)) in self.series.iter().enumerate() {
            for (group, &value) in values.iter().enumerate().filter(|(_, v)| y_axis.shows(**v)) {
                let left = field.left + width * (group as f64 + 0.1) + bar * index as f64;
                let y = field.y(y_axis.place(value));
                let gap = (bar * 0.08).min(2.0);
                canvas.rectangle(
                    (left + gap, y.min(base)),
                    (left + bar - gap, y.max(base)),
                    look(index).color,
                    1.0,
                );
            }
        }
        for (value, _) in &self.marks {
            let y = field.y(y_axis.place(*value));
            dashes(&mut canvas, (field.left, y), (field.right, y));
        }
        canvas
    }

    fn legend(&self) -> Vec<Entry> {
        let series = self.series.iter().enumerate().map(|(index, (name, _))| Entry {
            name: name.clone(),
            look: look(index),
            sample: Sample::Bar,
        });
        let marks = self.marks.iter().map(|(_, name)| Entry {
            name: name.clone(),
            look: look(0),
            sample: Sample::Dashes,
        });
        let entries: Vec<_> = series.chain(marks).collect();
        if entries.len() > 1 { entries } else { Vec::new() }
    }
}
