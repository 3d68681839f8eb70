//! What a recording has room for: decided before the first frame, from upper bounds of everything that is logged.

use crate::neighbors::{Grid, boxes};
use crate::output::text::{bytes, count};
use crate::render::collider_vertices;
use crate::scene::Scene;
use crate::scene::model::Axis;

/// Position (3 × f32) and color (RGBA bytes) of a particle; neither gets smaller by compression.
const PARTICLE_BYTES: u64 = 16;
/// Center and half size of a box.
const BOX_BYTES: u64 = 24;
/// Position and normal of each corner of a collider's triangle.
const TRIANGLE_BYTES: u64 = 72;
/// Documents, blueprint, names, header and footer.
const STATIC_BYTES: u64 = 256 << 10;
/// Curves, occupancy and texts of a frame, each in a chunk of its own, with their rows of the footer.
const FIGURES_BYTES: u64 = 40 << 10;
/// A chunk around a row of data, and its rows of the footer.
const CHUNK_BYTES: u64 = 4 << 10;
/// Bytes of a compressed pixel; pictures that need more are compressed harder.
const PIXEL_BYTES: f64 = 0.4;
/// What is left unplanned, as a divisor of the budget.
const MARGIN: u64 = 50;
/// Frames with particles that a stride leaves, unless the run itself has fewer.
const FEWEST_FRAMES: u32 = 30;
/// Particles that are worth more than every frame of them.
const WORTH_A_STRIDE: u32 = 10_000;

/// What is logged, and how much of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// Bytes of the recording, at most; below the budget where everything has room.
    pub planned: u64,
    /// Frames from one that has particles, boxes, voxels and a picture to the next; figures are there every frame.
    pub stride: u32,
    /// Particles shown, of so many that there can be.
    pub particles: u32,
    pub of_particles: u32,
    pub picture: Option<PictureShare>,
    /// Texels along a side of the index pool's map; none where there is no room.
    pub map_side: Option<u32>,
    /// Whether boxes of allocated voxels are shown.
    pub boxes: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureShare {
    /// Every pixel of a logged picture stands for so many by so many of the frame's.
    pub shrink: u32,
    /// Of one compressed picture, at most.
    pub bytes: u64,
}

impl Share {
    /// `pictures` says whether frames are drawn.
    pub fn new(scene: &Scene, pictures: bool, budget: u64) -> Self {
        let frames = scene.time.frames.max(1);
        let moving = scene.colliders.iter().filter(|c| !c.path.is_empty()).count() as u64;
        let triangles = (collider_vertices(scene).len() / 6) as u64;
        let fixed = STATIC_BYTES
            + document_bytes(scene)
            + triangles * TRIANGLE_BYTES
            + u64::from(frames) * (FIGURES_BYTES + moving * CHUNK_BYTES);
        let room = (budget - budget / MARGIN).saturating_sub(fixed);
        // Boundary particles are not shown.
        let all = scene.first_boundary();
        let enough = all.min((all / 10).max(WORTH_A_STRIDE));
        let longest = (frames / FEWEST_FRAMES).max(1);
        let with = |stride| {
            let share = Self::with_stride(scene, pictures, room, stride);
            let planned = share.planned + fixed + budget / MARGIN;
            Self { planned, ..share }
        };
        (1..=longest)
            .map(with)
            .find(|share| share.particles >= enough)
            .unwrap_or_else(|| with(longest))
    }

    fn with_stride(scene: &Scene, pictures: bool, room: u64, stride: u32) -> Self {
        let shown = u64::from(scene.time.frames.max(1).div_ceil(stride));
        let each = room / shown;
        let grid = Grid::new(scene, Axis::Y);
        let [width, height] = scene.render.size.map(u64::from);
        let picture = [1, 2, 4, 8].into_iter().filter(|_| pictures).find_map(|shrink| {
            let pixels = (width / u64::from(shrink)) * (height / u64::from(shrink));
            let bytes = (pixels as f64 * PIXEL_BYTES) as u64 + CHUNK_BYTES;
            (pixels > 0 && bytes <= each * 2 / 5).then_some(PictureShare { shrink, bytes })
        });
        let useful = (grid.domain_voxels() as f64).sqrt().ceil() as u32;
        let map_side = [512, 256, 128, 64]
            .into_iter()
            .filter(|&side| side < 2 * useful.max(64))
            .find(|side| u64::from(side * side) + CHUNK_BYTES <= each / 10);
        let box_bytes = u64::from(boxes::most_boxes(scene, &grid)) * BOX_BYTES + CHUNK_BYTES;
        let boxes = box_bytes <= each / 10;
        let taken = picture.map_or(0, |picture| picture.bytes)
            + map_side.map_or(0, |side| u64::from(side * side) + CHUNK_BYTES)
            + if boxes { box_bytes } else { 0 };
        let fit = each.saturating_sub(taken + CHUNK_BYTES) / PARTICLE_BYTES;
        let particles = fit.min(u64::from(scene.first_boundary()));
        Self {
            planned: shown * (taken + CHUNK_BYTES + particles * PARTICLE_BYTES),
            stride,
            particles: particles as u32,
            of_particles: scene.first_boundary(),
            picture,
            map_side,
            boxes,
        }
    }

    /// Ids of the particles shown, ascending: always the same ones, scattered evenly over bodies.
    pub fn ids(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = (0..self.of_particles).collect();
        if self.particles < self.of_particles {
            ids.sort_unstable_by_key(|&id| scatter(id));
            ids.truncate(self.particles as usize);
            ids.sort_unstable();
        }
        ids
    }

    /// In words, for the user and for the recording.
    pub fn told(&self, pictures: bool) -> String {
        let (shown, all) = (u64::from(self.particles), u64::from(self.of_particles));
        let mut parts = vec![if shown == all {
            format!("all {} particles", count(all))
        } else {
            format!(
                "{} of {} particles (always the same, chosen at random)",
                count(shown),
                count(all)
            )
        }];
        parts.push(match self.stride {
            1 => "every frame".into(),
            n => format!("one frame of {n}, figures every frame"),
        });
        match self.picture {
            Some(PictureShare { shrink: 1, .. }) => {}
            Some(PictureShare { shrink, .. }) => parts.push(format!("pictures at 1/{shrink} of their size")),
            None if pictures => parts.push("no room for pictures".into()),
            None => {}
        }
        if self.map_side.is_none() {
            parts.push("no room for the index pool".into());
        }
        if !self.boxes {
            parts.push("no room for the boxes of allocated voxels".into());
        }
        format!("{}; at most {}", parts.join(", "), bytes(self.planned))
    }
}

/// The scene's file is logged twice as long as it is at most (indented).
fn document_bytes(scene: &Scene) -> u64 {
    let text = serde_json::to_vec_pretty(&scene.file).unwrap_or_default();
    2 * text.len() as u64
}

/// Mixes the bits of an id (the finalizer of SplitMix64, Steele et al. 2014).
fn scatter(id: u32) -> u64 {
    let mut x = u64::from(id).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::{library, load};

    fn scene(name: &str, frames: u32) -> Scene {
        let text = library::find(name).expect("a scene that ships");
        let mut scene = load::parse(text, name, Path::new("."), &[]).expect("a valid scene");
        scene.time.frames = frames;
        scene
    }

    #[test]
    fn everything_is_there_where_there_is_room() {
        let scene = scene("green_cube", 100);
        let share = Share::new(&scene, true, 10 << 30);
        assert!(share.planned < 1 << 30, "{share:?}");
        assert_eq!((share.stride, share.particles), (1, scene.capacity));
        assert_eq!(share.picture.unwrap().shrink, 1);
        assert!(share.boxes && share.map_side.is_some());
        assert_eq!(share.ids().len(), scene.capacity as usize);
        assert!(share.told(true).starts_with("all "), "{}", share.told(true));
    }

    #[test]
    fn what_is_planned_fits_the_budget() {
        for frames in [1, 60, 300, 3000] {
            let scene = scene("green_cube", frames);
            for budget in [1_000_000, 20_000_000, 100_000_000, 500_000_000_u64] {
                let share = Share::new(&scene, true, budget);
                let heavy = u64::from(frames.div_ceil(share.stride));
                let each = u64::from(share.particles) * PARTICLE_BYTES
                    + share.picture.map_or(0, |picture| picture.bytes)
                    + share.map_side.map_or(0, |side| u64::from(side * side));
                assert!(heavy * each <= budget, "{frames} frames in {budget}: {share:?}");
                assert!(
                    share.particles == 0 || share.planned <= budget,
                    "{budget}: {share:?}"
                );
                assert!(heavy >= u64::from(frames.min(FEWEST_FRAMES)), "{share:?}");
            }
        }
    }

    #[test]
    fn a_small_budget_takes_a_stride_before_it_takes_nearly_all_particles() {
        let scene = scene("green_cube", 3000);
        let share = Share::new(&scene, true, 500_000_000);
        assert!(share.stride > 1 && share.particles >= WORTH_A_STRIDE, "{share:?}");
        let told = share.told(true);
        assert!(told.contains(" of ") && told.contains("one frame of"), "{told}");
    }

    #[test]
    fn the_subset_is_fixed_and_scattered() {
        let share = Share {
            particles: 1000,
            of_particles: 64_000,
            ..Share::new(&scene("green_cube", 10), false, 1 << 30)
        };
        let ids = share.ids();
        assert_eq!(ids.len(), 1000);
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]));
        // A lattice 40 wide keeps all its columns.
        let mut columns = [0; 40];
        ids.iter().for_each(|id| columns[(id % 40) as usize] += 1);
        assert!(columns.iter().all(|&n| (5..=50).contains(&n)), "{columns:?}");
    }
}
