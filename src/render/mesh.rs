//! A surface around the particles in pictures: made anew for each frame, and drawn without leaving the device.

use glam::{DVec3, Vec3};

use super::needs::Needs;
use super::stages::{Maker, Placed, ShadowReader, TRIANGLES};
use super::water::walls;
use crate::error::{Error, Result};
use crate::gpu::{Blend, Buffers, Gpu, Kernel, Pass, Variant};
use crate::scene::Scene;
use crate::scene::model::{Addressing, Wall};
use crate::surface::layout::Surface;
use crate::surface::{self, Lattice, MOST_NODES, Mesh, Searched, Shape, SurfaceMaker};

/// Of a voxel, in spacings of particles.
const WIDTH: f64 = 0.5;

pub struct MeshStages {
    maker: SurfaceMaker,
    /// Of the simulation's own search.
    variant: Variant,
    shape: Shape,
    lattice: Lattice,
    color: Kernel,
    shadows: Option<ShadowReader>,
    /// The frame's own, which the draws bind.
    mesh: Option<Mesh>,
}

/// Draws of the mesh: into the picture, and into the shadow map.
pub fn draws(maker: &Maker) -> Result<[Placed; 2]> {
    let solid = maker.draw("place_mesh", TRIANGLES, Some(Blend::Opaque))?;
    let cast = maker.draw("cast_mesh", TRIANGLES, None)?;
    Ok([(solid, 0, Some(1)), (cast, 0, Some(1))])
}

impl MeshStages {
    /// `variant` is the plan's.
    pub fn new(gpu: &Gpu, scene: &Scene, variant: &Variant, maker: &Maker) -> Result<Self> {
        let shape = shape(scene);
        Ok(Self {
            maker: SurfaceMaker::new(gpu.clone()),
            variant: variant.clone(),
            lattice: lattice(scene, &shape)?,
            shape,
            color: maker.kernel("color_mesh")?,
            shadows: maker.shadow_reader(),
            mesh: None,
        })
    }

    /// Makes the surface of particles 0 to `count`, and has the draws bind it. Gives the pass that colors its vertices.
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
        let mesh = self.mesh.insert(mesh);
        if mesh.triangles == 0 {
            return Ok(None);
        }
        let bytes = 4 * u64::from(mesh.vertices);
        mesh.buffers
            .create(gpu, "mesh_color", bytes, Default::default())?;
        let mut given = mesh.buffers.bindings();
        given.extend(self.shadows.iter().flat_map(ShadowReader::given));
        for (draw, vertices, _) in draws.iter_mut() {
            draw.rebind(gpu, buffers, &given)?;
            *vertices = 3 * mesh.triangles;
        }
        let color = self.color.pass_with(gpu, buffers, &given)?;
        Ok(Some((color, mesh.vertices)))
    }
}

fn shape(scene: &Scene) -> Shape {
    let spacing = 2.0 * scene.radius();
    let ends = walls(scene);
    let side = |axis: usize, upper: usize| {
        let is_closed = scene.domain.sides[axis][upper] != Wall::Open;
        is_closed.then_some(f64::from(ends[upper][axis]))
    };
    Shape {
        spacing,
        reach: surface::usual_reach(spacing).min(scene.search_radius()),
        width: WIDTH * spacing,
        addressing: Addressing::Bitmap,
        sides: [0, 1, 2].map(|axis| [side(axis, 0), side(axis, 1)]),
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
            help: "choose `splats`, `spheres` or `water` for render.look".into(),
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
pub fn add_resources(needs: &mut Needs) {
    needs.uniform("surface", size_of::<Surface>(), "how the surface is made");
    for (name, element, why) in [
        (
            "mesh_position",
            16,
            "the surface's vertices; each frame has its own, as many as it needs",
        ),
        ("mesh_normal", 16, "their normals"),
        ("mesh_color", 4, "their colors"),
        ("mesh_triangle", 12, "triangles between them"),
    ] {
        needs.storage(name, 1, element, why);
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
