//! What is inspected: a frame of a scene, or a particle file.

use super::Args;
use crate::cli::scene_args::Choices;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::neighbors::occupancy::{Allocation, Census, Figures, Octree};
use crate::output::{Progress, Tally, progress};
use crate::physics::collider::offset_at;
use crate::plan::{Plan, Wanted};
use crate::scene::{Neighbors, Particles, Scene, particle_file};
use crate::simulation::Simulation;

/// A state, and what was counted on the way to it.
pub struct Subject {
    /// The scene standing still in that state: nothing moves, nothing happens later.
    pub scene: Scene,
    pub frame: u32,
    /// Seconds.
    pub time: f64,
    /// Whether there is a time at all; particle files have none.
    pub simulated: bool,
    pub census: Census,
    /// Every N-th frame, where it was asked for.
    pub over_time: Vec<Sample>,
}

/// A frame on the way.
pub struct Sample {
    pub frame: u32,
    /// Seconds.
    pub time: f64,
    pub particles: u64,
    pub figures: Figures,
    pub octree: Octree,
    /// Voxels that have memory and bytes of each grid.
    pub grids: Vec<(u64, u64)>,
}

/// The scene up to the frame that is looked at, or a particle file as a scene.
pub fn load(args: &Args) -> Result<Scene> {
    let Some(path) = args.scene.particle_file() else {
        if args.radius.is_some() {
            return Err(Error::usage(
                "--radius is for particle files; a scene has its own",
                "leave it out, or change the scene: --set grains.radius=0.01",
            ));
        }
        return args.scene.load(&Choices {
            frames: args.frame.map(|frame| frame + 1),
            ..Choices::default()
        });
    };
    if args.scene.changes_scene() || args.frame.is_some() || args.every.is_some() {
        return Err(Error::usage(
            "a particle file has no frames and no keys of a scene",
            "leave out --frame, --every, --set, --fps, --seed and --size",
        ));
    }
    let radius = args.radius.ok_or_else(|| {
        Error::usage(
            "a particle file has no search radius",
            "give one in the file's unit: --radius 0.02",
        )
    })?;
    let (points, dimensions) = particle_file::load_positions(path, None)
        .map_err(|what| Error::usage(what, "give a PLY, CSV or NPY file with x, y and z"))?;
    let mut scene = Scene::of_points(&points, dimensions, radius, Neighbors::default())?;
    scene.name = path.file_stem().unwrap_or_default().to_string_lossy().into();
    Ok(scene)
}

impl Subject {
    /// Simulates up to the scene's last frame.
    pub fn reach(
        gpu: &Gpu,
        scene: Scene,
        grids: &[Scene],
        every: Option<u32>,
        style: progress::Style,
    ) -> Result<Self> {
        let last = scene.time.frames - 1;
        let plan = Plan::new(&scene, &gpu.limits, &Wanted::default())?;
        let mut progress = Progress::new(style, scene.time.frames);
        for note in scene.notes.iter().chain(plan.told()) {
            progress.note(note);
        }
        let mut tally = Tally::start(scene.time.frames);
        let mut simulation = Simulation::new(gpu.clone(), &scene, &plan)?;
        let mut over_time = Vec::new();
        let mut overflow = 0;
        let mut take = |frame: crate::simulation::Frame| {
            overflow += frame.overflow;
            tally.add(&frame);
            progress.frame(&frame, &tally);
        };
        for index in 0..=last {
            if let Some(frame) = simulation.next_frame()? {
                take(frame);
            }
            if every.is_some_and(|every| index % every == 0 || index == last) {
                let mut positions = simulation.particles()?.position;
                positions.extend_from_slice(&scene.boundary.position);
                over_time.push(Sample::of(&scene, grids, index, &positions));
            }
        }
        while let Some(frame) = simulation.finish_frame()? {
            take(frame);
        }
        progress.clear();
        if overflow > 0 {
            progress.warn(&format!(
                "the run's own pool was full for {overflow} insertions, so positions are not exact; raise neighbors.slots"
            ));
        }
        let time = f64::from(last) / scene.time.fps;
        let particles = simulation.particles()?;
        let simulated = last > 0 || scene.time.limited_by != NOTHING_MOVES;
        let scene = still(scene, particles, time);
        let census = Census::with_boundary(&scene, &scene.positions(), scene.boundary.len());
        Ok(Self {
            simulated,
            scene,
            frame: last,
            time,
            census,
            over_time,
        })
    }
}

/// What limits the step of a scene of bare points.
const NOTHING_MOVES: &str = "nothing moves";

impl Sample {
    fn of(scene: &Scene, grids: &[Scene], frame: u32, positions: &[glam::Vec3]) -> Self {
        let census = Census::of(scene, positions);
        let need = |scene: &Scene| {
            let allocation = Allocation::of(scene, &Census::of(scene, positions));
            (allocation.voxels, allocation.bytes)
        };
        Self {
            frame,
            time: f64::from(frame) / scene.time.fps,
            particles: positions.len() as u64 - scene.boundary.len() as u64,
            figures: census.figures(),
            octree: census.octree(),
            grids: grids.iter().map(need).collect(),
        }
    }
}

/// The scene as it is at `time` with these particles.
fn still(mut scene: Scene, particles: Particles, time: f64) -> Scene {
    for collider in &mut scene.colliders {
        if !collider.path.is_empty() {
            collider.path = vec![(0.0, offset_at(&collider.path, time))];
        }
    }
    scene.capacity = (particles.len() + scene.boundary.len()) as u32;
    scene.particles = particles;
    scene.schedule.clear();
    scene.time.frames = 1;
    scene
}
