//! Sensors: what they measure, when, and what they write.

mod read;

use glam::Vec3;

pub(super) use read::sensors;

use super::Dimensions;
use super::model::SensorField;

const AXES: [&str; 3] = ["x", "y", "z"];
/// Times at which sensors are sampled that are nearer than this share of the interval are one.
const NEAREST: f64 = 1e-6;

/// What is measured while the scene runs.
#[derive(Debug, Clone, Default)]
pub struct Sensors {
    pub list: Vec<Sensor>,
    /// Seconds between two samples; one with each frame when `None`.
    pub interval: Option<f64>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    pub name: String,
    pub kind: Kind,
}

/// What a sensor measures; local coordinates, metres.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    Point {
        at: Vec3,
        field: SensorField,
    },
    Height {
        from: Vec3,
        to: Vec3,
    },
    /// A rectangle across `axis`, along which `min` and `max` are equal.
    Flux {
        min: Vec3,
        max: Vec3,
        axis: usize,
    },
    Force {
        on: Target,
        /// Torques are about this point.
        about: Vec3,
    },
    /// Layers of equal thickness in a box.
    Profile {
        axis: usize,
        layers: u32,
        field: SensorField,
        min: Vec3,
        max: Vec3,
    },
    Extremes {
        field: SensorField,
        min: Vec3,
        max: Vec3,
    },
}

/// What particles push.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Index of a collider.
    Obstacle(usize),
    /// Axis, and 0 for its lower or 1 for its upper end.
    Side(usize, usize),
}

/// A column of numbers that a sensor writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// What it is, without the sensor's name: `pressure`, `velocity_x`.
    pub name: String,
    /// What shares a chart with it: `pressure`, `velocity`.
    pub quantity: &'static str,
    /// As charts have it: `m/s`.
    pub unit: &'static str,
}

impl Output {
    fn new(name: impl Into<String>, quantity: &'static str, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            quantity,
            unit,
        }
    }

    /// The column's header with the unit at its end, in the words that `stats.jsonl` has: `p1_pressure_pa`.
    pub fn header(&self, sensor: &str) -> String {
        let unit = match self.unit {
            "Pa" => "_pa",
            "kg/m³" => "_kg_per_m3",
            "m/s" => "_m_per_s",
            "m³/s" => "_m3_per_s",
            "m²/s" => "_m2_per_s",
            "kg/s" => "_kg_per_s",
            "kg/(m·s)" => "_kg_per_m_s",
            "N" => "_n",
            "N/m" => "_n_per_m",
            "N·m" => "_n_m",
            "m" => "_m",
            _ => "",
        };
        match sensor {
            "" => format!("{}{unit}", self.name),
            sensor => format!("{sensor}_{}{unit}", self.name),
        }
    }
}

impl SensorField {
    /// Its name and unit, and whether it is a vector.
    pub fn about(self) -> (&'static str, &'static str, bool) {
        match self {
            Self::Pressure => ("pressure", "Pa", false),
            Self::Density => ("density", "kg/m³", false),
            Self::Velocity => ("velocity", "m/s", true),
            Self::Speed => ("speed", "m/s", false),
            Self::Position => ("position", "m", true),
        }
    }

    /// Its numbers per particle in a scene.
    pub fn components(self, dimensions: Dimensions) -> usize {
        match self.about() {
            (_, _, true) => dimensions.count(),
            _ => 1,
        }
    }

    fn outputs(self, prefix: &str, dimensions: Dimensions) -> Vec<Output> {
        let (name, unit, is_vector) = self.about();
        match is_vector {
            true => AXES[..dimensions.count()]
                .iter()
                .map(|axis| Output::new(format!("{prefix}{name}_{axis}"), name, unit))
                .collect(),
            false => vec![Output::new(format!("{prefix}{name}"), name, unit)],
        }
    }
}

impl Sensor {
    /// The columns that it writes. Those of a profile are in a file of their own, with a row for each layer.
    pub fn outputs(&self, dimensions: Dimensions) -> Vec<Output> {
        let flat = dimensions == Dimensions::Two;
        match &self.kind {
            Kind::Point { field, .. } => field.outputs("", dimensions),
            Kind::Height { .. } => vec![Output::new("height", "height", "m")],
            Kind::Flux { .. } => {
                let [volume, mass] = if flat {
                    ["m²/s", "kg/(m·s)"]
                } else {
                    ["m³/s", "kg/s"]
                };
                vec![
                    Output::new("volume_flow", "volume_flow", volume),
                    Output::new("mass_flow", "mass_flow", mass),
                ]
            }
            Kind::Force { .. } => {
                let [force, torque] = if flat { ["N/m", "N"] } else { ["N", "N·m"] };
                let axes = &AXES[..dimensions.count()];
                let forces = axes
                    .iter()
                    .map(|axis| Output::new(format!("force_{axis}"), "force", force));
                let turns = if flat { &AXES[2..] } else { &AXES[..] };
                let torques = turns
                    .iter()
                    .map(|axis| Output::new(format!("torque_{axis}"), "torque", torque));
                forces.chain(torques).collect()
            }
            Kind::Profile { field, .. } => {
                let mut outputs = field.outputs("mean_", dimensions);
                outputs.push(Output::new("particles", "particles", ""));
                outputs
            }
            Kind::Extremes { field, .. } => {
                let mut outputs = field.outputs("lowest_", dimensions);
                outputs.extend(field.outputs("highest_", dimensions));
                outputs.push(Output::new("particles", "particles", ""));
                outputs
            }
        }
    }

    /// Layers of a profile; none of what writes to `sensors.csv`.
    pub fn layers(&self) -> Option<u32> {
        match self.kind {
            Kind::Profile { layers, .. } => Some(layers),
            _ => None,
        }
    }

    /// Whether a run of it needs the particles' forces, which no particle file holds.
    pub fn needs_forces(&self) -> bool {
        matches!(self.kind, Kind::Force { .. })
    }
}

impl Sensors {
    /// Times in (begin, end] at which sensors are sampled, seconds.
    pub fn times(&self, begin: f64, end: f64) -> Vec<f64> {
        if self.list.is_empty() {
            return Vec::new();
        }
        let Some(interval) = self.interval else {
            return vec![end];
        };
        let first = (begin / interval + NEAREST).floor() as u64 + 1;
        let last = (end / interval + NEAREST).floor() as u64;
        (first..=last).map(|k| k as f64 * interval).collect()
    }
}

/// The corners of the layer of this number.
pub fn layer(min: Vec3, max: Vec3, axis: usize, layers: u32, number: u32) -> (Vec3, Vec3) {
    let at = |number: u32| {
        let share = f64::from(number) / f64::from(layers);
        (f64::from(min[axis]) * (1.0 - share) + f64::from(max[axis]) * share) as f32
    };
    let (mut low, mut high) = (min, max);
    low[axis] = at(number);
    high[axis] = at(number + 1);
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_taken_once_each() {
        let of = |interval| Sensors {
            list: vec![Sensor {
                name: "a".into(),
                kind: Kind::Height {
                    from: Vec3::ZERO,
                    to: Vec3::Y,
                },
            }],
            interval,
        };
        assert_eq!(of(None).times(0.1, 0.2), [0.2]);
        assert_eq!(Sensors::default().times(0.0, 1.0), [0.0; 0]);
        let sensors = of(Some(0.03));
        let mut all = Vec::new();
        for frame in 0..30 {
            all.extend(sensors.times(f64::from(frame) / 10.0, f64::from(frame + 1) / 10.0));
        }
        assert_eq!(all.len(), 100);
        assert!(
            all.iter()
                .zip(1..)
                .all(|(time, k)| (time - f64::from(k) * 0.03).abs() < 1e-12)
        );
    }

    #[test]
    fn layers_meet() {
        let (min, max) = (Vec3::new(-0.3, 0.1, 0.0), Vec3::new(0.4, 0.2, 1.0));
        let each: Vec<_> = (0..7).map(|number| layer(min, max, 0, 7, number)).collect();
        assert_eq!((each[0].0, each[6].1), (min, max));
        assert!(
            each.windows(2)
                .all(|pair| pair[0].1.x == pair[1].0.x && pair[0].0.x < pair[0].1.x)
        );
    }
}
