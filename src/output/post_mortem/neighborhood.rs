//! The particle to look at, and what is around it.

use glam::Vec3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Violation;
use crate::guards::GuardKind;
use crate::scene::Scene;
use crate::simulation::State;

/// At most so many neighbors are listed.
const MOST_NEIGHBORS: usize = 64;
/// Neighbors of grains lie within so many search radii: those that have just touched count too.
const NEAR_GRAINS: f32 = 1.5;
/// What is drawn lies within so many search radii.
const SHOWN: f32 = 3.0;

/// A particle and what is around it, after the last good frame.
pub struct Neighborhood {
    pub particle: Seen,
    pub neighbors: Vec<Neighbor>,
    /// What a picture shows: local positions, metres, the particle first, and what each is.
    pub shown: Vec<(Vec3, f32, Role)>,
}

/// What a point of the picture is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    Particle,
    Neighbor,
    Wall,
    Other,
}

/// A particle after the last good frame.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Seen {
    /// Its id.
    pub id: u32,
    /// Why it is this one: it was caught, or what makes it stand out.
    pub chosen_as: &'static str,
    /// Its position, metres.
    pub position_m: [f64; 3],
    /// Its velocity, m/s.
    pub velocity_m_per_s: [f32; 3],
    /// Of a fluid: its density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_kg_per_m3: Option<f32>,
    /// Of a fluid: its pressure, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<f32>,
    /// Its voxel, along the directions u, s and w of the grid; null outside of it.
    pub voxel: Option<[i32; 3]>,
    #[serde(skip)]
    pub(super) local: Vec3,
}

/// A neighbor within the search radius; of grains, one and a half times as far.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Neighbor {
    /// Its id.
    pub id: u32,
    /// Whether it is a particle of a wall.
    pub is_boundary: bool,
    /// From center to center, metres.
    pub distance_m: f32,
    /// Its position, metres.
    pub position_m: [f64; 3],
    /// Its velocity, m/s.
    pub velocity_m_per_s: [f32; 3],
    /// Of a fluid: its density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_kg_per_m3: Option<f32>,
    /// Of a fluid: its pressure, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<f32>,
    /// Of grains: how deep the two overlap, as a share of the radius, that of the smaller.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlap: Option<f32>,
}

/// The columns of a state.
struct Columns<'a> {
    scene: &'a Scene,
    state: &'a State,
    ids: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    /// ρ/ρ₀ − 1 and Pa.
    fluid: Vec<[f32; 2]>,
    material: Vec<u32>,
    /// Metres; of grains of several sizes.
    radius: Vec<f32>,
}

impl Neighborhood {
    /// `None` where there are no particles.
    pub fn new(scene: &Scene, state: &State, violation: &Violation) -> Option<Self> {
        let columns = Columns::new(scene, state)?;
        let (slot, chosen_as) = columns.choose(violation)?;
        let radius = scene.search_radius() as f32;
        let center = columns.position[slot];
        let way = |&p: &Vec3| nearest(scene, p - center);
        let mut around: Vec<(usize, Vec3)> = columns.position.iter().map(way).enumerate().collect();
        around.retain(|(other, way)| *other != slot && way.length() <= SHOWN * radius);
        around.sort_by(|a, b| a.1.length().total_cmp(&b.1.length()));
        let near = match scene.grains() {
            Some(_) => NEAR_GRAINS * radius,
            None => radius,
        };
        let is_near = |way: &Vec3| way.length() < near;
        let neighbors = around
            .iter()
            .filter(|(_, way)| is_near(way))
            .take(MOST_NEIGHBORS)
            .map(|&(other, way)| columns.neighbor(slot, other, way));
        let role = |other: usize, way: &Vec3| match (columns.is_boundary(other), is_near(way)) {
            (true, _) => Role::Wall,
            (false, true) => Role::Neighbor,
            (false, false) => Role::Other,
        };
        let shown = around
            .iter()
            .map(|(other, way)| (center + *way, columns.radius(*other), role(*other, way)));
        Some(Self {
            particle: columns.seen(slot, chosen_as),
            neighbors: neighbors.collect(),
            shown: std::iter::once((center, columns.radius(slot), Role::Particle))
                .chain(shown)
                .collect(),
        })
    }

    /// Where the particle is, local, metres.
    pub fn local(&self) -> Vec3 {
        self.particle.local
    }
}

impl<'a> Columns<'a> {
    fn new(scene: &'a Scene, state: &'a State) -> Option<Self> {
        let pairs = state.buffer("fluid_state").unwrap_or_default().chunks_exact(8);
        let materials = state.buffer("material").unwrap_or_default().chunks_exact(4);
        let radii = state.buffer("radius").unwrap_or_default().chunks_exact(4);
        let columns = Self {
            scene,
            state,
            ids: state.ids(),
            position: state.vectors("position")?,
            velocity: state.vectors("velocity")?,
            fluid: pairs.map(bytemuck::pod_read_unaligned).collect(),
            material: materials.map(bytemuck::pod_read_unaligned).collect(),
            radius: radii.map(bytemuck::pod_read_unaligned).collect(),
        };
        let count = columns.ids.len();
        (columns.position.len() == count && columns.velocity.len() == count).then_some(columns)
    }

    fn is_boundary(&self, slot: usize) -> bool {
        self.ids[slot] >= self.scene.first_boundary()
    }

    /// The particle that was caught, or the one that stands out most, and why it is this one.
    fn choose(&self, violation: &Violation) -> Option<(usize, &'static str)> {
        if let Some(caught) = &violation.particle
            && let Some(slot) = self.ids.iter().position(|&id| id == caught.id)
        {
            return Some((slot, "the particle that the guard caught"));
        }
        let free = (0..self.ids.len()).filter(|&slot| !self.is_boundary(slot));
        let deviation = |slot: usize| self.fluid.get(slot).map_or(0.0, |state| state[0].abs());
        let speed = |slot: usize| self.velocity[slot].length();
        match violation.guard {
            GuardKind::Density if !self.fluid.is_empty() => free
                .max_by(|&a, &b| deviation(a).total_cmp(&deviation(b)))
                .map(|slot| (slot, "the density that is farthest from that at rest")),
            _ => free
                .max_by(|&a, &b| speed(a).total_cmp(&speed(b)))
                .map(|slot| (slot, "the fastest particle")),
        }
    }

    fn global(&self, local: Vec3) -> [f64; 3] {
        (local.as_dvec3() + self.state.origin).to_array()
    }

    fn density(&self, slot: usize) -> Option<f32> {
        let fluid = self.scene.fluid()?;
        let material = self.material.get(slot).copied().unwrap_or(0) as usize;
        let at_rest = fluid.materials.get(material)?.density as f32;
        let [deviation, _] = self.fluid.get(slot)?;
        Some(at_rest * (1.0 + deviation))
    }

    fn pressure(&self, slot: usize) -> Option<f32> {
        self.fluid.get(slot).map(|[_, pressure]| *pressure)
    }

    fn seen(&self, slot: usize, chosen_as: &'static str) -> Seen {
        Seen {
            id: self.ids[slot],
            chosen_as,
            position_m: self.global(self.position[slot]),
            velocity_m_per_s: self.velocity[slot].to_array(),
            density_kg_per_m3: self.density(slot),
            pressure_pa: self.pressure(slot),
            voxel: None,
            local: self.position[slot],
        }
    }

    /// Metres.
    fn radius(&self, slot: usize) -> f32 {
        self.radius
            .get(slot)
            .copied()
            .unwrap_or(self.scene.radius() as f32)
    }

    /// The particle in this slot, seen from that in the slot `center`.
    fn neighbor(&self, center: usize, slot: usize, way: Vec3) -> Neighbor {
        let is_boundary = self.is_boundary(slot);
        let [one, other] = [center, slot].map(|slot| self.radius(slot));
        let overlap = self
            .scene
            .grains()
            .map(|_| (one + other - way.length()).max(0.0) / one.min(other));
        Neighbor {
            id: self.ids[slot],
            is_boundary,
            distance_m: way.length(),
            position_m: self.global(self.position[slot]),
            velocity_m_per_s: self.velocity[slot].to_array(),
            density_kg_per_m3: self.density(slot),
            pressure_pa: self.pressure(slot),
            overlap,
        }
    }
}

/// The shortest way among those to a point and to its images beyond periodic sides.
fn nearest(scene: &Scene, way: Vec3) -> Vec3 {
    let period = scene.domain.period();
    let turns = |axis: usize| match period[axis] > 0.0 {
        true => (way[axis] / period[axis]).round() * period[axis],
        false => 0.0,
    };
    way - Vec3::from([0, 1, 2].map(turns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guards::Family;

    const SCENE: &str = r#"{
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1], "walls": "periodic" },
        "gravity": [0, 0],
        "fluid": { "spacing": 0.1, "max_speed": 1 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [1, 1] } }]
    }"#;

    #[test]
    fn neighbors_are_found_across_periodic_sides_and_the_nearest_is_first() {
        let scene = crate::scene::load::parse(SCENE, "test.json", std::path::Path::new("."), &[]).unwrap();
        let global: Vec<_> = scene
            .particles
            .position
            .iter()
            .map(|p| p.as_dvec3() + scene.origin)
            .collect();
        let mut velocity = vec![Vec3::ZERO; global.len()];
        // At the lower left corner.
        velocity[0] = Vec3::X;
        let state = State::of_particles(&scene, 3, &global, &velocity, None);
        let violation = Violation {
            guard: GuardKind::Energy,
            family: Family::WeaklyCompressible,
            detail: String::new(),
            frame: 4,
            step: 1,
            time: 0.0,
            step_s: 0.0,
            step_limited_by: "",
            particle: None,
        };
        let found = Neighborhood::new(&scene, &state, &violation).unwrap();
        assert_eq!(
            (found.particle.id, found.particle.chosen_as),
            (0, "the fastest particle")
        );
        // All around it, as in the middle.
        let spacing = scene.fluid().unwrap().spacing as f32;
        let next: Vec<f32> = found.neighbors[..4]
            .iter()
            .map(|n| n.distance_m / spacing)
            .collect();
        assert!(
            next.iter().all(|distance| (distance - 1.0).abs() < 1e-3),
            "{next:?}"
        );
        let ways: Vec<Vec3> = found.shown[1..5]
            .iter()
            .map(|(p, ..)| *p - found.local())
            .collect();
        let sum = ways.iter().fold(Vec3::ZERO, |sum, way| sum + *way);
        assert!(sum.length() < 1e-3 * spacing, "{ways:?}");
    }
}
