//! Neighbor lists (Verlet 1967): each particle's neighbors within the search radius and a skin serve every step until a
//! particle has moved by half the skin; only then are particles searched anew. The device decides.

use super::Search;
use super::addressing::search_state;
use super::layout::ListState;
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::{Dimensions, Scene};

/// Whether the scene asks for lists.
pub fn wanted(scene: &Scene) -> bool {
    scene.neighbors.skin > 0.0
}

/// Neighbors of a particle in a dense packing of equal spheres, within the radius and the skin.
pub fn usual_length(scene: &Scene) -> u32 {
    let reach = 1.0 + scene.neighbors.skin;
    let (touching, dimensions) = match scene.dimensions {
        Dimensions::Two => (6.0, 2),
        Dimensions::Three => (12.0, 3),
    };
    (touching * f64::powi(reach, dimensions)).ceil() as u32
}

/// Puts the lists behind a search, and lets the search run only when they no longer serve.
pub fn plan(search: &mut Search, scene: &Scene, variant: &mut Variant) {
    variant
        .flag("lists", true)
        .role("candidates", "storage/lists/query");
    search_state(search);
    let particles = u64::from(scene.capacity);
    let vector = match scene.dimensions {
        Dimensions::Two => 8,
        Dimensions::Three => 16,
    };
    let length = u64::from(search.grid.list_capacity);
    search.buffers.extend([
        BufferPlan::storage(
            "neighbor_list",
            particles * length,
            4,
            format!("up to {length} neighbors of each particle"),
        ),
        BufferPlan::storage("list_length", particles, 4, "how many they are"),
        BufferPlan::storage(
            "listed_position",
            particles,
            vector,
            "where each particle was when it was listed",
        ),
        BufferPlan::storage(
            "list_state",
            1,
            ListState::LAYOUT.size as u64,
            "whether the lists still serve",
        ),
    ]);
    for pass in &mut search.passes {
        pass.items = match pass.items {
            Items::Particles => Items::SearchedParticles,
            Items::Once => Items::SearchedOnce,
            other => other,
        };
    }
    search.before.push(PassPlan::new(
        "storage/lists/decide",
        "decide_search",
        Items::Fixed(1),
        "whether a particle has moved by half the skin",
    ));
    search.passes.extend([
        PassPlan::new(
            "storage/lists/build",
            "list_candidates",
            Items::SearchedParticles,
            "neighbors within the search radius and the skin",
        ),
        PassPlan::new(
            "storage/lists/check",
            "check_lists",
            Items::Fixed(1),
            "whether the lists had room",
        ),
    ]);
    search.otherwise.push(PassPlan::new(
        "storage/lists/keep",
        "keep_particles",
        Items::KeptParticles,
        "particles keep their places while their lists serve",
    ));
}
