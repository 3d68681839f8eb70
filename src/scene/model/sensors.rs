//! What a user writes about sensors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Axis, Coordinates};

/// Something that is measured while the scene runs.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sensor {
    /// A field at a point of a fluid, interpolated by the fluid's smoothing kernel; exact for fields that are linear in
    /// space where enough particles are around. The pressure is 0 where no fluid is, and other fields are missing there.
    Point {
        /// Name that its columns in `sensors.csv` begin with: letters, digits, `_` and `-`.
        name: String,
        /// The point, metres.
        at: Coordinates,
        /// What is measured.
        #[serde(default)]
        field: SensorField,
    },
    /// Height of a fluid's surface on a line: the way from the line's beginning to the farthest point that is inside of
    /// the fluid. Drops that fly alone do not count.
    Height {
        /// Name that its columns in `sensors.csv` begin with: letters, digits, `_` and `-`.
        name: String,
        /// Where the line begins, metres: a point of the floor, say.
        from: Coordinates,
        /// Where the line ends, metres; at the top of the domain, straight above `from`, when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<Coordinates>,
    },
    /// Volume and mass per second that flow through a rectangle (in 2D through a line, per metre of depth), positive in the
    /// direction of the axis that it stands across. Particles count within two spacings of the rectangle, the nearer the
    /// more.
    Flux {
        /// Name that its columns in `sensors.csv` begin with: letters, digits, `_` and `-`.
        name: String,
        /// Lower corner, metres.
        min: Coordinates,
        /// Upper corner, metres; along one axis it is where the lower corner is.
        max: Coordinates,
    },
    /// Force and torque that the particles exert on an obstacle, or on a side of the domain.
    Force {
        /// Name that its columns in `sensors.csv` begin with: letters, digits, `_` and `-`.
        name: String,
        /// Name of one of `colliders`. Give it or `side`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        obstacle: Option<String>,
        /// Side of the domain. Give it or `obstacle`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        side: Option<Side>,
        /// Point that torques are about, metres; it does not move. The center of the obstacle at the start, or of the side,
        /// when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        about: Option<Coordinates>,
    },
    /// Means over the particles in each of several layers of a box. They are written to a file of their own,
    /// `sensor_NAME.csv`.
    Profile {
        /// Name of the sensor and of its file: letters, digits, `_` and `-`.
        name: String,
        /// Axis that layers follow each other along.
        axis: Axis,
        /// Number of layers, all of the same thickness.
        #[serde(default = "twenty")]
        #[schemars(range(min = 1, max = 10_000))]
        layers: u32,
        /// What is averaged.
        #[serde(default = "velocity")]
        field: SensorField,
        /// Lower corner of the box, metres; the domain's when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        min: Option<Coordinates>,
        /// Upper corner of the box, metres; the domain's when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<Coordinates>,
    },
    /// The lowest and the highest value of the particles in a box, and how many particles these are.
    Extremes {
        /// Name that its columns in `sensors.csv` begin with: letters, digits, `_` and `-`.
        name: String,
        /// What is compared; of a vector, each of its components.
        field: SensorField,
        /// Lower corner of the box, metres; no bound when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        min: Option<Coordinates>,
        /// Upper corner of the box, metres; no bound when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<Coordinates>,
    },
}

impl Sensor {
    pub fn name(&self) -> &str {
        match self {
            Self::Point { name, .. }
            | Self::Height { name, .. }
            | Self::Flux { name, .. }
            | Self::Force { name, .. }
            | Self::Profile { name, .. }
            | Self::Extremes { name, .. } => name,
        }
    }
}

fn twenty() -> u32 {
    20
}

fn velocity() -> SensorField {
    SensorField::Velocity
}

/// What particles have that sensors can measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SensorField {
    /// Pressure of a fluid, Pa.
    #[default]
    Pressure,
    /// Density of a fluid, kg/m³.
    Density,
    /// Velocity, m/s; a column for each axis.
    Velocity,
    /// Magnitude of the velocity, m/s.
    Speed,
    /// Where particles are, metres; a column for each axis. For `extremes`.
    Position,
}

/// A side of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At the lower end of x.
    XMin,
    /// At the upper end of x.
    XMax,
    /// At the lower end of y: the floor.
    YMin,
    /// At the upper end of y.
    YMax,
    /// At the lower end of z.
    ZMin,
    /// At the upper end of z.
    ZMax,
}

impl Side {
    /// Number of its axis, and 0 for the lower and 1 for the upper end.
    pub fn place(self) -> (usize, usize) {
        match self {
            Self::XMin => (0, 0),
            Self::XMax => (0, 1),
            Self::YMin => (1, 0),
            Self::YMax => (1, 1),
            Self::ZMin => (2, 0),
            Self::ZMax => (2, 1),
        }
    }
}
