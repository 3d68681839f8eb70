//! A fluid with its numbers completed.

use std::f64::consts::PI;

use glam::DVec3;

use super::floating;
use super::frame::{Frame, Report};
use super::model::{
    self, DensityFrom, FluidSolver, Integrator, Kernel, NegativePressure, PressureForce, SceneFile, Slip,
    ViscosityForm,
};
use super::rigid::RigidBody;
use super::text::{number, suggest};
use super::{Dimensions, Particles, StepLimits};

/// Sound travels so much faster than the fastest expected flow: density then varies by about 1 % (Monaghan 1994).
const SOUND_OVER_FLOW: f64 = 10.0;
/// Support over spacing, in 2D and in 3D.
const USUAL_SUPPORT: [f64; 2] = [3.0, 2.6];
/// The same of `wcsph` in 3D with Wendland's C2 kernel, `continuity` and no surface tension, whose curvature needs more neighbors:
/// on a lattice gradients are off by 0.1 % with 32 neighbors, where 2.6 spacings have 80 and are off by 2 %.
const NEAR_SUPPORT: f64 = 2.2;
/// Of `dfsph`: a lattice at rest then has rest density, and one layer of boundary particles is as deep as the kernel sees.
const INCOMPRESSIBLE_SUPPORT: f64 = 2.0;
/// Strength of particle shifting of fluids in flight. The elliptical drop's axes are 0.1 % farther off with 1; with 0 its
/// particles come as near as 0.2 spacings.
const USUAL_SHIFTING: f64 = 0.5;
/// Share of the smoothing length that motion and sound together go in a step of `wcsph`. Sound waves on a lattice are stable up to
/// 1.5 (`src/study/stability/theory.rs`); half of that leaves room for particles as uneven as splashes make them. Errors of still
/// water, a dam's front and a standing wave are the same with 0.25.
const SOUND_SHARE: f64 = 0.75;
/// The same of `sph`, whose kernel of pressure is steep near zero, and where gradients are corrected or particles shifted: errors in
/// space are then so small that those of longer steps show (Taylor–Green vortices at 25²: 0.52 %, and 0.76 % with 0.5).
const FINE_SOUND_SHARE: f64 = 0.25;
/// Courant numbers of the time step's other limits (Morris 1997).
const VISCOUS_SHARE: f64 = 0.125;
const FORCE_SHARE: f64 = 0.25;
const CAPILLARY_SHARE: f64 = 0.25;
/// Viscosity of `dfsph` is implicit where it would make explicit steps shorter than this share of those that all else allows. A
/// loop costs about as much as one more step.
const EXPLICIT_SHARE: f64 = 0.5;
/// Share of the spacing that weight alone may press an incompressible fluid together in a step.
const INCOMPRESSIBLE_FALL: f64 = 0.01;
/// Names of the limits that change with the flow.
const SOUND: &str = "speed of sound";
const MOTION: &str = "motion";
const GRAVITY: &str = "gravity";

/// A weakly compressible fluid; SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Fluid {
    pub solver: FluidSolver,
    /// The longest step with which rigid bodies lie firmly on each other, seconds.
    pub contact_step: f64,
    /// Whether rigid bodies are in it.
    pub has_bodies: bool,
    /// Of particles at rest, metres.
    pub spacing: f64,
    /// At least one; particles carry an index into it where there are several.
    pub materials: Vec<Material>,
    pub kernel: Kernel,
    /// Where the kernel ends, metres: the search radius.
    pub support: f64,
    /// m/s.
    pub max_speed: f64,
    pub sound_speed: f64,
    pub gamma: u32,
    /// Of `dfsph`: at which its loops stop, and most iterations of each.
    pub max_density_error: f64,
    pub max_divergence_error: f64,
    pub max_viscosity_error: f64,
    pub max_iterations: u32,
    /// Of `dfsph`: whether a loop finds what viscosity does in a step, whatever the step's length.
    pub implicit_viscosity: bool,
    /// Of `dfsph`: share of the spacing that the fastest particle moves in a step.
    pub courant_number: f64,
    /// Of `dfsph`: longest step with which pressure holds fluid at rest, s.
    pub rest_step: f64,
    /// Pa.
    pub background_pressure: f64,
    pub density_from: DensityFrom,
    pub density_diffusion: f64,
    pub pressure_force: PressureForce,
    pub negative_pressure: NegativePressure,
    pub gradient_correction: bool,
    pub shifting: f64,
    pub artificial_viscosity: f64,
    /// Fanning's factor of walls that slip.
    pub wall_friction: f64,
    pub viscosity_form: ViscosityForm,
    /// Whether it has one, at its start or where more fluid comes in.
    pub free_surface: bool,
    pub slip: Slip,
    /// Degrees.
    pub contact_angle: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// At rest, kg/m³.
    pub density: f64,
    /// Dynamic, Pa·s.
    pub viscosity: f64,
    /// N/m.
    pub surface_tension: f64,
}

impl Kernel {
    /// Where it ends, as a multiple of its smoothing length.
    pub fn reach(self) -> f64 {
        match self {
            Self::CubicSpline | Self::WendlandC2 | Self::WendlandC4 => 2.0,
            Self::QuinticSpline => 3.0,
            Self::Muller => 1.0,
        }
    }
}

/// What a fluid's speeds are derived from.
pub struct Speeds<'a> {
    /// Local positions and velocities at the start.
    pub particles: &'a Particles,
    pub gravity: DVec3,
    /// Rigid bodies in the fluid.
    pub bodies: &'a [RigidBody],
    /// Fastest wall, obstacle or emitter, m/s.
    pub walls: f64,
    /// The greatest surface tension that events set, N/m.
    pub later_tension: f64,
}

/// Spacings that fluid which falls from the surface to the floor may cross in a step of `dfsph`, however slow the scene says that
/// it is: longer steps are too long for the pressure of fluid at rest. Columns of 50 particles were at rest with 0.64, had a flaw
/// with 0.70, and exploded with 0.77.
const MOST_OF_FALL: f64 = 0.57;

impl Fluid {
    pub fn new(given: &model::Fluid, frame: &Frame, speeds: &Speeds, report: &mut Report) -> Self {
        let fall_speed = expected_speed(frame, speeds);
        let max_speed = given.max_speed.unwrap_or(fall_speed);
        let ripple = ripple_speed(given, speeds.later_tension);
        let sound_speed = given
            .sound_speed
            .unwrap_or(SOUND_OVER_FLOW * max_speed.max(ripple));
        if max_speed <= 0.0 && given.sound_speed.is_none() {
            report.problem(
                "fluid",
                "nothing in the scene says how fast the fluid will be",
                "give `max_speed`, m/s",
            );
        }
        let compressible = given.solver != FluidSolver::Dfsph;
        if ripple > 0.0 && given.negative_pressure == NegativePressure::Clamp {
            report.notes.push(
                "surface tension cannot hold drops together while pressure is clamped: set fluid.negative_pressure to \
                 `keep`"
                    .into(),
            );
        }
        if sound_speed < 5.0 * ripple {
            report.notes.push(format!(
                "fluid.sound_speed {} m/s is less than five times the {} m/s of waves as short as the spacing: surface \
                 tension will press particles together",
                number(sound_speed),
                number(ripple)
            ));
        }
        if !compressible
            && frame
                .sides
                .iter()
                .flatten()
                .any(|&side| side == model::Wall::Planes)
        {
            report.problem(
                "domain.walls",
                "the solver `dfsph` has no walls of `planes`",
                "choose `particles`, or set fluid.solver to `wcsph`",
            );
        }
        let kernel = given.kernel.unwrap_or(match given.solver {
            FluidSolver::Sph => Kernel::Muller,
            FluidSolver::Wcsph => Kernel::default(),
            FluidSolver::Dfsph => Kernel::WendlandC2,
        });
        let density_from = given.density_from.unwrap_or(match given.solver {
            FluidSolver::Sph | FluidSolver::Dfsph => DensityFrom::Summation,
            FluidSolver::Wcsph => DensityFrom::Continuity,
        });
        let usual = match density_from {
            DensityFrom::Summation => 0.0,
            DensityFrom::Continuity => 0.1,
        };
        if density_from == DensityFrom::Summation && given.density_diffusion.is_some_and(|d| d > 0.0) {
            report.problem(
                "fluid.density_diffusion",
                "density comes from a summation, which has no diffusion",
                "leave it out, or set fluid.density_from to `continuity`",
            );
        }
        if kernel == Kernel::Muller && density_from == DensityFrom::Continuity {
            report.problem(
                "fluid.kernel",
                "`muller` has one kernel for density and another for forces, which `continuity` cannot use",
                "choose another kernel, or set fluid.density_from to `summation`",
            );
        }
        let support = given.support.unwrap_or_else(|| {
            usual_support(frame.dimensions, given.solver, kernel, density_from, ripple > 0.0)
        });
        let materials = match &given.materials[..] {
            [] => vec![Material {
                density: given.density,
                viscosity: given.viscosity,
                surface_tension: given.surface_tension,
            }],
            several => several
                .iter()
                .map(|m| Material {
                    density: m.density,
                    viscosity: m.viscosity,
                    surface_tension: m.surface_tension,
                })
                .collect(),
        };
        for (i, material) in given.materials.iter().enumerate() {
            if given.materials[..i]
                .iter()
                .any(|other| other.name == material.name)
            {
                report.problem(
                    format!("fluid.materials[{i}].name"),
                    format!("another material is called \"{}\" too", material.name),
                    "give each its own",
                );
            }
        }
        Self {
            solver: given.solver,
            spacing: given.spacing,
            materials,
            kernel,
            support: support * given.spacing,
            max_speed,
            sound_speed,
            gamma: given.gamma.unwrap_or(match given.solver {
                FluidSolver::Sph | FluidSolver::Dfsph => 1,
                FluidSolver::Wcsph => 7,
            }),
            max_density_error: given.max_density_error,
            max_divergence_error: given.max_divergence_error,
            max_viscosity_error: given.max_viscosity_error,
            max_iterations: given.max_iterations,
            implicit_viscosity: false,
            courant_number: given.courant_number,
            rest_step: MOST_OF_FALL * given.spacing / fall_speed,
            background_pressure: given.background_pressure,
            density_from,
            density_diffusion: given.density_diffusion.unwrap_or(usual),
            pressure_force: given.pressure_force,
            negative_pressure: given.negative_pressure,
            gradient_correction: given.gradient_correction,
            shifting: given.shifting.unwrap_or(0.0),
            artificial_viscosity: given.artificial_viscosity,
            wall_friction: given.wall_friction,
            has_bodies: !speeds.bodies.is_empty(),
            contact_step: match speeds.bodies {
                [] => f64::INFINITY,
                _ => floating::contact_step(given.spacing, speeds.gravity.length()),
            },
            viscosity_form: given.viscosity_form.unwrap_or_default(),
            free_surface: false,
            slip: given.slip,
            contact_angle: given.contact_angle.unwrap_or(90.0),
        }
    }

    /// The fluid, whose free surface is known now.
    pub fn with_surface(
        self,
        given: &model::Fluid,
        free_surface: bool,
        gravity: f64,
        integrator: Integrator,
    ) -> Self {
        let usual = match (self.solver, self.kernel) {
            (FluidSolver::Dfsph, _) | (_, Kernel::Muller) => ViscosityForm::Laplacian,
            // With surface tension drops would meet walls that they do not wet at angles that are too small.
            _ if free_surface && !self.has_surface_tension() => ViscosityForm::MonaghanGingold,
            _ => ViscosityForm::Laplacian,
        };
        // Under gravity pressure keeps particles apart, and shifting would disturb water at rest. Particles of two fluids
        // would be mixed by it.
        let shifts = free_surface
            && gravity == 0.0
            && !self.has_surface_tension()
            && self.solver == FluidSolver::Wcsph
            && self.density_from == DensityFrom::Continuity
            && self.materials.len() == 1
            && integrator == Integrator::SymplecticEuler;
        Self {
            viscosity_form: given.viscosity_form.unwrap_or(usual),
            shifting: given
                .shifting
                .unwrap_or(if shifts { USUAL_SHIFTING } else { 0.0 }),
            free_surface,
            ..self
        }
    }

    /// The fluid, whose viscosity, at most `greatest`, Pa·s, during the run, is implicit where it would make steps much shorter.
    /// `longest` is the scene's own step, seconds.
    pub fn with_viscosity_up_to(self, greatest: f64, gravity: f64, longest: Option<f64>) -> Self {
        let other = self.moving_step(gravity).min(longest.unwrap_or(f64::INFINITY));
        let explicit = self.viscous_step(greatest / self.materials[0].density);
        Self {
            // Bodies get the reverse of explicit viscosity alone.
            implicit_viscosity: self.solver == FluidSolver::Dfsph
                && !self.has_bodies
                && explicit < EXPLICIT_SHARE * other,
            ..self
        }
    }

    /// The longest step of `dfsph` as far as motion and weight go, seconds.
    pub fn moving_step(&self, gravity: f64) -> f64 {
        let falling = (INCOMPRESSIBLE_FALL * self.spacing / gravity).sqrt();
        falling.min(self.longest_step())
    }

    /// The longest explicit step with this kinematic viscosity, m²/s, seconds.
    pub fn viscous_step(&self, kinematic: f64) -> f64 {
        VISCOUS_SHARE * self.step_length().powi(2) / kinematic
    }

    /// h, metres.
    pub fn smoothing(&self) -> f64 {
        self.support / self.kernel.reach()
    }

    /// How deep boundary particles reach, metres.
    pub fn wall_depth(&self) -> f64 {
        match self.solver {
            // One layer: what lies deeper is out of reach at rest.
            FluidSolver::Dfsph => self.spacing,
            _ => self.support,
        }
    }

    /// Of a particle at rest, m³ (m² in 2D).
    pub fn volume(&self, dimensions: Dimensions) -> f64 {
        self.spacing.powi(dimensions.count() as i32)
    }

    /// Takes over what an event changes; of several fluids, of `material` alone where there is one.
    pub(super) fn change(&mut self, change: &model::Change, material: Option<usize>) {
        let set = |value: &mut f64, given: Option<f64>| *value = given.unwrap_or(*value);
        for (i, own) in self.materials.iter_mut().enumerate() {
            if material.is_none_or(|only| only == i) {
                set(&mut own.viscosity, change.viscosity);
                set(&mut own.surface_tension, change.surface_tension);
            }
        }
        set(&mut self.artificial_viscosity, change.artificial_viscosity);
        set(&mut self.sound_speed, change.sound_speed);
        set(&mut self.wall_friction, change.wall_friction);
    }

    /// Notes that density will vary much.
    pub(super) fn check_sound(&self, key: &str, report: &mut Report) {
        if self.solver != FluidSolver::Dfsph && self.sound_speed < 5.0 * self.max_speed {
            report.notes.push(format!(
                "{key} {} m/s is less than five times the expected speed {} m/s: density will vary by more than 4 %",
                number(self.sound_speed),
                number(self.max_speed)
            ));
        }
    }

    pub fn is_viscous(&self) -> bool {
        self.materials.iter().any(|material| material.viscosity > 0.0)
    }

    pub fn has_surface_tension(&self) -> bool {
        self.materials
            .iter()
            .any(|material| material.surface_tension > 0.0)
    }

    /// The longest stable steps, seconds, and what each keeps: sound, viscosity, weight (Morris 1997) and waves of the
    /// surface (Brackbill 1992; Morris 2000).
    pub fn step_limits(&self, gravity: f64) -> [(f64, &'static str); 5] {
        let h = self.step_length();
        let kinematic = self.materials.iter().map(|m| match self.implicit_viscosity {
            true => 0.0,
            false => m.viscosity / m.density,
        });
        let tension = self.materials.iter().map(|m| m.surface_tension / m.density);
        let tension = tension.fold(0.0, f64::max);
        let fastest = kinematic.fold(0.0, f64::max) + self.artificial_viscosity * h * self.sound_speed / 8.0;
        let signal = match self.solver {
            FluidSolver::Dfsph => (self.longest_step(), MOTION),
            _ => (self.sound_distance() / (self.sound_speed + self.max_speed), SOUND),
        };
        [
            signal,
            (self.viscous_step(fastest), "viscosity"),
            (FORCE_SHARE * (h / gravity).sqrt(), GRAVITY),
            (
                CAPILLARY_SHARE * (h.powi(3) / (2.0 * PI * tension)).sqrt(),
                "surface tension",
            ),
            (self.contact_step, "contacts of rigid bodies"),
        ]
    }

    /// How far motion and sound together may go in a step, in smoothing lengths.
    pub fn sound_share(&self) -> f64 {
        match self.solver == FluidSolver::Sph || self.gradient_correction || self.shifting > 0.0 {
            true => FINE_SOUND_SHARE,
            false => SOUND_SHARE,
        }
    }

    /// The same in metres.
    fn sound_distance(&self) -> f64 {
        self.sound_share() * self.step_length()
    }

    /// Of `dfsph`, also when all is at rest, s.
    fn longest_step(&self) -> f64 {
        (self.courant_number * self.spacing / self.max_speed).min(self.rest_step)
    }

    /// The length that steps are compared with, metres: h, but Müller's kernels end at their smoothing length, which
    /// would count for two of the others'.
    fn step_length(&self) -> f64 {
        self.support / self.kernel.reach().max(2.0)
    }

    /// The same for steps that follow the flow: only the other limits never change. Seconds: `expected` is the
    /// usual step, `longest` the scene's own.
    pub fn adaptive_limits(&self, gravity: f64, expected: f64, longest: Option<f64>) -> StepLimits {
        let limits = self.step_limits(gravity).into_iter();
        let constant = limits
            .filter(|(_, name)| ![SOUND, MOTION, GRAVITY].contains(name))
            .chain(longest.map(|step| (step, "scene's step")));
        let h = self.step_length();
        if self.solver == FluidSolver::Dfsph {
            // Where neighbors stand unevenly, pressure pushes a particle about as fast as fluid falls from the surface, also
            // when all is at rest.
            return StepLimits {
                expected,
                constant: constant
                    .chain([(self.longest_step(), "pressure")])
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .expect("viscosity is one"),
                courant_distance: self.courant_number * self.spacing,
                fall: INCOMPRESSIBLE_FALL * self.spacing,
                sound_speed: 0.0,
                expected_speed: 0.0,
            };
        }
        StepLimits {
            expected,
            constant: constant
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .expect("viscosity is one"),
            courant_distance: self.sound_distance(),
            fall: FORCE_SHARE * FORCE_SHARE * h,
            sound_speed: self.sound_speed,
            expected_speed: self.max_speed,
        }
    }

    /// (ρ/ρ₀) − 1 at a pressure above the background, Pa: the inverse of the equation of state.
    pub fn deviation_at(&self, density: f64, pressure: f64) -> f64 {
        let gamma = f64::from(self.gamma);
        let stiffness = density * self.sound_speed * self.sound_speed / gamma;
        ((pressure / stiffness).ln_1p() / gamma).exp_m1()
    }
}

/// Support over spacing where a scene does not say it.
pub fn usual_support(
    dimensions: Dimensions,
    solver: FluidSolver,
    kernel: Kernel,
    density_from: DensityFrom,
    has_surface_tension: bool,
) -> f64 {
    match (dimensions, solver, kernel, density_from) {
        (_, FluidSolver::Dfsph, ..) => INCOMPRESSIBLE_SUPPORT,
        (Dimensions::Three, FluidSolver::Wcsph, Kernel::WendlandC2, DensityFrom::Continuity)
            if !has_surface_tension =>
        {
            NEAR_SUPPORT
        }
        _ => USUAL_SUPPORT[dimensions.count() - 2],
    }
}

/// Of the shortest waves of the surface, √(σ/ρΔx), m/s, also where events set a surface tension of `later`.
fn ripple_speed(given: &model::Fluid, later: f64) -> f64 {
    let own = (given.surface_tension, given.density);
    let all = given.materials.iter().map(|m| (m.surface_tension, m.density));
    let each = all.chain(given.materials.is_empty().then_some(own));
    let fastest = each
        .map(|(tension, density)| tension.max(later) / density)
        .fold(0.0, f64::max);
    (fastest / given.spacing).sqrt()
}

/// That of a fall from the highest particle to the domain's floor, or of what moves at the start.
fn expected_speed(frame: &Frame, speeds: &Speeds) -> f64 {
    let fastest = speeds.particles.velocity.iter().map(|v| f64::from(v.length()));
    let fastest = fastest.chain(speeds.bodies.iter().map(RigidBody::speed));
    let fastest = fastest.fold(speeds.walls, f64::max);
    let closed = |axis: usize| {
        frame.sides[axis]
            .iter()
            .all(|&side| side != model::Wall::Periodic)
    };
    // Along a periodic direction gravity drives a flow, whose speed cannot be told from heights.
    let g = speeds.gravity;
    let pull = DVec3::from([0, 1, 2].map(|axis| if closed(axis) { g[axis] } else { 0.0 }));
    let height = |p: DVec3| -p.dot(pull);
    let corner = |low: bool| {
        DVec3::from([0, 1, 2].map(|k| {
            if (pull[k] < 0.0) == low {
                frame.min[k]
            } else {
                frame.max[k]
            }
        }))
    };
    let floor = height(corner(true));
    let highest = speeds.particles.position.iter().map(|p| height(p.as_dvec3()));
    let highest = highest.chain(speeds.bodies.iter().map(|body| height(body.center)));
    let highest = highest.fold(f64::NEG_INFINITY, f64::max);
    let top = if highest.is_finite() {
        highest
    } else {
        height(corner(false))
    };
    let fall = (2.0 * (top - floor).max(0.0)).sqrt();
    (fall * fall + fastest * fastest).sqrt()
}

/// Index of the material that a body or emitter names.
pub fn material(path: &str, name: Option<&str>, file: &SceneFile, report: &mut Report) -> u32 {
    let materials = file.fluid.as_ref().map_or(&[][..], |fluid| &fluid.materials[..]);
    let names = materials.iter().map(|material| material.name.as_str());
    match name {
        None => 0,
        Some(name) => match names.clone().position(|known| known == name) {
            Some(index) => index as u32,
            None => {
                let help = match materials {
                    [] => "leave it out, or describe it in fluid.materials".to_owned(),
                    _ => suggest(name, names),
                };
                report.problem(path, format!("no material is called \"{name}\""), help);
                0
            }
        },
    }
}
