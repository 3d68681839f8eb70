//! Colliders, and rigid bodies in a fluid, as triangles.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use super::backdrop::linear;
use crate::scene::floating::Surface;
use crate::scene::mesh::Mesh;
use crate::scene::{ColliderShape, Dimensions, Domain, Scene};

/// Two entries a vertex: position and the collider's number; normal and 1 where only the outside is drawn.
pub type Vertices = Vec<[f32; 4]>;

/// How thick pictures of a 2D scene show the rim of a hollow obstacle, in its radii.
const RIM: f32 = 0.03;

/// Edges sharper than this stay sharp in a mesh's shading.
const CREASE_COSINE: f64 = 0.7;

/// Every visible collider, where its shape places it; then rigid bodies in a fluid, each in its own axes and numbered behind
/// all colliders.
pub fn triangles(scene: &Scene) -> Vertices {
    let mut all = Triangles::default();
    for (number, collider) in scene.colliders.iter().enumerate() {
        if collider.visible {
            all.number = number as f32;
            all.shape(&collider.shape, scene);
        }
    }
    for (number, surface) in (scene.colliders.len()..).zip(surfaces(scene)) {
        all.number = number as f32;
        all.shape(&surface.shape, scene);
    }
    all.vertices
}

/// Those of rigid bodies in a fluid, body by body.
pub fn surfaces(scene: &Scene) -> impl Iterator<Item = &Surface> {
    scene
        .rigid_bodies
        .iter()
        .filter_map(|body| body.surface.as_deref())
}

/// Two entries a collider, and then a body: present offset and 1 where it casts a shadow; linear color. The device knows where
/// bodies are.
pub fn looks(scene: &Scene, offsets: &[Vec3]) -> Vec<[f32; 4]> {
    let mut looks = Vec::new();
    for (index, collider) in scene.colliders.iter().enumerate() {
        let offset = offsets.get(index).copied().unwrap_or_default();
        // A plane has no outline, so its shadow would end at the domain's sides.
        let casts = !matches!(collider.shape, ColliderShape::Plane { .. });
        looks.push(offset.extend(f32::from(u8::from(casts))).to_array());
        looks.push(linear_color(collider.color));
    }
    for surface in surfaces(scene) {
        looks.push([0.0, 0.0, 0.0, 1.0]);
        looks.push(linear_color(surface.color));
    }
    looks
}

fn linear_color(color: [f32; 3]) -> [f32; 4] {
    let [r, g, b] = color.map(|c| linear((c * 255.0).round() as u8));
    [r, g, b, 1.0]
}

#[derive(Default)]
struct Triangles {
    vertices: Vertices,
    number: f32,
}

impl Triangles {
    fn vertex(&mut self, position: Vec3, normal: Vec3, outside_only: bool) {
        self.vertices.push(position.extend(self.number).to_array());
        self.vertices
            .push(normal.extend(f32::from(u8::from(outside_only))).to_array());
    }

    /// A convex polygon as a fan.
    fn fan(&mut self, polygon: &[Vec3], normal: Vec3, outside_only: bool) {
        for k in 2..polygon.len() {
            for corner in [polygon[0], polygon[k - 1], polygon[k]] {
                self.vertex(corner, normal, outside_only);
            }
        }
    }

    fn shape(&mut self, shape: &ColliderShape, scene: &Scene) {
        let flat = scene.dimensions == Dimensions::Two;
        match shape {
            ColliderShape::Plane { point, normal } if flat => {
                let solid = clip(&domain_rectangle(&scene.domain), *point, -*normal);
                self.fan(&solid, Vec3::Z, false);
            }
            ColliderShape::Plane { point, normal } => {
                self.fan(&plane_in_box(*point, *normal, &scene.domain), *normal, true);
            }
            ColliderShape::Box { min, max } if flat => {
                self.fan(&rectangle(*min, *max), Vec3::Z, false);
            }
            ColliderShape::Box { min, max } => self.solid_box(*min, *max),
            ColliderShape::Sphere {
                center,
                radius,
                hollow: true,
            } if flat => self.ring(*center, *radius),
            // What is inside would be hidden.
            ColliderShape::Sphere { hollow: true, .. } => {}
            ColliderShape::Sphere { center, radius, .. } if flat => {
                let circle: Vec<Vec3> = (0..96).map(|k| center + on_circle(k) * *radius).collect();
                self.fan(&circle, Vec3::Z, false);
            }
            ColliderShape::Sphere { center, radius, .. } => self.sphere(*center, *radius),
            ColliderShape::Cylinder {
                from,
                to,
                radius,
                hollow,
            } => self.cylinder([*from, *to], *radius, *hollow),
            ColliderShape::Mesh(mesh) => self.mesh(mesh),
        }
    }

    /// The rim of what is solid around a disc.
    fn ring(&mut self, center: Vec3, radius: f32) {
        for k in 0..96 {
            let (a, b) = (on_circle(k), on_circle(k + 1));
            let outer = 1.0 + RIM;
            let quad = [a, a * outer, b * outer, b].map(|corner| center + corner * radius);
            self.fan(&quad, Vec3::Z, false);
        }
    }

    /// With both ends where it is solid inside. Of a hollow one the side that the eye looks at from inside.
    fn cylinder(&mut self, ends: [Vec3; 2], radius: f32, hollow: bool) {
        let axis = (ends[1] - ends[0]).normalize_or_zero();
        let (u, v) = axis.any_orthonormal_pair();
        let around = |k: u32| {
            let corner = on_circle(k);
            u * corner.x + v * corner.y
        };
        let side = if hollow { -1.0 } else { 1.0 };
        for k in 0..96 {
            let (a, b) = (around(k), around(k + 1));
            let [low, high] = ends;
            for (end, normal) in [(low, a), (low, b), (high, b), (low, a), (high, b), (high, a)] {
                self.vertex(end + normal * radius, normal * side, true);
            }
        }
        if !hollow {
            for (end, normal) in [(ends[0], -axis), (ends[1], axis)] {
                let circle: Vec<Vec3> = (0..96).map(|k| end + around(k) * radius).collect();
                self.fan(&circle, normal, true);
            }
        }
    }

    fn solid_box(&mut self, min: Vec3, max: Vec3) {
        let (middle, half) = ((min + max) * 0.5, (max - min) * 0.5);
        for axis in 0..3 {
            for sign in [-1.0_f32, 1.0] {
                let pick = |a: usize, s: f32| {
                    let mut v = Vec3::ZERO;
                    v[a % 3] = s;
                    v
                };
                let (normal, u, v) = (pick(axis, sign), pick(axis + 1, 1.0), pick(axis + 2, 1.0));
                let corners = [-u - v, u - v, u + v, v - u].map(|c| middle + (c + normal) * half);
                self.fan(&corners, normal, true);
            }
        }
    }

    fn sphere(&mut self, center: Vec3, radius: f32) {
        let (rings, sectors) = (48, 96);
        let at = |ring: u32, sector: u32| {
            let (s, c) = (ring as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
            let (t, u) = (sector as f32 / sectors as f32 * std::f32::consts::TAU).sin_cos();
            Vec3::new(s * u, c, s * t)
        };
        for ring in 0..rings {
            for sector in 0..sectors {
                let quad = [
                    at(ring, sector),
                    at(ring, sector + 1),
                    at(ring + 1, sector + 1),
                    at(ring + 1, sector),
                ];
                for k in [0, 1, 2, 0, 2, 3] {
                    self.vertex(center + quad[k] * radius, quad[k], true);
                }
            }
        }
    }

    /// Smooth where faces meet gently, sharp at creases; normals weighted by area.
    fn mesh(&mut self, mesh: &Mesh) {
        let corner = |i: u32| mesh.vertices[i as usize];
        let normal = |[a, b, c]: [u32; 3]| (corner(b) - corner(a)).cross(corner(c) - corner(a));
        let mut faces_at: BTreeMap<u32, Vec<DVec3>> = BTreeMap::new();
        for &triangle in &mesh.triangles {
            for vertex in triangle {
                faces_at.entry(vertex).or_default().push(normal(triangle));
            }
        }
        for &triangle in &mesh.triangles {
            let own = normal(triangle);
            let unit = own.normalize_or_zero();
            for vertex in triangle {
                let gentle = faces_at[&vertex]
                    .iter()
                    .filter(|face| face.normalize_or_zero().dot(unit) > CREASE_COSINE);
                let smooth = gentle.sum::<DVec3>().normalize_or(unit);
                self.vertex(corner(vertex).as_vec3(), smooth.as_vec3(), false);
            }
        }
    }
}

/// The k-th of 96 points of a circle of radius one.
fn on_circle(k: u32) -> Vec3 {
    Vec3::from((glam::Vec2::from_angle((k % 96) as f32 * 0.065_449_85), 0.0))
}

fn rectangle(min: Vec3, max: Vec3) -> Vec<Vec3> {
    vec![
        Vec3::new(min.x, min.y, 0.0),
        Vec3::new(max.x, min.y, 0.0),
        Vec3::new(max.x, max.y, 0.0),
        Vec3::new(min.x, max.y, 0.0),
    ]
}

fn domain_rectangle(domain: &Domain) -> Vec<Vec3> {
    rectangle(domain.min, domain.max)
}

/// The part of a convex polygon where `dot(p - point, side) >= 0` (Sutherland and Hodgman 1974).
fn clip(polygon: &[Vec3], point: Vec3, side: Vec3) -> Vec<Vec3> {
    let mut kept = Vec::new();
    for (index, &a) in polygon.iter().enumerate() {
        let b = polygon[(index + 1) % polygon.len()];
        let (da, db) = ((a - point).dot(side), (b - point).dot(side));
        if da >= 0.0 {
            kept.push(a);
        }
        if (da < 0.0) != (db < 0.0) {
            kept.push(a + (b - a) * (da / (da - db)));
        }
    }
    kept
}

/// The polygon in which a plane cuts the domain.
pub fn plane_in_box(point: Vec3, normal: Vec3, domain: &Domain) -> Vec<Vec3> {
    let (u, v) = normal.any_orthonormal_pair();
    let reach = (domain.max - domain.min).length() + (point - domain.min).length();
    let mut polygon: Vec<Vec3> = [-u - v, u - v, u + v, v - u]
        .iter()
        .map(|&c| point + c * reach)
        .collect();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        polygon = clip(&polygon, domain.min, axis);
        polygon = clip(&polygon, domain.max, -axis);
    }
    polygon
}
