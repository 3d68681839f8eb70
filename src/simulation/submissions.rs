//! How many steps go to the device at once. Few submissions cost least, but the host must come by several times a second:
//! somebody may have asked it to stop, and a display driver's watchdog ends what takes long.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use crate::error::Result;
use crate::gpu::Gpu;

/// Steps recorded into one submission, at most; enough to hide its cost.
const MOST_STEPS: u64 = 32;
/// Steps of the first submission, whose duration nobody knows.
const FIRST_STEPS: u64 = 2;
/// How long a submission should take at most.
const LONGEST: Duration = Duration::from_millis(150);
/// Submissions that the device has at once, so that it never waits for the host.
const UNDER_WAY: usize = 3;

/// Submissions that the device may not have done yet.
pub struct Submissions {
    under_way: VecDeque<Submitted>,
    /// When the last one was seen done.
    done: Instant,
    most_steps: u64,
}

struct Submitted {
    index: wgpu::SubmissionIndex,
    steps: u64,
    at: Instant,
}

impl Default for Submissions {
    fn default() -> Self {
        Self {
            under_way: VecDeque::new(),
            done: Instant::now(),
            most_steps: FIRST_STEPS,
        }
    }
}

impl Submissions {
    /// Steps that the next submission should have at most. Which steps are submitted together changes no bit.
    pub fn most_steps(&self) -> u64 {
        self.most_steps
    }

    /// Notes a submission of so many steps; waits for an older one where too many are under way.
    pub fn add(&mut self, gpu: &Gpu, index: wgpu::SubmissionIndex, steps: u64) -> Result<()> {
        self.under_way.push_back(Submitted {
            index,
            steps,
            at: Instant::now(),
        });
        if self.under_way.len() < UNDER_WAY {
            return Ok(());
        }
        let Some(oldest) = self.under_way.pop_front() else {
            return Ok(());
        };
        gpu.wait(Some(oldest.index))?;
        let now = Instant::now();
        // The device began with it when it was there and the one before it was done.
        let took = now - oldest.at.max(self.done);
        self.done = now;
        self.most_steps = steps_for(self.most_steps, oldest.steps, took);
        Ok(())
    }
}

/// How many steps the next submissions should have, after `steps` took so long. More come slowly, since a wait that was
/// short may only mean that the device was done before the host looked.
fn steps_for(most: u64, steps: u64, took: Duration) -> u64 {
    let fitting = LONGEST.as_nanos() * u128::from(steps) / took.as_nanos().max(1);
    u64::try_from(fitting)
        .unwrap_or(u64::MAX)
        .clamp(1, (2 * most).min(MOST_STEPS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_steps_go_together_and_long_ones_alone() {
        let step = |most: u64, ms: u64| steps_for(most, most, Duration::from_millis(ms * most));
        let mut most = FIRST_STEPS;
        for expected in [4, 8, 16, 32, 32] {
            most = step(most, 1);
            assert_eq!(most, expected);
        }
        // Particles came: a step takes 50 ms now, then two seconds.
        assert_eq!(step(32, 50), 3);
        assert_eq!(step(3, 2000), 1);
        assert_eq!(step(1, 2000), 1);
    }
}
