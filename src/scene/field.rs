//! Fields: what every particle has. Each is a row of [`FIELDS`]; from the rows come the device's buffers, the shaders that
//! sort and keep particles, checkpoints, particle files and colors.

use glam::Vec3;

use super::column::{Column, Source};
use super::fluid::Fluid;
use super::model::{DensityFrom, FluidSolver, Integrator, RollingResistance, Slip, ViscosityForm};
use super::{Dimensions, Particles, Scene};

/// A value of every particle.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// Of its buffer, in shaders, in files.
    pub name: &'static str,
    pub kind: Kind,
    pub unit: &'static str,
    pub about: &'static str,
    /// Where files, colors and plots take it from; `None` where they do not know it.
    pub column: Option<Source>,
    pub travels: Travels,
    /// Whether a checkpoint holds it.
    pub saved: bool,
    /// Whether a scene's particles have it. What is measured they have where somebody asks for it.
    pub has: fn(&Scene) -> bool,
    /// Bytes for particles that come; zeros where there is no such function.
    pub start: Option<fn(&Newcomers) -> Vec<u8>>,
    /// The vector whose spare number it is: then it has no buffer of its own and goes where the vector goes. One float per
    /// vector, which files and colors do not know.
    pub beside: Option<&'static str>,
    /// A field, and which of its numbers, that holds this one's value at the end of a step.
    pub ends_in: Option<(&'static str, usize)>,
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Float,
    Unsigned,
    /// Two numbers.
    Pair,
    /// As many numbers as there are dimensions, and one beside them.
    Vector,
    Matrix,
    /// `HalfStep` of `shaders/physics/dem/motion.wgsl`.
    HalfStep,
    /// What contacts remember: slots for as many contacts as a grain may have.
    Contacts {
        /// Whether they remember how far grains have rolled too.
        rolls: bool,
    },
}

/// Whether a value goes where its particle goes when particles are sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Travels {
    /// No: it is found anew behind each search.
    No,
    /// Yes: a step leaves the new value in `next_NAME`, from where the search takes it to its place.
    Stepped,
    /// Yes, and no step changes it.
    Kept,
}

/// Particles that come.
pub struct Newcomers<'a> {
    pub free: &'a Particles,
    /// Boundary particles, which follow the others.
    pub boundary: &'a Particles,
    /// Of all of them.
    pub ids: &'a [u32],
}

impl Kind {
    /// Of one value on the device.
    pub fn bytes(self, scene: &Scene) -> u64 {
        match (self, scene.dimensions) {
            (Self::Float | Self::Unsigned, _) => 4,
            (Self::Pair, _) => 8,
            (Self::Vector, _) | (Self::Matrix, Dimensions::Two) => 16,
            (Self::Matrix, Dimensions::Three) => 48,
            (Self::HalfStep, _) => 48,
            (Self::Contacts { rolls }, dimensions) => {
                16 * u64::from(contact_slots(scene) * contact_words(dimensions, rolls))
            }
        }
    }
}

/// Contacts that a grain has room to remember. Equal spheres touch at most twelve others, equal discs six; the rest is for
/// walls and obstacles, and for overlaps. As many of the smallest fit around the largest as around a ball whose surface three
/// quarters of them cover.
pub fn contact_slots(scene: &Scene) -> u32 {
    let ratio = 1.0 + scene.size_ratio();
    let (around, more) = match scene.dimensions {
        Dimensions::Two => (std::f64::consts::PI / (1.0 / ratio).asin(), 2),
        Dimensions::Three => (0.75 * 4.0 * ratio * ratio, 4),
    };
    2 * (around / 2.0).round() as u32 + more
}

/// Vectors of four numbers that a contact is remembered by.
pub fn contact_words(dimensions: Dimensions, rolls: bool) -> u32 {
    match dimensions {
        // An angle stands beside the vector.
        Dimensions::Two => 1,
        Dimensions::Three => 1 + u32::from(rolls),
    }
}

impl Field {
    /// What files, colors and plots make of it.
    pub const fn column(&self) -> Option<Column> {
        match self.column {
            Some(source) => Some(Column {
                name: self.name,
                unit: self.unit,
                about: self.about,
                source,
            }),
            None => None,
        }
    }

    /// The buffer that a search takes it from, or the only one that it has.
    pub fn before_search(&self) -> String {
        match self.travels {
            Travels::No => self.name.to_owned(),
            Travels::Stepped | Travels::Kept => format!("next_{}", self.name),
        }
    }
}

/// What a row is where it says nothing else.
const ROW: Field = Field {
    name: "",
    kind: Kind::Float,
    unit: "",
    about: "",
    column: None,
    travels: Travels::No,
    saved: false,
    has: |_| true,
    start: None,
    beside: None,
    ends_in: None,
};

/// Every field there is.
pub const FIELDS: &[Field] = &[
    Field {
        name: "position",
        kind: Kind::Vector,
        unit: "m",
        about: "where the particle's center is, in the scene's coordinates",
        column: Some(Source::State),
        travels: Travels::Stepped,
        saved: true,
        start: Some(|new| vectors(&new.free.position, &new.boundary.position)),
        ..ROW
    },
    Field {
        name: "velocity",
        kind: Kind::Vector,
        unit: "m/s",
        about: "velocity of the particle's center",
        column: Some(Source::State),
        travels: Travels::Stepped,
        saved: true,
        start: Some(|new| vectors(&new.free.velocity, &new.boundary.velocity)),
        ..ROW
    },
    Field {
        name: "id",
        kind: Kind::Unsigned,
        about: "the particle's number, stable during the run",
        column: Some(Source::State),
        travels: Travels::Kept,
        saved: true,
        start: Some(|new| bytemuck::cast_slice(new.ids).to_vec()),
        ..ROW
    },
    Field {
        name: "contacts",
        kind: Kind::Unsigned,
        about: "grains and walls that touch the grain; particles that a fluid particle's kernel reaches",
        column: Some(Source::Measured),
        ..ROW
    },
    Field {
        name: "density",
        unit: "kg/m³",
        about: "mass of the grains in the block of voxels around, over the block's volume; of a fluid, its density",
        column: Some(Source::Measured),
        ..ROW
    },
    Field {
        name: "pressure",
        unit: "Pa",
        about: "sum of the normal contact forces over the grain's surface; of a fluid, its pressure",
        column: Some(Source::Measured),
        ..ROW
    },
    Field {
        name: "material",
        kind: Kind::Unsigned,
        about: "number of the particle's material: the place of one of several fluids in fluid.materials; of grains, the place in \
                grains.materials counted from 1, and 0 for what `grains` itself says",
        column: Some(Source::Field),
        travels: Travels::Kept,
        saved: true,
        has: |scene| {
            scene.fluid().is_some_and(|fluid| fluid.materials.len() > 1)
                || scene.grains().is_some_and(|grains| grains.mixed)
        },
        start: Some(|new| bytemuck::cast_slice(&new.free.material).to_vec()),
        ..ROW
    },
    Field {
        name: "radius",
        unit: "m",
        about: "radius of the grain, where grains are of several sizes",
        column: Some(Source::Field),
        travels: Travels::Kept,
        saved: true,
        has: |scene| scene.grains().is_some_and(|grains| grains.sizes.is_some()),
        start: Some(|new| bytemuck::cast_slice(&new.free.radius).to_vec()),
        ..ROW
    },
    Field {
        name: "acceleration",
        kind: Kind::Vector,
        unit: "m/s²",
        about: "velocity Verlet needs the last accelerations",
        travels: Travels::Stepped,
        saved: true,
        has: |scene| scene.time.integrator == Integrator::VelocityVerlet && scene.friction().is_none(),
        ..ROW
    },
    Field {
        name: "body",
        kind: Kind::Unsigned,
        about: "number of the rigid body that the particle is a part of, from 1 on; 0 for loose grains",
        column: Some(Source::Field),
        travels: Travels::Kept,
        saved: true,
        has: has_rigid_bodies,
        start: Some(|new| bytemuck::cast_slice(&new.free.body).to_vec()),
        ..ROW
    },
    Field {
        name: "body_mass",
        about: "mass of the rigid body that the particle is a part of over that of a grain; 0 for loose grains",
        travels: Travels::Stepped,
        has: has_rigid_bodies,
        start: Some(|new| {
            let mut all = new.free.body_mass.clone();
            all.resize(new.ids.len(), 0.0);
            bytemuck::cast_slice(&all).to_vec()
        }),
        beside: Some("velocity"),
        ..ROW
    },
    Field {
        name: "angular_velocity",
        kind: Kind::Vector,
        unit: "rad/s",
        about: "angular velocity of the grain, about z in 2D",
        column: Some(Source::Field),
        travels: Travels::Stepped,
        saved: true,
        has: |scene| scene.friction().is_some(),
        start: Some(|new| {
            bytemuck::cast_slice(&new.ids.iter().map(|&id| contact_key(id)).collect::<Vec<_>>()).to_vec()
        }),
        ..ROW
    },
    Field {
        name: "half_step",
        kind: Kind::HalfStep,
        about: "velocity and angular velocity half a step ago, and what rounding took of the way",
        travels: Travels::Stepped,
        saved: true,
        has: |scene| scene.friction().is_some(),
        start: Some(|new| {
            let half_step = |v: &Vec3| [[v.x, v.y, v.z, 0.0], [0.0; 4], [0.0; 4]];
            let all: Vec<[[f32; 4]; 3]> = new.free.velocity.iter().map(half_step).collect();
            bytemuck::cast_slice(&all).to_vec()
        }),
        ..ROW
    },
    Field {
        name: "contact_history",
        kind: Kind::Contacts { rolls: false },
        about: "how far the surfaces have slid at each contact of the grain",
        travels: Travels::Stepped,
        saved: true,
        has: |scene| scene.friction().is_some() && !rolls_by_spring(scene),
        ..ROW
    },
    Field {
        name: "contact_history",
        kind: Kind::Contacts { rolls: true },
        about: "how far the surfaces have slid and rolled at each contact of the grain",
        travels: Travels::Stepped,
        saved: true,
        has: rolls_by_spring,
        ..ROW
    },
    Field {
        name: "fluid_state",
        kind: Kind::Pair,
        about: "ρ/ρ₀ − 1 and pressure, Pa",
        saved: true,
        has: |scene| scene.fluid().is_some(),
        ..ROW
    },
    Field {
        name: "correction",
        unit: "Pa",
        about: "pressure that corrected density in the last step, where `dfsph` begins to correct it again",
        travels: Travels::Stepped,
        saved: true,
        has: is_dfsph,
        ..ROW
    },
    Field {
        name: "density_deviation",
        about: "ρ/ρ₀ − 1, which the flow carries along",
        travels: Travels::Stepped,
        has: |scene| compressible(scene).any(|fluid| fluid.density_from == DensityFrom::Continuity),
        start: Some(|new| bytemuck::cast_slice(&new.free.density_deviation).to_vec()),
        beside: Some("velocity"),
        ends_in: Some(("fluid_state", 0)),
        ..ROW
    },
    Field {
        name: "solved_pressure",
        unit: "Pa",
        about: "pressure that the last step found, where the next one begins to look for it",
        travels: Travels::Stepped,
        has: is_dfsph,
        start: Some(|new| bytemuck::cast_slice(&new.free.start_pressure).to_vec()),
        beside: Some("velocity"),
        ends_in: Some(("fluid_state", 1)),
        ..ROW
    },
    Field {
        name: "viscous_velocity",
        kind: Kind::Vector,
        unit: "m/s",
        about: "velocities that viscous forces see, walls that stick included",
        has: |scene| {
            let sticks = |fluid: &Fluid| fluid.is_viscous() && fluid.slip == Slip::NoSlip;
            !scene.boundary.is_empty() && compressible(scene).any(sticks)
        },
        ..ROW
    },
    Field {
        name: "correction",
        kind: Kind::Matrix,
        about: "makes gradients exact for linear fields",
        has: |scene| compressible(scene).any(|fluid| fluid.gradient_correction),
        ..ROW
    },
    Field {
        name: "stress",
        kind: Kind::Matrix,
        unit: "Pa",
        about: "viscous stress",
        has: |scene| {
            let stressed =
                |fluid: &Fluid| fluid.is_viscous() && fluid.viscosity_form == ViscosityForm::Stress;
            compressible(scene).any(stressed)
        },
        ..ROW
    },
    Field {
        name: "surface_normal",
        kind: Kind::Vector,
        unit: "1/m",
        about: "where the surface is, and which way it faces",
        has: |scene| compressible(scene).any(Fluid::has_surface_tension),
        ..ROW
    },
];

fn has_rigid_bodies(scene: &Scene) -> bool {
    scene.grains().is_some() && !scene.rigid_bodies.is_empty()
}

/// No angular velocity, and beside it the key by which contacts remember the grain.
fn contact_key(id: u32) -> [f32; 4] {
    [0.0, 0.0, 0.0, (id + 1) as f32]
}

/// The most grains that have a contact key of their own: whole numbers are exact in f32 up to here.
pub const MOST_KEYS: u64 = (1 << 24) - 1;

/// Whether contacts remember how far grains have rolled.
fn rolls_by_spring(scene: &Scene) -> bool {
    scene
        .friction()
        .is_some_and(|friction| friction.rolling == Some(RollingResistance::Spring))
}

fn is_dfsph(scene: &Scene) -> bool {
    scene
        .fluid()
        .is_some_and(|fluid| fluid.solver == FluidSolver::Dfsph)
}

/// The scene's fluid at the start and after each change, unless it is incompressible.
fn compressible(scene: &Scene) -> impl Iterator<Item = &Fluid> {
    let fluids = scene.matters().filter_map(|matter| matter.fluid());
    fluids.filter(|fluid| fluid.solver != FluidSolver::Dfsph)
}

/// As the device holds vectors: a zero beside each.
fn vectors(free: &[Vec3], boundary: &[Vec3]) -> Vec<u8> {
    let four: Vec<[f32; 4]> = free
        .iter()
        .chain(boundary)
        .map(|v| v.extend(0.0).into())
        .collect();
    bytemuck::cast_slice(&four).to_vec()
}

/// Fields that a search takes to their places while it finds these.
pub const PLACED: [&str; 2] = ["position", "velocity"];

/// Fields that one pass copies.
pub const COPIED_AT_ONCE: usize = 3;

/// Which of the passes that copy fields need a second one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GoesOn {
    /// Of what follows position and velocity to its place.
    pub follow: bool,
    /// Of all that steps change.
    pub stay: bool,
}

impl Scene {
    /// Whether its particles have more fields than one pass copies.
    pub fn goes_on(&self) -> GoesOn {
        let fields = || self.fields().filter(|field| field.beside.is_none());
        let follow = fields().filter(|field| field.travels != Travels::No && !PLACED.contains(&field.name));
        let stay = fields().filter(|field| field.travels == Travels::Stepped);
        GoesOn {
            follow: follow.count() > COPIED_AT_ONCE,
            stay: stay.count() > COPIED_AT_ONCE,
        }
    }

    /// The fields of its particles, those apart that are measured when somebody asks for them.
    pub fn fields(&self) -> impl Iterator<Item = &Field> {
        let own = FIELDS.iter().chain(&self.more_fields);
        own.filter(|field| field.column != Some(Source::Measured) && (field.has)(self))
    }

    /// The field that is the spare number of this vector.
    pub fn beside(&self, vector: &Field) -> Option<&Field> {
        self.fields().find(|field| field.beside == Some(vector.name))
    }

    /// What the values of a field are, which may be one that is measured.
    pub fn kind_of(&self, name: &str) -> Kind {
        let mut all = FIELDS.iter().chain(&self.more_fields);
        let found = all.find(|field| field.name == name);
        found.expect("columns with a buffer are fields").kind
    }

    /// Whether its particles have such a field.
    pub fn has_field(&self, name: &str) -> bool {
        self.fields().any(|field| field.name == name)
    }
}
