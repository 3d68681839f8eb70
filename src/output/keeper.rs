//! When checkpoints are written, and how many stay.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;
use std::time::Instant;

use super::checkpoint::Checkpoint;
use super::disk;
use super::folder::Folder;
use super::text::{count, seconds};
use crate::error::Result;

/// What a user wants of checkpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checkpoints {
    pub every: Every,
    /// The newest so many stay; at least one.
    pub keep: u32,
}

impl Default for Checkpoints {
    fn default() -> Self {
        Self {
            every: Every::Seconds(60.0),
            keep: 2,
        }
    }
}

/// Distance of checkpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Every {
    /// None is written.
    Never,
    Frames(u32),
    /// Of wall-clock time.
    Seconds(f64),
}

impl FromStr for Every {
    type Err = String;

    /// `10` and `10frames` are frames; `30s`, `5min`, `1h` are wall-clock time; `0` and `off` are never.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let text = text.trim();
        if text == "off" {
            return Ok(Self::Never);
        }
        let unit_at = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (number, unit) = text.split_at(unit_at);
        let wrong = || "write 10 (frames), 30s, 5min, 1h, or 0 for none".to_owned();
        let number: f64 = number.trim().parse().map_err(|_| wrong())?;
        let scale = match unit {
            "" | "frame" | "frames" => None,
            "s" => Some(1.0),
            "min" => Some(60.0),
            "h" => Some(3600.0),
            _ => return Err(wrong()),
        };
        match scale {
            _ if number == 0.0 => Ok(Self::Never),
            Some(scale) if number > 0.0 && number.is_finite() => Ok(Self::Seconds(number * scale)),
            None if number >= 1.0 && number.fract() == 0.0 && number <= f64::from(u32::MAX) => {
                Ok(Self::Frames(number as u32))
            }
            _ => Err(wrong()),
        }
    }
}

impl std::fmt::Display for Every {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Never => f.write_str("never"),
            Self::Frames(1) => f.write_str("every frame"),
            Self::Frames(n) => write!(f, "every {} frames", count(u64::from(*n))),
            Self::Seconds(s) => write!(f, "every {} of wall-clock time", seconds(*s)),
        }
    }
}

/// Writes a run's checkpoints and removes those that are too many.
pub struct Keeper {
    settings: Checkpoints,
    folder: Arc<Folder>,
    /// A variant's first checkpoint always stays: without it nothing could start from the beginning.
    pinned: Option<u32>,
    last_frame: Option<u32>,
    last_time: Instant,
}

impl Keeper {
    /// `last` is the frame of the checkpoint that the run goes on from.
    pub fn new(settings: Checkpoints, folder: Arc<Folder>, pinned: Option<u32>, last: Option<u32>) -> Self {
        Self {
            settings,
            folder,
            pinned,
            last_frame: last,
            last_time: Instant::now(),
        }
    }

    /// Whether one is to be written behind `frame`; `at_end` where no further frame follows.
    pub fn is_due(&self, frame: u32, at_end: bool) -> bool {
        let since = frame - self.last_frame.unwrap_or(0).min(frame);
        match self.settings.every {
            // A variant cannot begin anew without its first one.
            Every::Never => self.pinned == Some(frame) && self.last_frame.is_none(),
            _ if self.last_frame == Some(frame) => false,
            _ if at_end || self.pinned == Some(frame) => true,
            Every::Frames(n) => since >= n,
            Every::Seconds(s) => self.last_time.elapsed().as_secs_f64() >= s,
        }
    }

    /// Whether a run that ends behind `frame` without another checkpoint loses nothing: it can go on from there, begins
    /// with that frame, or wants no checkpoints.
    pub fn has(&self, frame: u32) -> bool {
        self.settings.every == Every::Never || frame == 0 || self.last_frame == Some(frame)
    }

    /// The frame of the last checkpoint.
    pub fn last(&self) -> Option<u32> {
        self.last_frame
    }

    /// Frames up to `frame` that no checkpoint names yet.
    pub fn unsaved(&self, frame: u32) -> RangeInclusive<u32> {
        self.last_frame.map_or(0, |last| last + 1)..=frame
    }

    /// Every frame up to the state's must be safe on disk. After a failure, the next is due as if this one had been
    /// written, so that a full disk is told at the same pace.
    pub fn write(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let frame = checkpoint.state.frame;
        self.last_frame = Some(frame);
        let written = checkpoint.write(&self.folder.checkpoint(frame));
        self.last_time = Instant::now();
        written.and_then(|()| self.thin_out(frame))
    }

    /// Later ones than `newest` are none of the run's.
    fn thin_out(&self, newest: u32) -> Result<()> {
        let all = self.folder.checkpoints()?;
        let others: Vec<PathBuf> = all
            .into_iter()
            .filter(|(frame, _)| Some(*frame) != self.pinned && *frame <= newest)
            .map(|(_, path)| path)
            .collect();
        let too_many = others.len().saturating_sub(self.settings.keep as usize);
        for path in &others[..too_many] {
            std::fs::remove_file(path).map_err(|reason| disk::failed(path, "remove", reason))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::checkpoint::About;
    use crate::simulation::State;

    #[test]
    fn distances_are_frames_or_wall_clock_time() {
        let parse = |text: &str| text.parse::<Every>();
        assert_eq!(parse("10"), Ok(Every::Frames(10)));
        assert_eq!(parse("3 frames"), Ok(Every::Frames(3)));
        assert_eq!(parse("30s"), Ok(Every::Seconds(30.0)));
        assert_eq!(parse("1.5min"), Ok(Every::Seconds(90.0)));
        assert_eq!(parse("2h"), Ok(Every::Seconds(7200.0)));
        for never in ["0", "off", "0s"] {
            assert_eq!(parse(never), Ok(Every::Never), "{never}");
        }
        for wrong in ["", "s", "-1", "1.5", "-3s", "10 days", "inf s", "nan"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn due_by_frames_at_the_end_and_never_twice() {
        let folder = tempfile::tempdir().unwrap();
        let folder = Arc::new(Folder::open(folder.path(), false).unwrap());
        let keeper =
            |every, pinned, last| Keeper::new(Checkpoints { every, keep: 2 }, folder.clone(), pinned, last);
        let by_ten = keeper(Every::Frames(10), None, Some(20));
        assert_eq!(
            [20, 29, 30].map(|f| by_ten.is_due(f, false)),
            [false, false, true]
        );
        assert_eq!([20, 21].map(|f| by_ten.is_due(f, true)), [false, true]);
        assert!(!keeper(Every::Frames(10), None, None).is_due(0, false));
        assert!(keeper(Every::Seconds(0.0), None, None).is_due(1, false));
        assert_eq!([0, 19, 20, 21].map(|f| by_ten.has(f)), [true, false, true, false]);
        let never = keeper(Every::Never, Some(5), None);
        assert!(never.has(6));
        assert!(never.is_due(5, false) && !never.is_due(6, true));
    }

    #[test]
    fn the_newest_and_the_pinned_stay() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = Arc::new(Folder::open(temporary.path(), false).unwrap());
        let settings = Checkpoints {
            every: Every::Frames(1),
            keep: 2,
        };
        let mut keeper = Keeper::new(settings, folder.clone(), Some(3), None);
        for frame in 3..9 {
            let state = State {
                frame,
                particles: 0,
                dimensions: crate::scene::Dimensions::Two,
                origin: glam::DVec3::ZERO,
                lists_left_out: None,
                buffers: Vec::new(),
            };
            let about = About {
                run_id: String::new(),
                version: String::new(),
                adapter: String::new(),
                particle_steps: 0,
                health: Default::default(),
                guards: Default::default(),
                halvings: 0,
            };
            keeper.write(&Checkpoint { about, state }).unwrap();
        }
        let frames: Vec<u32> = folder
            .checkpoints()
            .unwrap()
            .iter()
            .map(|(frame, _)| *frame)
            .collect();
        assert_eq!(frames, [3, 7, 8]);
    }
}
