//! Neighbor lists (Verlet 1967): each particle's neighbors within the search radius and a skin serve every step until a
//! particle has moved by half the skin, or in a fluid strayed by as much from the straight path that it was on
//! ([`StraightPaths`]); only then are particles searched anew. The device decides.
//!
//! Boundary particles without fluid within the radius and the skin are out of reach: no fluid can come near them before the
//! next search, so they have no lists, and passes leave them out (`shaders/storage/lists/reached.wgsl`).

use std::collections::HashSet;

use super::addressing::search_state;
use super::grid::Voxel;
use super::layout::ListState;
use super::{Grid, Room, Search, storage};
use crate::error::{Error, Result};
use crate::gpu::{BufferPlan, Items, Limits, PassPlan, Variant};
use crate::scene::{Scene, StepLimits, floating};

/// Shader of the pass that counts a step; with lists it also decides whether to search.
const CLOCK: &str = "physics/advance_clock";

/// Flags that lists may set.
pub(super) const FLAGS: &[&str] = &[
    "lists",
    "lists_every_step",
    "straight_paths",
    "periodic",
    "walls_apart",
    "boundary_in_reach",
    floating::FLAG,
];

/// Particles whose rows of a list are interleaved: what the narrowest processors read side by side; wider ones read whole
/// sectors of memory all the same.
const LIST_LANES: u32 = 8;

/// Of straight paths, see [`StraightPaths`]: how much farther lists look than the skin, in search radii.
const PATH_REACH: f64 = 0.2;
/// The same: steps, as long as they may be, that the first lists look ahead.
const PATH_STEPS: u32 = 10;

/// Whether the scene asks for lists.
pub fn wanted(scene: &Scene) -> bool {
    scene.neighbors.skin > 0.0 || every_step(scene)
}

/// Whether lists are made in every step, for a solver that goes over them many times before particles move.
pub fn every_step(scene: &Scene) -> bool {
    scene.neighbors.lists_every_step
}

/// Lists of fluids hold the particles that come within the radius and the skin if all go straight on for a while, and serve
/// until one of them strays from its path by half the skin. Spray is fast, but hardly accelerated: it keeps its lists, where a
/// skin as wide as its way would make all lists long. Lists look only so far for particles that come near; so they end, too,
/// when one has gone half as far as they look beyond the radius.
///
/// How long they look ahead follows from how long the last ones lasted (`shaders/storage/lists/decide.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightPaths {
    /// How much farther than the radius and the skin lists look, m.
    pub reach: f64,
    /// How long the first ones look ahead, s.
    pub horizon: f64,
}

/// The paths that a scene's lists expect; `None` where they expect particles to stay.
pub fn straight_paths(scene: &Scene) -> Option<StraightPaths> {
    if every_step(scene) || !wanted(scene) || scene.fluid().is_none() {
        return None;
    }
    let time = &scene.time;
    let step = time.adaptive.as_ref().map_or(time.step, StepLimits::longest);
    Some(StraightPaths {
        reach: PATH_REACH * scene.search_radius(),
        horizon: f64::from(PATH_STEPS) * step,
    })
}

/// Whether boundary particles stand at the end of each list, for a solver whose loops leave them out.
fn walls_apart(scene: &Scene) -> bool {
    every_step(scene) && !scene.boundary.is_empty()
}

/// Whether passes leave out boundary particles that are out of reach. Those must stand behind the others, and lists must have
/// been made from the fluid's side.
pub fn knows_reach(scene: &Scene) -> bool {
    wanted(scene)
        && !every_step(scene)
        && !scene.boundary.is_empty()
        && storage::row(scene.neighbors.storage).sorts
}

/// Boundary particles that may be in reach of a scene's fluid at the start: those in voxels that hold fluid and in the voxels
/// around these. 0 where the search does not know which are in reach.
pub fn reached_at_start(scene: &Scene, grid: &Grid) -> u32 {
    if !knows_reach(scene) {
        return 0;
    }
    let boundary = &scene.boundary.position;
    if scene.domain.period() != glam::Vec3::ZERO {
        // Fluid reaches them across periodic sides too.
        return boundary.len() as u32;
    }
    let reach = super::grid::voxel_reach(scene) as i32;
    let mut near: HashSet<Voxel> = HashSet::new();
    let fluid: HashSet<Voxel> = scene
        .particles
        .position
        .iter()
        .filter_map(|&p| grid.voxel(p))
        .collect();
    for [u, s, w] in fluid {
        for du in -reach..=reach {
            for ds in -reach..=reach {
                near.extend((-reach..=reach).map(|dw| [u + du, s + ds, w + dw]));
            }
        }
    }
    let is_near = |&&p: &&glam::Vec3| grid.voxel(p).is_some_and(|voxel| near.contains(&voxel));
    boundary.iter().filter(is_near).count() as u32
}

/// Numbers that a list begins with: how many neighbors it has, boundary particles for themselves where they stand apart.
fn head(scene: &Scene) -> u32 {
    1 + u32::from(walls_apart(scene))
}

/// Neighbors that a particle usually has within the radius and the skin.
pub fn usual_length(scene: &Scene) -> u32 {
    scene.usual_neighbors(1.0 + scene.neighbors.skin).ceil() as u32
}

/// How many particles have lists.
fn listed(scene: &Scene, room: Room) -> u64 {
    let sorts = storage::row(scene.neighbors.storage).sorts;
    if knows_reach(scene) {
        u64::from(scene.first_boundary()) + u64::from(room.reached)
    } else if every_step(scene) && sorts {
        // Boundary particles, which stand behind the others, have no lists there but in rigid bodies.
        u64::from(scene.first_boundary()) + floating::members(scene)
    } else {
        scene.capacity.into()
    }
}

/// The lists' own buffers, with room for so many neighbors of each particle, and of so many boundary particles.
pub fn buffers(scene: &Scene, room: Room) -> Vec<BufferPlan> {
    let particles = u64::from(scene.capacity);
    let every_step = every_step(scene);
    // Rows are interleaved by so many.
    let rows = listed(scene, room).next_multiple_of(LIST_LANES.into());
    let length = u64::from(room.list);
    let head = u64::from(head(scene));
    let mut buffers = vec![
        BufferPlan::storage(
            "neighbor_list",
            rows * (length + head),
            4,
            format!("numbers and indices of up to {length} neighbors of each particle"),
        ),
        BufferPlan::storage(
            "list_state",
            1,
            ListState::LAYOUT.size as u64,
            "whether the lists still serve",
        ),
    ];
    if every_step {
        buffers.push(BufferPlan::storage(
            "pair_list",
            rows * length,
            8,
            "the same neighbors with the kernel's gradients there",
        ));
        buffers.push(BufferPlan::storage(
            "pair_weight",
            rows * length,
            4,
            "weights of the same neighbors in the pressure equation",
        ));
    } else {
        let (vectors, what) = match straight_paths(scene) {
            Some(_) => (2, "where each particle was when it was listed, and how fast"),
            None => (1, "where each particle was when it was listed"),
        };
        let bytes = vectors * size_of::<[f32; 4]>() as u64;
        buffers.push(BufferPlan::storage("listed", particles, bytes, what));
    }
    if knows_reach(scene) {
        let words = (scene.boundary.len() as u64).div_ceil(32);
        buffers.extend([
            BufferPlan::storage(
                "reach_mark",
                words,
                4,
                "bits of boundary particles in reach of fluid, while they are set",
            ),
            BufferPlan::storage("reach_word", words, 8, "the same bits, and those set before them"),
            BufferPlan::storage(
                "reached",
                // Shaders want room for one in any case.
                1 + u64::from(room.reached.max(1)),
                4,
                "boundary particles in reach of fluid: their number, then they",
            ),
        ]);
    }
    buffers
}

/// The most room for lists, at least `least` and at most `most`, that an adapter binds; `None` where it does not even bind
/// `least`. Of more particles with lists and longer lists, more particles come first.
pub fn largest(scene: &Scene, least: Room, most: Room, limits: &Limits) -> Option<Room> {
    let of = |reached| longest(scene, Room { reached, ..least }, most.list, limits);
    of(most.reached.max(least.reached)).or_else(|| of(least.reached))
}

/// The same with lists of at most `most` neighbors.
fn longest(scene: &Scene, least: Room, most: u32, limits: &Limits) -> Option<Room> {
    let of = |list| Room { list, ..least };
    let fits = |length| list_bytes(scene, of(length)) <= limits.largest();
    let (mut fitting, mut beyond) = (least.list, u64::from(most.max(least.list)) + 1);
    if !fits(fitting) {
        return None;
    }
    while u64::from(fitting) + 1 < beyond {
        let middle = u64::from(fitting).midpoint(beyond) as u32;
        if fits(middle) {
            fitting = middle;
        } else {
            beyond = middle.into();
        }
    }
    Some(of(fitting))
}

/// Bytes of the largest buffer of lists.
fn list_bytes(scene: &Scene, room: Room) -> u64 {
    let largest = buffers(scene, room).into_iter().map(|buffer| buffer.bytes).max();
    largest.unwrap_or_default()
}

/// The same scene without lists.
pub fn without(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.neighbors.skin = 0.0;
    scene
}

/// Whether a scene asks for lists and goes without them where they do not fit.
pub fn can_be_left_out(scene: &Scene) -> bool {
    wanted(scene) && needed_by(scene).is_none()
}

/// What of a scene needs lists, and what helps to do without.
fn needed_by(scene: &Scene) -> Option<(&'static str, &'static str)> {
    if scene.domain.period() != glam::Vec3::ZERO {
        Some(("periodic sides need lists", "choose other sides"))
    } else if every_step(scene) {
        Some(("the solver `dfsph` needs lists", "choose another fluid.solver"))
    } else if scene.time.adaptive.is_some() {
        Some(("adaptive steps need lists", "set time.adaptive to false"))
    } else {
        None
    }
}

/// What a run says that leaves out lists, for which an adapter has no room.
///
/// # Errors
///
/// Where the scene needs lists.
pub fn left_out(scene: &Scene, room: Room, limits: &Limits) -> Result<String> {
    let why = format!(
        "lists of {} neighbors of each of {} particles need {} bytes; this adapter binds at most {} at once",
        room.list,
        listed(scene, room),
        list_bytes(scene, room),
        limits.largest()
    );
    match needed_by(scene) {
        None => Ok(format!(
            "{why}: neighbors are searched in every step, without lists, which takes longer"
        )),
        Some((need, instead)) => Err(Error::Limit {
            what: format!("{why}, and {need}"),
            help: format!(
                "take fewer particles, set neighbors.skin lower, {instead}, or choose another adapter (`sliceflow \
                 devices` lists them)"
            ),
        }),
    }
}

/// Puts the lists behind a search, and lets the search run only when they no longer serve.
pub fn plan(search: &mut Search, scene: &Scene, variant: &mut Variant) {
    variant
        .flag("lists", true)
        .flag("lists_every_step", every_step(scene))
        .flag("walls_apart", walls_apart(scene))
        .flag("straight_paths", straight_paths(scene).is_some())
        .flag("boundary_in_reach", knows_reach(scene))
        .flag(floating::FLAG, floating::are_in(scene))
        .constant("LIST_LANES", LIST_LANES)
        .constant("LIST_HEAD", head(scene))
        .constant("PATH_STEPS", PATH_STEPS)
        .flag("periodic", scene.domain.period() != glam::Vec3::ZERO)
        .role("candidates", "storage/lists/query");
    search_state(search);
    search.buffers.extend(buffers(scene, search.grid.room()));
    search.buffers.push(
        BufferPlan::indirect(
            "search_dispatch",
            1,
            16,
            "a workgroup for the passes that lay out the grid, when there is a search",
        )
        .holding(&[[1u32; 4]])
        .renewed(),
    );
    search.passes = when(&search.passes, Items::SearchedParticles);
    search.passes.push(PassPlan::new(
        "storage/lists/build",
        "list_candidates",
        if every_step(scene) && !floating::are_in(scene) || knows_reach(scene) {
            Items::SearchedFreeParticles
        } else {
            Items::SearchedParticles
        },
        "neighbors within the search radius and the skin",
    ));
    if knows_reach(scene) {
        search.passes.extend([
            PassPlan::new(
                "storage/lists/rank",
                "rank_reached",
                Items::SearchedOnce,
                "prefix sum over the boundary particles in reach of fluid",
            ),
            PassPlan::new(
                "storage/lists/build_reached",
                "list_reached",
                Items::SearchedParticles,
                "fluid around the boundary particles in reach",
            ),
        ]);
    }
    search.passes.push(PassPlan::new(
        "storage/lists/check",
        "check_lists",
        Items::SearchedOnce,
        "whether the lists had room",
    ));
}

/// The same passes, with threads over particles only when `particles` says so.
fn when(passes: &[PassPlan], particles: Items) -> Vec<PassPlan> {
    let pass = |pass: &PassPlan| PassPlan {
        items: match (pass.items, particles) {
            (Items::Particles, _) => particles,
            (Items::FreeParticles, Items::SearchedParticles) => Items::SearchedFreeParticles,
            (Items::FreeParticles, Items::KeptParticles) => Items::KeptFreeParticles,
            (Items::FreeParticles, Items::MovingParticles) => Items::MovingFreeParticles,
            (Items::ReachedParticles, Items::SearchedParticles) => Items::SearchedReachedParticles,
            (Items::ReachedParticles, Items::KeptParticles) => Items::KeptReachedParticles,
            (Items::ReachedParticles, Items::MovingParticles) => Items::MovingReachedParticles,
            (Items::Once | Items::Fixed(1), Items::SearchedParticles) => Items::SearchedOnce,
            (other, _) => other,
        },
        ..pass.clone()
    };
    passes.iter().map(pass).collect()
}

/// The passes of a search and those of a step. The host records several steps and then one search; the device makes
/// steps until the lists no longer serve, leaves the rest of them out, and searches (`storage/lists/decide.wgsl`).
///
/// Particles keep their places meanwhile: a step moves them into the `next_` buffers and the one after it, with all
/// passes flipped, back again.
///
/// Where every step searches, particles are always where the search left them, and nothing has to be taken back.
///
/// `once` are passes behind each search, behind those that each step has there.
pub fn phases(
    search: &Search,
    every_step: bool,
    before: &[PassPlan],
    [after, once]: [&[PassPlan]; 2],
) -> [Vec<PassPlan>; 2] {
    let mut copies = vec![("storage/lists/keep", "keep_particles")];
    if search.goes_on.stay {
        copies.push(("storage/lists/keep_too", "keep_particles_too"));
    }
    let copy = |items, why: &str| -> Vec<PassPlan> {
        let pass = |&(shader, entry): &(&str, &str)| PassPlan::new(shader, entry, items, why);
        copies.iter().map(pass).collect()
    };
    let mut searching = Vec::new();
    if !every_step {
        searching.extend(copy(
            Items::AwayParticles,
            "particles back from the `next_` buffers, when their lists serve",
        ));
        let into = copy(
            Items::ReturnedParticles,
            "particles into the `next_` buffers, when they are searched",
        );
        searching.extend(into.into_iter().map(|pass| PassPlan {
            flipped: true,
            ..pass
        }));
    }
    searching.extend_from_slice(&search.passes);
    searching.extend(when(after, Items::SearchedParticles));
    searching.extend(when(once, Items::SearchedParticles));
    searching.push(PassPlan::new(
        "storage/lists/resume",
        "resume_steps",
        Items::Fixed(1),
        "steps go on with the new lists",
    ));
    let mut step = when(before, Items::MovingParticles);
    for pass in step.iter_mut().filter(|pass| pass.shader == CLOCK) {
        // It decides what is dispatched, so it cannot be dispatched from that buffer.
        pass.items = Items::Fixed(1);
    }
    if every_step {
        return [searching, step];
    }
    step.extend(
        when(after, Items::KeptParticles)
            .into_iter()
            .map(|pass| PassPlan {
                flipped: true,
                ..pass
            }),
    );
    [searching, step]
}
