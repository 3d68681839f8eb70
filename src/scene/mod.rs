//! Scenes: what a user writes ([`model`]), checked ([`check`]), completed and turned into numbers ([`Scene`]).
//!
//! Everything in a [`Scene`] is finite, in SI units, and relative to [`Scene::origin`], which was subtracted in f64.

pub mod allowance;
mod bgeo;
mod bodies;
pub mod boundary;
mod changes;
pub mod check;
pub mod color_maps;
mod coloring;
pub mod column;
mod contact;
mod emission;
pub mod field;
mod filling;
mod fit;
pub mod floating;
pub mod fluid;
mod fluid_keys;
pub mod fluid_start;
mod frame;
mod free_surface;
pub mod friction;
mod grain_keys;
mod grain_materials;
pub mod import;
mod json;
pub mod keys;
pub mod library;
pub mod load;
pub mod mesh;
pub mod model;
pub mod motion;
pub mod npy;
pub(crate) mod obstacles;
pub mod particle_file;
pub(crate) mod ply;
mod points;
pub mod rigid;
mod schedule;
pub mod sensors;
pub mod set;
pub mod shapes;
pub mod signed_distance;
pub mod sizes;
pub mod start;
pub mod synonyms;
pub(crate) mod text;
mod time;
mod validate;
mod vtp;

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use model::{Addressing, Cell, Dashpot, Integrator, Render, SceneFile, SlicingAxis, Storage, Wall};

use boundary::BoundaryParticles;
use column::Column;
use field::Field;
use fluid::Fluid;
use friction::Friction;
use rigid::RigidBody;
use sensors::Sensors;

/// A validated scene. Nothing after `scene::load` asks again whether a number makes sense.
#[derive(Debug, Clone)]
pub struct Scene {
    pub name: String,
    /// The scene as the user wrote it, after `--set`; defaults filled in.
    pub file: SceneFile,
    pub dimensions: Dimensions,
    /// Where local coordinates have their zero, in the scene's own coordinates, metres.
    pub origin: DVec3,
    pub domain: Domain,
    pub gravity: Vec3,
    pub matter: Matter,
    /// Particles that are there from the start; ids 0, 1, 2, … in this order.
    pub particles: Particles,
    /// Boundary particles of a fluid; their ids follow those of all others.
    pub boundary: BoundaryParticles,
    /// Particles on the device when every event has happened, boundary particles included.
    pub capacity: u32,
    pub colliders: Vec<Collider>,
    /// Bodies that particles from the start are parts of.
    pub rigid_bodies: Vec<RigidBody>,
    /// What happens during the run, by time.
    pub schedule: Vec<Scheduled>,
    /// Fields of its particles besides those that every scene of its kind has.
    pub more_fields: Vec<Field>,
    pub sensors: Sensors,
    pub neighbors: Neighbors,
    pub time: Time,
    /// The camera's points are in local coordinates too.
    pub render: Render,
    pub color: Coloring,
    /// What was decided or dropped on the way (overlaps removed, say); told to the user.
    pub notes: Vec<String>,
    pub written: Written,
}

impl Scene {
    /// Of a particle, metres: a grain's, that of the largest, or half the distance of a fluid's particles.
    pub fn radius(&self) -> f64 {
        match &self.matter {
            Matter::Grains(grains) => grains.radius,
            Matter::Fluid(fluid) => fluid.spacing / 2.0,
        }
    }

    /// Radius of the largest particle over that of the smallest.
    pub fn size_ratio(&self) -> f64 {
        self.grains()
            .map_or(1.0, |grains| grains.radius / grains.smallest())
    }

    /// Of a particle at rest over that of the largest, in the mean over all that there will be.
    pub fn mean_mass_share(&self) -> f64 {
        let later = self
            .schedule
            .iter()
            .filter_map(|scheduled| match &scheduled.action {
                Action::Add(particles) => Some(particles),
                Action::SetParameters { .. } => None,
            });
        let all = std::iter::once(&self.particles).chain(later);
        let (mut sum, mut count) = (0.0, 0.0);
        for radius in all.flat_map(|particles| &particles.radius) {
            sum += (f64::from(*radius) / self.radius()).powi(self.dimensions.count() as i32);
            count += 1.0;
        }
        if count > 0.0 { sum / count } else { 1.0 }
    }

    /// How far neighbors are searched, metres; of grains of several sizes, those of the two largest.
    pub fn search_radius(&self) -> f64 {
        match &self.matter {
            Matter::Grains(grains) => match &grains.contact.friction {
                Some(friction) => friction.reach(grains.radius) * 2.0 * grains.radius,
                None => 2.0 * grains.radius,
            },
            Matter::Fluid(fluid) => fluid.support,
        }
    }

    pub fn grains(&self) -> Option<&Grains> {
        self.matter.grains()
    }

    pub fn fluid(&self) -> Option<&Fluid> {
        self.matter.fluid()
    }

    /// Of a fluid that sound goes through, m/s.
    pub fn sound_speed(&self) -> Option<f64> {
        let compressible = |fluid: &&Fluid| fluid.solver != model::FluidSolver::Dfsph;
        self.fluid().filter(compressible).map(|fluid| fluid.sound_speed)
    }

    /// Of grains that rotate and rub.
    pub fn friction(&self) -> Option<&Friction> {
        self.grains()
            .and_then(|grains| grains.contact.friction.as_deref())
    }

    /// Gravity at the start and as events change it, m/s².
    pub fn gravities(&self) -> impl Iterator<Item = Vec3> {
        let later = self
            .schedule
            .iter()
            .filter_map(|scheduled| match &scheduled.action {
                Action::SetParameters { gravity, .. } => Some(*gravity),
                Action::Add(_) => None,
            });
        std::iter::once(self.gravity).chain(later)
    }

    /// What particles are at the start and after each change, in order of time.
    pub fn matters(&self) -> impl Iterator<Item = &Matter> {
        let later = self
            .schedule
            .iter()
            .filter_map(|scheduled| match &scheduled.action {
                Action::SetParameters { matter, .. } => Some(matter),
                Action::Add(_) => None,
            });
        std::iter::once(&self.matter).chain(later)
    }

    /// Neighbors of a particle within `reach` times the search radius: in a dense packing of equal spheres, or on a
    /// lattice as wide as a fluid's spacing. A large grain among small ones has more.
    pub fn usual_neighbors(&self, reach: f64) -> f64 {
        let (touching, ball, dimensions) = match self.dimensions {
            Dimensions::Two => (6.0, std::f64::consts::PI, 2),
            Dimensions::Three => (12.0, 4.0 / 3.0 * std::f64::consts::PI, 3),
        };
        match self.matter {
            Matter::Grains(_) => touching * f64::powi(reach, dimensions),
            Matter::Fluid(_) => {
                let radii = self.search_radius() / (2.0 * self.radius()) * reach;
                ball * f64::powi(radii, dimensions)
            }
        }
    }

    /// Local positions at the start, metres, boundary particles last.
    pub fn positions(&self) -> Vec<Vec3> {
        [&self.particles.position[..], &self.boundary.position].concat()
    }

    /// Where ids of boundary particles begin.
    pub fn first_boundary(&self) -> u32 {
        self.capacity - self.boundary.len() as u32
    }

    /// The scene with frames of so many steps.
    pub fn with_steps_per_frame(&self, steps: u32) -> Self {
        let mut scene = self.clone();
        scene.time.steps_per_frame = steps;
        scene.time.fps = 1.0 / (f64::from(steps) * scene.time.step);
        scene
    }
}

/// What the particles are.
#[derive(Debug, Clone, PartialEq)]
pub enum Matter {
    Grains(Grains),
    Fluid(Fluid),
}

impl Matter {
    /// Takes over what an event changes; grains get the contact law that holds from then on.
    fn change(&mut self, contact: Option<Contact>, change: &model::Change, material: Option<usize>) {
        match (self, contact) {
            (Self::Grains(grains), Some(contact)) => grains.contact = contact,
            (Self::Fluid(fluid), _) => fluid.change(change, material),
            (Self::Grains(_), None) => {}
        }
    }

    pub fn grains(&self) -> Option<&Grains> {
        match self {
            Self::Grains(grains) => Some(grains),
            Self::Fluid(_) => None,
        }
    }

    pub fn fluid(&self) -> Option<&Fluid> {
        match self {
            Self::Grains(_) => None,
            Self::Fluid(fluid) => Some(fluid),
        }
    }
}

/// What a scene was loaded from: loading it again gives the same scene, to the bit.
#[derive(Debug, Clone, Default)]
pub struct Written {
    pub text: String,
    /// For messages and the scene's name.
    pub file_name: String,
    /// Where paths in the scene start from.
    pub folder: PathBuf,
    /// `path=value`.
    pub overrides: Vec<String>,
    pub allowance: allowance::Allowance,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimensions {
    Two,
    Three,
}

impl Dimensions {
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// The scene's box in local coordinates, metres. In 2D, z runs from 0 to 0.
#[derive(Debug, Clone)]
pub struct Domain {
    pub min: Vec3,
    pub max: Vec3,
    /// `[axis][0]` is the lower side, `[axis][1]` the upper.
    pub sides: [[Wall; 2]; 3],
    /// Of `clamp` walls.
    pub restitution: f32,
    /// Number of the material of each side, of grains.
    pub materials: [[u32; 2]; 3],
}

impl Domain {
    /// Lengths after which space repeats, metres; zero along directions without periodic sides.
    pub fn period(&self) -> Vec3 {
        let of = |axis: usize| match self.sides[axis] {
            [Wall::Periodic, _] => self.max[axis] - self.min[axis],
            _ => 0.0,
        };
        Vec3::from([0, 1, 2].map(of))
    }

    /// Where surfaces of fluids end along each axis: at all sides but open ones, metres. At a periodic side they are cut as at a
    /// wall, since what goes on there comes in at the other one.
    pub fn ends(&self) -> [[Option<f32>; 2]; 3] {
        let end = |axis: usize, side: usize| {
            let is_closed = self.sides[axis][side] != Wall::Open;
            is_closed.then_some([self.min, self.max][side][axis])
        };
        [0, 1, 2].map(|axis| [end(axis, 0), end(axis, 1)])
    }

    /// Whether particles may leave it.
    pub fn is_open(&self) -> bool {
        self.sides.iter().flatten().any(|&side| side == Wall::Open)
    }
}

/// Grains.
#[derive(Debug, Clone, PartialEq)]
pub struct Grains {
    /// Of each, or of the largest, metres.
    pub radius: f64,
    /// The same one's, kilograms.
    pub mass: f64,
    /// Where they are not all of one size.
    pub sizes: Option<sizes::Span>,
    pub contact: Contact,
    /// Whether they are of several materials.
    pub mixed: bool,
}

impl Grains {
    /// Radius of the smallest, metres.
    pub fn smallest(&self) -> f64 {
        self.sizes.map_or(self.radius, |sizes| sizes.smallest)
    }
}

/// The contact law with its coefficients (Harada 2007, Eq. 9 and 10; Green 2012); of two of the largest grains, where they are
/// of several sizes.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// N/m.
    pub spring: f64,
    /// Between two grains, N·s/m.
    pub damping: f64,
    /// Between a grain and a wall or collider, N·s/m.
    pub wall_damping: f64,
    pub dashpot: Dashpot,
    /// N·s/m.
    pub shear: f64,
    /// N/m.
    pub attraction: f64,
    /// 1/s.
    pub global_damping: f64,
    /// Of grains that rotate; then all but `global_damping` of the above is zero.
    pub friction: Option<Box<Friction>>,
    /// The law of two of the smallest, and the mass of one in kilograms, where grains are of several sizes. Steps follow from
    /// it.
    pub smallest: Option<(Box<Contact>, f64)>,
}

/// Positions (local, metres) and velocities (m/s) of particles, one entry per particle.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    pub position: Vec<Vec3>,
    pub velocity: Vec<Vec3>,
    /// Of a fluid: (ρ/ρ₀) − 1 at the start. Empty for grains.
    pub density_deviation: Vec<f32>,
    /// Of a fluid: pressure at the start, Pa. Empty for grains.
    pub start_pressure: Vec<f32>,
    /// Of grains of several sizes, metres. Empty where there is one.
    pub radius: Vec<f32>,
    /// Of several fluids, or of grains of several materials: number of their material. Empty for one.
    pub material: Vec<u32>,
    /// Numbers of the rigid bodies that they are parts of, from 1 on; 0 for loose grains. Empty where all are loose.
    pub body: Vec<u32>,
    /// Masses of these bodies over that of a grain; 0 for loose grains. Empty where all are loose.
    pub body_mass: Vec<f32>,
}

impl Particles {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    pub fn append(&mut self, mut other: Particles) {
        self.position.append(&mut other.position);
        self.velocity.append(&mut other.velocity);
        self.density_deviation.append(&mut other.density_deviation);
        self.start_pressure.append(&mut other.start_pressure);
        self.radius.append(&mut other.radius);
        self.material.append(&mut other.material);
        self.body.append(&mut other.body);
        self.body_mass.append(&mut other.body_mass);
    }
}

/// An obstacle. It moves along `path`, piecewise linear; an empty path is rest.
#[derive(Debug, Clone)]
pub struct Collider {
    pub name: String,
    pub shape: ColliderShape,
    /// Seconds and the offset from where the shape stands, metres; ascending in time.
    pub path: Vec<(f64, Vec3)>,
    /// How its surface turns about its center or axis while the shape stays where it is, rad/s.
    pub spin: Vec3,
    /// Number of its material, of grains.
    pub material: u32,
    /// sRGB, 0 to 1.
    pub color: [f32; 3],
    pub visible: bool,
}

/// In local coordinates, metres.
#[derive(Debug, Clone)]
pub enum ColliderShape {
    /// Solid where `dot(normal, x - point) < 0`; the normal has length one.
    Plane {
        point: Vec3,
        normal: Vec3,
    },
    Box {
        min: Vec3,
        max: Vec3,
    },
    Sphere {
        center: Vec3,
        radius: f32,
        /// Solid outside instead of inside.
        hollow: bool,
    },
    Cylinder {
        from: Vec3,
        to: Vec3,
        radius: f32,
        /// Solid outside, without end in both directions.
        hollow: bool,
    },
    Mesh(mesh::Mesh),
}

/// Something to do before the first step that starts at `time` or later.
#[derive(Debug, Clone)]
pub struct Scheduled {
    /// Seconds.
    pub time: f64,
    pub action: Action,
}

#[derive(Debug, Clone)]
pub enum Action {
    /// From now on these hold.
    SetParameters { gravity: Vec3, matter: Matter },
    /// New particles; their ids follow those that exist.
    Add(Particles),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbors {
    pub addressing: Addressing,
    pub storage: Storage,
    pub slicing_axis: SlicingAxis,
    /// Whether clusters of particles get slices of their own.
    pub regions: bool,
    pub cell: Cell,
    /// Indices a voxel of a pool can hold.
    pub slots: u32,
    /// By which share of the search radius lists of neighbors reach farther; 0 for no lists.
    pub skin: f64,
    /// Room in the grid's buffers, as a multiple of what is needed when they are made.
    pub margin: f64,
    /// How far beyond open sides the search follows particles, metres; eight times the domain's longest side when
    /// `None`.
    pub quarantine_distance: Option<f64>,
    /// Whether the order of particles must be the same in every run.
    pub deterministic: bool,
    /// Whether lists are made in every step, for a solver that goes over them many times before particles move.
    pub lists_every_step: bool,
}

/// The share of the search radius that made runs fastest where it was measured.
const USUAL_SKIN: f64 = 0.1;

impl From<&model::Neighbors> for Neighbors {
    fn from(given: &model::Neighbors) -> Self {
        Self {
            addressing: given.addressing,
            storage: given.storage,
            slicing_axis: given.slicing_axis,
            regions: given.regions,
            cell: given.cell,
            slots: given.slots,
            skin: given.skin.unwrap_or(match given.storage {
                Storage::Pool => 0.0,
                _ => USUAL_SKIN,
            }),
            margin: given.margin,
            quarantine_distance: given.quarantine_distance,
            deterministic: given.deterministic,
            lists_every_step: false,
        }
    }
}

impl Default for Neighbors {
    fn default() -> Self {
        Self::from(&model::Neighbors::default())
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// Frames to write, the first state included: frame f shows time f / fps.
    pub frames: u32,
    pub fps: f64,
    /// Seconds; a whole number of steps makes one frame. Where steps are adaptive, what they are expected to be.
    pub step: f64,
    pub steps_per_frame: u32,
    pub integrator: Integrator,
    /// Seconds that the shortest contact of grains lasts.
    pub contact_duration: Option<f64>,
    /// What limits the step, in words.
    pub limited_by: &'static str,
    /// What the device chooses each step by; steps are all the same when `None`.
    pub adaptive: Option<StepLimits>,
}

/// What limits the length of a step that the device chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepLimits {
    /// What steps are expected to be, before they land on frames, seconds.
    pub expected: f64,
    /// The shortest of the limits that never change, seconds, and its name.
    pub constant: (f64, &'static str),
    /// Metres that motion and sound together may go in a step.
    pub courant_distance: f64,
    /// A step is at most √(fall / acceleration), metres.
    pub fall: f64,
    /// Of a fluid at rest density, m/s; 0 for grains.
    pub sound_speed: f64,
    /// Of a fluid, m/s; 0 for grains.
    pub expected_speed: f64,
}

impl StepLimits {
    /// What no step is longer than, s.
    pub fn longest(&self) -> f64 {
        let sound = self.courant_distance / self.sound_speed;
        self.constant.0.min(sound).max(self.expected)
    }

    /// What both allow.
    fn strictest(self, other: Self) -> Self {
        Self {
            expected: self.expected.min(other.expected),
            constant: if other.constant.0 < self.constant.0 {
                other.constant
            } else {
                self.constant
            },
            courant_distance: self.courant_distance.min(other.courant_distance),
            fall: self.fall.min(other.fall),
            sound_speed: self.sound_speed.max(other.sound_speed),
            expected_speed: self.expected_speed.max(other.expected_speed),
        }
    }
}

/// How values become colors.
#[derive(Debug, Clone)]
pub struct Coloring {
    pub column: Column,
    /// Name of a color map.
    pub map: String,
    /// Values at the ends of the map.
    pub range: [f64; 2],
    pub legend: bool,
}
