//! What a user writes about obstacles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Coordinates, Placement};

/// An obstacle. Grains meet it with the same contact law as each other; a fluid, as it meets walls.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// Name, for events that move it.
    #[serde(default)]
    pub name: String,
    /// The space that it takes.
    pub shape: ColliderShape,
    /// Motion from point to point; before the first and after the last point it rests.
    #[serde(default)]
    pub path: Vec<PathPoint>,
    /// How it moves between the points of its path.
    #[serde(default, skip_serializing_if = "Interpolation::is_linear")]
    pub interpolation: Interpolation,
    /// A motion to and fro, on top of what its path does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oscillation: Option<Oscillation>,
    /// How its surface turns while the shape stays where it is, rad/s, counter-clockwise: of a sphere about its center (about z
    /// in 3D), of a cylinder about its axis, as seen from its end `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub spin: Option<f64>,
    /// Name of one of `grains.materials`; with fluids it has no effect and is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Color in pictures, `#rrggbb`.
    #[serde(default = "steel")]
    pub color: String,
    /// Whether frames show it.
    #[serde(default = "yes")]
    pub visible: bool,
}

fn steel() -> String {
    "#8a8f98".into()
}
pub(super) fn yes() -> bool {
    true
}

/// The space that an obstacle takes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ColliderShape {
    /// Solid on the side that the normal points away from.
    Plane {
        /// A point of the plane, metres.
        point: Coordinates,
        /// Direction out of the solid, of any length.
        normal: Coordinates,
    },
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
        /// Solid outside instead of inside: a round vessel.
        #[serde(default)]
        hollow: bool,
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
        /// Solid outside instead of inside: a tube or drum, which goes on without end in both directions. Pictures show it
        /// from `from` to `to`.
        #[serde(default)]
        hollow: bool,
    },
    /// A closed triangle mesh (OBJ, PLY, STL); 3D only.
    Mesh {
        /// Path, relative to the scene file.
        file: String,
        /// Size, turn and place of the mesh.
        #[serde(default)]
        placement: Placement,
    },
}

/// Where a collider is at a time.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathPoint {
    /// When, seconds.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub at: f64,
    /// Way from where the collider's shape places it, metres.
    pub offset: Coordinates,
}

/// How a collider moves between the points of its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Along straight lines at a constant speed.
    #[default]
    Linear,
    /// Along a cubic spline through the points, whose velocity and acceleration are continuous; it begins and ends at rest.
    Spline,
}

impl Interpolation {
    fn is_linear(&self) -> bool {
        *self == Self::Linear
    }
}

/// A sine in time: at time t the collider is shifted by amplitude × sin(2π t / period + phase).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Oscillation {
    /// Farthest shift to one side, metres.
    pub amplitude: Coordinates,
    /// Seconds of one motion to and fro.
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub period: f64,
    /// Angle that the sine begins with, degrees; at 90 the collider begins at rest, farthest to one side.
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub phase: f64,
}
