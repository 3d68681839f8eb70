//! Sensors as the scene file has them, checked and in local coordinates.

use glam::{DVec3, Vec3};

use super::{Kind, Sensor, Sensors, Target};
use crate::scene::frame::{Frame, Report};
use crate::scene::model::{self, Axis, Coordinates, SceneFile, SensorField, Side, Wall};
use crate::scene::text::{list, number, suggest};
use crate::scene::{Collider, ColliderShape, Dimensions};

/// A box that has no bound ends here, metres.
const FAR: f64 = 1e30;

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
            ColliderShape::Cylinder { from, to, .. } => from.midpoint(*to),
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
