//! How many bytes a run's files may take (`--max-disk`): what is certain is counted before it begins, and the rest is measured
//! while it goes on.

use std::path::{Path, PathBuf};

use super::estimate::{checkpoints, disk_bytes};
use super::forecast::particles;
use super::keeper::Every;
use super::particles::ParticleOutput;
use super::record::names;
use super::run::Settings;
use super::text::bytes;
use crate::error::{Error, Result};
use crate::scene::Scene;

/// Frames that are written behind the one after which a run is told to stop: those on their way from the device, and one more.
const ON_THEIR_WAY: u64 = 5;
/// What is written when a run ends: a chart of each quantity of its sensors, and its record once more.
const CHART_BYTES: u64 = 80_000;
const CHARTS_OF_A_SENSOR: u64 = 2;
const RECORD_BYTES: u64 = 16_000;
/// A look at the disk is due when what is left may have become so many times less.
const LOOKS: u64 = 2;

/// Looks at the disk now and then, more often the less is left.
pub struct DiskBudget {
    max: u64,
    folder: PathBuf,
    video: Option<PathBuf>,
    /// Bytes that all checkpoints of a run take together, with the one that is being written.
    checkpoints: u64,
    /// Bytes that are written when it ends.
    end: u64,
    /// Bytes of a frame's files, the most so far.
    each: u64,
    /// Bytes that all but checkpoints took at the last look.
    frames: Option<u64>,
    frames_since: u64,
    frames_until: u64,
}

impl DiskBudget {
    /// Refuses a run whose particle files and checkpoint alone take more than they may. Gives a warning for one that is
    /// likely to reach the bound.
    pub fn check(scene: &Scene, settings: &Settings) -> Result<Option<String>> {
        let Some(max) = settings.max_disk else {
            return Ok(None);
        };
        let outputs = &settings.outputs;
        let walls = scene.boundary.len() as f64;
        // What is compressed may become small.
        let is_plain = |files: &&ParticleOutput| files.formats.iter().all(|format| format.name != "bgeo");
        // Files of a 2D scene may have vectors of two numbers.
        let share = scene.dimensions.count() as f64 / 3.0;
        let files = outputs.particles.as_ref().filter(is_plain).map_or(0.0, |files| {
            let all = particles(scene).into_iter().step_by(files.every as usize);
            all.map(|count| share * files.frame_bytes(1) * (count - walls))
                .sum::<f64>()
        });
        let (count, checkpoint) = checkpoints(scene, outputs);
        let certain = files as u64 + if count > 0 { checkpoint } else { 0 };
        if certain > max {
            return Err(Error::Budget {
                what: format!(
                    "the run would write at least {} of particle files and checkpoints, more than the {} of --max-disk",
                    bytes(certain),
                    bytes(max)
                ),
                help: "raise --max-disk, write fewer frames (--particles-every), or leave out columns (--columns)".into(),
            });
        }
        let likely = disk_bytes(scene, outputs);
        Ok((likely > max).then(|| {
            format!(
                "the run will write about {}, more than the {} of --max-disk: it will stop there, and `resume` can go on",
                bytes(likely),
                bytes(max)
            )
        }))
    }

    /// The budget of a run, where it has one.
    pub fn new(scene: &Scene, settings: &Settings) -> Option<Self> {
        let outputs = &settings.outputs;
        let (_, checkpoint) = checkpoints(scene, outputs);
        let kept = match outputs.checkpoints.every {
            Every::Never => 1,
            _ => u64::from(outputs.checkpoints.keep) + 1,
        };
        let particles = outputs
            .particles
            .as_ref()
            .map_or(0.0, |files| files.frame_bytes(scene.capacity));
        Some(Self {
            max: settings.max_disk?,
            folder: settings.folder.clone(),
            video: outputs.video.as_ref().map(|video| video.path().to_owned()),
            checkpoints: kept * checkpoint,
            end: CHART_BYTES * CHARTS_OF_A_SENSOR * scene.sensors.list.len() as u64 + RECORD_BYTES,
            each: particles as u64,
            frames: None,
            frames_since: 0,
            frames_until: 0,
        })
    }

    /// Counts a frame. Whether it is time to look at the disk, when everything written so far is there.
    pub fn is_look_due(&mut self) -> bool {
        self.frames_since += 1;
        self.frames_since >= self.frames_until
    }

    /// Looks at the disk.
    ///
    /// # Errors
    ///
    /// Where so little is left that the run has to stop.
    pub fn look(&mut self) -> Result<()> {
        let mut used = 0;
        let mut saved = 0;
        for name in names(&self.folder)? {
            let size = size(&self.folder.join(&name));
            used += size;
            if name.starts_with("checkpoint_") {
                saved += size;
            }
        }
        // One in the run's folder is among its files.
        if let Some(video) = self
            .video
            .as_ref()
            .filter(|video| !video.starts_with(&self.folder))
        {
            let ending = video.extension().unwrap_or_default().to_string_lossy();
            used += size(video) + size(&video.with_extension(format!("part.{ending}")));
        }
        // Checkpoints have room of their own.
        let frames = used - saved;
        if let Some(before) = self.frames {
            let each = frames.saturating_sub(before) / self.frames_since.max(1);
            self.each = self.each.max(each);
        }
        self.frames = Some(frames);
        self.frames_since = 0;
        let reserved = self.checkpoints.saturating_sub(saved) + self.end;
        let left = self.max.saturating_sub(used + reserved);
        if left < ON_THEIR_WAY * self.each || left == 0 {
            return Err(Error::Budget {
                what: format!(
                    "the run stops at --max-disk: its files take {} of {}, and a checkpoint and the frames on their way \
                     need the rest",
                    bytes(used),
                    bytes(self.max)
                ),
                help: "go on with `sliceflow resume` and a larger --max-disk, after making room if need be"
                    .into(),
            });
        }
        // What a frame takes is known from the second look on.
        self.frames_until = match self.each {
            0 => 1,
            each => ((left - ON_THEIR_WAY * each) / (LOOKS * each)).clamp(1, 1000),
        };
        Ok(())
    }
}

/// Of a file; zero where it is not there yet.
fn size(path: &Path) -> u64 {
    std::fs::symlink_metadata(path).map_or(0, |file| file.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_come_more_often_the_less_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let mut budget = DiskBudget {
            max: 100_000,
            folder: folder.path().to_owned(),
            video: None,
            checkpoints: 10_000,
            end: 0,
            each: 0,
            frames: None,
            frames_since: 0,
            frames_until: 0,
        };
        let mut looks = Vec::new();
        let mut written = 0;
        let stopped = (0..200).find(|&frame| {
            std::fs::write(folder.path().join(format!("frame_{frame:06}.png")), [0; 1000]).unwrap();
            written += 1000;
            if !budget.is_look_due() {
                return false;
            }
            looks.push(frame);
            budget.look().is_err()
        });
        // Room for the checkpoint and for five frames is left.
        let stopped = stopped.expect("it stops");
        assert!((80..=86).contains(&stopped), "{stopped}");
        assert!(written + 10_000 + 5 * 1000 <= 101_000, "{written}");
        assert!(looks.len() < 20, "{looks:?}");
    }
}
