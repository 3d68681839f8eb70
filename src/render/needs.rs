//! What a picture needs, before there is a device: buffers, textures, draws, each with its reason.

use super::blur;
use super::colliders;
use super::layout::Layout;
use super::light::SHADOW_TEXELS;
use super::mesh;
use super::passes;
use super::picture::{Picture, PoolPanel};
use super::style::Style;
use super::water;
use crate::gpu::BufferPlan;
use crate::gpu::draw::DEPTH_FORMAT;
use crate::scene::Scene;
use crate::scene::column::Source;
use crate::scene::model::View;

/// The color target: sRGB bytes, so that blending and averaging happen in linear light.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Half floats, which every adapter adds up.
pub const THICKNESS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// The color target where an extra image wants its light as it is.
const LINEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Marks of what pixels see.
pub const MARK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Pixels along a side of the blocks that hide spheres; `OCCLUSION_BLOCK` in shaders.
pub const BLOCK: u32 = 8;

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextureNeed {
    pub name: String,
    pub size: [u32; 2],
    pub format: wgpu::TextureFormat,
    pub bytes: u64,
    pub why: String,
}

/// A draw or a compute pass of a picture, in order. Its label is its (vertex) entry point: a verb.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrawNeed {
    pub label: String,
    /// The entry point that shades what is drawn; `None` for compute passes and for draws that write depth only.
    pub fragment: Option<String>,
    /// File below `shaders/`, without its ending.
    pub shader: String,
    pub why: String,
}

#[derive(Debug, Clone, Default)]
pub struct Needs {
    pub buffers: Vec<BufferPlan>,
    pub textures: Vec<TextureNeed>,
    pub draws: Vec<DrawNeed>,
}

impl Needs {
    pub(super) fn uniform(&mut self, name: &str, bytes: usize, why: &str) {
        self.buffers.push(BufferPlan::uniform(name, bytes, why));
    }

    pub(super) fn storage(&mut self, name: &str, count: u64, element: u64, why: &str) {
        self.buffers.push(BufferPlan::storage(name, count, element, why));
    }

    fn texture(&mut self, name: &str, size: [u32; 2], format: wgpu::TextureFormat, why: &str) {
        self.textures.push(TextureNeed {
            name: name.to_owned(),
            size,
            format,
            bytes: u64::from(size[0])
                * u64::from(size[1])
                * u64::from(format.block_copy_size(None).unwrap_or(4)),
            why: why.to_owned(),
        });
    }

    pub(super) fn depth_texture(&mut self, name: &str, size: [u32; 2], why: &str) {
        self.texture(name, size, DEPTH_FORMAT, why);
    }

    pub(super) fn mark_texture(&mut self, name: &str, size: [u32; 2], why: &str) {
        self.texture(name, size, MARK_FORMAT, why);
    }

    pub(super) fn thickness_texture(&mut self, name: &str, size: [u32; 2], why: &str) {
        self.texture(name, size, THICKNESS_FORMAT, why);
    }

    pub(super) fn draw(&mut self, on: bool, label: &str, fragment: Option<&str>, shader: &str, why: &str) {
        if on {
            self.draws.push(DrawNeed {
                label: label.to_owned(),
                fragment: fragment.map(str::to_owned),
                shader: shader.to_owned(),
                why: why.to_owned(),
            });
        }
    }
}

/// Everything that the view's pictures need besides the simulation's own buffers.
pub fn needs(scene: &Scene, view: View) -> Needs {
    let style = Style::new(scene, view);
    let layout = Layout::new(scene, view);
    let [width, height] = scene.render.size;
    let mut needs = Needs::default();
    let pixels = u64::from(width) * u64::from(height);
    needs.storage("frame_pixels", pixels, 4, "the finished picture, sRGB bytes");
    if let Some(place) = layout.scene {
        scene_needs(&mut needs, scene, &style, [place.width, place.height]);
    }
    if layout.pool.is_some() {
        needs.uniform(
            "pool_panel",
            size_of::<PoolPanel>(),
            "place and colors of the heatmap",
        );
        needs.draw(
            true,
            "paint_pool",
            None,
            "render/pool",
            "the index pool, one texel per voxel",
        );
    }
    needs
}

fn scene_needs(needs: &mut Needs, scene: &Scene, style: &Style, size: [u32; 2]) {
    needs.storage(
        "picture",
        1,
        size_of::<Picture>() as u64,
        "camera, light, range of the colors",
    );
    let capacity = u64::from(scene.capacity.max(1));
    if style.water {
        water::add_resources(needs, scene, style, size);
    } else {
        needs.storage("color_map", 256, 4, "the color map, 256 entries");
    }
    if style.mesh {
        mesh::add_resources(needs, style);
    }
    if style.splats() {
        needs.storage("splat", capacity, 4, "color and visibility of each particle");
    }
    if scene.color.column.source == Source::Given {
        let why = "what colors each particle, as files hold it";
        needs.storage("given_column", capacity, 4, why);
    }
    if style.colliders {
        let vertices = (colliders::triangles(scene).len() as u64).max(1);
        needs.storage("collider_vertex", vertices, 16, "colliders as triangles");
        let colliders = scene.colliders.len() + colliders::surfaces(scene).count();
        needs.storage(
            "collider_look",
            colliders as u64,
            32,
            "where colliders are and their color",
        );
    }
    if style.occlusion {
        let blocks = size.map(|side| u64::from(side.div_ceil(BLOCK)));
        needs.storage(
            "block_depth",
            blocks[0] * blocks[1],
            4,
            "depth that blocks of pixels hide",
        );
    }
    let samples = size.map(|side| side * scene.render.antialias);
    let why = "the scene, several samples per pixel";
    let format = match style.color_pass {
        true => LINEAR_FORMAT,
        false => COLOR_FORMAT,
    };
    needs.texture("scene_color", samples, format, why);
    needs.depth_texture("scene_depth", samples, "what is in front");
    if style.shadows {
        needs.depth_texture("shadow_map", [SHADOW_TEXELS; 2], "depth from the light");
    }
    if style.occlusion {
        needs.depth_texture("occluder_depth", size, "depth of what surely hides");
    }
    needs.draw(
        style.shadows && style.splats(),
        "cast_splat",
        style.round_shadows.then_some("round_splat"),
        "render/cast_shadow",
        "shadows of particles",
    );
    needs.draw(
        style.shadows && style.colliders,
        "cast_collider",
        None,
        "render/colliders",
        "shadows of colliders",
    );
    needs.draw(
        style.occlusion,
        "place_occluder",
        None,
        "render/occluders",
        "what spheres surely hide",
    );
    needs.draw(
        style.occlusion,
        "find_block_depth",
        None,
        "render/occlusion",
        "the same, by blocks of pixels",
    );
    needs.draw(
        style.splats(),
        "color_splats",
        None,
        "render/color_splats",
        "values to colors",
    );
    needs.draw(
        style.colliders,
        "place_collider",
        Some("shade_collider"),
        "render/colliders",
        "colliders",
    );
    let (vertex, fragment) = style.splat_entries();
    needs.draw(
        style.water,
        "place_water_drop",
        Some("shade_water_drop"),
        "render/water/drops",
        "particles with few neighbors",
    );
    if style.mesh && !style.water {
        mesh::add_draws(needs);
    }
    needs.draw(
        style.splats(),
        vertex,
        Some(fragment),
        style.splat_shader(),
        "particles",
    );
    let (edge, why) = match style.water {
        true => ("draw_glass", "the domain, a glass tank"),
        false => ("draw_red", "the domain in red lines"),
    };
    needs.draw(
        style.domain,
        "place_domain_edge",
        Some(edge),
        "render/domain_box",
        why,
    );
    needs.draw(
        style.slices,
        "place_slice_side",
        Some("fill_green"),
        "render/slices",
        "allocated slices, translucent",
    );
    needs.draw(
        style.slices,
        "place_slice_edge",
        Some("edge_green"),
        "render/slices",
        "edges of the slices",
    );
    if style.water {
        water::add_draws(needs, style);
    }
    needs.draw(
        !style.water,
        "resolve",
        None,
        "render/resolve",
        "samples to pixels, over the backdrop",
    );
    blur::add(needs, scene, style, size);
    passes::add(needs, scene, style, size);
}
