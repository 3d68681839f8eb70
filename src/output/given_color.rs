//! Colors from values that a run has left, where nothing needs to be measured again.

use glam::Vec3;

use super::read_back::Snapshot;
use crate::physics;
use crate::scene::Scene;
use crate::scene::field::Kind;
use crate::simulation::State;

/// Columns that follow from positions alone, and from the grid that pictures are drawn with.
const OF_POSITION: [&str; 5] = ["x", "y", "z", "id", "slice"];

/// The values that color a frame's particles, in order of id, as particle files or a checkpoint hold them. `None` where
/// they do not, or where positions say the same.
pub fn values(scene: &Scene, snapshot: &Snapshot) -> Option<Vec<f32>> {
    let name = scene.color.column.name;
    if OF_POSITION.contains(&name) {
        return None;
    }
    if let Some(column) = snapshot.column(name).filter(|column| column.width == 1) {
        return Some(column.values.iter().map(|&value| value as f32).collect());
    }
    if let Some(velocity) = snapshot.column("velocity").filter(|column| column.width == 3) {
        let of: Option<fn(Vec3) -> f32> = match name {
            "speed" => Some(Vec3::length),
            "velocity_x" => Some(|v| v.x),
            "velocity_y" => Some(|v| v.y),
            "velocity_z" => Some(|v| v.z),
            _ => None,
        };
        if let Some(of) = of {
            let vector = |v: &[f64]| of(Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32));
            return Some(velocity.values.chunks_exact(3).map(vector).collect());
        }
    }
    snapshot.state.as_ref().and_then(|state| of_state(scene, state))
}

/// What a checkpoint's state says of the particles.
fn of_state(scene: &Scene, state: &State) -> Option<Vec<f32>> {
    let name = scene.color.column.name;
    let material: Option<Vec<u32>> = state.buffer("material").map(bytemuck::pod_collect_to_vec);
    let material_of = |slot: usize| material.as_ref().map_or(0, |of| of[slot] as usize);
    let derived = physics::model(&scene.matter).from_state;
    let derived = derived.iter().find(|derived| derived.column == name);
    let found = match derived {
        Some(derived) => state.buffer(derived.buffer)?,
        None => state.buffer(name)?,
    };
    let found: Vec<f32> = match (derived, scene.kind_of(name)) {
        (None, Kind::Unsigned) => {
            let numbers: Vec<u32> = bytemuck::pod_collect_to_vec(found);
            numbers.into_iter().map(|number| number as f32).collect()
        }
        _ => bytemuck::pod_collect_to_vec(found),
    };
    let ids = state.ids();
    let mut values = vec![0.0; ids.len().checked_sub(scene.boundary.len())?];
    for (slot, &id) in ids.iter().enumerate() {
        // Boundary particles have the highest ids.
        let Some(value) = values.get_mut(id as usize) else {
            continue;
        };
        *value = match derived {
            Some(derived) => {
                let own = &found[slot * derived.width..][..derived.width];
                (derived.value)(scene, own, material_of(slot))
            }
            None => found[slot],
        };
    }
    Some(values)
}
