//! Scenes that studies simulate, made of the papers' descriptions.

use std::path::Path;

use glam::Vec3;
use rand::seq::SliceRandom as _;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::error::Result;
use crate::scene::{Neighbors, Particles, Scene, load};

/// Metres; voxels are about twice as wide.
pub const RADIUS: f64 = 0.005;
/// Metres between grains that are placed side by side.
const SPACING: f64 = 0.0102;

/// Grains in a closed box of `voxels` voxels, y up; the text is JSON as users write it.
pub fn base(name: &str, voxels: [u32; 3]) -> Value {
    let extent = voxels.map(|n| 2.0 * RADIUS * f64::from(n));
    json!({
        "name": name,
        "domain": { "min": [0, 0, 0], "max": extent },
        "grains": { "radius": RADIUS, "density": 2500, "spring": 1000, "restitution": 0.5, "shear": 0.1 },
        "bodies": [],
        "neighbors": { "slicing_axis": "y", "skin": 0 },
        "time": { "duration": 1, "fps": 60, "steps_per_contact": 20 },
        "render": {
            "size": [720, 720],
            "camera": { "projection": "orthographic", "axis": "z" },
            "background": "dark",
            "color": { "by": "speed", "map": "white_blue", "range": [0, 2] },
            "show": { "slices": true, "floor": false }
        }
    })
}

/// Harada 2007, Table 1 and Figure 2: a block of `columns` × `layers` × `columns` grains is dropped in the middle of a
/// cube of `cells`³ voxels.
pub fn dropped_block(cells: u32, columns: u32, layers: u32, seconds: f64, fps: f64) -> Result<Scene> {
    let mut file = base(&format!("{} grains", columns * columns * layers), [cells; 3]);
    let middle = RADIUS * f64::from(cells);
    // The lattice fills a box in whole grains.
    let half = SPACING * f64::from(columns) / 2.0;
    let (low, high) = (middle - half, middle + half);
    let bottom = 0.02 * 2.0 * middle;
    let top = bottom + SPACING * f64::from(layers);
    file["bodies"] = json!([{
        "shape": { "kind": "box", "min": [low, bottom, low], "max": [high, top, high] },
        "spacing": SPACING,
        "jitter": 0.01
    }]);
    file["time"]["duration"] = seconds.into();
    file["time"]["fps"] = fps.into();
    parse(&file)
}

/// A scene of `file` with these grains (in the scene's own coordinates) in place of its bodies.
pub fn with_particles(file: &Value, particles: Particles) -> Result<Scene> {
    let mut file = file.clone();
    // One grain, which is replaced.
    let middle = centre(&file);
    let grain = file["grains"]["radius"].as_f64().unwrap_or(RADIUS);
    file["bodies"] = json!([{ "shape": { "kind": "sphere", "center": middle, "radius": 1.5 * grain } }]);
    let scene = parse(&file)?;
    let origin = scene.origin.as_vec3();
    let position = particles.position.iter().map(|&p| p - origin).collect();
    Ok(replaced(
        &scene,
        Particles {
            position,
            ..particles
        },
    ))
}

/// The scene with other grains at its start.
pub fn replaced(scene: &Scene, particles: Particles) -> Scene {
    Scene {
        capacity: (particles.len() + scene.boundary.len()) as u32,
        particles,
        rigid_bodies: Vec::new(),
        ..scene.clone()
    }
}

pub fn parse(file: &Value) -> Result<Scene> {
    let name = file["name"].as_str().unwrap_or("study").to_owned();
    load::parse(&file.to_string(), &format!("{name}.json"), Path::new(""), &[])
}

/// What `+lists` and `+any-order` behind a grid's name ask for: neighbor lists with the usual skin, and no canonical
/// order.
pub const LISTS: &str = "+lists";
pub const ANY_ORDER: &str = "+any-order";

/// The scene with another grid, `ADDRESSING-STORAGE`, with [`LISTS`] or [`ANY_ORDER`] behind.
pub fn with_grid(scene: &Scene, grid: &str) -> Result<Scene> {
    let plain = grid.trim_end_matches(LISTS).trim_end_matches(ANY_ORDER);
    let (addressing, storage) = plain.split_once('-').unwrap_or((plain, "counting"));
    let mut file = serde_json::to_value(&scene.file).expect("a validated scene has text keys");
    file["neighbors"]["addressing"] = addressing.into();
    file["neighbors"]["storage"] = storage.into();
    if grid.ends_with(LISTS) {
        file["neighbors"]["skin"] = Neighbors::default().skin.into();
    }
    if grid.ends_with(ANY_ORDER) {
        file["neighbors"]["deterministic"] = false.into();
    }
    // Only the search's own choices are taken over, so that bodies need not be placed again.
    file["bodies"] =
        json!([{ "shape": { "kind": "sphere", "center": centre(&file), "radius": 1.5 * scene.radius() } }]);
    file["events"] = json!([]);
    let chosen = parse(&file)?;
    Ok(Scene {
        neighbors: chosen.neighbors,
        file: chosen.file,
        ..scene.clone()
    })
}

fn centre(file: &Value) -> Vec<f64> {
    let ends = |axis: usize| ["min", "max"].map(|end| file["domain"][end][axis].as_f64().unwrap_or(0.0));
    let dimensions = file["domain"]["min"].as_array().map_or(3, Vec::len);
    (0..dimensions)
        .map(|axis| ends(axis).iter().sum::<f64>() / 2.0)
        .collect()
}

/// Points on a lattice of one voxel's width inside the box, those for which `inside` holds, displaced by up to a
/// hundredth of a voxel and at rest.
pub fn lattice(voxels: [u32; 3], inside: impl Fn(Vec3) -> bool) -> Particles {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let width = 2.0 * RADIUS as f32;
    let mut position = Vec::new();
    for y in 0..voxels[1] {
        for z in 0..voxels[2] {
            for x in 0..voxels[0] {
                let voxel = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
                if inside(voxel) {
                    let jitter = Vec3::from([(); 3].map(|()| random.random_range(-0.01..0.01)));
                    position.push((voxel + jitter) * width);
                }
            }
        }
    }
    at_rest(position)
}

pub fn at_rest(position: Vec<Vec3>) -> Particles {
    Particles {
        velocity: vec![Vec3::ZERO; position.len()],
        position,
        ..Particles::default()
    }
}

/// The same particles in another order, the same one every time.
pub fn shuffled(particles: &Particles) -> Particles {
    let mut order: Vec<usize> = (0..particles.len()).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(2));
    reordered(particles, &order)
}

/// The same particles in the order of the keys.
pub fn sorted<K: Ord>(particles: &Particles, key: impl Fn(Vec3) -> K) -> Particles {
    let mut order: Vec<usize> = (0..particles.len()).collect();
    order.sort_by_cached_key(|&i| key(particles.position[i]));
    reordered(particles, &order)
}

fn reordered(particles: &Particles, order: &[usize]) -> Particles {
    Particles {
        position: order.iter().map(|&i| particles.position[i]).collect(),
        velocity: order.iter().map(|&i| particles.velocity[i]).collect(),
        ..Particles::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dropped_block_has_its_grains_in_the_cube() {
        let scene = dropped_block(64, 8, 32, 0.1, 60.0).unwrap();
        assert_eq!(scene.capacity, 2048);
        let widest = scene.domain.max - scene.domain.min;
        assert!((widest - 0.64).abs().max_element() < 1e-6);
    }

    #[test]
    fn placed_grains_lie_in_the_domain() {
        let scene = with_particles(&base("tank", [12; 3]), lattice([12; 3], |_| true)).unwrap();
        assert_eq!(scene.capacity, 12 * 12 * 12);
        let reach = Vec3::splat(0.97 * RADIUS as f32);
        for &position in &scene.particles.position {
            let inside = position.cmpge(scene.domain.min + reach) & position.cmple(scene.domain.max - reach);
            assert!(inside.all(), "{position}");
        }
    }

    #[test]
    fn another_grid_changes_nothing_else() {
        let scene = dropped_block(32, 4, 8, 0.1, 60.0).unwrap();
        let other = with_grid(&scene, "rows-pool").unwrap();
        assert_eq!(other.particles, scene.particles);
        assert_eq!(other.time, scene.time);
        assert_ne!(other.neighbors, scene.neighbors);
        assert!(with_grid(&scene, "cubes-pool").is_err());
        let listed = with_grid(&scene, "rows-counting+lists").unwrap();
        assert!(listed.neighbors.skin > 0.0 && other.neighbors.skin == 0.0);
        assert!(
            !with_grid(&scene, "rows-counting+any-order")
                .unwrap()
                .neighbors
                .deterministic
        );
    }

    #[test]
    fn orders_hold_the_same_particles() {
        let particles = lattice([8, 8, 8], |_| true);
        let again = sorted(&shuffled(&particles), |p| {
            (p * 100.0).to_array().map(|x| x as i32)
        });
        assert_ne!(shuffled(&particles), particles);
        assert_eq!(
            again,
            sorted(&particles, |p| (p * 100.0).to_array().map(|x| x as i32))
        );
    }
}
