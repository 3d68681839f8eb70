//! What a user writes about grains and how they push each other.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sizes;

/// Grains and their contact law. By `spring_dashpot` they do not rotate; by `linear` and `hertz` they rotate, rub and
/// resist rolling, so that they come to rest as a heap.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Radius of every grain, metres; of the largest, where there are `sizes`.
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub radius: f64,
    /// Makes grains of several sizes. Contacts then have the coefficients of their own effective mass and radius: `restitution`
    /// and `contact_time` hold for each two grains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sizes: Option<Sizes>,
    /// Density of a grain's material, kg/m³ (a 2D grain is a disc one metre thick).
    #[serde(default = "sand")]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub density: f64,
    /// How grains push each other, and whether they rotate.
    #[serde(default)]
    pub law: ContactLaw,
    /// Spring coefficient of `spring_dashpot` (k of Harada 2007, Eq. 9) and `linear`, in N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e15))]
    pub spring: Option<f64>,
    /// Seconds that a head-on contact of two grains lasts; says what `spring` is, with `linear`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e3))]
    pub contact_time: Option<f64>,
    /// Young's modulus of the grains' material, Pa, with `hertz`. Walls are rigid unless their material says
    /// otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1e13))]
    pub young_modulus: Option<f64>,
    /// Poisson's ratio of the grains' material, with `hertz`; 0.25 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub poisson_ratio: Option<f64>,
    /// Coulomb's coefficient of friction between grains, with `linear` and `hertz`; 0.5 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub friction: Option<f64>,
    /// The same between grains and walls or obstacles; that between grains when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub wall_friction: Option<f64>,
    /// Tangential over normal stiffness, with `linear`; when left out 2/7 (1/3 in 2D), with which a contact swings along and
    /// across in the same time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 2.0))]
    pub tangential_stiffness: Option<f64>,
    /// Resistance to rolling, with `linear` and `hertz`: greatest torque over normal force and effective radius (half of a
    /// grain's, and all of it at walls). 0 when left out. It stands for grains that are not round: 0.1 to 0.5 for sand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub rolling_friction: Option<f64>,
    /// How rolling is resisted, where `rolling_friction` is more than 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rolling_resistance: Option<RollingResistance>,
    /// Greatest pull between two grains, or a grain and a wall, N, with `linear` and `hertz`: as large while they touch, and
    /// less with their distance until `cohesion_range`, as that of a bridge of liquid. 0 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub cohesion: Option<f64>,
    /// Distance of the surfaces at which the pull ends, metres; a tenth of the radius when left out, and at most the radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e6))]
    pub cohesion_range: Option<f64>,
    /// Materials of grains, obstacles and sides besides `grains`, which is what the keys above say, with `linear` and `hertz`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<GrainMaterial>,
    /// What holds where two materials meet, in place of what would follow from both.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<MaterialPair>,
    /// Dashpot coefficient η of Harada 2007, Eq. 10, in N·s/m, with `spring_dashpot`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub damping: Option<f64>,
    /// Speed after a head-on collision over speed before it; sets the dashpots for two grains and for a wall so that both
    /// give it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1.0))]
    pub restitution: Option<f64>,
    /// Which part of the relative velocity the dashpot of `spring_dashpot` resists.
    #[serde(default)]
    pub dashpot: Dashpot,
    /// Force against the tangential relative velocity at a contact of `spring_dashpot` (Green 2012), N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub shear: f64,
    /// Pull towards a touching grain of `spring_dashpot`, times the distance of the centers (Green 2012), N/m.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub attraction: f64,
    /// Rate at which every grain's velocity fades (Green 2012's global damping), 1/s.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub global_damping: f64,
}

fn sand() -> f64 {
    2500.0
}

/// What grains, obstacles or sides are made of. What is left out is as in `grains`. Where grains meet an obstacle or a side, the
/// latter's material says how they rub and rebound; where grains of two materials meet, it is the geometric mean of both.
/// Springs act one after the other; walls whose material has none are rigid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainMaterial {
    /// Name, for bodies, emitters, colliders, sides and pairs.
    pub name: String,
    /// As `grains.friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub friction: Option<f64>,
    /// As `grains.rolling_friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub rolling_friction: Option<f64>,
    /// As `grains.restitution`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1.0))]
    pub restitution: Option<f64>,
    /// As `grains.cohesion`, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub cohesion: Option<f64>,
    /// As `grains.spring`, N/m, with `linear`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 1e15))]
    pub spring: Option<f64>,
    /// As `grains.young_modulus`, Pa, with `hertz`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1e13))]
    pub young_modulus: Option<f64>,
    /// As `grains.poisson_ratio`, with `hertz`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub poisson_ratio: Option<f64>,
}

/// What holds where two materials meet; what is left out follows from both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialPair {
    /// Names of the two, in any order; `grains` stands for what the keys of `grains` say.
    pub between: [String; 2],
    /// As `grains.friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub friction: Option<f64>,
    /// As `grains.rolling_friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub rolling_friction: Option<f64>,
    /// As `grains.restitution`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1.0))]
    pub restitution: Option<f64>,
    /// As `grains.cohesion`, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub cohesion: Option<f64>,
}

/// How grains push each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactLaw {
    /// Spring and dashpot (Harada 2007, Eq. 9 and 10) with shear and attraction (Green 2012). Give the dashpot as `damping`
    /// or as `restitution`, not both. Grains do not rotate and nothing keeps them from sliding, so heaps flow apart.
    #[default]
    SpringDashpot,
    /// Linear springs and dashpots across and along the contact, the latter under Coulomb's limit (Cundall and Strack 1979).
    /// Give `spring` or `contact_time`, and `restitution`. Grains rotate.
    Linear,
    /// Elastic spheres (Hertz 1882, Mindlin 1949) under Coulomb's limit, from `young_modulus`, `poisson_ratio` and
    /// `restitution`, which holds at all speeds (Tsuji 1992). Grains rotate. 3D only.
    Hertz,
}

/// How rolling is resisted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RollingResistance {
    /// A spring that gives way at the greatest torque, with a dashpot as long as it holds (type C of Ai et al. 2011).
    #[default]
    Spring,
    /// The greatest torque, as long as there is rolling (type A of Ai et al. 2011).
    ConstantTorque,
}

/// Which part of the relative velocity the dashpot resists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Dashpot {
    /// All of it, as Harada 2007, Eq. 10 is written.
    #[default]
    Full,
    /// Its normal part only, as in linear spring-dashpot models of the literature.
    Normal,
}
