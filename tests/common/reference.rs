//! Grains in f64 on the CPU, all pairs: what the shaders' contact law and integrators are held against.

use glam::DVec3;
use sliceflow::scene::model::{Dashpot, Integrator, Wall};
use sliceflow::scene::{Contact, Scene};

pub struct Reference {
    pub position: Vec<DVec3>,
    pub velocity: Vec<DVec3>,
    acceleration: Vec<DVec3>,
    radius: f64,
    mass: f64,
    contact: Contact,
    gravity: DVec3,
    lower: DVec3,
    upper: DVec3,
    axes: usize,
    walls: Wall,
    restitution: f64,
    integrator: Integrator,
    step: f64,
}

impl Reference {
    /// Starts from the scene's f32 values, so that only the arithmetic differs. Obstacles are left out.
    pub fn new(scene: &Scene) -> Self {
        let mut reference = Self {
            position: scene.particles.position.iter().map(|p| p.as_dvec3()).collect(),
            velocity: scene.particles.velocity.iter().map(|v| v.as_dvec3()).collect(),
            acceleration: Vec::new(),
            radius: scene.radius(),
            mass: scene.grains().unwrap().mass,
            contact: scene.grains().unwrap().contact.clone(),
            gravity: scene.gravity.as_dvec3(),
            lower: scene.domain.min.as_dvec3(),
            upper: scene.domain.max.as_dvec3(),
            axes: scene.dimensions.count(),
            walls: scene.domain.sides[0][0],
            restitution: f64::from(scene.domain.restitution),
            integrator: scene.time.integrator,
            step: scene.time.step,
        };
        reference.acceleration = reference.accelerations(&reference.velocity);
        reference
    }

    /// Force of one contact on a grain; `normal` points to what it touches, `approach` is that one's relative velocity.
    fn force(&self, normal: DVec3, overlap: f64, approach: DVec3, damping: f64) -> DVec3 {
        let c = &self.contact;
        let along = approach.dot(normal) * normal;
        let dashpot = match c.dashpot {
            Dashpot::Full => approach,
            Dashpot::Normal => along,
        };
        -c.spring * overlap * normal + damping * dashpot + c.shear * (approach - along)
    }

    pub fn accelerations(&self, velocity: &[DVec3]) -> Vec<DVec3> {
        let c = &self.contact;
        let mut all = Vec::new();
        for (i, &x) in self.position.iter().enumerate() {
            let v = velocity[i];
            let mut force = DVec3::ZERO;
            for (j, &other) in self.position.iter().enumerate() {
                let r = other - x;
                if i != j && r.length() < 2.0 * self.radius {
                    let overlap = 2.0 * self.radius - r.length();
                    force +=
                        self.force(r.normalize(), overlap, velocity[j] - v, c.damping) + c.attraction * r;
                }
            }
            if self.walls == Wall::Contact {
                for axis in 0..self.axes {
                    let mut outwards = DVec3::ZERO;
                    outwards[axis] = 1.0;
                    let above = self.radius - (self.upper[axis] - x[axis]);
                    let below = self.radius - (x[axis] - self.lower[axis]);
                    if above > 0.0 {
                        force += self.force(outwards, above, -v, c.wall_damping);
                    }
                    if below > 0.0 {
                        force += self.force(-outwards, below, -v, c.wall_damping);
                    }
                }
            }
            all.push(force / self.mass + self.gravity - c.global_damping * v);
        }
        all
    }

    fn clamp(&self, x: &mut DVec3, v: &mut DVec3) {
        if self.walls != Wall::Clamp {
            return;
        }
        for axis in 0..self.axes {
            let inside = x[axis].clamp(self.lower[axis] + self.radius, self.upper[axis] - self.radius);
            if (x[axis] - inside) * v[axis] > 0.0 {
                v[axis] *= -self.restitution;
            }
            x[axis] = inside;
        }
    }

    pub fn advance(&mut self, steps: u32) {
        for _ in 0..steps {
            match self.integrator {
                Integrator::SymplecticEuler => {
                    let acceleration = self.accelerations(&self.velocity);
                    self.drift(&acceleration, 1.0);
                }
                Integrator::VelocityVerlet => {
                    let before = self.acceleration.clone();
                    self.drift(&before, 0.5);
                    self.acceleration = self.accelerations(&self.velocity);
                    for (v, (new, old)) in self.velocity.iter_mut().zip(self.acceleration.iter().zip(before))
                    {
                        *v += 0.5 * self.step * (*new - old);
                    }
                }
            }
        }
    }

    /// v' = v + a dt, x' = x + (v + `share` a dt) dt, walls.
    fn drift(&mut self, acceleration: &[DVec3], share: f64) {
        let dt = self.step;
        for (i, a) in acceleration.iter().enumerate() {
            let mut x = self.position[i] + self.velocity[i] * dt + share * *a * dt * dt;
            let mut v = self.velocity[i] + *a * dt;
            self.clamp(&mut x, &mut v);
            (self.position[i], self.velocity[i]) = (x, v);
        }
    }
}
