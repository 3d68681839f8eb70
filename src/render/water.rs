//! Water in pictures. The particles' spheres give a thickness as seen by the eye, and one as seen by the light. The surface is
//! these spheres too, smoothed on screen, or a mesh (`mesh.rs`); it is shaded. What it looks like, and what it needs.

use super::backdrop::linear;
use super::light::SHADOW_TEXELS;
use super::needs::Needs;
use super::style::Style;
use crate::gpu::BufferPlan;
use crate::scene::{Scene, color_maps};
use crate::shared_struct;
use crate::surface::Drops;

shared_struct! {
    /// See `shaders/render/water/water.wgsl`.
    pub struct Water {
        pub absorption: [f32; 4],
        pub scatter: [f32; 4],
        pub drop: [f32; 4],
        pub low: [f32; 4],
        pub high: [f32; 4],
        pub radius: f32,
        pub drop_radius: f32,
        pub reach: f32,
        pub volume: f32,
        pub spacing: f32,
        pub smoothing: f32,
        pub range: f32,
        pub retreat: f32,
        pub few: f32,
        pub many: f32,
        pub deep: f32,
        pub spray: f32,
    }
}

/// Radii are multiples of a particle's as drawn, half its distance from the next: spheres so large leave no holes.
const SURFACE_RADIUS: f64 = 2.0;
const DROP_RADIUS: f64 = 0.4;
const THICKNESS_RADIUS: f64 = 2.8;
/// The filter's standard deviation, in distances of particles.
const SMOOTHING: f64 = 1.0;
/// Surfaces farther apart are not smoothed together, in distances of particles.
const RANGE: f64 = 3.0;
/// How far behind a surface the filter sees what lies beyond that: the depth of a sphere.
const RETREAT: f64 = 1.0;
/// Neighbors that a drop has less of, and that a particle inside the water has more of, as shares of those in the middle.
const FEW: f64 = 0.2;
const MANY: f64 = 0.58;
/// Neighbors, as a share, that particles of the two outermost layers of water have less of. Spheres farther inside are not seen.
const DEEP: f64 = 0.95;
/// The length after which light has the water's color where the scene does not say, as a share of the domain's diagonal.
const ABSORPTION_SHARE: f64 = 0.1;
/// Stands for an end where there is none, metres.
const FAR_AWAY: f32 = 1e9;
/// Light that comes back from deep water, as a share of its color.
const SCATTER: f32 = 0.35;

impl Water {
    pub fn new(scene: &Scene, style: &Style) -> Self {
        let looks = &scene.render.water;
        let diagonal = f64::from((scene.domain.max - scene.domain.min).length());
        let length = looks.absorption_length.unwrap_or(ABSORPTION_SHARE * diagonal);
        let color = color_maps::parse_hex(&looks.color)
            .unwrap_or_default()
            .map(linear);
        let four = |[r, g, b]: [f32; 3]| [r, g, b, 0.0];
        let spacing = 2.0 * scene.radius();
        let ends = scene.domain.ends();
        let end = |side: usize, far: f32| ends.map(|of_axis| of_axis[side].unwrap_or(far));
        let full = scene.usual_neighbors(1.0);
        Self {
            absorption: four(color.map(|channel| -channel.max(1e-4).ln() / length as f32)),
            scatter: four(color.map(|channel| SCATTER * channel)),
            drop: four(color.map(|channel| 0.5 + 0.5 * channel)),
            low: four(end(0, -FAR_AWAY)),
            high: four(end(1, FAR_AWAY)),
            radius: (SURFACE_RADIUS * style.radius) as f32,
            drop_radius: (DROP_RADIUS * style.radius) as f32,
            reach: (THICKNESS_RADIUS * style.radius) as f32,
            volume: spacing.powi(3) as f32,
            spacing: spacing as f32,
            smoothing: (SMOOTHING * spacing) as f32,
            range: (RANGE * spacing) as f32,
            retreat: (RETREAT * spacing) as f32,
            few: (FEW * full) as f32,
            many: (MANY * full) as f32,
            deep: (DEEP * full) as f32,
            spray: f32::from(u8::from(looks.spray)),
        }
    }
}

/// Which particles are drops, apart from the surface.
pub fn drops(scene: &Scene) -> Drops {
    Drops {
        reach: scene.search_radius(),
        fewest: FEW * scene.usual_neighbors(1.0),
    }
}

/// Texels of the thickness seen by the light, along a side.
const SHADOW_SIDE: u32 = SHADOW_TEXELS / 2;

/// The passes that smooth the surface, in order; an even number, so that the last leaves it where the first found it.
pub const SMOOTHING_PASSES: [&str; 6] = [
    "smooth_rows",
    "smooth_columns",
    "smooth_rows_again",
    "smooth_columns_again",
    "smooth_rows_finely",
    "smooth_columns_finely",
];

/// Buffers and textures of a picture of `size` pixels.
pub fn add_resources(needs: &mut Needs, scene: &Scene, style: &Style, size: [u32; 2]) {
    let samples = size.map(|side| side * scene.render.antialias);
    let count = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    let look = Water::new(scene, style);
    needs
        .buffers
        .push(BufferPlan::table("water", &[look], "what water looks like"));
    let why = "the water's surface, as distances from the eye";
    needs.storage("water_surface", count(samples), 4, why);
    match style.mesh {
        true => needs.mark_texture("water_normal", samples, "normals of the water's surface"),
        false => needs.storage("next_water_surface", count(samples), 4, "the same, smoothed"),
    }
    needs.storage(
        "behind",
        count(size),
        8,
        "what lies behind the water, half floats",
    );
    needs.depth_texture("water_depth", samples, "the water's surface as it is drawn");
    let halves = size.map(|side| side.div_ceil(2));
    needs.thickness_texture("water_thickness", halves, "thickness of the water");
    needs.thickness_texture("water_shadow", [SHADOW_SIDE; 2], "the same as the light sees it");
}

/// Draws and passes between those of the scene and the finished picture.
pub fn add_draws(needs: &mut Needs, style: &Style) {
    let splats = "render/water/splats";
    let surface = match style.mesh {
        true => (
            "place_water_mesh",
            Some("keep_water_normal"),
            "render/water/mesh",
            "the water's surface",
        ),
        false => (
            "place_water_surface",
            Some("cut_water_surface"),
            splats,
            "the water's surface",
        ),
    };
    let thickness = match style.mesh {
        true => (
            "place_water_chord",
            Some("add_water_chord"),
            "render/water/mesh",
            "the water's thickness",
        ),
        false => (
            "place_water_thickness",
            Some("add_water_thickness"),
            splats,
            "the water's thickness",
        ),
    };
    for (label, fragment, shader, why) in [
        (
            "place_water_shadow",
            Some("add_water_shadow"),
            splats,
            "water that sunlight passes",
        ),
        surface,
        thickness,
        (
            "find_water_surface",
            None,
            "render/water/surface",
            "depth as distances",
        ),
    ] {
        needs.draw(true, label, fragment, shader, why);
    }
    for label in SMOOTHING_PASSES {
        needs.draw(
            !style.mesh,
            label,
            None,
            "render/water/smooth",
            "smooths the water's surface",
        );
    }
    let why = "what lies behind the water";
    needs.draw(true, "paint_behind", None, "render/water/behind", why);
    let why = "reflection, refraction and absorption; samples to pixels";
    needs.draw(true, "resolve_water", None, "render/water/resolve", why);
}
