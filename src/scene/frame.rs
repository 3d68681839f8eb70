//! The scene's frame of reference: dimensions, origin, domain; and the problems and notes gathered on the way.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::allowance::Allowance;
use super::model::{Coordinates, SceneFile, Wall};
use super::text::number;
use super::{Dimensions, Domain};
use crate::error::Problem;

/// Metres; and the bound of velocities, m/s. Far beyond it, f32 cannot hold the square of a number.
pub const LARGEST_COORDINATE: f64 = 1e9;

/// Share of a particle's radius by which f32 may round its coordinates before that is told, and before it is refused.
const TOLD_ROUNDING: f64 = 1e-3;
const MOST_ROUNDING: f64 = 0.1;

/// What validation found so far.
#[derive(Default)]
pub struct Report {
    pub problems: Vec<Problem>,
    pub notes: Vec<String>,
    pub allowance: Allowance,
    /// Bytes that were asked for so far.
    taken: f64,
}

impl Report {
    pub fn new(allowance: Allowance) -> Self {
        Self {
            allowance,
            ..Self::default()
        }
    }

    /// Whether `count` particles may be placed, which are then counted; a problem at `path` where they are too many.
    /// `says` comes before their number and `what` behind it; `help` says how to make them fewer.
    pub fn room_for(&mut self, path: &str, says: &str, count: f64, what: &str, help: &str) -> bool {
        let most = self.allowance.particles;
        if count > most as f64 || count.is_nan() {
            self.problem(
                path,
                format!("{says} {} {what}", number(count)),
                format!("{help}: at most {most} {what}"),
            );
            return false;
        }
        let says = format!("{says} {} {what}", number(count));
        self.memory_for(path, &says, Allowance::bytes_of(count), help)
    }

    /// Whether so many bytes of memory may be taken, which are then counted; a problem at `path` where not.
    pub fn memory_for(&mut self, path: &str, says: &str, bytes: f64, help: &str) -> bool {
        let (all, most) = (self.taken + bytes, self.allowance.memory as f64);
        if all > most || all.is_nan() {
            self.problem(
                path,
                format!(
                    "{says}, and with that the scene takes about {} MB of memory",
                    number((all / 1e6).ceil())
                ),
                format!(
                    "{help}, or allow more than {} MB with --max-memory",
                    number((most / 1e6).floor())
                ),
            );
            return false;
        }
        self.taken = all;
        true
    }

    /// The path of a file that a scene in `folder` names; a problem, and `None`, where it may not be read.
    pub fn file(&mut self, path: &str, folder: &Path, file: &str) -> Option<PathBuf> {
        let found = folder.join(file);
        if self.allowance.reads(&found, folder) {
            return Some(found);
        }
        let real = found.canonicalize().unwrap_or_else(|_| found.clone());
        self.problem(
            path,
            format!("{file} lies outside of the scene's folder"),
            format!(
                "put it into that folder, or allow this one with --allow-read {}",
                real.parent().unwrap_or(Path::new("/")).display()
            ),
        );
        None
    }

    pub fn problem(&mut self, path: impl Into<String>, what: impl Into<String>, help: impl Into<String>) {
        self.problems.push(Problem::new(path, what, help));
    }

    /// A point or vector with as many numbers as the scene has dimensions; a 2D scene may give z as 0.
    pub fn vector(&mut self, path: &str, given: &Coordinates, dimensions: Dimensions) -> DVec3 {
        let numbers = &given.0;
        let z = numbers.get(2).copied().unwrap_or(0.0);
        match dimensions {
            Dimensions::Three if numbers.len() != 3 => self.problem(
                path,
                format!("{} numbers in a 3D scene", numbers.len()),
                "give x, y and z, or set `dimensions` to 2",
            ),
            Dimensions::Two if z != 0.0 => self.problem(
                path,
                format!("z is {} in a 2D scene", number(z)),
                "leave z out, or set `dimensions` to 3",
            ),
            _ => {}
        }
        if let Some(far) = numbers.iter().find(|x| x.abs() > LARGEST_COORDINATE) {
            self.problem(
                path,
                format!("{} is too large", number(*far)),
                format!("give numbers between -{0} and {0}", number(LARGEST_COORDINATE)),
            );
        }
        DVec3::new(numbers[0], numbers[1], z)
    }

    /// A vector that may be left out: zero then.
    pub fn optional(&mut self, path: &str, given: Option<&Coordinates>, dimensions: Dimensions) -> DVec3 {
        given.map_or(DVec3::ZERO, |given| self.vector(path, given, dimensions))
    }
}

/// The domain and the local coordinates that have their zero at its center.
pub struct Frame {
    pub dimensions: Dimensions,
    /// In the scene's coordinates, metres.
    pub origin: DVec3,
    /// Local corners, metres.
    pub min: DVec3,
    pub max: DVec3,
    pub sides: [[Wall; 2]; 3],
    /// Steps of the decimal grid that local coordinates are snapped to, 1/m.
    quanta_per_metre: f64,
}

impl Frame {
    /// Whether a local point is nearer than `reach` (metres) to a side that is a plane.
    pub fn beside_planes(&self, at: DVec3, reach: f64) -> bool {
        (0..3).any(|axis| {
            let [low, high] = self.sides[axis].map(|side| side == Wall::Planes);
            low && at[axis] - self.min[axis] < reach || high && self.max[axis] - at[axis] < reach
        })
    }

    pub fn new(file: &SceneFile, report: &mut Report) -> Self {
        let dimensions = match file.dimensions {
            2 => Dimensions::Two,
            _ => Dimensions::Three,
        };
        match (&file.grains, &file.fluid) {
            (None, None) => report.problem(
                "",
                "the scene has neither `grains` nor a `fluid`",
                "say what the particles are: add one of them",
            ),
            (Some(_), Some(_)) => report.problem(
                "fluid",
                "the scene has `grains` too, and both cannot be in one scene",
                "remove one of them",
            ),
            _ => {}
        }
        let low = report.vector("domain.min", &file.domain.min, dimensions);
        let high = report.vector("domain.max", &file.domain.max, dimensions);
        let diameter = 2.0 * file.radius();
        for (axis, name) in AXES.iter().enumerate().take(dimensions.count()) {
            let width = high[axis] - low[axis];
            if width <= 0.0 {
                report.problem(
                    "domain",
                    format!(
                        "min {} is not below max {} along {name}",
                        number(low[axis]),
                        number(high[axis])
                    ),
                    "swap them, or move one",
                );
            } else if width < 2.0 * diameter * (1.0 - 1e-9) {
                report.problem(
                    "domain",
                    format!(
                        "{} m wide along {name}, less than two particle diameters",
                        number(width)
                    ),
                    format!(
                        "make it at least {} m wide, or the particles smaller",
                        number(2.0 * diameter)
                    ),
                );
            }
        }
        let mut frame = Self {
            dimensions,
            origin: (low + high) / 2.0,
            min: DVec3::ZERO,
            max: DVec3::ZERO,
            sides: sides(file, dimensions, report),
            quanta_per_metre: 10f64.powi(7 - file.radius().log10().floor() as i32),
        };
        frame.min = frame.local(low);
        frame.max = frame.local(high);
        frame.check_precision(file.smallest_radius(), report);
        frame
    }

    /// f32 has 24 digits, counted from the domain's center.
    fn check_precision(&self, radius: f64, report: &mut Report) {
        let half_width = self.axes().map(|(axis, _)| self.max[axis]).fold(0.0, f64::max);
        let rounding = half_width * f64::from(f32::EPSILON) / 2.0;
        if rounding > TOLD_ROUNDING * radius {
            let what = format!(
                "single precision rounds coordinates at the domain's ends by up to {} m, {} of a particle's radius",
                number(rounding),
                number(rounding / radius)
            );
            let most = |share: f64| number(4.0 * share * radius / f64::from(f32::EPSILON));
            if rounding > MOST_ROUNDING * radius {
                report.problem(
                    "domain",
                    what,
                    format!(
                        "make it at most {} m wide (at most {} m for results that rounding leaves alone), or the \
                         particles larger",
                        most(MOST_ROUNDING),
                        most(TOLD_ROUNDING)
                    ),
                );
            } else {
                report.notes.push(format!(
                    "domain: {what}; up to {} m wide it is less",
                    most(TOLD_ROUNDING)
                ));
            }
        }
    }

    /// Local coordinates of a point of the scene.
    pub fn local(&self, point: DVec3) -> DVec3 {
        self.snap(point - self.origin)
    }

    /// Local coordinates, rounded to a ten-millionth of the radius' decade, so that a scene moved by a million metres
    /// gives the same numbers: what f64 lost by the move is smaller than half a quantum.
    pub fn snap(&self, local: DVec3) -> DVec3 {
        (local * self.quanta_per_metre).round() / self.quanta_per_metre
    }

    pub fn domain(&self, restitution: f64) -> Domain {
        Domain {
            min: self.min.as_vec3(),
            max: self.max.as_vec3(),
            sides: self.sides,
            restitution: restitution as f32,
            materials: Default::default(),
        }
    }

    /// Names of the axes that the scene has.
    pub fn axes(&self) -> impl Iterator<Item = (usize, &'static str)> {
        AXES.into_iter().enumerate().take(self.dimensions.count())
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

fn sides(file: &SceneFile, dimensions: Dimensions, report: &mut Report) -> [[Wall; 2]; 3] {
    let named = &file.domain.sides;
    if dimensions == Dimensions::Two && (named.z_min.is_some() || named.z_max.is_some()) {
        report.problem(
            "domain.sides",
            "a 2D scene has no z sides",
            "remove `z_min` and `z_max`",
        );
    }
    let usual = match file.fluid {
        Some(_) => Wall::Particles,
        None => Wall::Contact,
    };
    let or_all = |side: Option<Wall>| side.or(file.domain.walls).unwrap_or(usual);
    let mut sides = [
        [or_all(named.x_min), or_all(named.x_max)],
        [or_all(named.y_min), or_all(named.y_max)],
        [or_all(named.z_min), or_all(named.z_max)],
    ];
    for (axis, sides) in sides.iter_mut().enumerate() {
        if axis >= dimensions.count() {
            // Nothing moves along z in 2D.
            *sides = sides.map(|side| if side == Wall::Open { side } else { usual });
            continue;
        }
        for (end, &side) in ["min", "max"].iter().zip(&*sides) {
            let of_grains = matches!(side, Wall::Contact | Wall::Clamp);
            let of_fluids = matches!(side, Wall::Particles | Wall::Planes | Wall::Periodic);
            if of_grains && file.fluid.is_some() || of_fluids && file.grains.is_some() {
                let (matter, help) = match file.fluid {
                    Some(_) => ("a fluid", "choose `particles`, `planes`, `open` or `periodic`"),
                    None => ("grains", "choose `contact`, `clamp` or `open`"),
                };
                report.problem(
                    format!("domain.sides.{}_{end}", AXES[axis]),
                    format!("{matter} cannot have this kind of wall"),
                    help,
                );
            }
        }
        if (sides[0] == Wall::Periodic) != (sides[1] == Wall::Periodic) {
            report.problem(
                "domain.sides",
                format!("only one of the two {} sides is periodic", AXES[axis]),
                "make both periodic, or none",
            );
        }
    }
    sides
}
