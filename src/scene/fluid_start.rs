//! How a fluid begins: flows of known form, pressures, and the places that these ask for.

use glam::{DVec3, Vec3};

use super::Dimensions;
use super::fluid::Fluid;
use super::frame::Frame;
use super::model::{self, Flow, FluidSolver, StartPressure};

/// Velocity (m/s) and pressure over density (m²/s²) of a flow at a point of the scene, metres.
pub fn flow_at(flow: &Flow, dimensions: Dimensions, at: DVec3) -> (DVec3, f64) {
    match *flow {
        Flow::TaylorGreen { speed, wavelength } => {
            let k = std::f64::consts::TAU / wavelength;
            let ((sx, cx), (sy, cy), cz) = ((k * at.x).sin_cos(), (k * at.y).sin_cos(), (k * at.z).cos());
            let (c2x, c2y, c2z) = (
                (2.0 * k * at.x).cos(),
                (2.0 * k * at.y).cos(),
                (2.0 * k * at.z).cos(),
            );
            match dimensions {
                // u = −U cos kx sin ky, v = U sin kx cos ky, p = −ρU²/4 (cos 2kx + cos 2ky).
                Dimensions::Two => (
                    DVec3::new(-cx * sy, sx * cy, 0.0) * speed,
                    -0.25 * speed * speed * (c2x + c2y),
                ),
                // u = U sin kx cos ky cos kz, v = −U cos kx sin ky cos kz (Brachet 1983).
                Dimensions::Three => (
                    DVec3::new(sx * cy * cz, -cx * sy * cz, 0.0) * speed,
                    speed * speed / 16.0 * (c2x + c2y) * (c2z + 2.0),
                ),
            }
        }
        Flow::Rotation { rate } => (DVec3::new(-at.y, at.x, 0.0) * rate, 0.0),
        Flow::Stretch { rate } => (DVec3::new(-at.x, at.y, 0.0) * rate, 0.0),
        Flow::StandingWave {
            speed,
            wavelength,
            depth,
        } => {
            let k = std::f64::consts::TAU / wavelength;
            let (sin, cos) = (k * at.x).sin_cos();
            let share = |value: f64| value / (k * depth).cosh() * speed;
            // The gradient of cosh ky cos kx.
            (
                DVec3::new(
                    -share((k * at.y).cosh()) * sin,
                    share((k * at.y).sinh()) * cos,
                    0.0,
                ),
                0.0,
            )
        }
    }
}

/// Pressures of a body's particles at the start, Pa, from those of its flow and of the fluid that stands above.
pub fn start_pressures(
    body: &model::Body,
    fluid: &model::Fluid,
    positions: &[DVec3],
    density: f64,
    gravity: DVec3,
    frame: &Frame,
) -> Vec<f64> {
    let mut pressures = vec![0.0; positions.len()];
    if let Some(flow) = &body.flow {
        for (pressure, position) in pressures.iter_mut().zip(positions) {
            *pressure += density * flow_at(flow, frame.dimensions, *position + frame.origin).1;
        }
    }
    let (top, bottom) = extent(positions, gravity, fluid.spacing);
    // An incompressible fluid finds its pressures from anywhere, but nearby it finds them sooner.
    let stands = || bottom < lowest_potential(frame, gravity) + gravity.length() * fluid.spacing / 2.0;
    if body.pressure == StartPressure::Hydrostatic || fluid.solver == FluidSolver::Dfsph && stands() {
        for (pressure, position) in pressures.iter_mut().zip(positions) {
            *pressure += density * (top + position.dot(gravity));
        }
    }
    pressures
}

/// Of gravity at the lowest corner of the domain, m²/s².
fn lowest_potential(frame: &Frame, gravity: DVec3) -> f64 {
    let lowest = |axis: usize| match gravity[axis] > 0.0 {
        true => frame.max[axis],
        false => frame.min[axis],
    };
    -gravity.dot(DVec3::from([0, 1, 2].map(lowest)))
}

/// The highest and the lowest potential −g·x of a body, half a spacing beyond its particles, m²/s².
fn extent(positions: &[DVec3], gravity: DVec3, spacing: f64) -> (f64, f64) {
    let potential = positions.iter().map(|p| -p.dot(gravity));
    let (low, high) = potential.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    let half = gravity.length() * spacing / 2.0;
    (high + half, low - half)
}

impl Fluid {
    /// Packs a body that begins under its own weight as densely as that makes it, so that it begins at rest: each
    /// particle keeps the mass above it and comes nearer to the body's lowest point.
    ///
    /// With p = ρ₀ g d at depth d and 1/(1 + e) = (1 + a d)^(−1/γ), a = γ g / c², what lies between d and the bottom D
    /// is ∫ (1 + a s)^(−1/γ) ds high.
    pub fn settle(&self, positions: &mut [Vec3], gravity: DVec3) {
        let g = gravity.length();
        if g == 0.0 || positions.is_empty() {
            return;
        }
        let exact: Vec<DVec3> = positions.iter().map(|p| p.as_dvec3()).collect();
        let (top, bottom) = extent(&exact, gravity, self.spacing);
        let a = f64::from(self.gamma) * g / (self.sound_speed * self.sound_speed);
        let power = 1.0 - 1.0 / f64::from(self.gamma);
        let integral = |depth: f64| {
            let stretched = (a * depth).ln_1p();
            if power == 0.0 {
                stretched / a
            } else {
                (power * stretched).exp_m1() / (power * a)
            }
        };
        let deepest = (top - bottom) / g;
        for (position, exact) in positions.iter_mut().zip(&exact) {
            let depth = (top + exact.dot(gravity)) / g;
            let height = integral(deepest) - integral(depth);
            let sinks = (deepest - depth) - height;
            *position = (*exact + gravity / g * sinks).as_vec3();
        }
    }
}
