//! Neighbor search = addressing × storage: which voxel a point falls in, and how a voxel keeps its particles.
//!
//! Physics sees three things, whatever stands behind them: `RANGES`, `candidate_range(home, k)` and
//! `candidate(slot)`. A row of [`ADDRESSINGS`] or [`STORAGES`] and its shader files are all that a new way needs.

pub mod addressing;
pub mod boxes;
pub mod grid;
pub mod layout;
pub mod lists;
pub mod occupancy;
pub mod room;
mod sort;
pub mod storage;

pub use addressing::ADDRESSINGS;
pub use grid::Grid;
pub use room::Room;
pub use storage::STORAGES;

use glam::Vec3;

use crate::gpu::{BufferPlan, DISPATCHES, Items, PassPlan, Variant};
use crate::scene::field::GoesOn;
use crate::scene::model::{Addressing, Axis};
use crate::scene::{Dimensions, Scene};
use addressing::{RoomRule, Space};

/// Shader file that gives physics its candidates straight from the voxels.
pub const FROM_VOXELS: &str = "storage/from_voxels";

/// What a picture of the voxels shows where there is none.
pub const NO_VOXEL: u32 = u32::MAX;
/// Empty columns between two clusters that part them, and regions along one direction (Harada 2007, Section 7).
const REGION_GAP: u32 = 4;
const REGIONS_ALONG: u32 = 4;
/// Flags that an addressing or a storage may set.
const FLAGS: &[&str] = &[
    "bitmap",
    "bounded",
    "fixed_room",
    "packed_pairs",
    "regions",
    "separated",
];

/// Slices are cut across another axis when that needs so much less room.
const WORTH_TURNING: f64 = 0.9;

/// The buffers and passes of a scene's neighbor search. The passes read `next_position` and the other `next_` columns
/// and leave the particles in `position` and so on, with the grid made for them.
pub struct Search {
    pub grid: Grid,
    pub buffers: Vec<BufferPlan>,
    pub passes: Vec<PassPlan>,
    /// Whether boundary particles stand behind all others.
    separated: bool,
    /// Which passes that copy particles' fields need a second one.
    goes_on: GoesOn,
    /// Flags of the variant that the addressing and the storage need.
    flags: Vec<&'static str>,
    /// Constants of the variant that the storage needs.
    constants: Vec<(&'static str, u32)>,
    /// What a user should know about them.
    pub notes: Vec<String>,
}

/// What a scene's first state needs, with the slicing axis that needs least where the scene leaves it open.
pub fn first_grid(scene: &Scene) -> Grid {
    let (grid, room) = least(scene, &scene.positions());
    let reached = lists::reached_at_start(scene, &grid);
    roomy(scene, grid, Room { reached, ..room })
}

/// The same for particles at these local positions.
pub fn grid_for(scene: &Scene, positions: &[Vec3]) -> Grid {
    let (grid, room) = least(scene, positions);
    roomy(scene, grid, room)
}

/// The grid and the room that these local positions need, without any margin, with the slicing axis that needs least
/// where the scene leaves it open.
fn least(scene: &Scene, positions: &[Vec3]) -> (Grid, Room) {
    axes(scene)
        .map(|axis| measured(scene, axis, positions))
        .min_by_key(|(_, room)| (room.voxels, room.rows))
        .expect("a scene has axes")
}

/// A grid with room for `needed`; with slices across another axis where the scene leaves it open and these positions
/// need clearly less then.
pub fn grown_grid(scene: &Scene, grid: Grid, needed: Room, positions: Option<&[Vec3]>) -> Grid {
    let turned = positions.and_then(|positions| {
        axes(scene)
            .map(|axis| measured(scene, axis, positions))
            .filter(|(_, room)| f64::from(room.voxels) < WORTH_TURNING * f64::from(needed.voxels))
            .min_by_key(|(_, room)| room.voxels)
    });
    match turned {
        Some((turned, room)) => roomy(scene, turned, room),
        None => {
            let has = grid.room();
            // What was not too small keeps its size.
            let pick = |needed: u32, has: u32, roomy: u32| if needed > has { roomy } else { has };
            let more = roomy(scene, grid, needed).room();
            grid.with_room(Room {
                voxels: pick(needed.voxels, has.voxels, more.voxels),
                rows: pick(needed.rows, has.rows, more.rows),
                words: pick(needed.words, has.words, more.words),
                list: pick(needed.list, has.list, more.list),
                reached: pick(needed.reached, has.reached, more.reached),
            })
        }
    }
}

/// Whether particles can need more room than the grid has.
pub fn can_grow(scene: &Scene, grid: &Grid) -> bool {
    lists::wanted(scene)
        || match addressing::row(scene.neighbors.addressing).room {
            RoomRule::Fixed(_) => false,
            RoomRule::Followed(_) => !room::most(grid).is_within(grid.room()),
        }
}

/// How much room a scene's grid needs for these local positions, without any margin.
pub fn room_for(scene: &Scene, axis: Axis, positions: &[Vec3]) -> Room {
    measured(scene, axis, positions).1
}

fn axes(scene: &Scene) -> impl Iterator<Item = Axis> {
    let dimensions = scene.dimensions.count();
    let given = scene.neighbors.slicing_axis.fixed();
    [Axis::Y, Axis::X, Axis::Z]
        .into_iter()
        .take(dimensions)
        .filter(move |&axis| given.is_none_or(|given| given == axis))
}

fn measured(scene: &Scene, axis: Axis, positions: &[Vec3]) -> (Grid, Room) {
    let mut grid = Grid::new(scene, axis);
    let mut room = match addressing::row(scene.neighbors.addressing).room {
        RoomRule::Fixed(room) => room(&mut grid, scene),
        RoomRule::Followed(room) => room(scene, &mut positions.iter().filter_map(|&p| grid.voxel(p))),
    };
    if lists::wanted(scene) {
        room.list = lists::usual_length(scene);
    }
    if scene.dimensions == Dimensions::Two && room.rows > 0 {
        room.rows = grid.slices();
    }
    (grid, room)
}

/// The grid with room for what is needed and the scene's margin.
fn roomy(scene: &Scene, grid: Grid, needed: Room) -> Grid {
    let most = Room {
        reached: match lists::knows_reach(scene) {
            true => scene.boundary.len() as u32,
            false => 0,
        },
        ..room::most(&grid)
    };
    let more = needed.with_margin(scene.neighbors.margin, most);
    match addressing::row(scene.neighbors.addressing).room {
        RoomRule::Fixed(_) => grid.with_room(Room {
            list: more.list,
            reached: more.reached,
            ..needed
        }),
        RoomRule::Followed(_) => grid.with_room(more),
    }
}

/// The search that a scene asks for, through this grid; sets the roles `<addressing>` and `<storage>` of `variant`.
pub fn plan(scene: &Scene, grid: Grid, variant: &mut Variant) -> Search {
    variant
        .role("addressing", addressing::row(scene.neighbors.addressing).query)
        .role("storage", storage::row(scene.neighbors.storage).query)
        .role("candidates", FROM_VOXELS)
        .role("marks", "cells/next_voxel")
        .constant("SLOTS", scene.neighbors.slots)
        .constant("REACH", grid::voxel_reach(scene))
        .flag("deterministic", scene.neighbors.deterministic);
    let mut search = Search::new(scene, grid, scene.capacity);
    variant
        .constant("NO_VOXEL", NO_VOXEL)
        .constant("REGIONS_ALONG", REGIONS_ALONG)
        .constant("REGION_GAP", REGION_GAP)
        .without(lists::FLAGS);
    if lists::wanted(scene) {
        lists::plan(&mut search, scene, variant);
    }
    if storage::row(scene.neighbors.storage).sorts {
        search.passes.push(PassPlan::new(
            "storage/sorted/keep",
            "keep_fields",
            match lists::wanted(scene) {
                true => Items::SearchedParticles,
                false => Items::Particles,
            },
            "what no step changes, for the next search",
        ));
    }
    search.set_flags(variant);
    for &(name, value) in &search.constants {
        variant.constant(name, value);
    }
    search
}

impl Search {
    /// The voxels alone that an addressing lays out in a grid, without particles in them. The roles `<marks>` and
    /// `<addressing>` of `variant` say which voxels there are, and how they are found: `span(voxel, 0)` is a voxel itself.
    pub fn of_voxels(kind: Addressing, grid: Grid, variant: &mut Variant) -> Self {
        let space = Space {
            dimensions: Dimensions::Three,
            parted: false,
            is_open: true,
        };
        let mut search = Self::bare(grid);
        search.address(kind, space);
        variant
            .role("addressing", addressing::row(kind).query)
            .constant("REACH", 0)
            .constant("NO_VOXEL", NO_VOXEL);
        search.set_flags(variant);
        search
    }

    /// Everything that a scene's search has, with room for so many particles and for the voxels that `grid` says.
    fn new(scene: &Scene, grid: Grid, particles: u32) -> Self {
        let storage = storage::row(scene.neighbors.storage);
        let mut search = Self {
            separated: storage.sorts && !scene.boundary.is_empty(),
            goes_on: scene.goes_on(),
            ..Self::bare(grid)
        };
        if search.separated {
            search.flags.push("separated");
        }
        search.address(scene.neighbors.addressing, Space::of(scene));
        (storage.plan)(&mut search, particles, &scene.neighbors);
        search
    }

    /// What every search has.
    fn bare(grid: Grid) -> Self {
        Self {
            buffers: vec![
                BufferPlan::constant("grid", &grid, "place and size of the voxels"),
                BufferPlan::indirect(
                    "dispatch",
                    DISPATCHES.len() as u64,
                    16,
                    "workgroups of the passes, which the device decides",
                ),
            ],
            passes: Vec::new(),
            flags: Vec::new(),
            constants: Vec::new(),
            notes: Vec::new(),
            separated: false,
            goes_on: GoesOn::default(),
            grid,
        }
    }

    /// Adds what an addressing needs.
    fn address(&mut self, kind: Addressing, space: Space) {
        let addressing = addressing::row(kind);
        if matches!(addressing.room, RoomRule::Fixed(_)) {
            self.flags.push("fixed_room");
        }
        (addressing.plan)(self, space);
    }

    /// Decides about the flags of addressings and storages.
    fn set_flags(&self, variant: &mut Variant) {
        for flag in FLAGS {
            variant.flag(flag, self.flags.contains(flag));
        }
    }
}
