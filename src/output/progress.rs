//! How a run is going, on standard error.

use std::io::{IsTerminal as _, Write as _, stderr};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::bar::Bar;
use super::forecast::Forecast;
use super::tally::Tally;
use super::text::{printable, seconds, short};
use crate::simulation::frame::Frame;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Style {
    /// A bar; lines where standard error is not a terminal.
    #[default]
    Bar,
    /// Lines for people and logs.
    Plain,
    /// One JSON object per line, for programs.
    Json,
    /// Warnings and errors alone.
    None,
}

const TEMPLATE: &str = "{bar:30} {pos}/{len} frames  {wide_msg}";

/// Lines come no faster than this, so that logs stay short.
const LINE_PAUSE: Duration = Duration::from_secs(5);

/// Shows frames as they finish, and notes and warnings between them.
pub struct Progress {
    show: Show,
    forecast: Forecast,
}

#[derive(Clone)]
enum Show {
    Bar(Bar),
    Plain { last: Option<Instant> },
    Json,
    Quiet,
}

impl Progress {
    pub fn new(style: Style, frames: u32) -> Self {
        let show = match style {
            Style::Json => Show::Json,
            Style::None => Show::Quiet,
            Style::Bar if cfg!(feature = "cli") && stderr().is_terminal() => {
                Show::Bar(Bar::new(TEMPLATE, frames))
            }
            Style::Bar | Style::Plain => Show::Plain { last: None },
        };
        Self {
            show,
            forecast: Forecast::even(frames),
        }
    }

    /// Expects so many particles of each frame, where they become more.
    pub fn expect(&mut self, particles: Vec<f64>) {
        self.forecast = Forecast::new(particles);
    }

    /// Something to know.
    pub fn note(&self, text: &str) {
        self.show.note(text);
    }

    /// Something to mind.
    pub fn warn(&self, text: &str) {
        self.show.tell("warning", text);
    }

    /// Tells notes from another thread.
    pub fn teller(&self) -> impl Fn(&str) + Send + 'static {
        let show = self.show.clone();
        move |text| show.note(text)
    }

    pub fn frame(&mut self, frame: &Frame, tally: &Tally) {
        let remaining_s = self.forecast.add(tally.frames_done, tally.wall_s);
        // The first frame has no steps, and a frame that is drawn again neither.
        let mut how_fast = Vec::new();
        if tally.particle_steps > 0 {
            how_fast.push(format!("{} particle steps/s", short(tally.particle_steps_per_s)));
        }
        how_fast.extend(remaining_s.map(|left| format!("{} left", seconds(left))));
        match &mut self.show {
            Show::Bar(bar) => {
                bar.set(tally.frames_done);
                bar.message(how_fast.join(", "));
            }
            Show::Plain { last } => {
                let is_last = tally.frames_done == tally.frames;
                if is_last || last.is_none_or(|last| last.elapsed() >= LINE_PAUSE) {
                    *last = Some(Instant::now());
                    let place = format!(
                        "frame {} of {}, t = {:.3} s",
                        tally.frames_done, tally.frames, frame.time
                    );
                    how_fast.insert(0, place);
                    line(&how_fast.join(", "));
                }
            }
            Show::Json => event(json!({
                "event": "frame",
                "frame": frame.index,
                "frames": tally.frames,
                "time_s": frame.time,
                "steps": frame.steps,
                "particles": frame.particles,
                "wall_s": tally.wall_s,
                "particle_steps_per_s": tally.particle_steps_per_s,
                "remaining_s": remaining_s,
            })),
            Show::Quiet => {}
        }
    }

    /// Ends the display; `text` says what there is now.
    pub fn finish(&self, text: &str, tally: &Tally) {
        self.clear();
        match &self.show {
            Show::Bar(_) | Show::Plain { .. } => line(text),
            Show::Json => event(json!({ "event": "end", "message": text, "result": tally })),
            Show::Quiet => {}
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        if let Show::Bar(bar) = &self.show {
            bar.clear();
        }
    }
}

impl Show {
    fn note(&self, text: &str) {
        if !matches!(self, Self::Quiet) {
            self.tell("note", text);
        }
    }

    fn tell(&self, kind: &str, text: &str) {
        match self {
            Self::Bar(bar) => bar.suspend(|| line(&format!("{kind}: {text}"))),
            Self::Plain { .. } | Self::Quiet => line(&format!("{kind}: {text}")),
            Self::Json => event(json!({ "event": kind, "message": text })),
        }
    }
}

fn event(value: Value) {
    line(&value.to_string());
}

/// A log that nobody reads any more is no reason to stop a run.
fn line(text: &str) {
    let _ = writeln!(stderr(), "{}", printable(text));
}
