//! What a user writes: the scene file, field for field, with unit, range and default.
//!
//! These types carry no decisions. The JSON schema (`sliceflow schema`) is derived from them, `check` walks a
//! file against that schema and collects every mistake, and `validate` turns the result into a [`super::Scene`].

mod bodies;
mod colliders;
mod fluid;
mod grains;
mod neighbors;
mod render;
mod rigid;
mod sensors;
mod sizes;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::number;

pub use bodies::{Arrangement, Body, Flow, Placement, Shape, StartPressure};
pub use colliders::{Collider, ColliderShape, Interpolation, Oscillation, PathPoint};
pub use fluid::{
    DensityFrom, Fluid, FluidSolver, Kernel, Material, NegativePressure, PressureForce, Slip, ViscosityForm,
};
pub use grains::{ContactLaw, Dashpot, GrainMaterial, Grains, MaterialPair, RollingResistance};
pub use neighbors::{Addressing, Cell, Neighbors, SlicingAxis, Storage};
pub use render::{
    Background, Camera, CameraPoint, Color, Easing, ImagePass, Look, MeshStyle, PassFiles, Projection,
    Render, Show, Splat, SurfaceKernel, View, Water, WaterSurface,
};
pub use rigid::{Copies, Rigid};
pub use sensors::{Sensor, SensorField, Side};
pub use sizes::{Sieve, Sizes};

/// A point, direction or velocity: two numbers in a 2D scene, three in a 3D scene. SI units, y up, right-handed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Coordinates(#[schemars(length(min = 2, max = 3))] pub Vec<f64>);

/// A scene of grains or of a fluid in a box, from which frames are made.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Where editors find the schema; not used by the program.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Short name; the file's name when left out.
    #[serde(default)]
    pub name: String,
    /// One or two sentences for `sliceflow scenes`.
    #[serde(default)]
    pub description: String,
    /// Paper, experiment or author that the scene comes from.
    #[serde(default)]
    pub source: String,
    /// 2 or 3.
    #[serde(default = "three")]
    #[schemars(range(min = 2, max = 3))]
    pub dimensions: u32,
    /// Seed of every random choice (jitter, random packings).
    #[serde(default)]
    pub seed: u64,
    /// The box that the particles live in, and what its sides do.
    pub domain: Domain,
    /// Acceleration that acts on every particle, m/s²; 9.81 downwards when left out.
    #[serde(default = "earth")]
    pub gravity: Coordinates,
    /// Grains: particles that touch. A scene has grains or a fluid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grains: Option<Grains>,
    /// A fluid, or several of different density. A scene has grains or a fluid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fluid: Option<Fluid>,
    /// Grains or fluid that are there from the start.
    #[serde(default)]
    pub bodies: Vec<Body>,
    /// Obstacles, at rest or moving.
    #[serde(default)]
    pub colliders: Vec<Collider>,
    /// Places where particles flow in.
    #[serde(default)]
    pub emitters: Vec<Emitter>,
    /// What happens at given times.
    #[serde(default)]
    pub events: Vec<Event>,
    /// What is measured while the scene runs, and written to `sensors.csv`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<Sensor>,
    /// How neighbors are found. It changes speed and memory, not what is found, unless a `pool` overflows.
    #[serde(default)]
    pub neighbors: Neighbors,
    /// How long the scene is, and how long frames and steps are.
    #[serde(default)]
    pub time: Time,
    /// How frames look.
    #[serde(default)]
    pub render: Render,
}

impl SceneFile {
    /// Of a particle, metres: a grain's radius, that of the largest, or half the distance of a fluid's particles.
    pub fn radius(&self) -> f64 {
        match (&self.grains, &self.fluid) {
            (Some(grains), _) => grains.radius,
            (None, Some(fluid)) => fluid.spacing / 2.0,
            (None, None) => 0.0,
        }
    }

    /// Of the smallest particle, metres.
    pub fn smallest_radius(&self) -> f64 {
        self.sizes().map_or(self.radius(), Sizes::smallest)
    }

    /// Of grains that are not all of one size.
    pub fn sizes(&self) -> Option<&Sizes> {
        self.grains.as_ref()?.sizes.as_ref()
    }

    /// The key that says how large particles are, and its value, for messages.
    pub fn size(&self) -> String {
        match &self.fluid {
            Some(fluid) => format!("fluid.spacing ({} m)", number(fluid.spacing)),
            None => format!("grains.radius ({} m)", number(self.radius())),
        }
    }

    /// kg/m³, of a grain's material or the fluid at rest.
    pub fn density(&self) -> f64 {
        match (&self.grains, &self.fluid) {
            (Some(grains), _) => grains.density,
            (None, Some(fluid)) => fluid.density,
            (None, None) => 0.0,
        }
    }

    /// Paths of the meshes and particle files that the scene names, as it writes them.
    pub fn files(&self) -> Vec<&str> {
        let bodies = self.bodies.iter().filter_map(|body| match &body.shape {
            Shape::Mesh { file, .. } | Shape::Particles { file, .. } => Some(file.as_str()),
            _ => None,
        });
        let colliders = self
            .colliders
            .iter()
            .filter_map(|collider| match &collider.shape {
                ColliderShape::Mesh { file, .. } => Some(file.as_str()),
                _ => None,
            });
        let mut files: Vec<_> = bodies.chain(colliders).collect();
        files.sort_unstable();
        files.dedup();
        files
    }
}

fn three() -> u32 {
    3
}
fn earth() -> Coordinates {
    Coordinates(vec![0.0, -9.81, 0.0])
}

/// The box that the particles live in, and what its sides do.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Lower corner, metres.
    pub min: Coordinates,
    /// Upper corner, metres.
    pub max: Coordinates,
    /// What all sides do, unless `sides` names one; `contact` for grains and `particles` for fluids when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<Wall>,
    /// Sides that differ from `walls`.
    #[serde(default)]
    pub sides: Sides,
    /// Share of the normal speed that a `clamp` wall gives back.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
    /// Velocities of the sides' surfaces, m/s, while the sides stay where they are: a lid that drives the fluid.
    #[serde(default, skip_serializing_if = "SideVelocities::is_empty")]
    pub side_velocities: SideVelocities,
    /// Materials of `contact` sides, by names of `grains.materials`.
    #[serde(default, skip_serializing_if = "SideMaterials::is_empty")]
    pub side_materials: SideMaterials,
}

/// Materials of the domain's sides; those that are left out are of `grains`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SideMaterials {
    /// Material of the side at the lower end of x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_min: Option<String>,
    /// Material of the side at the upper end of x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_max: Option<String>,
    /// Material of the side at the lower end of y: the floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_min: Option<String>,
    /// Material of the side at the upper end of y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_max: Option<String>,
    /// Material of the side at the lower end of z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_min: Option<String>,
    /// Material of the side at the upper end of z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_max: Option<String>,
}

impl SideMaterials {
    /// `[axis][end]`, with the side's name.
    pub fn all(&self) -> [[(&'static str, Option<&str>); 2]; 3] {
        [
            [("x_min", self.x_min.as_deref()), ("x_max", self.x_max.as_deref())],
            [("y_min", self.y_min.as_deref()), ("y_max", self.y_max.as_deref())],
            [("z_min", self.z_min.as_deref()), ("z_max", self.z_max.as_deref())],
        ]
    }

    fn is_empty(&self) -> bool {
        self.all().iter().flatten().all(|(_, given)| given.is_none())
    }
}

/// Velocities of the surfaces of the domain's sides; those that are left out rest.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SideVelocities {
    /// Velocity of the surface at the lower end of x, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_min: Option<Coordinates>,
    /// Velocity of the surface at the upper end of x, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_max: Option<Coordinates>,
    /// Velocity of the surface at the lower end of y, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_min: Option<Coordinates>,
    /// Velocity of the surface at the upper end of y, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_max: Option<Coordinates>,
    /// Velocity of the surface at the lower end of z, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_min: Option<Coordinates>,
    /// Velocity of the surface at the upper end of z, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_max: Option<Coordinates>,
}

impl SideVelocities {
    /// `[axis][end]`, with the side's name.
    pub fn all(&self) -> [[(&'static str, Option<&Coordinates>); 2]; 3] {
        [
            [("x_min", self.x_min.as_ref()), ("x_max", self.x_max.as_ref())],
            [("y_min", self.y_min.as_ref()), ("y_max", self.y_max.as_ref())],
            [("z_min", self.z_min.as_ref()), ("z_max", self.z_max.as_ref())],
        ]
    }

    fn is_empty(&self) -> bool {
        self.all().iter().flatten().all(|(_, given)| given.is_none())
    }
}

fn half() -> f64 {
    0.5
}

/// What a side of the domain does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Wall {
    /// Pushes back with the same contact law as between grains. For grains.
    Contact,
    /// Moves the grain back to the wall and reverses its normal speed, times `restitution` (Green 2012). For grains.
    Clamp,
    /// Layers of particles beyond the side that carry the fluid's pressure and velocity on (Adami 2012). Beyond an open
    /// side they go on as smooth planes, so that splashes stay above their tank. For fluids.
    Particles,
    /// A plane beyond which the fluid's pressure and velocity go on as far as the kernel reaches (Rojas 2013). For fluids.
    Planes,
    /// Lets particles leave.
    Open,
    /// What leaves here comes in at the opposite side, which has to be periodic too. For fluids.
    Periodic,
}

/// What single sides of the domain do; those that are left out do what `walls` says.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sides {
    /// What the side at the lower end of x does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_min: Option<Wall>,
    /// What the side at the upper end of x does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_max: Option<Wall>,
    /// What the side at the lower end of y does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_min: Option<Wall>,
    /// What the side at the upper end of y does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_max: Option<Wall>,
    /// What the side at the lower end of z does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_min: Option<Wall>,
    /// What the side at the upper end of z does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_max: Option<Wall>,
}

/// A disc (a line in 2D) that lets particles in, layer by layer, one spacing apart.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Emitter {
    /// Name, for events that switch it.
    pub name: String,
    /// Center of the disc, metres.
    pub center: Coordinates,
    /// Radius of the disc, metres.
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub radius: f64,
    /// Velocity with which particles come, m/s; the disc stands across it.
    pub velocity: Coordinates,
    /// Distance of particles, metres; 1.1 times a grain's diameter, or the fluid's spacing, when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub spacing: Option<f64>,
    /// How the particles of a layer stand: on a lattice, which is the same in each layer, or in `random` disorder, each layer
    /// turned, shifted and loosened as far as particles do not overlap. When left out `lattice`, and `random` for grains that
    /// rotate or are of several sizes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<Arrangement>,
    /// Name of one of `fluid.materials`, the first when left out; or of `grains.materials`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Whether it flows from the start; events switch it.
    #[serde(default = "colliders::yes")]
    pub on: bool,
}

/// Something that happens at a time. One event may do several things.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// When, seconds.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub at: f64,
    /// New values of parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set: Option<Change>,
    /// Drops a ball of grains (Green 2012's key 3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drop: Option<Drop>,
    /// Switches an emitter on or off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub emitter: Option<Switch>,
    /// Moves a collider.
    #[serde(default, rename = "move", skip_serializing_if = "Option::is_none")]
    pub move_collider: Option<Move>,
}

/// New values of parameters; those that are left out stay as they are.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// As `gravity`, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Coordinates>,
    /// As `grains.spring`, N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e15))]
    pub spring: Option<f64>,
    /// As `grains.damping`, N·s/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub damping: Option<f64>,
    /// As `grains.restitution`: speed after a head-on collision over speed before it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1.0))]
    pub restitution: Option<f64>,
    /// As `grains.shear`, N·s/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub shear: Option<f64>,
    /// As `grains.attraction`, N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub attraction: Option<f64>,
    /// As `grains.global_damping`, 1/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub global_damping: Option<f64>,
    /// As `fluid.viscosity`, Pa·s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub viscosity: Option<f64>,
    /// As `fluid.artificial_viscosity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub artificial_viscosity: Option<f64>,
    /// As `fluid.surface_tension`, N/m (N in 2D). Not of `dfsph`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub surface_tension: Option<f64>,
    /// As `fluid.sound_speed`, m/s. Densities stay as they are, so pressures jump with its square. Not of `dfsph`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub sound_speed: Option<f64>,
    /// As `fluid.wall_friction`. Not of `dfsph`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wall_friction: Option<f64>,
    /// Name of one of `fluid.materials`, whose `viscosity` and `surface_tension` change; those of all when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
}

/// A ball of grains that appears and falls.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drop {
    /// Center of the ball, metres.
    pub center: Coordinates,
    /// Radius of the ball, metres.
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub radius: f64,
    /// Its velocity, m/s; zero when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Coordinates>,
}

/// An emitter that begins or ends to flow.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Switch {
    /// Name of the emitter.
    pub name: String,
    /// Whether it flows from now on.
    pub on: bool,
}

/// A collider that moves from where it is.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Move {
    /// Name of the collider.
    pub collider: String,
    /// How far, metres, on top of what its path goes on to do.
    pub by: Coordinates,
    /// Seconds that the move takes.
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub during: f64,
}

/// An axis of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// To the right.
    X,
    /// Upwards.
    #[default]
    Y,
    /// Towards the viewer.
    Z,
}

/// How long the scene is, and how long frames and steps are.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Simulated time, seconds; with `fps` it gives the number of frames.
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub duration: f64,
    /// Frames per simulated second.
    #[schemars(range(min = 1e-6, max = 1e9))]
    pub fps: f64,
    /// Length of a step, seconds; derived from contacts or from the fluid's speeds when left out. Shortened so that steps
    /// land on frame times. The longest step where steps are adaptive.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e3))]
    pub step: Option<f64>,
    /// Steps in the shortest contact, when `step` is left out; fewer than 20 is refused.
    #[schemars(range(min = 20, max = 100_000))]
    pub steps_per_contact: u32,
    /// How a step is made from forces: `symplectic_euler` when left out, and `velocity_verlet` for grains whose law is `linear`
    /// or `hertz`, which know no other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integrator: Option<Integrator>,
    /// Whether the device chooses each step by what it finds: motion, acceleration and, in fluids, the local speed of
    /// sound, besides the contact's duration, viscosity and `step`. Steps land on frame times and on events. Needs
    /// neighbor lists (`neighbors.skin`).
    pub adaptive: bool,
    /// Seconds between two samples of the sensors; one sample with each frame when left out. A sample is taken exactly then
    /// where steps are adaptive, and otherwise at the end of the step that reaches this time. With an interval shorter than
    /// a step, every step is sampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e9))]
    pub sensor_interval: Option<f64>,
}

impl Default for Time {
    fn default() -> Self {
        Self {
            duration: 4.0,
            fps: 30.0,
            step: None,
            steps_per_contact: 40,
            integrator: None,
            adaptive: false,
            sensor_interval: None,
        }
    }
}

impl Time {
    /// What the scene asks for, or what is usual for all but grains that rotate.
    pub fn integrator(&self) -> Integrator {
        self.integrator.unwrap_or_default()
    }
}

/// How a step is made from forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// First order, one force pass per step (Rojas 2013, Eq. 7).
    #[default]
    SymplecticEuler,
    /// Second order, one force pass per step; each particle keeps its acceleration too.
    VelocityVerlet,
}
