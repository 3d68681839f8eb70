//! The passes that draw the scene, in order.

use super::colliders;
use super::needs::{BLOCK, Needs};
use super::picture::Picture;
use super::style::Style;
use crate::error::Result;
use crate::gpu::draw::DEPTH_FORMAT;
use crate::gpu::{Blend, Buffers, Draw, DrawStyle, Gpu, Pass, Shader, Variant};
use crate::scene::Scene;

/// The color target: sRGB bytes, so that blending and averaging happen in linear light.
const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// A draw with its vertices an instance and its instances; `None` is one per particle.
type Placed = (Draw, u32, Option<u32>);

pub struct Stages {
    picture: wgpu::Buffer,
    collider_look: Option<wgpu::Buffer>,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    shadows: Option<(wgpu::TextureView, Vec<Placed>)>,
    occluders: Option<(wgpu::TextureView, Draw, Pass)>,
    color_splats: Pass,
    draws: Vec<Placed>,
    resolve: Pass,
}

const STRIP: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleStrip;
const LIST: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleList;

fn style(topology: wgpu::PrimitiveTopology, blend: Option<Blend>) -> DrawStyle {
    DrawStyle {
        color: blend.map(|blend| (COLOR_FORMAT, blend)),
        topology,
    }
}

fn texture(gpu: &Gpu, needs: &Needs, name: &str) -> Result<Option<wgpu::TextureView>> {
    let Some(need) = needs.textures.iter().find(|need| need.name == name) else {
        return Ok(None);
    };
    let descriptor = wgpu::TextureDescriptor {
        label: Some(name),
        size: wgpu::Extent3d {
            width: need.size[0],
            height: need.size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: if name == "scene_color" {
            COLOR_FORMAT
        } else {
            DEPTH_FORMAT
        },
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let what = || format!("texture `{name}` of {} bytes", need.bytes);
    let made = gpu.make(what, |device| device.create_texture(&descriptor))?;
    Ok(Some(made.create_view(&Default::default())))
}

impl Stages {
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        parts: &Style,
        variant: &Variant,
        buffers: &Buffers,
        needs: &Needs,
    ) -> Result<Self> {
        let load = |path: &str| Shader::load(path, variant);
        let target = |name: &str| texture(gpu, needs, name);
        let (Some(color), Some(depth)) = (target("scene_color")?, target("scene_depth")?) else {
            unreachable!("every scene picture has these targets");
        };
        let shadow_map = target("shadow_map")?;
        let occluder_depth = target("occluder_depth")?;
        let shadow_sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow_sampler"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let mut textures = vec![
            ("scene_color", wgpu::BindingResource::TextureView(&color)),
            ("shadow_sampler", wgpu::BindingResource::Sampler(&shadow_sampler)),
        ];
        for (name, view) in [("shadow_map", &shadow_map), ("occluder_depth", &occluder_depth)] {
            textures.extend(
                view.as_ref()
                    .map(|v| (name, wgpu::BindingResource::TextureView(v))),
            );
        }
        let draw = |vertex: &str, style: DrawStyle| {
            let need = needs.draws.iter().find(|need| need.label == vertex);
            let need = need.expect("a picture needs what it draws");
            let fragment = need.fragment.as_deref();
            Draw::new(
                gpu,
                &load(&need.shader)?,
                vertex,
                fragment,
                style,
                buffers,
                &textures,
            )
        };
        let compute =
            |path: &str, entry: &str| Pass::with_textures(gpu, &load(path)?, entry, buffers, &textures);

        let collider_vertices = if parts.colliders {
            colliders::triangles(scene).len() as u32 / 2
        } else {
            0
        };
        let mut casts = Vec::new();
        if parts.shadows {
            casts.push((draw("cast_splat", style(STRIP, None))?, 4, None));
            if parts.colliders {
                let cast = draw("cast_collider", style(LIST, None))?;
                casts.push((cast, collider_vertices, Some(1)));
            }
        }
        let opaque = Some(Blend::Opaque);
        let over = Some(Blend::Over);
        let mut draws = Vec::new();
        if parts.colliders {
            let solid = draw("place_collider", style(LIST, opaque))?;
            draws.push((solid, collider_vertices, Some(1)));
        }
        let (splat, _) = parts.splat_entries();
        draws.push((draw(splat, style(STRIP, opaque))?, 4, None));
        if parts.domain {
            let edges = if parts.three_dimensional { 12 } else { 4 };
            let lines = draw("place_domain_edge", style(STRIP, opaque))?;
            draws.push((lines, 4, Some(edges)));
        }
        if parts.slices {
            // One record a slice, and one for the total.
            let records = buffers.get("slice_record", "render/slices.wgsl")?.size() / 16;
            let slices = records.saturating_sub(1) as u32;
            let (sides, edges) = if parts.three_dimensional { (4, 12) } else { (1, 4) };
            let fill = draw("place_slice_side", style(STRIP, over))?;
            draws.push((fill, 4, Some(slices * sides)));
            let lines = draw("place_slice_edge", style(STRIP, over))?;
            draws.push((lines, 4, Some(slices * edges)));
        }
        let occluders = match &occluder_depth {
            Some(view) => Some((
                view.clone(),
                draw("place_occluder", style(STRIP, None))?,
                compute("render/occlusion", "find_block_depth")?,
            )),
            None => None,
        };
        let collider_look = match parts.colliders {
            true => Some(buffers.get("collider_look", "render/colliders.wgsl")?.clone()),
            false => None,
        };
        Ok(Self {
            picture: buffers.get("picture", "render/picture.wgsl")?.clone(),
            collider_look,
            color_splats: compute("render/color_splats", "color_splats")?,
            resolve: compute("render/resolve", "resolve")?,
            shadows: shadow_map.clone().map(|view| (view, casts)),
            occluders,
            draws,
            color,
            depth,
        })
    }

    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture,
        looks: &[[f32; 4]],
    ) -> Result<()> {
        upload(gpu, encoder, &self.picture, bytemuck::bytes_of(picture))?;
        if let Some(buffer) = &self.collider_look {
            upload(gpu, encoder, buffer, bytemuck::cast_slice(looks))?;
        }
        let [_, _, width, height] = picture.rectangle;
        if let Some((view, casts)) = &self.shadows {
            draw_all(encoder, "cast_shadows", None, view, casts, picture.count);
        }
        if let Some((view, place, find)) = &self.occluders {
            {
                let mut pass = begin(encoder, &place.label, None, view);
                place.encode(&mut pass, 4, picture.count);
            }
            dispatch(encoder, find, width.div_ceil(BLOCK) * height.div_ceil(BLOCK));
        }
        dispatch(encoder, &self.color_splats, picture.count);
        draw_all(
            encoder,
            "draw_scene",
            Some(&self.color),
            &self.depth,
            &self.draws,
            picture.count,
        );
        dispatch(encoder, &self.resolve, width * height);
        Ok(())
    }
}

/// Copies bytes in the order of the encoder's commands, so that several frames may share a submission.
fn upload(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer, bytes: &[u8]) -> Result<()> {
    let descriptor = wgpu::BufferDescriptor {
        label: Some("upload"),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    let what = || format!("buffer `upload` of {} bytes", descriptor.size);
    let staging = gpu.make(what, |device| device.create_buffer(&descriptor))?;
    gpu.queue.write_buffer(&staging, 0, bytes);
    encoder.copy_buffer_to_buffer(&staging, 0, buffer, 0, descriptor.size);
    Ok(())
}

fn dispatch(encoder: &mut wgpu::CommandEncoder, pass: &Pass, items: u32) {
    let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some(&pass.label),
        timestamp_writes: None,
    });
    pass.encode(&mut compute, items);
}

fn draw_all(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    color: Option<&wgpu::TextureView>,
    depth: &wgpu::TextureView,
    draws: &[Placed],
    count: u32,
) {
    let mut pass = begin(encoder, label, color, depth);
    for (draw, vertices, instances) in draws {
        draw.encode(&mut pass, *vertices, instances.unwrap_or(count));
    }
}

fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    color: Option<&wgpu::TextureView>,
    depth: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    let color = color.map(|view| wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    });
    let attachments = [color];
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: if attachments[0].is_some() {
            &attachments
        } else {
            &[]
        },
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
