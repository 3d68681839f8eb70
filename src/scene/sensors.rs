//! Sensors: from the scene file to local coordinates, and what they write.

use glam::{DVec3, Vec3};

use super::frame::{Frame, Report};
use super::model::{self, Axis, Coordinates, SceneFile, SensorField, Side, Wall};
use super::text::{list, number, suggest};
use super::{Collider, ColliderShape, Dimensions};

const AXES: [&str; 3] = ["x", "y", "z"];
/// A box that has no bound ends here, metres.
const FAR: f64 = 1e30;
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

/// All sensors of a scene.
pub fn sensors(file: &SceneFile, frame: &Frame, colliders: &[Collider], report: &mut Report) -> Sensors {
    if file.sensors.is_empty() && file.time.sensor_interval.is_some() {
        let note = "time.sensor_interval has no effect: the scene has no sensors";
        report.notes.push(note.into());
    }
    let mut list = Vec::new();
    for (i, given) in file.sensors.iter().enumerate() {
        let path = format!("sensors[{i}]");
        check_name(&path, given.name(), &file.sensors[..i], report);
        let reader = Reader {
            path: &path,
            file,
            frame,
            colliders,
        };
        if let Some(kind) = reader.kind(given, report) {
            list.push(Sensor {
                name: given.name().to_owned(),
                kind,
            });
        }
    }
    Sensors {
        list,
        interval: file.time.sensor_interval,
    }
}

fn check_name(path: &str, name: &str, before: &[model::Sensor], report: &mut Report) {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(fits) {
        report.problem(
            format!("{path}.name"),
            format!("\"{name}\" cannot begin a column's name"),
            "use letters from a to z, digits, `_` and `-`",
        );
    }
    if let Some(twin) = before.iter().position(|other| other.name() == name) {
        report.problem(
            format!("{path}.name"),
            format!("sensors[{twin}] has the same name"),
            "give each sensor its own",
        );
    }
}

struct Reader<'a> {
    path: &'a str,
    file: &'a SceneFile,
    frame: &'a Frame,
    colliders: &'a [Collider],
}

impl Reader<'_> {
    /// `None` where it is refused.
    fn kind(&self, given: &model::Sensor, report: &mut Report) -> Option<Kind> {
        let before = report.problems.len();
        let kind = match given {
            model::Sensor::Point { at, field, .. } => {
                self.need_fluid("interpolated between particles", report);
                self.check_field(*field, report);
                if *field == SensorField::Position {
                    report.problem(
                        format!("{}.field", self.path),
                        "a point has no position that changes",
                        "choose `pressure`, `density`, `velocity` or `speed`",
                    );
                }
                Some(Kind::Point {
                    at: self.inside("at", at, report).as_vec3(),
                    field: *field,
                })
            }
            model::Sensor::Height { from, to, .. } => {
                self.need_fluid("asked where their surface is", report);
                let from = self.inside("from", from, report);
                let to = match to {
                    Some(to) => self.inside("to", to, report),
                    None => DVec3::new(from.x, self.frame.max.y, from.z),
                };
                if from.distance(to) < self.file.radius() {
                    report.problem(
                        self.path,
                        format!("the line is {} m long", number(from.distance(to))),
                        "move `from` and `to` apart",
                    );
                }
                Some(Kind::Height {
                    from: from.as_vec3(),
                    to: to.as_vec3(),
                })
            }
            model::Sensor::Flux { min, max, .. } => self.flux(min, max, report),
            model::Sensor::Force {
                obstacle,
                side,
                about,
                ..
            } => self.force(obstacle.as_deref(), *side, about.as_ref(), report),
            model::Sensor::Profile {
                axis,
                layers,
                field,
                min,
                max,
                ..
            } => {
                let axis = *axis as usize;
                if axis >= self.frame.dimensions.count() {
                    report.problem(
                        format!("{}.axis", self.path),
                        "a 2D scene has no z axis",
                        "layer along `x` or `y`",
                    );
                }
                self.check_field(*field, report);
                let bounds = (self.frame.min, self.frame.max);
                let (min, max) = self.corners(min.as_ref(), max.as_ref(), bounds, report);
                Some(Kind::Profile {
                    axis,
                    layers: *layers,
                    field: *field,
                    min: min.as_vec3(),
                    max: max.as_vec3(),
                })
            }
            model::Sensor::Extremes { field, min, max, .. } => {
                self.check_field(*field, report);
                let bounds = (DVec3::splat(-FAR), DVec3::splat(FAR));
                let (min, max) = self.corners(min.as_ref(), max.as_ref(), bounds, report);
                Some(Kind::Extremes {
                    field: *field,
                    min: min.as_vec3(),
                    max: max.as_vec3(),
                })
            }
        };
        kind.filter(|_| report.problems.len() == before)
    }

    fn need_fluid(&self, what: &str, report: &mut Report) {
        if self.file.grains.is_some() {
            report.problem(
                self.path,
                format!("grains cannot be {what}"),
                "choose the kind `flux`, `force`, `profile` or `extremes`",
            );
        }
    }

    fn check_field(&self, field: SensorField, report: &mut Report) {
        let of_fluids = matches!(field, SensorField::Pressure | SensorField::Density);
        if of_fluids && self.file.grains.is_some() {
            report.problem(
                format!("{}.field", self.path),
                format!("grains have no {} as a fluid has", field.about().0),
                "choose `velocity`, `speed` or `position`; forces have the kind `force`",
            );
        }
    }

    /// A point of the domain, in local coordinates.
    fn inside(&self, key: &str, given: &Coordinates, report: &mut Report) -> DVec3 {
        let path = format!("{}.{key}", self.path);
        let point = report.vector(&path, given, self.frame.dimensions);
        let local = self.frame.local(point);
        for (axis, name) in self.frame.axes() {
            let (low, high) = (self.frame.min[axis], self.frame.max[axis]);
            if !(low..=high).contains(&local[axis]) {
                let zero = self.frame.origin[axis];
                report.problem(
                    &path,
                    format!("{name} = {} m lies outside of the domain", number(point[axis])),
                    format!(
                        "choose {name} from {} to {} m",
                        number(low + zero),
                        number(high + zero)
                    ),
                );
            }
        }
        local
    }

    /// A box in local coordinates; `bounds` where a corner is left out, and in 2D along z.
    fn corners(
        &self,
        min: Option<&Coordinates>,
        max: Option<&Coordinates>,
        bounds: (DVec3, DVec3),
        report: &mut Report,
    ) -> (DVec3, DVec3) {
        let mut corner = |key: &str, given: Option<&Coordinates>, bound: DVec3| match given {
            None => bound,
            Some(given) => {
                let place = format!("{}.{key}", self.path);
                let point = report.vector(&place, given, self.frame.dimensions);
                self.frame.local(point)
            }
        };
        let (mut low, mut high) = (corner("min", min, bounds.0), corner("max", max, bounds.1));
        if self.frame.dimensions == Dimensions::Two {
            (low.z, high.z) = (-FAR, FAR);
        }
        let empty = self.frame.axes().find(|(axis, _)| low[*axis] >= high[*axis]);
        if let Some((_, name)) = empty {
            report.problem(
                self.path,
                format!("the box is empty: min is not below max along {name}"),
                "swap them, or move one",
            );
        }
        (low, high)
    }

    fn flux(&self, min: &Coordinates, max: &Coordinates, report: &mut Report) -> Option<Kind> {
        let low = self.inside("min", min, report);
        let high = self.inside("max", max, report);
        let flat: Vec<usize> = self
            .frame
            .axes()
            .map(|(axis, _)| axis)
            .filter(|&axis| low[axis] == high[axis])
            .collect();
        let wrong = self.frame.axes().find(|(axis, _)| low[*axis] > high[*axis]);
        if let Some((_, name)) = wrong {
            report.problem(
                self.path,
                format!("min is not below max along {name}"),
                "swap them, or move one",
            );
            return None;
        }
        let shape = match self.frame.dimensions {
            Dimensions::Two => "a line",
            Dimensions::Three => "a rectangle",
        };
        let help = format!(
            "make min and max equal along one axis, and along no other: {shape} stands across an axis"
        );
        match flat[..] {
            [axis] => Some(Kind::Flux {
                min: low.as_vec3(),
                max: high.as_vec3(),
                axis,
            }),
            [] => {
                report.problem(
                    self.path,
                    format!("min and max are corners of a box, not of {shape}"),
                    help,
                );
                None
            }
            _ => {
                report.problem(self.path, format!("{shape} from min to max has no extent"), help);
                None
            }
        }
    }

    fn force(
        &self,
        obstacle: Option<&str>,
        side: Option<Side>,
        about: Option<&Coordinates>,
        report: &mut Report,
    ) -> Option<Kind> {
        let (on, usual) = match (obstacle, side) {
            (Some(name), None) => self.obstacle(name, report)?,
            (None, Some(side)) => self.side(side, report)?,
            _ => {
                let wrong = match obstacle {
                    Some(_) => "both `obstacle` and `side` are given",
                    None => "neither `obstacle` nor `side` is given",
                };
                report.problem(self.path, wrong, "say what the force acts on with one of them");
                return None;
            }
        };
        let about = match about {
            None => usual,
            Some(about) => {
                let path = format!("{}.about", self.path);
                let point = report.vector(&path, about, self.frame.dimensions);
                self.frame.local(point).as_vec3()
            }
        };
        Some(Kind::Force { on, about })
    }

    /// A collider, and its center at the start.
    fn obstacle(&self, name: &str, report: &mut Report) -> Option<(Target, Vec3)> {
        let names = self.file.colliders.iter().map(|collider| collider.name.as_str());
        let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
        if !names.contains(&name) {
            let help = match names[..] {
                [] => "give the obstacle in `colliders` a `name`".to_owned(),
                _ => suggest(name, names.iter().copied()),
            };
            report.problem(
                format!("{}.obstacle", self.path),
                format!("there is no obstacle \"{name}\""),
                help,
            );
            return None;
        }
        // A collider that is missing for its own mistake is told there.
        let index = self.colliders.iter().position(|collider| collider.name == name)?;
        let collider = &self.colliders[index];
        let offset = collider.path.first().map_or(Vec3::ZERO, |(_, offset)| *offset);
        let center = match &collider.shape {
            ColliderShape::Plane { point, .. } => *point,
            ColliderShape::Box { min, max } => (*min + *max) * 0.5,
            ColliderShape::Sphere { center, .. } => *center,
            ColliderShape::Mesh(mesh) => {
                let (low, high) = mesh.bounds();
                ((low + high) * 0.5).as_vec3()
            }
        };
        Some((Target::Obstacle(index), center + offset))
    }

    /// A side of the domain, and its center.
    fn side(&self, side: Side, report: &mut Report) -> Option<(Target, Vec3)> {
        let (axis, end) = side.place();
        if axis >= self.frame.dimensions.count() {
            report.problem(
                format!("{}.side", self.path),
                "a 2D scene has no z sides",
                format!("choose {}", list(["x_min", "x_max", "y_min", "y_max"])),
            );
            return None;
        }
        let wall = self.frame.sides[axis][end];
        let (what, instead) = match wall {
            Wall::Contact | Wall::Particles | Wall::Planes => ("", ""),
            Wall::Clamp => ("sets particles back without a force", "`contact`"),
            Wall::Open => ("is open", "`contact`, `particles` or `planes`"),
            Wall::Periodic => ("is periodic", "`particles` or `planes`"),
        };
        if !what.is_empty() {
            report.problem(
                format!("{}.side", self.path),
                format!("this side {what}, so nothing pushes it"),
                format!("choose another side, or make it {instead} in domain.sides"),
            );
            return None;
        }
        let mut center = (self.frame.min + self.frame.max) * 0.5;
        center[axis] = if end == 0 {
            self.frame.min[axis]
        } else {
            self.frame.max[axis]
        };
        Some((Target::Side(axis, end), center.as_vec3()))
    }
}

/// Number of an axis: x, y, z.
const _: () = assert!(Axis::X as usize == 0 && Axis::Y as usize == 1 && Axis::Z as usize == 2);

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
