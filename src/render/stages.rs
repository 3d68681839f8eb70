//! The passes that draw the scene, in order.

use super::colliders;
use super::mesh::{self, MeshStages};
use super::needs::{BLOCK, Needs};
use super::passes::PassStages;
use super::picture::Picture;
use super::style::Style;
use super::water_stages::WaterStages;
use crate::error::Result;
use crate::gpu::binding::Given;
use crate::gpu::{Blend, Buffers, Draw, DrawStyle, Gpu, Kernel, Pass, Shader, Variant};
use crate::render::needs::{COLOR_FORMAT, DrawNeed, MARK_FORMAT, THICKNESS_FORMAT};
use crate::scene::Scene;

/// A draw with its vertices an instance and its instances; `None` is one per particle.
pub type Placed = (Draw, u32, Option<u32>);

pub struct Stages {
    picture: wgpu::Buffer,
    collider_look: Option<wgpu::Buffer>,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    shadows: Option<(wgpu::TextureView, Vec<Placed>)>,
    occluders: Option<(wgpu::TextureView, Draw, Pass)>,
    draws: Vec<Placed>,
    particles: Particles,
    /// Extra images, behind the picture that they belong to.
    pub(super) passes: Option<PassStages>,
    mesh: Option<Box<MeshStages>>,
}

/// How particles get into the picture.
enum Particles {
    /// As splats or a mesh among the draws: splats' colors before these, the samples' average after them.
    Drawn {
        color: Option<Pass>,
        resolve: Pass,
    },
    Water(Box<WaterStages>),
}

pub const STRIP: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleStrip;
pub const TRIANGLES: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleList;

const SHADOW_MAP: &str = "shadow_map";
const SHADOW_SAMPLER: &str = "shadow_sampler";

/// The picture's textures by name, and how shadows are read, for what is bound anew in each frame.
#[derive(Clone)]
pub struct Textures {
    views: Vec<(String, wgpu::TextureView)>,
    shadow_sampler: wgpu::Sampler,
}

impl Textures {
    pub fn given(&self) -> impl Iterator<Item = Given<'_>> {
        let views = self.views.iter();
        views
            .map(|(name, view)| (name.as_str(), wgpu::BindingResource::TextureView(view)))
            .chain([(
                SHADOW_SAMPLER,
                wgpu::BindingResource::Sampler(&self.shadow_sampler),
            )])
    }
}

/// Makes the passes and draws that a picture needs.
pub struct Maker<'a> {
    gpu: &'a Gpu,
    variant: &'a Variant,
    buffers: &'a Buffers,
    needs: &'a Needs,
    textures: Textures,
}

impl<'a> Maker<'a> {
    fn new(gpu: &'a Gpu, variant: &'a Variant, buffers: &'a Buffers, needs: &'a Needs) -> Result<Self> {
        let mut views = Vec::new();
        for need in &needs.textures {
            let descriptor = wgpu::TextureDescriptor {
                label: Some(&need.name),
                size: wgpu::Extent3d {
                    width: need.size[0],
                    height: need.size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: need.format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            let what = || format!("texture `{}` of {} bytes", need.name, need.bytes);
            let made = gpu.make(what, |device| device.create_texture(&descriptor))?;
            views.push((need.name.clone(), made.create_view(&Default::default())));
        }
        let shadow_sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow_sampler"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        Ok(Self {
            gpu,
            variant,
            buffers,
            needs,
            textures: Textures {
                views,
                shadow_sampler,
            },
        })
    }

    fn find(&self, texture: &str) -> Option<wgpu::TextureView> {
        let mut views = self.textures.views.iter();
        let found = views.find(|(name, _)| name == texture)?;
        Some(found.1.clone())
    }

    /// A texture that the picture needs.
    pub fn view(&self, texture: &str) -> wgpu::TextureView {
        self.find(texture).expect("a picture needs what it draws into")
    }

    fn given(&self) -> Vec<Given<'_>> {
        self.textures.given().collect()
    }

    /// What draws read besides buffers, to be bound anew.
    pub fn textures(&self) -> Textures {
        self.textures.clone()
    }

    fn need(&self, label: &str) -> &DrawNeed {
        let need = self.needs.draws.iter().find(|need| need.label == label);
        need.expect("a picture needs what it draws")
    }

    /// A draw into a color target, or of depth alone without `blend`.
    pub fn draw(&self, label: &str, topology: wgpu::PrimitiveTopology, blend: Option<Blend>) -> Result<Draw> {
        let format = |blend| match blend {
            Blend::Add => THICKNESS_FORMAT,
            Blend::Opaque | Blend::Over => self.color_format(),
        };
        self.draw_into(label, topology, blend.map(|blend| (format(blend), blend)))
    }

    /// A draw of marks.
    pub fn mark(&self, label: &str, topology: wgpu::PrimitiveTopology) -> Result<Draw> {
        self.draw_into(label, topology, Some((MARK_FORMAT, Blend::Opaque)))
    }

    fn color_format(&self) -> wgpu::TextureFormat {
        let color = self.needs.textures.iter().find(|need| need.name == "scene_color");
        color.map_or(COLOR_FORMAT, |need| need.format)
    }

    fn draw_into(
        &self,
        label: &str,
        topology: wgpu::PrimitiveTopology,
        color: Option<(wgpu::TextureFormat, Blend)>,
    ) -> Result<Draw> {
        let fragment = self.need(label).fragment.as_deref();
        let shader = Shader::load(&self.need(label).shader, self.variant)?;
        let style = DrawStyle { color, topology };
        Draw::new(
            self.gpu,
            &shader,
            label,
            fragment,
            style,
            self.buffers,
            &self.given(),
        )
    }

    /// A compute pass that binds something else in each frame.
    pub fn kernel(&self, label: &str) -> Result<Kernel> {
        Kernel::load(self.gpu, &self.need(label).shader, self.variant, label)
    }

    pub fn compute(&self, label: &str) -> Result<Pass> {
        self.kernel(label)?
            .pass_with(self.gpu, self.buffers, &self.given())
    }

    /// A pass in which each `name` and `next_name` have changed places.
    pub fn flipped(&self, label: &str) -> Result<Pass> {
        self.kernel(label)?.flipped_pass(self.gpu, self.buffers)
    }
}

impl Stages {
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        parts: &Style,
        plan: &Variant,
        buffers: &Buffers,
        needs: &Needs,
    ) -> Result<Self> {
        let variant = parts.variant(scene, plan);
        let maker = Maker::new(gpu, &variant, buffers, needs)?;
        let collider_vertices = if parts.colliders {
            colliders::triangles(scene).len() as u32 / 2
        } else {
            0
        };
        let (mut casts, mut draws) = (Vec::new(), Vec::new());
        let mesh = match parts.mesh {
            true => Some(Box::new(MeshStages::new(gpu, scene, parts, plan, &maker)?)),
            false => None,
        };
        if parts.mesh && !parts.water {
            // Both stand first, where each frame finds them.
            let [solid, cast] = mesh::draws(&maker)?;
            draws.push(solid);
            casts.push(cast);
        }
        if parts.shadows && parts.splats() {
            casts.push((maker.draw("cast_splat", STRIP, None)?, 4, None));
        }
        if parts.shadows && parts.colliders {
            let cast = maker.draw("cast_collider", TRIANGLES, None)?;
            casts.push((cast, collider_vertices, Some(1)));
        }
        let opaque = Some(Blend::Opaque);
        let over = Some(Blend::Over);
        if parts.colliders {
            let solid = maker.draw("place_collider", TRIANGLES, opaque)?;
            draws.push((solid, collider_vertices, Some(1)));
        }
        if parts.water || !parts.mesh {
            let splat = match parts.water {
                true => "place_water_drop",
                false => parts.splat_entries().0,
            };
            draws.push((maker.draw(splat, STRIP, opaque)?, 4, None));
        }
        if parts.domain {
            let edges = if parts.three_dimensional { 12 } else { 4 };
            let lines = maker.draw("place_domain_edge", STRIP, opaque)?;
            draws.push((lines, 4, Some(edges)));
        }
        if parts.slices {
            // One record a slice, and one for the total.
            let records = buffers.get("slice_record", "render/slices.wgsl")?.size() / 16;
            let slices = records.saturating_sub(1) as u32;
            let (sides, edges) = if parts.three_dimensional { (4, 12) } else { (1, 4) };
            let fill = maker.draw("place_slice_side", STRIP, over)?;
            draws.push((fill, 4, Some(slices * sides)));
            let lines = maker.draw("place_slice_edge", STRIP, over)?;
            draws.push((lines, 4, Some(slices * edges)));
        }
        let occluders = match maker.find("occluder_depth") {
            Some(view) => Some((
                view,
                maker.draw("place_occluder", STRIP, None)?,
                maker.compute("find_block_depth")?,
            )),
            None => None,
        };
        let collider_look = match parts.colliders {
            true => Some(buffers.get("collider_look", "render/colliders.wgsl")?.clone()),
            false => None,
        };
        let particles = match parts.water {
            true => Particles::Water(Box::new(WaterStages::new(&maker, parts.mesh)?)),
            false => Particles::Drawn {
                color: parts
                    .splats()
                    .then(|| maker.compute("color_splats"))
                    .transpose()?,
                resolve: maker.compute("resolve")?,
            },
        };
        Ok(Self {
            picture: buffers.get("picture", "render/picture.wgsl")?.clone(),
            collider_look,
            shadows: maker.find(SHADOW_MAP).map(|view| (view, casts)),
            occluders,
            draws,
            color: maker.view("scene_color"),
            depth: maker.view("scene_depth"),
            particles,
            passes: PassStages::new(&maker, scene, parts, buffers, collider_vertices)?,
            mesh,
        })
    }

    pub fn encode(
        &mut self,
        gpu: &Gpu,
        buffers: &Buffers,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture,
        looks: &[[f32; 4]],
    ) -> Result<()> {
        upload(gpu, encoder, &self.picture, bytemuck::bytes_of(picture))?;
        if let Some(buffer) = &self.collider_look {
            upload(gpu, encoder, buffer, bytemuck::cast_slice(looks))?;
        }
        let [_, _, width, height] = picture.rectangle;
        if let Some(mesh) = &mut self.mesh {
            let mut draws: Vec<&mut Placed> = match &mut self.particles {
                Particles::Water(stages) => stages.of_surface().into(),
                Particles::Drawn { .. } => {
                    let casts = self.shadows.as_mut();
                    let cast = casts.map(|(_, casts)| &mut casts[0]);
                    [&mut self.draws[0]].into_iter().chain(cast).collect()
                }
            };
            if let Some((color, vertices)) = mesh.make(gpu, buffers, picture.count, &mut draws)? {
                dispatch(encoder, &color, vertices);
            }
        }
        if let Some((view, casts)) = &self.shadows {
            draw_all(encoder, "cast_shadows", Target::Depth(view), casts, picture.count);
        }
        if let Some((view, place, find)) = &self.occluders {
            {
                let mut pass = begin(encoder, &place.label, Target::Depth(view));
                place.encode(&mut pass, 4, picture.count);
            }
            dispatch(encoder, find, width.div_ceil(BLOCK) * height.div_ceil(BLOCK));
        }
        if let Particles::Drawn {
            color: Some(color), ..
        } = &self.particles
        {
            dispatch(encoder, color, picture.count);
        }
        let target = Target::Both(&self.color, &self.depth);
        draw_all(encoder, "draw_scene", target, &self.draws, picture.count);
        match &self.particles {
            Particles::Drawn { resolve, .. } => dispatch(encoder, resolve, width * height),
            Particles::Water(stages) => stages.encode(encoder, picture),
        }
        Ok(())
    }
}

/// Copies bytes in the order of the encoder's commands, so that several frames may share a submission.
pub fn upload(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    buffer: &wgpu::Buffer,
    bytes: &[u8],
) -> Result<()> {
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

pub fn dispatch(encoder: &mut wgpu::CommandEncoder, pass: &Pass, items: u32) {
    let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some(&pass.label),
        timestamp_writes: None,
    });
    pass.encode(&mut compute, items);
}

/// What a render pass draws into; all of it is cleared first.
#[derive(Clone, Copy)]
pub enum Target<'a> {
    Color(&'a wgpu::TextureView),
    Depth(&'a wgpu::TextureView),
    Both(&'a wgpu::TextureView, &'a wgpu::TextureView),
}

pub fn draw_all(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    target: Target,
    draws: &[Placed],
    count: u32,
) {
    let mut pass = begin(encoder, label, target);
    for (draw, vertices, instances) in draws {
        draw.encode(&mut pass, *vertices, instances.unwrap_or(count));
    }
}

fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, label: &str, target: Target) -> wgpu::RenderPass<'a> {
    let (color, depth) = match target {
        Target::Color(color) => (Some(color), None),
        Target::Depth(depth) => (None, Some(depth)),
        Target::Both(color, depth) => (Some(color), Some(depth)),
    };
    let colors: Vec<_> = color
        .into_iter()
        .map(|view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        })
        .collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &colors,
        depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
