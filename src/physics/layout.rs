//! Structs that the shaders of `physics` and `common/parameters.wgsl` share with the host.

use crate::gpu::shared::SharedLayout;
use crate::shared_struct;

/// Bytes of one `Packed` vector of `common/vector.wgsl`: x, y, z (0 in 2D) and a number beside them.
pub const PACKED_BYTES: u64 = size_of::<Packed>() as u64;
/// Such a vector.
pub type Packed = [f32; 4];

/// A vector with nothing beside it.
pub fn packed(v: glam::Vec3) -> Packed {
    [v.x, v.y, v.z, 0.0]
}

shared_struct! {
    pub struct Parameters {
        /// m/s².
        pub gravity: [f32; 4],
        pub particle_count: u32,
        /// Seconds.
        pub time_step: f32,
        /// Particles that are no boundary particles.
        pub free_count: u32,
        /// Ids from here on are boundary particles.
        pub first_boundary: u32,
    }
}

shared_struct! {
    pub struct Clock {
        pub step_in_segment: u32,
        pub step: u32,
    }
}

shared_struct! {
    /// How far a segment has come, and the lengths of steps, where the device chooses them.
    pub struct StepControl {
        /// Ticks until the segment ends.
        pub left: u32,
        /// Seconds.
        pub tick: f32,
        /// Not zero: a frame ends with the segment.
        pub ends_frame: u32,
        /// Of the fastest obstacle in this segment, m/s.
        pub obstacle_speed: f32,
        /// Length of the step made last, seconds.
        pub step: f32,
        /// Length of the step that comes, seconds.
        pub next_step: f32,
        pub next_ticks: u32,
        /// What the limits allow that step, seconds.
        pub wanted: f32,
        /// Which limit that is ([`super::step_control::names`]).
        pub limit: u32,
        /// Not zero: steps would be so short that the run would never end.
        pub stalled: u32,
        /// Steps since the last frame, seconds.
        pub shortest: f32,
        pub longest: f32,
        /// Steps since the last frame, by what limited them.
        pub made: [u32; super::step_control::LIMITS.len()],
    }
}

shared_struct! {
    /// What a step notes of its particles for the next one's length, as bits of `f32`.
    pub struct Extremes {
        /// m/s².
        pub acceleration: u32,
        /// m/s.
        pub signal: u32,
        /// m/s.
        pub sound: u32,
    }
}

shared_struct! {
    pub struct StepControlLimits {
        /// Seconds.
        pub constant: f32,
        /// Metres.
        pub courant_distance: f32,
        /// Metres.
        pub fall: f32,
        /// m/s.
        pub sound_speed: f32,
        /// m/s.
        pub expected_speed: f32,
        /// Seconds.
        pub shortest: f32,
    }
}

shared_struct! {
    pub struct Guard {
        /// Metres; beyond it a particle is lost. The fourth: where single precision ends.
        pub lower: [f32; 4],
        /// The fourth: square of the speed beyond which a particle is too fast, m²/s².
        pub upper: [f32; 4],
        /// Square of the speed beyond which a fluid has run away, m²/s².
        pub runaway: f32,
        /// Of the first accidents.
        pub step: u32,
        /// Accidents until now.
        pub count: u32,
        /// Lowest [`Accident::order`] among those of that step.
        pub lowest: u32,
        /// How many of them were lower than all before.
        pub noted: u32,
        /// Of the step.
        pub extremes: Extremes,
        /// Not zero: a particle has moved so far that a neighbor may be missing from a list.
        pub far: u32,
        /// Seconds since lists were made that expect straight paths.
        pub listed_for: f32,
        pub _pad: [u32; 2],
        /// Those, in no order.
        pub accidents: [Accident; Guard::ACCIDENTS],
    }
}

shared_struct! {
    /// What a guard caught.
    pub struct Accident {
        /// Before the step, metres.
        pub position: [f32; 4],
        /// After it, m/s.
        pub velocity: [f32; 4],
        /// Its slot until the step ends.
        pub id: u32,
        /// [`crate::guards::GuardKind::code`].
        pub kind: u32,
        /// The accident with the lowest one is told.
        pub order: u32,
        pub _pad: u32,
    }
}

impl Guard {
    /// Accidents that a step has room for. Orders are at random, so that of n accidents the logarithm of n are lower than all
    /// before.
    pub const ACCIDENTS: usize = 32;
    /// Stands in `step` as long as nothing was caught.
    pub const NO_STEP: u32 = u32::MAX;

    /// The accident to tell of, which is the same one in every run.
    pub fn told(&self) -> Option<&Accident> {
        let noted = (self.noted as usize).min(Self::ACCIDENTS);
        self.accidents[..noted]
            .iter()
            .min_by_key(|accident| accident.order)
    }
}

shared_struct! {
    pub struct ContactWalls {
        pub lower: [f32; 4],
        pub upper: [f32; 4],
        /// Numbers of the sides' materials.
        pub lower_materials: [f32; 4],
        pub upper_materials: [f32; 4],
    }
}

shared_struct! {
    pub struct ClampWalls {
        pub lower: [f32; 4],
        pub upper: [f32; 4],
        pub restitution: f32,
        pub _pad: [u32; 3],
    }
}

shared_struct! {
    pub struct Contact {
        /// N/m.
        pub spring: f32,
        /// Between grains, N·s/m.
        pub damping: f32,
        /// Between a grain and a wall, N·s/m.
        pub wall_damping: f32,
        /// N·s/m.
        pub shear: f32,
        /// N/m.
        pub attraction: f32,
        /// 1/s.
        pub global_damping: f32,
        /// Metres.
        pub diameter: f32,
        /// 1/kg.
        pub inverse_mass: f32,
    }
}

shared_struct! {
    /// Coefficients of a contact of two grains, or of a grain and a wall, in the units of the contact law.
    pub struct Pairing {
        pub stiffness: f32,
        pub damping: f32,
        pub shear_stiffness: f32,
        pub shear_damping: f32,
        /// Tangential over normal force, at most.
        pub friction: f32,
        /// Torque over normal force, at most, metres.
        pub rolling_limit: f32,
        /// N·m per radian, over the normal stiffness, m².
        pub rolling_stiffness: f32,
        /// N·m·s, over the square root of the rolling stiffness.
        pub rolling_damping: f32,
        /// kg·m².
        pub rolling_inertia: f32,
        /// Greatest pull, N.
        pub cohesion: f32,
        pub _pad: [u32; 2],
    }
}

shared_struct! {
    /// Contacts of grains that rotate and rub.
    pub struct FrictionalContact {
        pub grains: Pairing,
        pub walls: Pairing,
        /// Metres.
        pub diameter: f32,
        /// Distance within which centers may come to touch during half a step, metres.
        pub reach: f32,
        /// 1/kg.
        pub inverse_mass: f32,
        /// 1/(kg·m²).
        pub inverse_inertia: f32,
        /// kg·m².
        pub inertia: f32,
        /// 1/s.
        pub global_damping: f32,
        /// More than any coordinate, metres.
        pub farthest: f32,
        /// Metres.
        pub cohesion_range: f32,
    }
}

shared_struct! {
    /// Something linear and something angular, each with a number beside it.
    pub struct Motion {
        pub linear: Packed,
        pub angular: Packed,
    }
}

shared_struct! {
    /// What a rigid body is made of.
    pub struct BodyShape {
        /// Place of its first particle among the particles of bodies.
        pub first: u32,
        /// Number of its particles.
        pub count: u32,
        /// 1/kg.
        pub inverse_mass: f32,
        /// Of one grain, or of one particle of the fluid, kg.
        pub grain_mass: f32,
        /// Columns, along the body's own axes, 1/(kg·m²).
        pub inverse_inertia: [[f32; 4]; 3],
    }
}

shared_struct! {
    /// A particle of a rigid body in a fluid.
    pub struct Member {
        /// Where it is in its body, from the center of mass along the body's own axes, metres.
        pub place: [f32; 4],
        /// Number of the body, from 0 on.
        pub body: u32,
        /// Where the particle stands behind the last search.
        pub slot: u32,
        /// Of the body, 1/kg.
        pub inverse_mass: f32,
        /// Sum over the contacts of the body, metres.
        pub overlaps: f32,
    }
}

shared_struct! {
    /// How a rigid body moves.
    pub struct BodyState {
        /// Of its center of mass, metres; beside it, its mass over that of a grain.
        pub center: [f32; 4],
        /// What rounding has left out of the center, metres.
        pub center_rest: [f32; 4],
        /// m/s.
        pub velocity: [f32; 4],
        /// Half a step ago, m/s; beside it, how long the last step was, seconds.
        pub half_velocity: [f32; 4],
        /// rad/s.
        pub angular_velocity: [f32; 4],
        /// Angular momentum half a step ago, kg·m²/s.
        pub half_momentum: [f32; 4],
        /// Quaternion x, y, z, w that turns the body's own axes to the scene's.
        pub orientation: [f32; 4],
        /// What rounding has left out of it.
        pub orientation_rest: [f32; 4],
    }
}

shared_struct! {
    pub struct Collider {
        /// [`Collider::PLANE`] and so on.
        pub kind: u32,
        pub field_offset: u32,
        pub radius: f32,
        pub cell: f32,
        pub a: [f32; 4],
        pub b: [f32; 4],
        pub offset: [f32; 4],
        pub velocity: [f32; 4],
        /// rad/s; beside it, the number of its material.
        pub spin: [f32; 4],
    }
}

impl Collider {
    pub const PLANE: u32 = 0;
    pub const BOX: u32 = 1;
    pub const SPHERE: u32 = 2;
    pub const MESH: u32 = 3;
    pub const CYLINDER: u32 = 4;
}

shared_struct! {
    pub struct Measure {
        /// Of a grain, the largest, kg.
        pub mass: f32,
        /// Of the same, m².
        pub surface: f32,
        /// Of the voxels that a search visits, m³.
        pub block_volume: f32,
        pub _pad: u32,
        /// Where the potential energy is zero, metres.
        pub reference: [f32; 4],
    }
}

shared_struct! {
    pub struct Sums {
        /// Joules.
        pub kinetic_energy: f32,
        pub potential_energy: f32,
        /// m/s.
        pub max_speed: f32,
        /// Metres.
        pub max_overlap: f32,
        /// Over all grains; a contact of two counts twice.
        pub contacts: u32,
        /// Of a fluid, |ρ/ρ₀ − 1|, summed over its particles.
        pub density_error: f32,
        pub max_density_error: f32,
        /// Of a fluid, particles whose pressure counts as zero because it would be negative.
        pub clamped_pressures: u32,
        /// Those of them whose density is the lowest that is allowed.
        pub clamped_densities: u32,
    }
}

shared_struct! {
    pub struct Occupancy {
        pub voxels: u32,
        /// Voxels with 0, 1, 2, 3, 4 and more particles.
        pub holding: [u32; 6],
        /// Particles that a pool has no room for.
        pub beyond_slots: u32,
    }
}

shared_struct! {
    pub struct Overflow {
        /// Particles without a slot in the last search.
        pub now: u32,
        /// The same, summed over the searches since the last frame.
        pub since_last_frame: u32,
    }
}

shared_struct! {
    pub struct Fluid {
        /// Metres.
        pub support: f32,
        /// 1/m.
        pub inverse_smoothing: f32,
        pub kernel_scale: f32,
        pub slope_scale: f32,
        pub laplacian_scale: f32,
        /// m³, or m² in 2D.
        pub volume: f32,
        /// kg/m³.
        pub density: f32,
        /// Pa·s.
        pub viscosity: f32,
        /// Pa.
        pub stiffness: f32,
        /// Pa.
        pub background_pressure: f32,
        /// s²/m².
        pub inverse_sound_squared: f32,
        /// m²/s.
        pub diffusion: f32,
        /// m²/s.
        pub artificial_viscosity: f32,
        pub wall_friction: f32,
        /// m²/s.
        pub shifting: f32,
        /// Metres.
        pub shift_limit: f32,
        pub kernel_at_spacing: f32,
        /// m².
        pub smallest_square: f32,
        pub lowest_deviation: f32,
        /// N/m.
        pub surface_tension: f32,
        pub wetting: f32,
        /// Metres.
        pub spacing: f32,
        pub _pad: [u32; 2],
        /// 1 along directions in which space does not repeat, else 0.
        pub closed: [f32; 4],
    }
}

shared_struct! {
    pub struct Planes {
        /// Metres; far away where a side is no plane.
        pub lower: [f32; 4],
        pub upper: [f32; 4],
        /// m/s.
        pub x_min: [f32; 4],
        pub x_max: [f32; 4],
        pub y_min: [f32; 4],
        pub y_max: [f32; 4],
        pub z_min: [f32; 4],
        pub z_max: [f32; 4],
        /// Metres.
        pub anchor: [f32; 4],
        /// Metres.
        pub spacing: f32,
        pub _pad: [u32; 3],
    }
}

shared_struct! {
    pub struct Rim {
        /// Metres; far away where there is no such side.
        pub lower: [f32; 4],
        pub upper: [f32; 4],
        pub open_lower: [f32; 4],
        pub open_upper: [f32; 4],
    }
}

shared_struct! {
    pub struct Material {
        /// kg/m³.
        pub density: f32,
        /// Pa·s.
        pub viscosity: f32,
        /// Pa.
        pub stiffness: f32,
        /// N/m.
        pub surface_tension: f32,
    }
}

shared_struct! {
    /// How the loops of `dfsph` went since the last frame.
    pub struct Convergence {
        pub steps: u32,
        /// Of the loop of density, summed over the steps.
        pub density_iterations: u32,
        pub most_density_iterations: u32,
        /// Steps that stopped at the largest number of iterations.
        pub density_unconverged: u32,
        /// What the worst step stopped at, mean of max(ρ/ρ₀ − 1, 0).
        pub density_error: f32,
        pub divergence_iterations: u32,
        pub most_divergence_iterations: u32,
        pub divergence_unconverged: u32,
        pub divergence_error: f32,
        pub viscosity_iterations: u32,
        pub most_viscosity_iterations: u32,
        pub viscosity_unconverged: u32,
        /// Share of what viscosity had to change that the worst step left.
        pub viscosity_error: f32,
        pub iteration: u32,
    }
}

shared_struct! {
    /// Where the loop of implicit viscosity is.
    pub struct Damping {
        pub strength: f32,
        pub step: f32,
        pub radius: f32,
        pub weight: f32,
        pub next_weight: f32,
        pub rounding: f32,
        pub first: f32,
    }
}

shared_struct! {
    /// What `dfsph` stops at.
    pub struct Dfsph {
        pub density_error: f32,
        pub divergence_error: f32,
        pub density_iterations: u32,
        pub divergence_iterations: u32,
        pub relaxation: f32,
        pub density_relaxation: f32,
        pub momentum: f32,
        pub warm_correction: f32,
        pub slope_volume: f32,
        pub lattice_gradient: f32,
        pub surface_density: f32,
        pub surface_slope: f32,
        pub surface_weight: f32,
        pub steepest: f32,
        pub viscosity_error: f32,
        pub viscosity_iterations: u32,
        pub speed: f32,
        pub shear: f32,
        pub far_shear: f32,
    }
}

shared_struct! {
    /// What sensors look at.
    pub struct Probe {
        pub kind: u32,
        pub field: u32,
        pub target_body: u32,
        pub threshold: f32,
        /// Metres.
        pub lower: [f32; 4],
        pub upper: [f32; 4],
        pub direction: [f32; 4],
        /// Metres.
        pub reach: f32,
        /// Of a particle at rest, m³ (m² in 2D).
        pub volume: f32,
        /// At rest, kg/m³.
        pub density: f32,
        /// Share of the kernel.
        pub least_filling: f32,
    }
}

shared_struct! {
    /// What a probe finds.
    pub struct Reading {
        pub a: [f32; 4],
        pub b: [f32; 4],
    }
}

/// Everything to hold against the shaders.
pub const SHARED: &[SharedLayout] = &[
    Parameters::LAYOUT,
    Clock::LAYOUT,
    StepControl::LAYOUT,
    Extremes::LAYOUT,
    StepControlLimits::LAYOUT,
    Guard::LAYOUT,
    Accident::LAYOUT,
    ContactWalls::LAYOUT,
    ClampWalls::LAYOUT,
    Contact::LAYOUT,
    Pairing::LAYOUT,
    FrictionalContact::LAYOUT,
    Motion::LAYOUT,
    BodyShape::LAYOUT,
    BodyState::LAYOUT,
    Member::LAYOUT,
    Collider::LAYOUT,
    Measure::LAYOUT,
    Fluid::LAYOUT,
    Planes::LAYOUT,
    Rim::LAYOUT,
    Material::LAYOUT,
    Convergence::LAYOUT,
    Damping::LAYOUT,
    Dfsph::LAYOUT,
    Sums::LAYOUT,
    Probe::LAYOUT,
    Reading::LAYOUT,
    Occupancy::LAYOUT,
    Overflow::LAYOUT,
    crate::neighbors::Grid::LAYOUT,
    crate::neighbors::layout::SearchState::LAYOUT,
    crate::neighbors::layout::ListState::LAYOUT,
];
