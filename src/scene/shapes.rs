//! Regions filled with grains (stub; replaced on merging).

use glam::DVec3;
use rand_chacha::ChaCha8Rng;

use super::Dimensions;
use super::mesh::Mesh;

pub enum Region {
    Box { min: DVec3, max: DVec3 },
    Sphere { center: DVec3, radius: f64 },
    Cylinder { from: DVec3, to: DVec3, radius: f64 },
    Mesh(Mesh),
}

pub fn lattice(
    region: &Region,
    dimensions: Dimensions,
    radius: f64,
    spacing: f64,
    _jitter: f64,
    _rng: &mut ChaCha8Rng,
) -> Vec<DVec3> {
    let (min, max) = match region {
        Region::Box { min, max } => (*min, *max),
        Region::Sphere { center, radius } => (*center - *radius, *center + *radius),
        _ => return Vec::new(),
    };
    let count = ((max - min - 2.0 * radius) / spacing + 1e-6).floor().as_i64vec3() + 1;
    let planes = if dimensions == Dimensions::Two { 1 } else { count.z };
    let first = (min + max) / 2.0 - (count - 1).as_dvec3() * spacing / 2.0;
    let mut points = Vec::new();
    for z in 0..planes {
        for y in 0..count.y {
            for x in 0..count.x {
                let mut point = first + DVec3::new(x as f64, y as f64, z as f64) * spacing;
                if dimensions == Dimensions::Two {
                    point.z = 0.0;
                }
                let inside = match region {
                    Region::Sphere { center, radius: ball } => {
                        point.distance(*center) + radius <= ball * (1.0 + 1e-9)
                    }
                    _ => true,
                };
                if inside {
                    points.push(point);
                }
            }
        }
    }
    points
}

pub fn random(
    region: &Region,
    dimensions: Dimensions,
    radius: f64,
    _fraction: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<DVec3> {
    lattice(region, dimensions, radius, 2.0 * radius, 0.0, rng)
}

pub fn without_overlaps(points: &[DVec3], _distance: f64) -> Vec<usize> {
    (0..points.len()).collect()
}
