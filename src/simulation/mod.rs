//! Executes a plan: steps, frames, and what comes back of them.

pub mod frame;
mod neighbor_lists;
mod particles;
pub mod passes;
mod reallocation;
mod rounds;
mod segments;
pub mod sensors;
pub mod state;
mod step_control;
mod submissions;
mod violation;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use glam::Vec3;

pub use frame::{AdaptiveSteps, ColumnData, Frame, Statistics, Values, Voxels};
pub use neighbor_lists::{NeighborCounts, NeighborLists, PairQuery};
pub use sensors::Sample;
pub use state::State;

use crate::error::{Error, Result};
use crate::gpu::readback::Ring;
use crate::gpu::timing::Timer;
use crate::gpu::{BufferPlan, Buffers, Gpu, Kernels};
use crate::neighbors::{Grid, boxes, lists};
use crate::physics::collider::offset_at;
use crate::physics::layout::{Clock, Guard, Occupancy, Overflow, Parameters, StepControl, Sums};
use crate::physics::{Written, bodies};
use crate::plan::Plan;
use crate::render::Renderer;
use crate::render::passes::images;
use crate::scene::{Action, Matter, Scene};
use passes::{Passes, Step, recorded};
use segments::{Segment, segments};
use submissions::Submissions;

/// Frames that may be on their way to the host while the device goes on.
const FRAMES_UNDER_WAY: usize = 3;

/// A scene on a device.
pub struct Simulation {
    gpu: Gpu,
    scene: Scene,
    plan: Plan,
    buffers: Buffers,
    passes: Passes,
    kernels: Kernels,
    renderer: Option<Renderer>,
    ring: Ring<Pending>,
    timer: Option<Timer>,
    /// Of a step: the last one of a frame, or the mean over a frame where some steps search and others do not.
    pass_ms: Vec<(String, f64)>,
    next_frame: u32,
    /// Particles that exist, boundary particles included.
    count: u32,
    gravity: Vec3,
    /// What particles are by now.
    matter: Matter,
    /// Events that have happened.
    happened: usize,
    submissions: RefCell<Submissions>,
    /// Asked before each submission whether to give the frame up.
    stop: Option<fn() -> bool>,
    /// Steps that were submitted since the run began.
    submitted: u64,
    /// Of adaptive steps, as the device left it.
    step_control: StepControl,
    /// How often the grid's buffers were made larger since the last frame was sent.
    reallocations: u32,
    /// Steps that searched, as the device counts them, now and when the last frame was sent.
    searches: [u32; 2],
    /// Steps from one search to the next, averaged over the latest.
    list_lifetime: f64,
    /// Step at which that was found.
    last_look: u32,
    /// Particles that the last search did not follow.
    quarantined: u32,
    /// When sensors were sampled since the last frame was sent, seconds.
    sampled: Vec<f64>,
    /// Frame and steps that a restored state began with.
    restored: (u32, u32),
}

/// A frame on its way to the host.
struct Pending {
    index: u32,
    particles: u32,
    quarantined: u32,
    gravity: Vec3,
    searches: u32,
    reallocations: u32,
    lists_left_out: Option<String>,
    pass_ms: Vec<(String, f64)>,
    /// When its samples of sensors were taken, seconds.
    sampled: Vec<f64>,
    /// As it was; it may grow or turn before the frame arrives.
    grid: Grid,
    /// Of the staging buffer, in order.
    parts: Vec<Part>,
}

/// The beginning of a buffer, on its way to the host.
#[derive(Clone)]
struct Part {
    name: String,
    bytes: u64,
    /// Bytes that are zeroed behind that.
    zeroed: Range<u64>,
}

impl Simulation {
    /// # Errors
    ///
    /// Where the device has no room for the plan's buffers, or refuses a pass.
    pub fn new(gpu: Gpu, scene: &Scene, plan: &Plan) -> Result<Self> {
        Self::with_kernels(gpu, scene, plan, Kernels::default())
    }

    /// The same, with what another simulation on this device has compiled.
    ///
    /// # Errors
    ///
    /// As those of [`Simulation::new`].
    pub fn with_kernels(gpu: Gpu, scene: &Scene, plan: &Plan, mut kernels: Kernels) -> Result<Self> {
        let mut scene = match plan.lists_left_out {
            Some(_) => lists::without(scene),
            None => scene.clone(),
        };
        if !plan.wanted.sensors {
            scene.sensors = Default::default();
        }
        let mut buffers = Buffers::default();
        for buffer in &plan.buffers {
            buffers.make(&gpu, buffer)?;
        }
        let renderer = match plan.wanted.view {
            Some(view) => Some(Renderer::new(&gpu, &scene, &plan.variant, &mut buffers, view)?),
            None => None,
        };
        let passes = Passes::new(&gpu, plan, &buffers, &mut kernels)?;
        Ok(Self {
            passes,
            kernels,
            buffers,
            renderer,
            ring: Ring::new(FRAMES_UNDER_WAY),
            timer: None,
            pass_ms: Vec::new(),
            next_frame: 0,
            count: 0,
            gravity: scene.gravity,
            matter: scene.matter.clone(),
            happened: 0,
            submissions: RefCell::default(),
            stop: None,
            submitted: 0,
            step_control: step_control::at_start(&scene),
            reallocations: 0,
            searches: [0; 2],
            list_lifetime: rounds::USUAL_LIST_LIFETIME,
            last_look: 0,
            quarantined: 0,
            sampled: Vec::new(),
            restored: (0, 0),
            scene,
            plan: plan.clone(),
            gpu,
        })
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What it has compiled, for [`Simulation::with_kernels`].
    pub fn into_kernels(self) -> Kernels {
        self.kernels
    }

    /// The device's buffers, by name.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }

    /// Times the passes of each frame's last step, and its own; this makes the host wait for every frame.
    pub fn set_timings(&mut self, on: bool) {
        let passes = [&self.passes.step, &self.passes.start, &self.passes.observe];
        let passes = passes
            .iter()
            .map(|steps| recorded(steps).len())
            .max()
            .unwrap_or(0) as u32;
        self.timer = if on { Timer::new(&self.gpu, passes) } else { None };
    }

    /// From now on a frame is given up with [`Error::Interrupted`] as soon as `asked` says so. Frames before it can
    /// still be received; the simulation stands in the middle of a frame then, and cannot go on.
    pub fn stop_when(&mut self, asked: Option<fn() -> bool>) {
        self.stop = asked;
    }

    /// What events change. Takes effect with the next submission.
    fn write_parameters(&self, time_step: f64) -> Result<()> {
        let parameters = Parameters {
            gravity: [self.gravity.x, self.gravity.y, self.gravity.z, 0.0],
            particle_count: self.count,
            time_step: time_step as f32,
            free_count: self.free_particles(),
            first_boundary: self.scene.first_boundary(),
        };
        self.buffers.write(&self.gpu, "parameters", 0, &[parameters])?;
        let dispatch = self
            .plan
            .dispatch(self.count, self.free_particles(), &self.gpu.limits);
        self.buffers.write(&self.gpu, "dispatch", 0, &dispatch)?;
        self.write_all(&(self.plan.model.parameters)(&self.scene, &self.matter))
    }

    fn write_all(&self, all: &[Written]) -> Result<()> {
        all.iter()
            .try_for_each(|written| self.buffers.write(&self.gpu, written.buffer, 0, &written.bytes))
    }

    /// Simulates up to the next frame (frame 0 is the initial state), has it observed and drawn, and sends it on its
    /// way. Returns an older frame when enough are under way.
    ///
    /// # Errors
    ///
    /// Where a particle goes wrong, and where the device does; then with frame and step.
    pub fn next_frame(&mut self) -> Result<Option<Frame>> {
        let index = self.next_frame;
        let sent = self.make_frame(index);
        self.dated(index, sent)
    }

    fn make_frame(&mut self, index: u32) -> Result<Option<Frame>> {
        if index == 0 {
            let boundary = self.boundary_as_particles();
            self.add_particles(&self.scene.particles.clone(), Some(&boundary))?;
            self.write_parameters(self.scene.time.step)?;
            self.sample(0.0)?;
        } else {
            self.step_control.begin_frame();
            for segment in segments(&self.scene, index - 1) {
                self.begin_segment(&segment)?;
                self.run_segment(&segment)?;
                if segment.is_sampled {
                    self.sample(segment.end_time)?;
                }
            }
        }
        self.next_frame += 1;
        self.send_frame(index)
    }

    /// After the last frame: those that are still on their way, in order.
    ///
    /// # Errors
    ///
    /// As those of [`Simulation::next_frame`].
    pub fn finish_frame(&mut self) -> Result<Option<Frame>> {
        let received = self.ring.receive(&self.gpu);
        match self.dated(self.next_frame.saturating_sub(1), received)? {
            Some((bytes, pending)) => self.receive(&bytes, pending).map(Some),
            None => Ok(None),
        }
    }

    /// Adds to an error of the device when it was found.
    fn dated<T>(&self, frame: u32, result: Result<T>) -> Result<T> {
        result.map_err(|error| match error {
            Error::Device { what, help } => Error::Device {
                what: format!("at frame {frame}, step {}: {what}", self.submitted),
                help,
            },
            other => other,
        })
    }

    /// Does what is due before a segment's first step, and sets obstacles on their way.
    fn begin_segment(&mut self, segment: &Segment) -> Result<()> {
        let mut changed = false;
        while self.happened < segment.events_before {
            let action = self.scene.schedule[self.happened].action.clone();
            self.happened += 1;
            changed = true;
            match action {
                Action::SetParameters { gravity, matter } => {
                    self.gravity = gravity;
                    self.matter = matter;
                }
                Action::Add(particles) => self.add_particles(&particles, None)?,
            }
        }
        if changed {
            self.write_parameters(self.scene.time.step)?;
        }
        self.place_obstacles(segment)?;
        self.step_segment(segment)
    }

    /// Sets moving obstacles on their way through a segment.
    fn place_obstacles(&self, segment: &Segment) -> Result<()> {
        if !self.plan.obstacles.moving {
            return Ok(());
        }
        let (from, to) = (segment.start_time, segment.end_time);
        let place = self.plan.model.place_obstacles;
        self.write_all(&place(&self.scene, &self.plan.obstacles, from, to))
    }

    /// Searches neighbors of what stands in `next_position`, and does what a step does after its search.
    fn search(&self) -> Result<()> {
        for buffer in self.plan.buffers.iter().filter(|buffer| buffer.renewed) {
            self.buffers.fill(&self.gpu, buffer)?;
        }
        self.submit(&[&self.passes.start])
    }

    /// Runs a segment's steps; a frame's last one is timed pass by pass where times are wanted.
    fn run_segment(&mut self, segment: &Segment) -> Result<()> {
        if self.count == 0 {
            return Ok(());
        }
        let timed = segment.ends_frame && self.timer.is_some();
        let end = self.submitted + u64::from(segment.steps);
        if lists::wanted(&self.scene) {
            self.run_listed_steps(segment, timed)?;
        }
        // Either there were no lists, or they have been left out on the way.
        if lists::wanted(&self.scene) || self.submitted == end {
            return Ok(());
        }
        self.submit_steps(end - self.submitted - u64::from(timed))?;
        self.settle()?;
        if timed {
            self.submitted += 1;
            self.pass_ms = self.time(&self.passes.step)?;
            self.settle()?;
        }
        Ok(())
    }

    /// Steps that searched since the frame before this one.
    fn searches_since_last_frame(&mut self, index: u32) -> u32 {
        let [now, before] = self.searches;
        self.searches[1] = now;
        if lists::wanted(&self.scene) {
            now.wrapping_sub(before)
        } else if index == 0 {
            0
        } else {
            self.scene.time.steps_per_frame
        }
    }

    /// Has the device make so many steps more, or with lists nearly as many ([`Simulation::settle`] makes the others).
    fn submit_steps(&mut self, steps: u64) -> Result<()> {
        self.submitted += steps;
        if lists::wanted(&self.scene) {
            return self.submit_rounds(steps);
        }
        let mut left = steps;
        while left > 0 {
            let now = left.min(self.most_steps());
            left -= now;
            self.submit(&vec![&self.passes.step[..]; now as usize])?;
        }
        Ok(())
    }

    /// Steps that a submission should have at most.
    fn most_steps(&self) -> u64 {
        self.submissions.borrow().most_steps()
    }

    /// Records passes of so many steps, or of a search, and submits them.
    fn submit(&self, sequences: &[&[Step]]) -> Result<()> {
        if self.stop.is_some_and(|asked| asked()) {
            return Err(Error::interrupted(""));
        }
        let mut encoder = self.encoder("steps");
        let mut compute = encoder.begin_compute_pass(&Default::default());
        for step in sequences.iter().flat_map(|steps| recorded(steps)) {
            self.encode(step, &mut compute)?;
        }
        drop(compute);
        let index = self.gpu.submit(encoder)?;
        self.submissions
            .borrow_mut()
            .add(&self.gpu, index, sequences.len() as u64)
    }

    /// Runs passes one by one, with their milliseconds when there is a timer.
    fn time(&self, steps: &[Step]) -> Result<Vec<(String, f64)>> {
        let Some(timer) = &self.timer else {
            return Ok(Vec::new());
        };
        let passes: Result<Vec<_>> = recorded(steps)
            .into_iter()
            .map(|step| Ok((&step.pass, step.groups(&self.buffers)?)))
            .collect();
        timer.run(&self.gpu, &passes?)
    }

    fn encoder(&self, label: &str) -> wgpu::CommandEncoder {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some(label) };
        self.gpu.device.create_command_encoder(&descriptor)
    }

    fn encode(&self, step: &Step, compute: &mut wgpu::ComputePass<'_>) -> Result<()> {
        step.pass.dispatch(compute, step.groups(&self.buffers)?);
        Ok(())
    }

    /// Observes, draws, and copies what is wanted into the staging ring.
    fn send_frame(&mut self, index: u32) -> Result<Option<Frame>> {
        let mut encoder = self.encoder("frame");
        let mut pass_ms = std::mem::take(&mut self.pass_ms);
        if self.count > 0 {
            if self.timer.is_some() {
                let cleared = std::mem::replace(&mut encoder, self.encoder("frame"));
                self.gpu.submit(cleared)?;
                pass_ms.extend(self.time(&self.passes.observe)?);
            } else {
                let mut compute = encoder.begin_compute_pass(&Default::default());
                for step in &self.passes.observe {
                    self.encode(step, &mut compute)?;
                }
            }
        }
        if let Some(renderer) = &mut self.renderer {
            let time = f64::from(index) / self.scene.time.fps;
            let offsets: Vec<Vec3> = self
                .scene
                .colliders
                .iter()
                .map(|c| offset_at(&c.path, time))
                .collect();
            renderer.draw(&self.gpu, &self.buffers, &mut encoder, self.count, time, &offsets)?;
        }

        let parts = self.parts(index);
        let bytes = parts.iter().map(|part| part.bytes).sum();
        let pending = Pending {
            index,
            particles: self.free_particles(),
            quarantined: self.quarantined,
            gravity: self.gravity,
            searches: self.searches_since_last_frame(index),
            reallocations: std::mem::take(&mut self.reallocations),
            lists_left_out: self.plan.lists_left_out.clone(),
            pass_ms,
            sampled: std::mem::take(&mut self.sampled),
            grid: self.plan.grid,
            parts: parts.clone(),
        };
        let buffers = &self.buffers;
        let mut missing = None;
        let oldest = self
            .ring
            .send(&self.gpu, encoder, bytes, pending, |encoder, staging| {
                let mut offset = 0;
                for Part { name, bytes, zeroed } in &parts {
                    match buffers.get(name, "(host)") {
                        Ok(buffer) if *bytes > 0 => {
                            encoder.copy_buffer_to_buffer(buffer, 0, staging, offset, *bytes);
                            offset += bytes;
                            if !zeroed.is_empty() {
                                encoder.clear_buffer(buffer, zeroed.start, Some(zeroed.end - zeroed.start));
                            }
                        }
                        Ok(_) => {}
                        Err(error) => missing = Some(error),
                    }
                }
            })?;
        if let Some(error) = missing {
            return Err(error);
        }
        match oldest {
            Some((bytes, pending)) => self.receive(&bytes, pending).map(Some),
            None => Ok(None),
        }
    }

    /// What a frame brings to the host.
    fn parts(&self, index: u32) -> Vec<Part> {
        let reported = |buffer: &BufferPlan| {
            buffer.reported.clone().map(|zeroed| Part {
                name: buffer.name.clone(),
                bytes: buffer.bytes,
                zeroed,
            })
        };
        let mut parts: Vec<Part> = self.plan.buffers.iter().filter_map(reported).collect();
        let mut add = |name: &str, bytes: u64| {
            parts.push(Part {
                name: name.to_owned(),
                bytes,
                zeroed: 0..0,
            });
        };
        let samples = sensors::bytes(&self.scene, self.sampled.len());
        if samples > 0 {
            add("sensor_samples", samples);
        }
        let wanted = &self.plan.wanted;
        if index.is_multiple_of(wanted.columns_every.max(1)) {
            for name in frame::sources(&wanted.columns) {
                let bytes = self.scene.kind_of(name).bytes(self.scene.dimensions);
                add(name, bytes * u64::from(self.count));
            }
        }
        if let Some(side) = self.plan.wanted.voxel_map {
            add("voxel_map", 4 * u64::from(side) * u64::from(side));
            if let Some((name, bytes)) = boxes::record(&self.scene, &self.plan.grid) {
                add(name, bytes);
            }
        }
        if self.renderer.is_some() {
            add("frame_pixels", self.plan.picture_bytes);
            // A word per pixel of the picture.
            let pixels = self.plan.picture_bytes / 4;
            for image in images(&self.scene.render).filter(|image| self.buffers.contains(image.buffer)) {
                add(image.buffer, image.bytes_per_pixel * pixels);
            }
        }
        parts
    }

    /// Makes a frame of the bytes that arrived.
    fn receive(&self, bytes: &[u8], pending: Pending) -> Result<Frame> {
        let mut by_name = BTreeMap::new();
        let mut offset = 0;
        for part in &pending.parts {
            let end = offset + part.bytes as usize;
            by_name.insert(part.name.as_str(), &bytes[offset..end]);
            offset = end;
        }
        let clock: Clock = bytemuck::pod_read_unaligned(by_name["clock"]);
        let step_control = by_name
            .get("step_control")
            .map(|bytes| bytemuck::pod_read_unaligned(bytes));
        let guard: Guard = bytemuck::pod_read_unaligned(by_name["guard"]);
        if guard.count > 0 {
            return Err(self.caught(&guard, pending.index, clock.step, step_control.as_ref()));
        }
        let overflow = by_name
            .get("overflow")
            .map_or_else(Overflow::default, |b| bytemuck::pod_read_unaligned(b));
        let bodies = by_name.get("body_state").map_or_else(Vec::new, |bytes| {
            bodies::motions(&self.scene, &bytemuck::pod_collect_to_vec(bytes))
        });
        let statistics = self.plan.wanted.statistics.then(|| {
            let sums: Sums = bytemuck::pod_read_unaligned(by_name["sums"]);
            let occupancy: Occupancy = bytemuck::pod_read_unaligned(by_name["occupancy_count"]);
            let [kinetic, potential] = bodies::energies(&self.scene, pending.gravity.as_dvec3(), &bodies);
            let of_particles = Statistics::new(
                &self.scene,
                self.plan.model,
                pending.particles,
                sums,
                occupancy,
                overflow,
            );
            Statistics {
                kinetic_energy: of_particles.kinetic_energy + kinetic,
                potential_energy: of_particles.potential_energy + potential,
                ..of_particles
            }
        });
        let time = &self.scene.time;
        let adaptive = self.adaptive_steps(step_control.as_ref());
        Ok(Frame {
            index: pending.index,
            time: f64::from(pending.index) / time.fps,
            steps: u64::from(clock.step),
            step_s: adaptive
                .as_ref()
                .map_or(time.step, |steps| steps.mean_s(time.fps)),
            step_limited_by: adaptive
                .as_ref()
                .map_or(time.limited_by, AdaptiveSteps::usual_limit),
            adaptive,
            particles: pending.particles,
            boundary_particles: self.scene.boundary.len() as u32,
            overflow: u64::from(overflow.since_last_frame),
            convergence: by_name
                .get("convergence")
                .map(|bytes| bytemuck::pod_read_unaligned(bytes)),
            quarantined: pending.quarantined,
            searches: pending.searches,
            reallocations: pending.reallocations,
            lists_left_out: pending.lists_left_out,
            pixels: by_name.get("frame_pixels").map(|pixels| pixels.to_vec()),
            passes: images(&self.scene.render)
                .filter_map(|image| Some((image.pass, by_name.get(image.buffer)?.to_vec())))
                .collect(),
            statistics,
            samples: by_name.get("sensor_samples").map_or_else(Vec::new, |bytes| {
                sensors::samples(&self.scene, &pending.sampled, bytes)
            }),
            bodies,
            columns: frame::columns(&self.scene, &self.plan, &by_name),
            voxels: by_name.get("voxel_map").map(|map| {
                let record = boxes::record(&self.scene, &pending.grid);
                let record = record.map_or(&[][..], |(name, _)| by_name[name]);
                Voxels::new(&self.scene, &pending.grid, map, record)
            }),
            pass_ms: pending.pass_ms,
        })
    }
}
