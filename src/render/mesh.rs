//! A surface around the particles in pictures, as a solid or as water's: made anew for each frame, and drawn without leaving the
//! device.

use glam::{DVec3, Vec3};

use super::needs::Needs;
use super::stages::{Maker, Placed, TRIANGLES, Textures};
use super::style::Style;
use super::water;
use crate::error::{Error, Result};
use crate::gpu::buffers::Usage;
use crate::gpu::{Blend, Buffers, Gpu, Kernel, Pass, Variant};
use crate::scene::Scene;
use crate::scene::model::{Addressing, Wall};
use crate::surface::layout::Surface;
use crate::surface::{self, Lattice, MOST_NODES, Searched, Shape, SurfaceMaker};

/// Of a voxel, in spacings of particles.
const WIDTH: f64 = 0.5;

pub struct MeshStages {
    maker: SurfaceMaker,
    /// Of the simulation's own search.
    variant: Variant,
    shape: Shape,
    lattice: Lattice,
    /// None where it is water.
    color: Option<Kernel>,
    textures: Textures,
}

/// Draws of a solid mesh: into the picture, and into the shadow map.
pub fn draws(maker: &Maker) -> Result<[Placed; 2]> {
    let solid = maker.draw("place_mesh", TRIANGLES, Some(Blend::Opaque))?;
    let cast = maker.draw("cast_mesh", TRIANGLES, None)?;
    Ok([(solid, 0, Some(1)), (cast, 0, Some(1))])
}

impl MeshStages {
    /// `variant` is the plan's.
    pub fn new(gpu: &Gpu, scene: &Scene, style: &Style, variant: &Variant, maker: &Maker) -> Result<Self> {
        let shape = shape(scene, style);
        Ok(Self {
            maker: SurfaceMaker::new(gpu.clone()),
            variant: variant.clone(),
            lattice: lattice(scene, &shape)?,
            shape,
            color: match style.water {
                true => None,
                false => Some(maker.kernel("color_mesh")?),
            },
            textures: maker.textures(),
        })
    }

    /// Makes the surface of particles 0 to `count`, and has the draws bind it. Gives the pass that colors its vertices, where
    /// they have colors.
    pub fn make(
        &mut self,
        gpu: &Gpu,
        buffers: &Buffers,
        count: u32,
        draws: &mut [&mut Placed],
    ) -> Result<Option<(Pass, u32)>> {
        for (_, vertices, _) in draws.iter_mut() {
            *vertices = 0;
        }
        if count == 0 {
            return Ok(None);
        }
        let searched = Searched {
            buffers,
            variant: &self.variant,
            particles: count,
        };
        let mesh = self.maker.make(&searched, &self.shape, &self.lattice)?;
        if mesh.triangles == 0 {
            return Ok(None);
        }
        let made = self.maker.buffers();
        if self.color.is_some() {
            made.reserve(gpu, "mesh_color", 4 * u64::from(mesh.vertices), Usage::Storage)?;
        }
        let mut given = made.bindings();
        given.extend(self.textures.given());
        for (draw, vertices, _) in draws.iter_mut() {
            draw.rebind(gpu, buffers, &given)?;
            *vertices = 3 * mesh.triangles;
        }
        let Some(color) = &self.color else {
            return Ok(None);
        };
        Ok(Some((color.pass_with(gpu, buffers, &given)?, mesh.vertices)))
    }
}

fn shape(scene: &Scene, style: &Style) -> Shape {
    let spacing = 2.0 * scene.radius();
    Shape {
        spacing,
        reach: surface::usual_reach(spacing).min(scene.search_radius()),
        width: WIDTH * spacing,
        addressing: Addressing::Bitmap,
        kernel: scene.render.mesh.kernel,
        drops: style.water.then(|| water::drops(scene)),
        sides: scene.domain.ends().map(|ends| ends.map(|end| end.map(f64::from))),
    }
}

/// The box of voxels over the domain, and over as much beyond its open sides as the search follows particles. It stands still,
/// so that waves do not swim through it.
fn lattice(scene: &Scene, shape: &Shape) -> Result<Lattice> {
    let domain = &scene.domain;
    let (low, high) = (domain.min.as_dvec3(), domain.max.as_dvec3());
    let inside = ((high - low).max_element() + 2.0 * surface::margin(shape)) / shape.width;
    let most = f64::from(MOST_NODES) - 2.0;
    if inside > most {
        return Err(Error::Limit {
            what: format!(
                "a mesh needs {inside:.1e} voxels along the domain's longest side, and can have {most}"
            ),
            help:
                "choose `splats`, `spheres` or `water` for render.look, and `screen` for render.water.surface"
                    .into(),
        });
    }
    let followed = scene.neighbors.quarantine_distance;
    let followed = followed.unwrap_or(8.0 * (high - low).max_element());
    // Beyond open sides as far as there are numbers for voxels.
    let followed = followed.min((most - inside) / 2.0 * shape.width);
    let beyond = |upper: usize| {
        let along = |axis: usize| match domain.sides[axis][upper] {
            Wall::Open => followed,
            _ => 0.0,
        };
        DVec3::new(along(0), along(1), along(2)) + surface::margin(shape)
    };
    let below = (beyond(0) / shape.width).ceil();
    let nodes = below + ((high - low + beyond(1)) / shape.width).ceil() + 1.0;
    let lower: Vec3 = (low - below * shape.width).as_vec3();
    Ok(Lattice {
        lower,
        size: nodes.to_array().map(|n| n as u32),
    })
}

/// What draws bind until there is a mesh.
pub fn add_resources(needs: &mut Needs, style: &Style) {
    needs.uniform("surface", size_of::<Surface>(), "how the surface is made");
    for (name, element, why) in [
        (
            "mesh_position",
            16,
            "the surface's vertices; each frame has its own, as many as it needs",
        ),
        ("mesh_normal", 16, "their normals"),
        ("mesh_triangle", 12, "triangles between them"),
    ] {
        needs.storage(name, 1, element, why);
    }
    if !style.water {
        needs.storage("mesh_color", 1, 4, "colors of the vertices");
    }
}

pub fn add_draws(needs: &mut Needs) {
    let shader = "render/mesh";
    needs.draw(true, "cast_mesh", None, shader, "the surface's shadow");
    let why = "colors of the surface's vertices";
    needs.draw(true, "color_mesh", None, "surface/color_mesh", why);
    let why = "the surface around the particles";
    needs.draw(true, "place_mesh", Some("shade_mesh"), shader, why);
}
