//! What a scene's picture is made of: decided once, read by the renderer, the plan and the tests.

use super::camera::Sight;
use super::layout::Layout;
use super::light::{Light, SHADOW_TEXELS};
use super::matte::{self, Matte};
use super::needs::BLOCK;
use super::passes;
use super::picture::floor_height;
use crate::gpu::Variant;
use crate::neighbors::FROM_VOXELS;
use crate::scene::column::Source;
use crate::scene::floating;
use crate::scene::model::{Addressing, Background, ImagePass, Look, Splat, View, WaterSurface};
use crate::scene::{Dimensions, Scene};

/// Which parts a picture has. All are false where the view shows the pool alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    pub three_dimensional: bool,
    /// Lit spheres; otherwise flat discs.
    pub spheres: bool,
    /// Spheres are matte grains with colors of their own.
    pub matte: Option<&'static Matte>,
    /// The surface of water in place of spheres or discs.
    pub water: bool,
    /// A mesh around the particles in place of spheres or discs; where there is water, its surface.
    pub mesh: bool,
    /// Nothing behind the scene, so that pictures have alpha.
    pub transparent: bool,
    /// Spheres and colliders cast shadows.
    pub shadows: bool,
    /// Spheres that others surely hide are not drawn.
    pub occlusion: bool,
    /// Shadows of single spheres are large enough to be seen as round.
    pub round_shadows: bool,
    pub floor: bool,
    pub colliders: bool,
    pub domain: bool,
    pub slices: bool,
    /// There are extra images that say what pixels see.
    pub marks: bool,
    /// There is an extra image of linear light.
    pub color_pass: bool,
    /// A frame is the mean of several pictures.
    pub blurred: bool,
    /// Metres, as drawn.
    pub radius: f64,
}

impl Style {
    pub fn new(scene: &Scene, view: View) -> Self {
        let render = &scene.render;
        let drawn = view != View::Pool;
        let three_dimensional = scene.dimensions == Dimensions::Three;
        let matte = matte::find(render.look);
        let spheres = render.splat == Splat::Sphere || render.look == Look::Spheres || matte.is_some();
        let water = drawn && render.look == Look::Water;
        let mesh = drawn
            && match render.look {
                Look::Mesh => true,
                Look::Water => render.water.surface == WaterSurface::Mesh,
                Look::Splats | Look::Spheres | Look::Clay | Look::Sand => false,
            };
        let radius = scene.radius() * render.splat_scale;
        let layout = Layout::new(scene, view);
        let round_shadows = layout.scene.is_some_and(|place| {
            let sight = Sight::new(scene, [place.width, place.height], layout.insets, 0.0);
            radius > 3.0 * Light::new(scene, &sight, floor_height(scene)).texel
        });
        let solid = drawn && three_dimensional && (spheres || water || mesh);
        Self {
            three_dimensional,
            spheres,
            matte,
            water,
            mesh,
            transparent: render.background == Background::Transparent,
            shadows: solid,
            occlusion: solid && !water && !mesh,
            round_shadows,
            floor: drawn && three_dimensional && render.show.floor,
            colliders: drawn
                && render.show.colliders
                && (scene.colliders.iter().any(|c| c.visible) || floating::are_in(scene)),
            domain: drawn && render.show.domain,
            slices: drawn && render.show.slices && scene.neighbors.addressing == Addressing::Sliced,
            marks: drawn && passes::need_marks(render),
            color_pass: drawn && render.passes.contains(&ImagePass::Color),
            blurred: drawn && render.is_blurred(),
            radius,
        }
    }

    /// The plan's variant with what pictures add.
    pub fn variant(&self, scene: &Scene, plan: &Variant) -> Variant {
        let column = match scene.color.column.source {
            _ if self.matte.is_some() => "render/looks/chance".to_owned(),
            Source::Given => "render/given_column".to_owned(),
            _ => {
                let field = format!("fields/{}/color", scene.color.column.name);
                match plan.modules.contains_key(&field) {
                    true => field,
                    false => format!("render/columns/{}", scene.color.column.name),
                }
            }
        };
        let mut variant = plan.clone();
        variant
            .flag("two_dimensional", !self.three_dimensional)
            .flag("shadows", self.shadows)
            .flag("occlusion", self.occlusion)
            .flag("round_shadows", self.round_shadows)
            .flag("matte", self.matte.is_some())
            .flag("has_floor", self.floor)
            .flag("water", self.water)
            .flag("water_mesh", self.water && self.mesh)
            .flag("transparent", self.transparent)
            .flag("solid_floor", self.floor && !self.transparent)
            .flag("has_obstacles", self.colliders)
            .flag("color_pass", self.color_pass)
            .flag("blurred", self.blurred)
            .role("seen_particle", self.seen_particle())
            .constant("SHADOW_TEXELS", SHADOW_TEXELS)
            .constant("OCCLUSION_BLOCK", BLOCK)
            .role("column", column);
        if let Some(matte) = self.matte {
            variant.role("own_surface", matte.shader);
        }
        if self.mesh {
            // Its vertices are no particles, and have no lists.
            variant
                .role("candidates", FROM_VOXELS)
                .constant("COLUMN_WIDTH", 1);
        }
        variant
    }

    /// Whether each particle is drawn as a sphere or a disc.
    pub fn splats(&self) -> bool {
        !self.water && !self.mesh
    }

    /// Vertex and fragment entry point of the splats.
    pub fn splat_entries(&self) -> (&'static str, &'static str) {
        if self.spheres {
            ("place_sphere", "shade_sphere")
        } else {
            ("place_disc", "fill_disc")
        }
    }

    /// File that says where a pixel sees a particle.
    fn seen_particle(&self) -> &'static str {
        match (self.water, self.spheres) {
            (true, _) => "render/passes/seen_water",
            (_, true) => "render/passes/seen_sphere",
            (_, false) => "render/passes/seen_disc",
        }
    }

    /// File of the splats.
    pub fn splat_shader(&self) -> &'static str {
        if self.spheres {
            "render/sphere"
        } else {
            "render/disc"
        }
    }
}
