//! How much longer a run takes, judged by the frames that it made last.

use std::collections::VecDeque;

use crate::scene::{Action, Scene};

/// So many of the last frames are looked at.
const RECENT: usize = 30;

/// Expects of the frames to come what the last ones took, more where there will be more particles.
pub struct Forecast {
    /// Of each frame of the run, in order: boundary particles included, as the scene plans them.
    particles: Vec<f64>,
    /// Particles and seconds of the last frames.
    recent: VecDeque<[f64; 2]>,
    /// Frames since this sitting began.
    arrived: u32,
    /// When the last one arrived, seconds.
    last_s: f64,
}

impl Forecast {
    pub fn new(particles: Vec<f64>) -> Self {
        Self {
            particles,
            recent: VecDeque::new(),
            arrived: 0,
            last_s: 0.0,
        }
    }

    /// For frames of which each takes as long as another.
    pub fn even(frames: u32) -> Self {
        Self::new(vec![1.0; frames as usize])
    }

    /// Counts the frame that arrived when the clock said `now_s`, the run's `done`th. Gives the seconds from then until
    /// the last one, or `None` while nothing can be said: the first two frames of a sitting are not looked at, since
    /// setting up belongs to the one, and compiling shaders to the other.
    pub fn add(&mut self, done: u32, now_s: f64) -> Option<f64> {
        let done = done as usize;
        let particles = self.particles.get(done.wrapping_sub(1)).copied();
        self.arrived += 1;
        if self.arrived > 2 {
            self.recent
                .push_back([particles.unwrap_or_default(), now_s - self.last_s]);
        }
        if self.recent.len() > RECENT {
            self.recent.pop_front();
        }
        self.last_s = now_s;
        let left = self.particles.get(done..).unwrap_or_default();
        if left.is_empty() {
            return Some(0.0);
        }
        let [each, per_particle] = line(self.recent.make_contiguous())?;
        Some(left.iter().map(|particles| each + per_particle * particles).sum())
    }
}

/// The line that fits points of particles and seconds best and is nowhere negative: seconds without particles, and of
/// each particle. `None` of no point.
pub fn line(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    if points.is_empty() {
        return None;
    }
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let [particles, seconds] = [mean(&|point| point[0]), mean(&|point| point[1])];
    let spread = mean(&|point| (point[0] - particles).powi(2));
    if spread == 0.0 {
        return Some([seconds, 0.0]);
    }
    let slope = mean(&|point| (point[0] - particles) * (point[1] - seconds)) / spread;
    let slope = slope.clamp(0.0, seconds / particles);
    Some([seconds - slope * particles, slope])
}

/// How many particles there are when each frame is made, boundary particles included.
pub fn particles(scene: &Scene) -> Vec<f64> {
    let start = scene.particles.len() + scene.boundary.len();
    let at = |frame: u32| {
        let time = f64::from(frame) / scene.time.fps;
        let added = scene.schedule.iter().take_while(|due| due.time < time);
        let added = added.map(|due| match &due.action {
            Action::Add(particles) => particles.len(),
            Action::SetParameters { .. } => 0,
        });
        (start + added.sum::<usize>()) as f64
    };
    (0..scene.time.frames).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is expected after each frame of a run, which arrive when a made-up clock says so.
    fn run(particles: &[f64], clock: impl Fn(u32) -> f64, frames: std::ops::Range<u32>) -> Vec<Option<f64>> {
        let mut forecast = Forecast::new(particles.to_vec());
        frames
            .map(|index| forecast.add(index + 1, clock(index)))
            .collect()
    }

    fn near(found: Option<f64>, expected: f64) {
        assert!(
            found.is_some_and(|found| (found - expected).abs() < 1e-6 * (1.0 + expected)),
            "{found:?}, not {expected}"
        );
    }

    /// Setting up takes a minute, and compiling ten seconds of the second frame; the other 58 take a second each.
    #[test]
    fn setting_up_is_no_frame() {
        let clock = |index: u32| match index {
            0 => 60.0,
            later => 70.0 + f64::from(later),
        };
        let expected = run(&[100.0; 60], clock, 0..60);
        assert_eq!(expected[..2], [None, None]);
        for (index, &left) in expected.iter().enumerate().skip(2) {
            near(left, 59.0 - index as f64);
        }
    }

    /// The same, of a run that goes on behind frame 9.
    #[test]
    fn neither_in_a_run_that_goes_on() {
        let clock = |index: u32| {
            if index == 10 {
                60.0
            } else {
                70.0 + f64::from(index)
            }
        };
        let expected = run(&[100.0; 60], clock, 10..60);
        assert_eq!(expected[..2], [None, None]);
        near(expected[2], 47.0);
    }

    /// Frames become four times as slow; after a while only slow ones count.
    #[test]
    fn only_the_last_frames_count() {
        let clock = |index: u32| f64::from(index) + 3.0 * f64::from(index.saturating_sub(50));
        let expected = run(&[100.0; 200], clock, 0..200);
        near(expected[50], 149.0);
        near(expected[50 + RECENT], 4.0 * (149.0 - RECENT as f64));
    }

    /// A fifth of a second for each frame's picture and a millisecond for each of the particles, which become more.
    #[test]
    fn more_particles_take_longer() {
        let particles: Vec<f64> = (0..100).map(|frame| 10.0 * f64::from(frame)).collect();
        let seconds = |frame: u32| 0.2 + 1e-3 * particles[frame as usize];
        let clock = |index: u32| (1..=index).map(seconds).sum();
        let expected = run(&particles, clock, 0..100);
        for index in 3..100 {
            near(expected[index as usize], (index + 1..100).map(seconds).sum());
        }
        assert_eq!(expected[99], Some(0.0));
    }

    /// Fewer seconds with more particles are chance: a frame never takes less than nothing.
    #[test]
    fn no_frame_takes_less_than_nothing() {
        let particles: Vec<f64> = (0..100).map(f64::from).collect();
        let clock = |index: u32| 10.0 * f64::from(index).sqrt();
        for expected in run(&particles, clock, 0..100).into_iter().flatten() {
            assert!(expected >= 0.0);
        }
    }

    #[test]
    fn emitters_and_drops_are_counted() {
        let text = r#"{ "dimensions": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "grains": { "radius": 0.01, "density": 1500, "spring": 2000, "restitution": 0.5 },
            "bodies": [{ "shape": { "kind": "box", "min": [0.1, 0.1], "max": [0.3, 0.3] } }],
            "events": [{ "at": 0.15, "drop": { "center": [0.5, 0.5], "radius": 0.1 } }],
            "time": { "duration": 0.3, "fps": 10 } }"#;
        let scene = crate::scene::load::parse(text, "test", std::path::Path::new("."), &[]).unwrap();
        let found = particles(&scene);
        assert_eq!(found.len(), 4);
        let start = scene.particles.len() as f64;
        assert_eq!(found[..2], [start, start]);
        assert_eq!(found[2..], [f64::from(scene.capacity); 2]);
        assert!(found[2] > start);
    }
}
