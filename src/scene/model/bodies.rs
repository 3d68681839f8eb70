//! What a user writes about bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Coordinates, Rigid};

/// Grains or fluid that are there from the start.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// The space that its particles fill.
    pub shape: Shape,
    /// Velocity at the start, m/s; zero when left out. A particle file's own velocities are added to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Coordinates>,
    /// A flow of known form, added to `velocity`; for fluids.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<Flow>,
    /// Pressure at the start; for fluids whose density follows `continuity` (`dfsph` finds its pressures by itself).
    #[serde(default)]
    pub pressure: StartPressure,
    /// Name of one of `fluid.materials`, the first when left out; or of `grains.materials`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// How its particles stand at the start: on a `lattice` when left out, and `random` where grains are of several sizes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<Arrangement>,
    /// Distance of neighbors on the lattice, metres; a grain's diameter when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub spacing: Option<f64>,
    /// Random displacement of lattice points, as a share of the spacing.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub jitter: f64,
    /// Share of the shape's volume that a random arrangement tries to fill with grains; 0.25 when left out, and 0.5 where they
    /// are of several sizes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 0.5))]
    pub fraction: Option<f64>,
    /// Makes it a rigid body; for grains whose law is `linear` or `hertz`, whose `spacing` in it is between a grain's radius
    /// and its diameter, and for fluids of the solver `dfsph`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rigid: Option<Rigid>,
}

/// How particles stand at the start, or when they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// A square or cubic lattice.
    #[default]
    Lattice,
    /// Random points no nearer than a diameter (random sequential addition), seeded. Grains of several sizes are pushed apart
    /// from random points until none overlap.
    Random,
}

/// A flow with which a fluid begins.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Flow {
    /// Vortices that decay (Taylor and Green 1937), with their pressure; in 3D those of Brachet 1983.
    TaylorGreen {
        /// Fastest speed, m/s.
        #[schemars(range(min = 0.0, max = 1e9))]
        speed: f64,
        /// Distance after which the flow repeats, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        wavelength: f64,
    },
    /// Turns like a rigid body about the z axis through the origin.
    Rotation {
        /// Angular speed, counter-clockwise, rad/s.
        #[schemars(range(min = -1e9, max = 1e9))]
        rate: f64,
    },
    /// Is stretched along y and pressed together along x, from the origin on: velocity (−A x, A y).
    Stretch {
        /// A, 1/s.
        #[schemars(range(min = -1e9, max = 1e9))]
        rate: f64,
    },
    /// A wave that stands, as it passes through its flat surface: crests and troughs over x = 0 and every half wavelength,
    /// over a floor at y = 0.
    StandingWave {
        /// Fastest speed at the surface, m/s.
        #[schemars(range(min = 0.0, max = 1e9))]
        speed: f64,
        /// Metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        wavelength: f64,
        /// Of the fluid, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        depth: f64,
    },
}

/// Pressure of a body at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StartPressure {
    /// That at rest density, and that of the body's `flow`.
    #[default]
    Rest,
    /// Grows with the depth below the body's highest point.
    Hydrostatic,
}

/// The space that a body's particles fill.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A box whose sides follow the axes; a rectangle in 2D.
    Box {
        /// Lower corner, metres.
        min: Coordinates,
        /// Upper corner, metres.
        max: Coordinates,
    },
    /// A ball; a disc in 2D.
    Sphere {
        /// Center, metres.
        center: Coordinates,
        /// Radius, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        radius: f64,
    },
    /// What lies between two circles, filled ring by ring; 2D only.
    Ring {
        /// Center of both circles, metres.
        center: Coordinates,
        /// Radius of the inner circle, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        inner: f64,
        /// Radius of the outer circle, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        outer: f64,
    },
    /// A cylinder in any direction; 3D only.
    Cylinder {
        /// Center of the first end, metres.
        from: Coordinates,
        /// Center of the other end, metres.
        to: Coordinates,
        /// Radius, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        radius: f64,
    },
    /// The inside of a closed triangle mesh (OBJ, PLY, STL); 3D only.
    Mesh {
        /// Path, relative to the scene file.
        file: String,
        /// Size, turn and place of the mesh.
        #[serde(default)]
        placement: Placement,
    },
    /// Particles from a file: PLY, VTP, BGEO, CSV (x, y, z, optional vx, vy, vz, id) or NPY (N×2 or N×3).
    Particles {
        /// Path, relative to the scene file.
        file: String,
        /// Size, turn and place of the particles.
        #[serde(default)]
        placement: Placement,
    },
}

/// Size, turn and place of something read from a file: scaled and stretched, then turned, then moved.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Placement {
    /// Factor on every length of the file; 0.01 reads centimetres.
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub scale: f64,
    /// Three factors along the file's own x, y and z, above zero, besides `scale`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stretch: Option<Coordinates>,
    /// Turns about x, then y, then z, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotate: Option<Coordinates>,
    /// Where it moves after that, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub translate: Option<Coordinates>,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            scale: 1.0,
            stretch: None,
            rotate: None,
            translate: None,
        }
    }
}
