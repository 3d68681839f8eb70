//! Times of several grids side by side.

use std::time::Instant;

use super::bench::{Bench, first_line};
use crate::error::Result;
use crate::gpu::timing::median;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;
use crate::scene::model::View;
use crate::simulation::Simulation;
use crate::simulation::frame::Frame;

/// Milliseconds of a grid: medians over rounds that took turns with the other grids' rounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Times {
    /// Wall time of one step, many steps in one submission.
    pub step_ms: f64,
    /// Lowest and highest round.
    pub spread_ms: [f64; 2],
    /// Label and time of each pass of a step, each timed alone.
    pub passes: Vec<(String, f64)>,
    /// The sum of the search's passes.
    pub build_ms: f64,
}

impl Times {
    /// The sum of the passes that read the grid.
    pub fn query_ms(&self) -> f64 {
        self.passes.iter().map(|(_, ms)| ms).sum::<f64>() - self.build_ms
    }
}

/// How often is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    pub rounds: u32,
    /// Steps of a round.
    pub steps: u32,
}

/// A scene and what it is called beside others.
pub struct Entry {
    pub name: String,
    pub scene: Scene,
}

/// What an entry came to: times, or why there are none.
pub type Outcome = std::result::Result<Times, String>;

/// A way to size the grid's buffers.
pub struct Policy {
    pub name: &'static str,
    /// Its margin says how much room the buffers have.
    pub scene: Scene,
    /// Whether buffers are made anew, exactly as large as needed, after every step.
    pub exactly: bool,
}

/// What a policy came to.
pub struct Sized {
    /// Median over turns of the wall time of a step.
    pub step_ms: f64,
    /// How often a search found too little room.
    pub reallocations: u32,
    pub pool_bytes: u64,
}

impl Bench {
    /// Times of all entries, round by round.
    pub fn measure(&self, entries: &[Entry], effort: Effort) -> Vec<Outcome> {
        let begin = |entry: &Entry| Measured::new(self, &entry.scene, effort.steps);
        let mut runs: Vec<_> = entries
            .iter()
            .map(|entry| begin(entry).map_err(|error| first_line(&error)))
            .collect();
        for round in 0..effort.rounds as usize {
            let forwards = round % 2 == 0;
            for turn in 0..runs.len() {
                let index = if forwards { turn } else { runs.len() - 1 - turn };
                if let Ok(run) = &mut runs[index]
                    && let Err(error) = run.round(1).and_then(|()| run.time_passes())
                {
                    runs[index] = Err(first_line(&error));
                }
            }
        }
        runs.into_iter().map(|run| run.map(Measured::times)).collect()
    }

    /// Runs policies in turns of so many steps, each step a frame that is waited for.
    pub fn compare(
        &self,
        policies: &[Policy],
        turns: u32,
        steps: u32,
    ) -> Vec<std::result::Result<Sized, String>> {
        let begin = |policy: &Policy| Ok((Measured::new(self, &policy.scene, 1)?, 0));
        let mut runs: Vec<Result<(Measured, u32)>> = policies.iter().map(begin).collect();
        for _ in 0..turns {
            for (run, policy) in runs.iter_mut().zip(policies) {
                if let Ok((measured, reallocations)) = run
                    && let Err(error) = measured.turn(steps, policy.exactly, reallocations)
                {
                    *run = Err(error);
                }
            }
        }
        let sized = |(measured, reallocations): (Measured, u32)| {
            let pool = measured.simulation.buffers().get("index_pool", "(study)")?;
            Ok(Sized {
                pool_bytes: pool.size(),
                reallocations,
                step_ms: median(measured.step_ms),
            })
        };
        runs.into_iter()
            .map(|run| run.and_then(sized).map_err(|error| first_line(&error)))
            .collect()
    }

    /// Frames a second of a scene whose frames are single steps: drawn, with their pixels brought back.
    pub fn frames_per_second(&self, scene: &Scene, frames: u32) -> Result<f64> {
        let wanted = Wanted {
            view: Some(View::Scene),
            ..Default::default()
        };
        let mut simulation = self.simulation(scene, &wanted)?;
        // The first frames compile the shaders.
        for _ in 0..4 {
            simulation.next_frame()?;
        }
        while simulation.finish_frame()?.is_some() {}
        let start = Instant::now();
        for _ in 0..frames {
            simulation.next_frame()?;
        }
        while simulation.finish_frame()?.is_some() {}
        Ok(f64::from(frames) / start.elapsed().as_secs_f64())
    }
}

/// One scene's simulation and what it has shown so far.
pub struct Measured {
    pub simulation: Simulation,
    pub plan: Plan,
    search: Vec<String>,
    /// Milliseconds of a step, round by round.
    pub step_ms: Vec<f64>,
    passes: Vec<(String, Vec<f64>)>,
    /// The frame that came last.
    pub last: Frame,
    /// Steps of the last round that searched.
    pub searches: u32,
}

impl Measured {
    /// With frames of so many steps, of adaptive ones about as many; two of them are past, so that shaders are compiled.
    pub fn new(bench: &Bench, scene: &Scene, steps: u32) -> Result<Self> {
        Self::wanting(bench, scene, steps, &Wanted::default())
    }

    /// The same with what else a plan is asked for.
    pub fn wanting(bench: &Bench, scene: &Scene, steps: u32, wanted: &Wanted) -> Result<Self> {
        let scene = scene.with_steps_per_frame(steps);
        let gpu = bench.gpu()?;
        let plan = Plan::new(&scene, &gpu.limits, wanted)?.with_its_lists()?;
        let is_search = |shader: &str| shader.starts_with("cells/") || shader.starts_with("storage/");
        let search = plan
            .passes
            .iter()
            .filter(|row| is_search(&row.pass.shader))
            .map(|row| row.pass.entry.clone())
            .collect();
        let mut measured = Self {
            simulation: bench.with_plan(gpu, &scene, &plan)?,
            plan,
            search,
            step_ms: Vec::new(),
            passes: Vec::new(),
            last: Frame::default(),
            searches: 0,
        };
        // The first state, and the steps that compile the shaders.
        measured.frames(1)?;
        measured.frames(1)?;
        Ok(measured)
    }

    /// Simulates frames and waits for all of them; gives the number of steps, and how often a grid grew.
    fn frames(&mut self, count: u32) -> Result<(u64, u32)> {
        let before = self.last.steps;
        let mut reallocations = 0;
        self.searches = 0;
        let mut take = |frame: Frame| {
            reallocations += frame.reallocations;
            self.searches += frame.searches;
            self.last = frame;
        };
        for _ in 0..count {
            if let Some(frame) = self.simulation.next_frame()? {
                take(frame);
            }
        }
        while let Some(frame) = self.simulation.finish_frame()? {
            take(frame);
        }
        Ok((self.last.steps - before, reallocations))
    }

    /// Simulates frames; the round's time of a step is kept.
    pub fn round(&mut self, frames: u32) -> Result<()> {
        let start = Instant::now();
        let (steps, _) = self.frames(frames)?;
        self.step_ms
            .push(start.elapsed().as_secs_f64() * 1e3 / steps.max(1) as f64);
        Ok(())
    }

    /// Simulates a frame whose passes are timed.
    pub fn time_passes(&mut self) -> Result<()> {
        self.simulation.set_timings(true);
        self.frames(1)?;
        self.simulation.set_timings(false);
        // A sort runs its passes several times in a step.
        let mut sums: Vec<(String, f64)> = Vec::new();
        for (label, ms) in std::mem::take(&mut self.last.pass_ms) {
            match sums.iter_mut().find(|(known, _)| *known == label) {
                Some((_, sum)) => *sum += ms,
                None => sums.push((label, ms)),
            }
        }
        for (label, ms) in sums {
            match self.passes.iter_mut().find(|(known, _)| *known == label) {
                Some((_, times)) => times.push(ms),
                None => self.passes.push((label, vec![ms])),
            }
        }
        Ok(())
    }

    /// Steps one by one; the turn's time of a step is kept.
    fn turn(&mut self, steps: u32, exactly: bool, reallocations: &mut u32) -> Result<()> {
        let start = Instant::now();
        for _ in 0..steps {
            *reallocations += self.frames(1)?.1;
            if exactly {
                self.simulation.resize_exactly()?;
            }
        }
        self.step_ms
            .push(start.elapsed().as_secs_f64() * 1e3 / f64::from(steps));
        Ok(())
    }

    pub fn times(self) -> Times {
        let passes: Vec<_> = self
            .passes
            .into_iter()
            .map(|(label, times)| (label, median(times)))
            .collect();
        let build = passes.iter().filter(|(label, _)| self.search.contains(label));
        let extreme =
            |pick: fn(f64, f64) -> f64| self.step_ms.iter().copied().reduce(pick).unwrap_or(f64::NAN);
        Times {
            build_ms: build.map(|(_, ms)| ms).sum(),
            spread_ms: [extreme(f64::min), extreme(f64::max)],
            step_ms: median(self.step_ms),
            passes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(vec![]).is_nan());
    }
}
