//! Fluids in f64 on the CPU, all pairs, with matrices for what the shaders do by components: what they are held against.

use glam::{DMat3, DVec3};
use sliceflow::physics::kernels;
use sliceflow::scene::boundary::NO_BODY;
use sliceflow::scene::fluid::Fluid;
use sliceflow::scene::model::{
    DensityFrom, Integrator, Kernel, NegativePressure, PressureForce, Slip, ViscosityForm,
};
use sliceflow::scene::{Dimensions, Scene};

pub struct Reference {
    pub position: Vec<DVec3>,
    pub velocity: Vec<DVec3>,
    /// ρ/ρ₀ − 1.
    pub deviation: Vec<f64>,
    /// Pa.
    pub pressure: Vec<f64>,
    /// Particles before this one are fluid, the others boundary.
    pub free: usize,
    viscous: Vec<DVec3>,
    correction: Vec<DMat3>,
    stress: Vec<DMat3>,
    surface_normal: Vec<DVec3>,
    material: Vec<usize>,
    surface: Vec<DVec3>,
    body_velocity: Vec<DVec3>,
    fluid: Fluid,
    dimensions: usize,
    gravity: DVec3,
    period: DVec3,
    lower: DVec3,
    step: f64,
    verlet: bool,
    acceleration: Vec<DVec3>,
}

impl Reference {
    /// Starts from the scene's f32 values, so that only the arithmetic differs.
    pub fn new(scene: &Scene) -> Self {
        let fluid = scene.fluid().expect("a fluid").clone();
        let walls = &scene.boundary;
        let exact = |v: &glam::Vec3| v.as_dvec3();
        let free = scene.particles.len();
        let motion = |&body: &u32| match body {
            NO_BODY => DVec3::ZERO,
            body => match &scene.colliders[body as usize].path[..] {
                [(from, start), (to, end), ..] => (*end - *start).as_dvec3() / (to - from),
                _ => DVec3::ZERO,
            },
        };
        let mut deviation: Vec<f64> = scene
            .particles
            .density_deviation
            .iter()
            .map(|&e| f64::from(e))
            .collect();
        deviation.resize(free + walls.len(), 0.0);
        let mut material: Vec<usize> = scene.particles.material.iter().map(|&m| m as usize).collect();
        material.resize(free + walls.len(), 0);
        let mut reference = Self {
            position: scene
                .particles
                .position
                .iter()
                .chain(&walls.position)
                .map(exact)
                .collect(),
            velocity: scene
                .particles
                .velocity
                .iter()
                .chain(&walls.surface_velocity)
                .map(exact)
                .collect(),
            pressure: vec![0.0; deviation.len()],
            viscous: Vec::new(),
            correction: Vec::new(),
            stress: Vec::new(),
            surface_normal: Vec::new(),
            deviation,
            free,
            material,
            surface: walls.surface_velocity.iter().map(exact).collect(),
            body_velocity: walls.body.iter().map(motion).collect(),
            dimensions: scene.dimensions.count(),
            gravity: scene.gravity.as_dvec3(),
            period: scene.domain.period().as_dvec3(),
            lower: scene.domain.min.as_dvec3(),
            step: scene.time.step,
            verlet: scene.time.integrator == Integrator::VelocityVerlet,
            acceleration: Vec::new(),
            fluid,
        };
        reference.settle(0.0);
        reference.acceleration = reference
            .forces()
            .into_iter()
            .map(|forces| forces.acceleration)
            .collect();
        reference
    }

    fn flat(&self) -> Dimensions {
        if self.dimensions == 2 {
            Dimensions::Two
        } else {
            Dimensions::Three
        }
    }

    fn is_boundary(&self, i: usize) -> bool {
        i >= self.free
    }

    fn rest_density(&self, i: usize) -> f64 {
        self.fluid.materials[self.material[i]].density
    }

    fn volume(&self, i: usize) -> f64 {
        self.fluid.volume(self.flat()) / (1.0 + self.deviation[i])
    }

    /// Neighbors: the particle, the way to it, the distance, and ∇ᵢW.
    fn neighbors(&self, i: usize) -> Vec<(usize, DVec3, f64, DVec3)> {
        let h = self.fluid.smoothing();
        let mut found = Vec::new();
        for j in 0..self.position.len() {
            let mut away = self.position[j] - self.position[i];
            for axis in 0..3 {
                if self.period[axis] > 0.0 {
                    away[axis] -= self.period[axis] * (away[axis] / self.period[axis]).round();
                }
            }
            let r = away.length();
            if j != i && r < self.fluid.support {
                let slope = kernels::slope(self.fluid.kernel, self.dimensions, h, r);
                found.push((j, away, r, -away / r * slope));
            }
        }
        found
    }

    fn pressure_at(&self, i: usize, deviation: f64) -> f64 {
        let gamma = f64::from(self.fluid.gamma);
        let stiffness = self.rest_density(i) * self.fluid.sound_speed.powi(2) / gamma;
        let p = self.fluid.background_pressure + stiffness * ((1.0 + deviation).powf(gamma) - 1.0);
        match self.fluid.negative_pressure {
            NegativePressure::Clamp => p.max(0.0),
            _ => p,
        }
    }

    /// Densities, pressures, boundary particles and stresses where particles are.
    fn settle(&mut self, step: f64) {
        let fluid = self.fluid.clone();
        let h = fluid.smoothing();
        let w = |r: f64| kernels::value(fluid.kernel, self.dimensions, h, r);
        let closed = DVec3::from([0, 1, 2].map(|axis| if self.period[axis] > 0.0 { 0.0 } else { 1.0 }));
        let mut deviation = Vec::with_capacity(self.deviation.len());
        self.correction = vec![DMat3::IDENTITY; self.position.len()];
        for i in 0..self.free {
            let neighbors = self.neighbors(i);
            let e = self.deviation[i];
            let mut moment = DMat3::ZERO;
            let mut slopes = DMat3::ZERO;
            let mut diffused = 0.0;
            let mut sum = w(0.0);
            let mut surrounded = 0.0;
            let at_rest = self.gravity * closed / fluid.sound_speed.powi(2)
                * (1.0 + (2.0 - f64::from(fluid.gamma)) * e);
            for &(j, away, r, gradient) in &neighbors {
                let volume = match fluid.density_from {
                    DensityFrom::Summation => fluid.volume(self.flat()),
                    DensityFrom::Continuity => self.volume(j),
                };
                moment += outer(away, gradient) * volume;
                let mirrors = fluid.gradient_correction || fluid.slip == Slip::FreeSlip;
                let mirrored = if self.is_boundary(j) && mirrors { 2.0 } else { 1.0 };
                slopes += outer(self.velocity[j] - self.velocity[i], gradient) * (mirrored * volume);
                sum += w(r);
                surrounded += volume * gradient.dot(away);
                if !self.is_boundary(j) && self.material[j] == self.material[i] {
                    let difference = self.deviation[j] - e - at_rest.dot(away);
                    diffused += volume * difference * gradient.dot(away) / (r * r);
                }
            }
            if self.dimensions == 2 {
                moment.z_axis.z = 1.0;
            }
            if fluid.gradient_correction && moment.determinant() > 0.3 {
                self.correction[i] = moment.inverse();
            }
            let correction = self.correction[i];
            let slopes = if fluid.gradient_correction {
                slopes * correction
            } else {
                slopes
            };
            let divergence = slopes.x_axis.x + slopes.y_axis.y + slopes.z_axis.z;
            deviation.push(match fluid.density_from {
                DensityFrom::Summation => fluid.volume(self.flat()) * sum - 1.0,
                DensityFrom::Continuity => {
                    let diffusion = 2.0 * fluid.density_diffusion * fluid.support / 2.0 * fluid.sound_speed;
                    let moved = e + step * (diffusion * diffused - (1.0 + e) * divergence);
                    match fluid.negative_pressure {
                        NegativePressure::Clamp => {
                            let moved = moved.max(-(fluid.max_speed / fluid.sound_speed).powi(2));
                            if surrounded < 0.15 * self.dimensions as f64 {
                                moved.min(0.0)
                            } else {
                                moved
                            }
                        }
                        _ => moved,
                    }
                }
            });
        }
        self.deviation[..self.free].copy_from_slice(&deviation);
        for i in 0..self.free {
            self.pressure[i] = self.pressure_at(i, self.deviation[i]);
        }
        self.viscous = self.velocity.clone();
        for i in self.free..self.position.len() {
            let (mut weights, mut pressure, mut moving, mut stiffness) = (0.0, 0.0, DVec3::ZERO, 0.0);
            for (j, away, r, _) in self.neighbors(i) {
                if !self.is_boundary(j) {
                    let density = self.rest_density(j) * (1.0 + self.deviation[j]);
                    weights += w(r);
                    pressure += w(r) * (self.pressure[j] - density * self.gravity.dot(away));
                    moving += w(r) * self.velocity[j];
                    stiffness += w(r) * self.rest_density(j);
                }
            }
            let rest = self.fluid.materials[0].density;
            let (mut p, density) = if weights > 0.0 {
                (pressure / weights, stiffness / weights)
            } else {
                (fluid.background_pressure, rest)
            };
            if fluid.negative_pressure == NegativePressure::Clamp {
                p = p.max(0.0);
            }
            self.pressure[i] = p;
            self.deviation[i] = fluid.deviation_at(density, p - fluid.background_pressure);
            if weights > 0.0 && fluid.slip == Slip::NoSlip {
                self.viscous[i] = 2.0 * self.velocity[i] - moving / weights;
            }
        }
        self.find_stress();
        self.surface_normal = (0..self.position.len()).map(|i| self.surface_normal(i)).collect();
    }

    fn surface_normal(&self, i: usize) -> DVec3 {
        if self.is_boundary(i) {
            return DVec3::ZERO;
        }
        let support = self.fluid.support;
        let (mut normal, mut offset, mut wall_normal) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (j, away, r, gradient) in self.neighbors(i) {
            if self.is_boundary(j) || self.material[j] == self.material[i] {
                normal += gradient * self.volume(j);
                offset += (1.0 - r / support) * away;
            }
            if self.is_boundary(j) {
                wall_normal += gradient * self.volume(j);
            }
        }
        if normal.length() * support <= 0.5 {
            return DVec3::ZERO;
        }
        let touch = (wall_normal.length() * support / 0.3).min(1.0);
        let wall = wall_normal.normalize_or_zero();
        let angle = self.fluid.contact_angle.to_radians();
        let met = angle.cos() * wall + angle.sin() * (offset - offset.dot(wall) * wall).normalize_or_zero();
        normal.length() * offset.normalize().lerp(met, touch).normalize_or_zero()
    }

    fn find_stress(&mut self) {
        self.stress = vec![DMat3::ZERO; self.position.len()];
        for i in 0..self.free {
            let mut slopes = DMat3::ZERO;
            for (j, _, _, gradient) in self.neighbors(i) {
                if !(self.is_boundary(j) && self.fluid.slip == Slip::FreeSlip) {
                    slopes += outer(self.viscous[j] - self.velocity[i], gradient) * self.volume(j);
                }
            }
            if self.fluid.gradient_correction {
                slopes *= self.correction[i];
            }
            let trace = slopes.x_axis.x + slopes.y_axis.y + slopes.z_axis.z;
            let viscosity = self.fluid.materials[self.material[i]].viscosity;
            self.stress[i] =
                (slopes + slopes.transpose() - DMat3::IDENTITY * (2.0 / 3.0 * trace)) * viscosity;
        }
    }

    /// Of every particle of the fluid.
    fn forces(&self) -> Vec<Forces> {
        let fluid = &self.fluid;
        let h = fluid.smoothing();
        let half = fluid.support / 2.0;
        let mut all = Vec::new();
        for i in 0..self.free {
            let density = self.rest_density(i) * (1.0 + self.deviation[i]);
            let viscosity = fluid.materials[self.material[i]].viscosity;
            let (mut push, mut drag) = (DVec3::ZERO, DVec3::ZERO);
            let normal = self.surface_normal[i];
            let (mut turned, mut seen) = (0.0, 0.0);
            let mut offset = DVec3::ZERO;
            let (mut inwards, mut against) = (DVec3::ZERO, 0.0);
            let (mut wall_velocity, mut damping) = (DVec3::ZERO, DMat3::ZERO);
            let (mut crowd, mut slopes, mut deviation_slope) = (DVec3::ZERO, DMat3::ZERO, DVec3::ZERO);
            let (mut inside, mut surrounded) = (DVec3::ZERO, 0.0);
            for (j, away, r, gradient) in self.neighbors(i) {
                let volume = self.volume(j);
                let other = self.rest_density(j) * (1.0 + self.deviation[j]);
                let (p, q) = (self.pressure[i], self.pressure[j]);
                let pressures = match fluid.pressure_force {
                    PressureForce::Difference => q - p,
                    PressureForce::Monaghan => {
                        other * density * (p / (density * density) + q / (other * other))
                    }
                    PressureForce::Symmetric => q + p,
                };
                push -= volume * pressures * gradient;
                let apart = self.viscous[j] - self.velocity[i];
                let slides = self.is_boundary(j) && fluid.slip == Slip::FreeSlip;
                if fluid.viscosity_form == ViscosityForm::Stress {
                    let mine = self.stress[i];
                    let other = if self.is_boundary(j) { mine } else { self.stress[j] };
                    let step = if fluid.gradient_correction {
                        other - mine
                    } else {
                        other + mine
                    };
                    drag += volume * (step * gradient);
                } else if fluid.kernel == Kernel::Muller && !slides {
                    let laplacian = kernels::muller_laplacian(self.dimensions)
                        / h.powi(self.dimensions as i32 + 2)
                        * (1.0 - r / h);
                    drag += viscosity * volume * laplacian * apart;
                } else if fluid.viscosity_form == ViscosityForm::MonaghanGingold && !slides {
                    let both = viscosity + fluid.materials[self.material[j]].viscosity;
                    let steep = volume * gradient.dot(away) / (r * r);
                    let approach = apart.dot(away) / (r * r).max(0.01 * half * half);
                    drag += (self.dimensions as f64 + 2.0) * both * steep * approach * away;
                } else if !slides {
                    let both = viscosity + fluid.materials[self.material[j]].viscosity;
                    drag += both * volume * gradient.dot(away) / (r * r) * apart;
                    offset += both * volume * gradient;
                }
                let beside = self.surface_normal[j];
                if beside != DVec3::ZERO && self.material[j] == self.material[i] {
                    let direction = normal.normalize_or_zero();
                    let along = away - away.dot(direction) * direction;
                    let steep = volume * gradient.dot(away) / (r * r);
                    turned += steep * (beside.normalize() - direction).dot(along);
                    seen += steep * along.length_squared();
                }
                let approach = (self.velocity[j] - self.velocity[i]).dot(away).min(0.0);
                let strength = fluid.artificial_viscosity * half * fluid.sound_speed;
                let damped = strength / (r * r + 0.01 * half * half);
                if slides {
                    let steep = volume * gradient.dot(away) / (r * r);
                    inwards += steep * away;
                    against += steep;
                    wall_velocity += steep * self.velocity[j];
                    damping += outer(away, away) * (steep * damped);
                } else {
                    drag += volume * density * damped * approach * gradient;
                }
                let near = kernels::value(fluid.kernel, self.dimensions, h, r)
                    / kernels::value(fluid.kernel, self.dimensions, h, fluid.spacing);
                crowd += volume * (1.0 + 0.2 * near.powi(4)) * gradient;
                if !slides {
                    slopes += outer(apart, gradient) * volume;
                }
                inside += volume * gradient;
                surrounded += volume * gradient.dot(away) / self.dimensions as f64;
                deviation_slope += volume * (self.deviation[j] - self.deviation[i]) * gradient;
            }
            let shown = |least: f64, most: f64| ((surrounded - least) / (most - least)).clamp(0.0, 1.0);
            if fluid.negative_pressure == NegativePressure::Control {
                push += shown(0.9, 0.97) * 2.0 * self.pressure[i].min(0.0) * inside;
            }
            if against > 0.0 {
                let area = inwards.length();
                let inwards = inwards.normalize_or_zero();
                let past = wall_velocity / against - self.velocity[i];
                let nearing = past.dot(inwards);
                drag += density * nearing.min(0.0) * inwards.dot(damping * inwards) * inwards;
                let along = past - nearing * inwards;
                drag += density * fluid.wall_friction * area * along.length() * along;
            }
            if seen != 0.0 {
                let curved = (self.dimensions - 1) as f64;
                let curvature = -curved * turned / seen;
                let most = 0.5 * curved / fluid.spacing;
                let tension = fluid.materials[self.material[i]].surface_tension;
                push += 2.0 * tension * curvature.clamp(-most, most) * normal;
            }
            if fluid.gradient_correction {
                let exact = self.correction[i];
                if fluid.pressure_force == PressureForce::Difference {
                    push = exact * push;
                }
                if fluid.viscosity_form == ViscosityForm::Stress {
                    drag = exact * drag;
                }
                slopes *= exact;
                deviation_slope = exact * deviation_slope;
                let slips = fluid.slip == Slip::FreeSlip && self.free < self.position.len();
                if fluid.viscosity_form == ViscosityForm::Laplacian
                    && fluid.kernel != Kernel::Muller
                    && !slips
                {
                    let trace = exact.x_axis.x
                        + exact.y_axis.y
                        + if self.dimensions == 3 { exact.z_axis.z } else { 0.0 };
                    drag = (trace / self.dimensions as f64) * (drag - slopes * offset);
                }
            }
            let normal = inside.normalize_or_zero();
            let through = (1.0 - shown(0.8, 0.95)) * crowd.dot(normal);
            let crowd = if fluid.free_surface || fluid.negative_pressure == NegativePressure::Clamp {
                shown(0.3, 0.4) * (crowd - through * normal)
            } else {
                crowd
            };
            let wanted = -4.0 * fluid.shifting * half * fluid.max_speed * self.step * crowd;
            let shift = wanted * (0.05 * fluid.spacing / wanted.length().max(1e-30)).min(1.0);
            all.push(Forces {
                acceleration: self.gravity + (push + drag) / density,
                shift,
                velocity_change: slopes * shift,
                deviation_change: deviation_slope.dot(shift),
            });
        }
        all
    }

    /// Moves everything by one step.
    pub fn advance(&mut self) {
        let (mut position, mut velocity) = (self.position.clone(), self.velocity.clone());
        let mut deviation = self.deviation.clone();
        for (i, forces) in self.forces().into_iter().enumerate() {
            let a = if self.verlet {
                self.acceleration[i]
            } else {
                forces.acceleration
            };
            velocity[i] += self.step * a;
            position[i] += self.step * velocity[i];
            if self.verlet {
                position[i] -= 0.5 * self.step * self.step * a;
            }
            if self.fluid.shifting > 0.0 {
                position[i] += forces.shift;
                velocity[i] += forces.velocity_change;
                deviation[i] += forces.deviation_change;
            }
        }
        for k in 0..self.surface.len() {
            let i = self.free + k;
            position[i] += self.step * self.body_velocity[k];
            velocity[i] = self.body_velocity[k] + self.surface[k];
        }
        for position in &mut position {
            for axis in 0..3 {
                if self.period[axis] > 0.0 {
                    let laps = (position[axis] - self.lower[axis]) / self.period[axis];
                    position[axis] -= self.period[axis] * laps.floor();
                }
            }
        }
        (self.position, self.velocity, self.deviation) = (position, velocity, deviation);
        self.settle(self.step);
        if self.verlet {
            for (i, forces) in self.forces().into_iter().enumerate() {
                self.velocity[i] += 0.5 * self.step * (forces.acceleration - self.acceleration[i]);
                self.acceleration[i] = forces.acceleration;
            }
        }
    }
}

struct Forces {
    acceleration: DVec3,
    shift: DVec3,
    velocity_change: DVec3,
    deviation_change: f64,
}

/// a bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
