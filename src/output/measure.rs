//! How long a run will take, judged by a short burst of its own steps. Nothing is written.

use std::path::Path;
use std::thread::available_parallelism;
use std::time::Instant;

use serde::Serialize;

use super::forecast::{line, particles};
use super::png::{compose, encode};
use super::run::Outputs;
use crate::error::Result;
use crate::gpu::{AdapterChoice, Gpu};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::Scene;
use crate::simulation::Simulation;

/// Seconds that a burst lasts, longer where a few steps take longer.
const BURST_S: f64 = 4.0;
/// Steps between two looks at the clock; neighbor lists serve about as many.
const STEPS: u32 = 8;
/// Looks at the clock, at least.
const FEWEST: usize = 3;

/// What a burst measured, and what it makes of the whole run.
#[derive(Debug, Clone, Serialize)]
pub struct Measured {
    pub steps: u64,
    /// At the burst's end, without boundary particles.
    pub particles: u32,
    pub step_s: f64,
    pub particle_steps_per_s: f64,
    /// Opening the device, compiling shaders, and the first frame.
    pub setup_s: f64,
    /// All steps of the run.
    pub steps_s: f64,
    /// Observing and drawing all its frames, and bringing them to the host.
    pub frames_s: f64,
    /// Compressing all its pictures, on all threads.
    pub pictures_s: f64,
    /// All of these; where the device is not the processor, pictures are compressed meanwhile.
    pub run_s: f64,
}

/// Simulates the beginning of a scene. `None` where no particle appears in it.
pub fn measure(scene: &Scene, outputs: &Outputs, adapter: &AdapterChoice) -> Result<Option<Measured>> {
    let frame = first_frame(scene, outputs, adapter)?;
    let Some(burst) = burst(scene, adapter)? else {
        return Ok(None);
    };
    let frames = f64::from(scene.time.frames);
    let [each, per_particle] = burst.step_s;
    let step_s = |particles: &f64| each + per_particle * particles;
    let setup_s = frame.setup_s + burst.compile_s;
    let steps_s =
        f64::from(scene.time.steps_per_frame) * particles(scene).iter().skip(1).map(step_s).sum::<f64>();
    let frames_s = frames * frame.device_s;
    let threads = available_parallelism().map_or(1, |threads| threads.get());
    let pictures_s = frames * frame.picture_s / threads as f64;
    let run_s = if frame.is_software {
        setup_s + steps_s + frames_s + pictures_s
    } else {
        setup_s + (steps_s + frames_s).max(pictures_s)
    };
    let steps = burst.sum(|look| look.steps as f64);
    let seconds = burst.sum(|look| look.seconds);
    let particle_steps = burst.sum(|look| look.steps as f64 * f64::from(look.particles));
    Ok(Some(Measured {
        steps: steps as u64,
        particles: burst.looks.last().map_or(0, |look| look.particles),
        step_s: seconds / steps,
        particle_steps_per_s: particle_steps / seconds,
        setup_s,
        steps_s,
        frames_s,
        pictures_s,
        run_s,
    }))
}

/// Seconds that a frame takes besides its steps.
struct FrameTimes {
    is_software: bool,
    setup_s: f64,
    device_s: f64,
    picture_s: f64,
}

fn first_frame(scene: &Scene, outputs: &Outputs, adapter: &AdapterChoice) -> Result<FrameTimes> {
    let start = Instant::now();
    let gpu = Gpu::open(adapter, false)?;
    let is_software = gpu.is_software();
    let plan = Plan::new(scene, &gpu.limits, &outputs.wanted(scene))?;
    let mut simulation = Simulation::new(gpu, scene, &plan)?;
    simulation.next_frame()?;
    simulation.finish_frame()?;
    let setup_s = start.elapsed().as_secs_f64();

    let start = Instant::now();
    simulation.show(0)?;
    let frame = simulation.finish_frame()?;
    let device_s = start.elapsed().as_secs_f64();

    let mut picture_s = 0.0;
    if let Some(frame) = frame.filter(|_| outputs.pictures) {
        let overlay = Overlay::new(scene, scene.render.view)?;
        let start = Instant::now();
        if let Some(picture) = compose(&frame, &overlay)? {
            encode(picture, Path::new("a picture"))?;
        }
        picture_s = start.elapsed().as_secs_f64();
    }
    Ok(FrameTimes {
        is_software,
        setup_s,
        device_s,
        picture_s,
    })
}

/// A few steps.
struct Look {
    steps: u64,
    /// Without boundary particles.
    particles: u32,
    seconds: f64,
}

/// What steps of a scene's beginning take.
struct Burst {
    looks: Vec<Look>,
    /// The first steps took so much longer than the others.
    compile_s: f64,
    /// Seconds of a step without particles, and of each particle in it, boundary particles included.
    step_s: [f64; 2],
}

impl Burst {
    /// `looks` begin with the steps that compiled shaders. `None` of no look.
    fn new(mut looks: Vec<Look>, walls: usize) -> Option<Self> {
        let first = (looks.len() > 1).then(|| looks.remove(0));
        let point = |look: &Look| {
            let particles = f64::from(look.particles) + walls as f64;
            [particles, look.seconds / look.steps as f64]
        };
        let step_s = line(&looks.iter().map(point).collect::<Vec<_>>())?;
        let compile_s = first.map_or(0.0, |first| {
            let [particles, step] = point(&first);
            (step - step_s[0] - step_s[1] * particles).max(0.0) * first.steps as f64
        });
        Some(Self {
            looks,
            compile_s,
            step_s,
        })
    }

    fn sum(&self, of: impl Fn(&Look) -> f64) -> f64 {
        self.looks.iter().map(of).sum()
    }
}

fn burst(scene: &Scene, adapter: &AdapterChoice) -> Result<Option<Burst>> {
    let steps = STEPS.min(scene.time.steps_per_frame);
    let in_all = u64::from(scene.time.frames - 1) * u64::from(scene.time.steps_per_frame / steps);
    let scene = scene.with_steps_per_frame(steps);
    let gpu = Gpu::open(adapter, false)?;
    let plan = Plan::new(&scene, &gpu.limits, &Wanted::default())?;
    let mut simulation = Simulation::new(gpu, &scene, &plan)?;
    let start = Instant::now();
    let mut looks = Vec::new();
    let mut steps = 0;
    for _ in 0..=in_all {
        let begin = Instant::now();
        simulation.next_frame()?;
        let Some(frame) = simulation.finish_frame()? else {
            break;
        };
        if frame.steps > steps && frame.particles > 0 {
            looks.push(Look {
                steps: frame.steps - steps,
                particles: frame.particles,
                seconds: begin.elapsed().as_secs_f64(),
            });
        }
        steps = frame.steps;
        let is_enough = looks.is_empty() || looks.len() > FEWEST;
        if is_enough && start.elapsed().as_secs_f64() >= BURST_S {
            break;
        }
    }
    Ok(Burst::new(looks, scene.boundary.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step takes a millisecond and a microsecond for each particle; shaders took two seconds.
    #[test]
    fn compiling_is_no_step() {
        let look = |particles: u32, more: f64| Look {
            steps: 8,
            particles,
            seconds: 8.0 * (1e-3 + 1e-6 * f64::from(particles + 500)) + more,
        };
        let burst = Burst::new(vec![look(1000, 2.0), look(2000, 0.0), look(4000, 0.0)], 500).unwrap();
        assert_eq!(burst.looks.len(), 2);
        assert!((burst.compile_s - 2.0).abs() < 1e-9, "{}", burst.compile_s);
        let [each, per_particle] = burst.step_s;
        assert!((each - 1e-3).abs() < 1e-12 && (per_particle - 1e-6).abs() < 1e-12);
        assert!(Burst::new(Vec::new(), 0).is_none());
        let single = Burst::new(vec![look(1000, 0.0)], 500).unwrap();
        assert_eq!((single.looks.len(), single.compile_s), (1, 0.0));
    }
}
