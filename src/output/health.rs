//! Signs in the statistics that a run's numbers should not be trusted.

use serde::{Deserialize, Serialize};

use super::text::count;
use crate::simulation::frame::Frame;

/// Deepest overlap, as a share of the radius, that a soft-sphere contact should have.
const LARGEST_OVERLAP: f64 = 0.2;

/// Notices each sign once, and sums up at the end.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Health {
    overflow: u64,
    overlap_told: bool,
    quarantine_told: bool,
    #[serde(default)]
    sound_told: bool,
    reallocations: u32,
    /// Told in every sitting.
    #[serde(skip)]
    lists_told: bool,
}

impl Health {
    /// Warnings that this frame is the first to deserve. `sound_speed` is that of a weakly compressible fluid, m/s.
    pub fn check(&mut self, frame: &Frame, sound_speed: Option<f64>) -> Vec<String> {
        let mut warnings = Vec::new();
        if frame.overflow > 0 && self.overflow == 0 {
            warnings.push(format!(
                "frame {}: particles found their voxel full {} times, so contacts are missed; give voxels more room with \
                 --set neighbors.slots=8, or use --grid sliced-counting",
                frame.index,
                count(frame.overflow)
            ));
        }
        self.overflow += frame.overflow;
        if frame.quarantined > 0 && !self.quarantine_told {
            self.quarantine_told = true;
            warnings.push(format!(
                "frame {}: {} particles are farther from the domain than the neighbor search follows, so they find \
                 no neighbors; to follow them, set neighbors.quarantine_distance higher",
                frame.index,
                count(frame.quarantined.into())
            ));
        }
        if let (false, Some(why)) = (self.lists_told, &frame.lists_left_out) {
            self.lists_told = true;
            warnings.push(format!("frame {}: {why}", frame.index));
        }
        self.reallocations += frame.reallocations;
        let overlap = frame.statistics.map_or(0.0, |statistics| statistics.max_overlap);
        if overlap > LARGEST_OVERLAP && !self.overlap_told {
            self.overlap_told = true;
            warnings.push(format!(
                "frame {}: grains overlap by {:.0} % of their radius; make grains stiffer (grains.spring, or grains.young_modulus)",
                frame.index,
                100.0 * overlap
            ));
        }
        let speed = frame.statistics.map_or(0.0, |statistics| statistics.max_speed);
        if let Some(sound) = sound_speed.filter(|sound| speed > *sound && !self.sound_told) {
            self.sound_told = true;
            warnings.push(format!(
                "frame {}: fluid moves at {speed:.3} m/s, faster than sound in it, {sound:.3} m/s, so that its pressures are \
                 wrong; raise fluid.max_speed",
                frame.index
            ));
        }
        warnings
    }

    /// What to say when the run is over.
    pub fn summary(&self) -> Option<String> {
        (self.overflow > 0).then(|| {
            format!(
                "during the run, particles found their voxel full {} times",
                count(self.overflow)
            )
        })
    }

    /// What is good to know when the run is over.
    pub fn note(&self) -> Option<String> {
        (self.reallocations > 0).then(|| {
            let often = match self.reallocations {
                1 => "once".to_owned(),
                times => format!("{times} times"),
            };
            format!(
                "the grid's buffers were made larger {often}, and the steps concerned were made again; \
                 a higher neighbors.margin avoids that"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::frame::Statistics;

    #[test]
    fn each_sign_is_told_once() {
        let frame = Frame {
            index: 7,
            particles: 1,
            ..Default::default()
        };
        let with = |max_overlap, overflow| Frame {
            overflow,
            statistics: Some(Statistics {
                max_overlap,
                ..Default::default()
            }),
            ..frame.clone()
        };
        let (well, mut ill) = (with(0.05, 0), with(0.3, 40));
        ill.lists_left_out = Some("no lists".into());
        let mut health = Health::default();
        assert!(health.check(&well, None).is_empty());
        assert_eq!(health.summary(), None);
        let warnings = health.check(&ill, None);
        assert!(warnings[0].contains("40 times"), "{warnings:?}");
        assert!(warnings[1] == "frame 7: no lists", "{warnings:?}");
        assert!(warnings[2].contains("30 %"), "{warnings:?}");
        assert!(health.check(&ill, None).is_empty());
        assert!(health.summary().unwrap().contains("80 times"));
        let fast = Frame {
            statistics: Some(Statistics {
                max_speed: 11.0,
                ..Default::default()
            }),
            ..frame
        };
        assert!(health.check(&fast, Some(12.0)).is_empty());
        let warnings = health.check(&fast, Some(10.0));
        assert!(warnings[0].contains("faster than sound in it"), "{warnings:?}");
        assert!(health.check(&fast, Some(10.0)).is_empty());
    }
}
