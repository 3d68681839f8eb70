//! Which parts of space have voxels in memory, as boxes.

use glam::Vec3;

use super::Grid;
use super::addressing::Space;
use crate::scene::model::Addressing;
use crate::scene::{Dimensions, Scene};

/// Lower and upper corner, metres, local coordinates.
pub type VoxelBox = [Vec3; 2];

/// Most boxes that there can be, whatever axis slices are cut across.
pub fn most_boxes(scene: &Scene, grid: &Grid) -> u32 {
    match scene.neighbors.addressing {
        Addressing::Sliced => {
            let followed = [0, 1, 2].map(|k| (grid.high[k] - grid.low[k]).max(0) as u32);
            followed.into_iter().max().unwrap_or(0) * Space::of(scene).regions() as u32
        }
        _ => 1,
    }
}

/// Name and bytes of the device buffer that [`boxes`] reads, where boxes change during a run.
pub fn record(scene: &Scene, grid: &Grid) -> Option<(&'static str, u64)> {
    match scene.neighbors.addressing {
        Addressing::Sliced => Some((
            "slice_record",
            16 * (u64::from(grid.slices()) * Space::of(scene).regions() + 1),
        )),
        _ => None,
    }
}

/// Boxes around the voxels in memory: one per slice, or the whole domain. Rows are too many for boxes, so addressings
/// that keep rows have none. `record` holds the bytes of the buffer that [`record`] names.
pub fn boxes(scene: &Scene, grid: &Grid, record: &[u8]) -> Vec<VoxelBox> {
    let [width, slices, depth, _] = grid.size;
    match scene.neighbors.addressing {
        Addressing::Sliced => {
            let records: Vec<[i32; 4]> = bytemuck::pod_collect_to_vec(record);
            // Those of one region after those of the other.
            let at = (grid.low[1]..grid.high[1]).cycle();
            let pairs = at.zip(records.windows(2));
            let slice = |(s, pair): (i32, &[[i32; 4]])| {
                let [first, u, w, width] = pair[0];
                let voxels = pair[1][0] - first;
                let high = |depth| [u + width, s + 1, w + depth];
                (width > 0).then(|| in_space(scene, grid, [u, s, w], high(voxels / width)))
            };
            pairs.filter_map(slice).collect()
        }
        Addressing::Rows | Addressing::Bitmap => Vec::new(),
        Addressing::Uniform | Addressing::Hash | Addressing::Morton => {
            vec![in_space(scene, grid, [0; 3], [width, slices, depth])]
        }
    }
}

/// A box of voxels, given in (u, s, w) order with its upper end excluded.
fn in_space(scene: &Scene, grid: &Grid, low: [i32; 3], high: [i32; 3]) -> VoxelBox {
    let corner = |voxel: [i32; 3]| {
        let along = |k: usize| (f64::from(grid.lower[k]) + f64::from(voxel[k]) * f64::from(grid.side)) as f32;
        let (u, s, w) = (along(0), along(1), along(2));
        let mut point = match grid.axis {
            0 => Vec3::new(s, u, w),
            2 => Vec3::new(u, w, s),
            _ => Vec3::new(u, s, w),
        };
        if scene.dimensions == Dimensions::Two {
            point.z = 0.0;
        }
        point
    };
    [corner(low), corner(high)]
}
