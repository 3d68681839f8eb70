//! Pictures of the particles, straight from the simulation's buffers (the point-splat pipeline of Rojas 2013).
//!
//! A picture is made of few passes: shadows; what spheres surely hide; each particle's color; colliders, particles
//! and lines into a supersampled texture; and the resolve into `frame_pixels`. Water takes the particles' place with passes
//! of its own (`water_stages.rs`), and so does a mesh around them (`mesh.rs`). Extra images come behind the picture
//! (`passes.rs`); a blurred one is the mean of several (`blur.rs`). Nothing comes back but pixels, which [`Overlay`] finishes
//! on an encoder thread.

mod backdrop;
pub mod blur;
mod camera;
mod colliders;
mod layout;
mod light;
mod matte;
mod mesh;
mod needs;
mod overlay;
pub mod passes;
mod picture;
mod pool_legend;
mod stages;
mod style;
mod text;
pub mod ticks;
mod water;
mod water_stages;

use glam::{DVec2, Vec3};

pub use backdrop::{POOL_COLORS, linear};
pub use camera::{Sight, depth_range};
pub use colliders::{Vertices, plane_in_box, triangles as collider_vertices};
pub use layout::{Layout, PoolPlace, Rectangle};
pub use needs::{DrawNeed, Needs, TextureNeed, needs};
pub use overlay::{Caption, Overlay};
pub use picture::{Picture, PoolPanel};
pub use style::Style;
pub use text::over_white;
pub use water::Water;

use crate::error::{Error, Result};
use crate::gpu::{Buffers, Gpu, Kernel, Pass, Variant};
use crate::physics::collider::offset_at;
use crate::scene::model::View;
use crate::scene::{Scene, color_maps};
use blur::Blur;
use stages::Stages;

/// What the shaders of a scene's pictures are made of: the plan's variant with what pictures add.
pub fn variant(scene: &Scene, view: View, plan: &Variant) -> Variant {
    Style::new(scene, view).variant(scene, plan)
}

/// Draws frames of one scene and view.
pub struct Renderer {
    scene: Scene,
    layout: Layout,
    style: Style,
    /// Present where the view shows the scene.
    stages: Option<Stages>,
    /// Present where frames are means of several pictures.
    blur: Option<Blur>,
    /// Present where the view shows the index pool.
    paint_pool: Option<Pass>,
}

fn pool_pass(gpu: &Gpu, variant: &Variant, buffers: &Buffers) -> Result<Pass> {
    Kernel::load(gpu, "render/pool", variant, "paint_pool")?.pass(gpu, buffers)
}

impl Renderer {
    /// `variant` carries the plan's flags and roles; buffers listed by [`needs()`] that
    /// are not there yet are created.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        variant: &Variant,
        buffers: &mut Buffers,
        view: View,
    ) -> Result<Self> {
        let layout = Layout::new(scene, view);
        let style = Style::new(scene, view);
        let needs = needs(scene, view);
        check_limits(gpu, &needs)?;
        for need in &needs.buffers {
            if !buffers.contains(&need.name) {
                buffers.make(gpu, need)?;
            }
        }
        let stages = match layout.scene {
            Some(_) => {
                let map = color_maps::find(&scene.color.map).ok_or_else(|| {
                    Error::usage(
                        format!("there is no color map `{}`", scene.color.map),
                        "see `sliceflow scenes --color-maps`",
                    )
                })?;
                let color = |share: f64| match style.matte {
                    Some(matte) => matte.color(share),
                    None => (map.at)(share),
                };
                let entries: Vec<u32> = (0..256)
                    .map(|k| backdrop::packed(color(f64::from(k) / 255.0)) & 0x00ff_ffff)
                    .collect();
                if buffers.contains("color_map") {
                    buffers.write(gpu, "color_map", 0, &entries)?;
                }
                if style.colliders {
                    buffers.write(gpu, "collider_vertex", 0, &colliders::triangles(scene))?;
                }
                Some(Stages::new(gpu, scene, &style, variant, buffers, &needs)?)
            }
            None => None,
        };
        let blur = match style.blurred {
            true => Some(Blur::new(gpu, scene, &style.variant(scene, variant), buffers)?),
            false => None,
        };
        let paint_pool = match &layout.pool {
            Some(place) => {
                let panel = PoolPanel::new(scene, &layout, place);
                buffers.write(gpu, "pool_panel", 0, &[panel])?;
                Some(pool_pass(gpu, &style.variant(scene, variant), buffers)?)
            }
            None => None,
        };
        Ok(Self {
            scene: scene.clone(),
            layout,
            style,
            stages,
            blur,
            paint_pool,
        })
    }

    /// Takes over buffers of the grid that were made anew.
    pub fn rebind(&mut self, gpu: &Gpu, variant: &Variant, buffers: &Buffers) -> Result<()> {
        if self.paint_pool.is_some() {
            let variant = self.style.variant(&self.scene, variant);
            self.paint_pool = Some(pool_pass(gpu, &variant, buffers)?);
        }
        Ok(())
    }

    /// Draws particles 0..`count` into `frame_pixels`. `time` is in seconds; `offsets` has each collider's present
    /// offset in metres.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        buffers: &Buffers,
        encoder: &mut wgpu::CommandEncoder,
        count: u32,
        time: f64,
        offsets: &[Vec3],
    ) -> Result<()> {
        if let (Some(stages), Some(place)) = (&mut self.stages, self.layout.scene) {
            let picture =
                |time, lens| Picture::new(&self.scene, &self.layout, place, &self.style, time, lens, count);
            if let Some(blur) = &self.blur {
                blur.begin(encoder);
                for &moment in &blur.moments {
                    blur.go_to(gpu, encoder, moment, count)?;
                    let time = time + moment.after_s;
                    let paths = self.scene.colliders.iter().map(|collider| &collider.path);
                    let offsets: Vec<Vec3> = paths.map(|path| offset_at(path, time)).collect();
                    let picture = picture(time, moment.lens);
                    stages.encode(
                        gpu,
                        buffers,
                        encoder,
                        &picture,
                        &colliders::looks(&self.scene, &offsets),
                    )?;
                }
                blur.end(encoder, place.width * place.height);
            }
            // Extra images are those of the frame's own time.
            if self.blur.is_none() || self.style.marks {
                let picture = picture(time, DVec2::ZERO);
                let looks = colliders::looks(&self.scene, offsets);
                stages.encode(gpu, buffers, encoder, &picture, &looks)?;
                if let Some(passes) = &stages.passes {
                    passes.encode(gpu, encoder, &self.scene, &self.layout, &picture, time)?;
                }
            }
        }
        if let (Some(paint), Some(place)) = (&self.paint_pool, &self.layout.pool) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("paint_pool"),
                timestamp_writes: None,
            });
            paint.encode(&mut pass, place.panel.width * place.panel.height);
        }
        Ok(())
    }

    /// Width and height of the frame, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.layout.frame
    }
}

fn check_limits(gpu: &Gpu, needs: &Needs) -> Result<()> {
    let most = gpu.limits.texture;
    for texture in &needs.textures {
        let [width, height] = texture.size;
        if width.max(height) > most {
            return Err(Error::Limit {
                what: format!(
                    "`{}` needs {width}×{height} samples; the adapter draws {most}×{most}",
                    texture.name
                ),
                help: "set render.antialias or render.size lower".into(),
            });
        }
    }
    Ok(())
}
