//! Fluids in a scene file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A weakly compressible fluid: smoothed particle hydrodynamics (SPH).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// How the fluid's pressure is found.
    #[serde(default)]
    pub solver: FluidSolver,
    /// Distance of particles at rest, metres. Each has the mass of a square or cube of this side. It becomes a little more
    /// or less where bodies' boxes are no whole number of spacings long, so that the fluid fills them exactly.
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub spacing: f64,
    /// Density at rest, kg/m³ (a 2D fluid is one metre deep).
    #[serde(default = "water")]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub density: f64,
    /// Dynamic viscosity, Pa·s.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub viscosity: f64,
    /// How viscous forces are computed; `monaghan_gingold` for a fluid of `wcsph` with a free surface and no surface
    /// tension, and `laplacian` for all others when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity_form: Option<ViscosityForm>,
    /// Artificial viscosity α (Monaghan 1992); keeps impacts stable. Walls along which fluid slips damp only what
    /// comes nearer.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub artificial_viscosity: f64,
    /// Speed of sound, m/s; ten times the fastest expected speed when left out, so that density varies by about one percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub sound_speed: Option<f64>,
    /// Fastest speed to be expected, m/s; from the scene's heights, velocities and gravity when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub max_speed: Option<f64>,
    /// Of `dfsph`: mean of max(ρ/ρ₀ − 1, 0) at which a step's loop of density stops.
    #[serde(default = "density_error")]
    #[schemars(range(min = 1e-6, max = 0.1))]
    pub max_density_error: f64,
    /// Of `dfsph`: mean of what a step's divergence adds to ρ/ρ₀ at which its loop stops.
    #[serde(default = "divergence_error")]
    #[schemars(range(min = 1e-6, max = 0.1))]
    pub max_divergence_error: f64,
    /// Of `dfsph`, where viscosity is so high that steps find it implicitly: share of what it changes in a step that its loop
    /// may leave.
    #[serde(default = "viscosity_error")]
    #[schemars(range(min = 1e-4, max = 0.5))]
    pub max_viscosity_error: f64,
    /// Of `dfsph`: most iterations of each loop in a step. Steps that stop there are counted in `stats.jsonl`.
    #[serde(default = "iterations")]
    #[schemars(range(min = 3, max = 1000))]
    pub max_iterations: u32,
    /// Of `dfsph`: share of the spacing that the fastest particle moves in a step.
    #[serde(default = "courant_number")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub courant_number: f64,
    /// Exponent γ of the equation of state p = (ρ₀c²/γ) ((ρ/ρ₀)^γ − 1) (Tait; Monaghan 1994); 7 for `wcsph` and 1 for
    /// `sph` when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 7))]
    pub gamma: Option<u32>,
    /// Pressure at rest density p₀, Pa.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub background_pressure: f64,
    /// The kernel; for `sph` Müller's three when left out, otherwise `wendland_c2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kernel: Option<Kernel>,
    /// Where the kernel ends, as a multiple of `spacing`. When left out, 2 for `dfsph`; else 3 in 2D, and in 3D 2.2 for `wcsph` with
    /// `wendland_c2`, `continuity` and no surface tension, 2.6 for all others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.5, max = 6.0))]
    pub support: Option<f64>,
    /// How density follows the flow; `summation` for `sph` and `continuity` for `wcsph` when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_from: Option<DensityFrom>,
    /// Strength δ of the diffusion of density that keeps `continuity` free of noise (Fourtakas 2019); 0 is none, and
    /// 0.1 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub density_diffusion: Option<f64>,
    /// How pressures of two particles make a force.
    #[serde(default)]
    pub pressure_force: PressureForce,
    /// What negative pressures do.
    #[serde(default)]
    pub negative_pressure: NegativePressure,
    /// Whether gradients are corrected to be exact for linear fields (Randles and Libersky 1996), and with them the
    /// Laplacian of viscous forces (Schwaiger 2008), except where fluid slips along walls.
    #[serde(default)]
    pub gradient_correction: bool,
    /// Strength of particle shifting, which keeps particles evenly spread (Lind 2012); 0 is none, 1 that of δ⁺-SPH
    /// (Sun 2017). In a fluid with a free surface, or whose negative pressures are clamped, it acts along surfaces only; else
    /// it fills voids. When left out, 0.5 for one fluid of `wcsph` in flight, with a free surface but without gravity and
    /// surface tension, that `symplectic_euler` moves, and 0 for all others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub shifting: Option<f64>,
    /// What fluid does at walls.
    #[serde(default)]
    pub slip: Slip,
    /// Friction of walls along which fluid slips: Fanning's factor c (a quarter of Darcy's). They resist with a shear
    /// stress of ½ c ρ v², as turbulent layers do that are thinner than the particles. 0.005 is usual for smooth walls.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wall_friction: f64,
    /// Surface tension of the free surface, N/m (N in 2D); 0.0728 for water in air (Brackbill 1992; Morris 2000). Between two fluids it
    /// is the sum of both. Drops need `negative_pressure: keep` to hold together.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub surface_tension: f64,
    /// Angle at which the surface meets walls, measured inside the fluid, degrees; 90 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 180.0))]
    pub contact_angle: Option<f64>,
    /// More fluids than one; bodies and emitters name theirs. The keys `density`, `viscosity` and
    /// `surface_tension` above hold where none is described here.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
}

fn water() -> f64 {
    1000.0
}

fn density_error() -> f64 {
    1e-4
}

fn divergence_error() -> f64 {
    5e-5
}

fn viscosity_error() -> f64 {
    0.01
}

fn iterations() -> u32 {
    50
}

fn courant_number() -> f64 {
    0.5
}

/// One of several fluids.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name, for bodies and emitters.
    pub name: String,
    /// Density at rest, kg/m³.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub density: f64,
    /// Dynamic viscosity, Pa·s.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub viscosity: f64,
    /// Surface tension of its free surface, N/m (N in 2D).
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub surface_tension: f64,
}

/// How the fluid's pressure is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FluidSolver {
    /// Müller 2003 as Harada 2007 used it: density by summation, linear pressure, a kernel for each force.
    Sph,
    /// Weakly compressible SPH (Monaghan 1994; Rojas 2013): short steps; knows surface tension, several fluids, walls as
    /// planes, and the corrections that the most accurate flows need.
    Wcsph,
    /// Divergence-free, incompressible SPH (Bender and Koschier 2015, 2017): long adaptive steps, pressures by iteration.
    #[default]
    Dfsph,
}

/// The weight of neighbors by distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// Monaghan and Lattanzio 1985.
    CubicSpline,
    /// Wendland 1995, once more often differentiable than the cubic spline and free of pairing.
    #[default]
    WendlandC2,
    /// Wendland 1995.
    WendlandC4,
    /// Schoenberg 1946; Morris 1997.
    QuinticSpline,
    /// Poly6 for density, spiky for pressure, and one for viscosity (Müller 2003).
    Muller,
}

/// How viscous forces are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ViscosityForm {
    /// Differences of velocities (Morris 1997; the listing of Rojas 2013). At a free surface it dissipates too little.
    #[default]
    Laplacian,
    /// The parts of those differences along pairs (Monaghan and Gingold 1983): dissipates what a free surface asks for
    /// (Colagrossi 2011), and keeps angular momentum.
    MonaghanGingold,
    /// The divergence of the viscous stress, which takes one more pass (Rojas 2013, Eq. 4).
    Stress,
}

/// How density follows the flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DensityFrom {
    /// Sum of the masses around, weighted by the kernel (Rojas 2013, Eq. 1).
    Summation,
    /// The equation of continuity; right at free surfaces too.
    #[default]
    Continuity,
}

/// How pressures of two particles make a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PressureForce {
    /// (pᵢ + pⱼ) / (ρᵢ ρⱼ) (Rojas 2013); stable between fluids of different density.
    #[default]
    Symmetric,
    /// pᵢ/ρᵢ² + pⱼ/ρⱼ² (Monaghan 1992).
    Monaghan,
    /// (pⱼ − pᵢ) / (ρᵢ ρⱼ): exact for even pressure, but forces of a pair do not cancel. For flows without a free
    /// surface, with `gradient_correction` and `shifting`.
    Difference,
}

/// What negative pressures do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NegativePressure {
    /// They stay, and pull.
    Keep,
    /// They count as zero: fluid tears instead of pulling, and torn fluid keeps at most as far below rest density as the
    /// expected speed makes it vary. What has left the fluid of a solver with `continuity` is under the air's pressure,
    /// so that spray falls and does not hover as a gas.
    #[default]
    Clamp,
    /// Inside of the fluid they act through the difference of pressures, which cannot clump particles (Sun 2018).
    Control,
}

/// What fluid does at walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Slip {
    /// It sticks, and artificial viscosity with it: thin fast layers are braked more than by water's own viscosity.
    #[default]
    NoSlip,
    /// It slides without friction; walls mirror what comes near.
    FreeSlip,
}
