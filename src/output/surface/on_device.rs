//! Meshes made on the device, brought to the host.

use std::sync::{Mutex, MutexGuard};

use glam::{DVec3, Vec3};

use super::reconstruct::Cloud;
use super::walls::Walls;
use super::{SurfaceMesh, VertexColumn};
use crate::error::{Error, Result};
use crate::gpu::{AdapterChoice, Buffers, Gpu, readback};
use crate::plan::{Plan, Wanted};
use crate::scene::model::{Addressing, SurfaceKernel};
use crate::scene::{Dimensions, Neighbors, Scene};
use crate::simulation::Simulation;
use crate::surface::{self, Figures, Lattice, MOST_NODES, Mesh, Searched, Shape, SurfaceMaker};

/// A device that makes meshes, one at a time.
pub struct OnDevice {
    gpu: Gpu,
    addressing: Addressing,
    kernel: SurfaceKernel,
    workshop: Mutex<Workshop>,
}

/// What one mesh after the other is made with.
struct Workshop {
    maker: SurfaceMaker,
    /// Sums over the meshes so far.
    figures: Figures,
}

impl OnDevice {
    /// Opens the device. Surfaces are stored by `addressing`, one of [`surface::ADDRESSINGS`], and made by `kernel`.
    ///
    /// # Errors
    ///
    /// Where there is no such adapter.
    pub fn open(choice: &AdapterChoice, addressing: Addressing, kernel: SurfaceKernel) -> Result<Self> {
        Ok(Self::with(Gpu::open(choice, false)?, addressing, kernel))
    }

    pub(super) fn with(gpu: Gpu, addressing: Addressing, kernel: SurfaceKernel) -> Self {
        Self {
            workshop: Mutex::new(Workshop {
                maker: SurfaceMaker::new(gpu.clone()),
                figures: Figures::default(),
            }),
            gpu,
            addressing,
            kernel,
        }
    }

    /// Passes that have been compiled.
    #[cfg(test)]
    pub(super) fn compiled(&self) -> usize {
        self.gpu.compiled()
    }

    /// Sums of what the meshes so far have cost.
    pub fn figures(&self) -> Figures {
        self.workshop().figures
    }

    fn workshop(&self) -> MutexGuard<'_, Workshop> {
        self.workshop
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Makes a mesh of a frame; `None` where there is no surface.
    pub(super) fn reconstruct(
        &self,
        cloud: &Cloud,
        spacing: f64,
        width: f64,
        walls: &Walls,
        normals: bool,
    ) -> Result<Option<SurfaceMesh>> {
        let mut workshop = self.workshop();
        let Workshop { maker, figures } = &mut *workshop;
        let scene = Scene::of_points(
            &cloud.position,
            Dimensions::Three,
            surface::usual_reach(spacing),
            Neighbors::default(),
        )?;
        let local = |side: Option<f64>, axis: usize| side.map(|side| side - scene.origin[axis]);
        let sides = walls.sides();
        let shape = Shape {
            spacing,
            reach: surface::usual_reach(spacing),
            width,
            addressing: self.addressing,
            kernel: self.kernel,
            drops: None,
            sides: [0, 1, 2].map(|axis| sides[axis].map(|side| local(side, axis))),
        };
        let lattice = lattice(&cloud.position, &shape, scene.origin)?;
        let plan = Plan::new(&scene, &self.gpu.limits, &Wanted::default())?;
        let mut simulation = Simulation::new(self.gpu.clone(), &scene, &plan)?;
        simulation.next_frame()?;
        let searched = Searched {
            buffers: simulation.buffers(),
            variant: &plan.variant,
            particles: cloud.position.len() as u32,
        };
        let mesh = maker.make(&searched, &shape, &lattice)?;
        add(figures, &mesh.figures);
        if mesh.triangles == 0 {
            return Ok(None);
        }
        let mut columns = Vec::new();
        for VertexColumn { name, width, values } in &cloud.columns {
            columns.push(VertexColumn {
                name: name.clone(),
                width: *width,
                values: maker.blend(&searched, &mesh, values, *width as u32)?,
            });
        }
        let mut fetched = fetch(&self.gpu, maker.buffers(), &mesh, &scene, columns, normals)?;
        for vertex in &mut fetched.vertices {
            *vertex = walls.way_out(*vertex, cloud.frame, spacing);
        }
        Ok(Some(fetched))
    }
}

/// Brings a mesh to the host.
fn fetch(
    gpu: &Gpu,
    buffers: &Buffers,
    mesh: &Mesh,
    scene: &Scene,
    columns: Vec<VertexColumn>,
    normals: bool,
) -> Result<SurfaceMesh> {
    let vectors = |name: &str| -> Result<Vec<Vec3>> {
        let buffer = buffers.get(name, "(host)")?;
        let stored = readback::read::<[f32; 4]>(gpu, buffer, mesh.vertices as usize)?;
        Ok(stored
            .into_iter()
            .map(|[x, y, z, _]| Vec3::new(x, y, z))
            .collect())
    };
    let triangles = buffers.get("mesh_triangle", "(host)")?;
    Ok(SurfaceMesh {
        vertices: vectors("mesh_position")?
            .into_iter()
            .map(|place| place.as_dvec3() + scene.origin)
            .collect(),
        normals: match normals {
            true => vectors("mesh_normal")?.into_iter().map(Into::into).collect(),
            false => Vec::new(),
        },
        columns,
        triangles: readback::read(gpu, triangles, mesh.triangles as usize)?,
    })
}

/// The box of voxels around particles. Nodes stand at whole multiples of a voxel's width, so that waves do not swim through
/// them from frame to frame.
fn lattice(positions: &[DVec3], shape: &Shape, origin: DVec3) -> Result<Lattice> {
    let [low, high] =
        [DVec3::min, DVec3::max].map(|pick| positions.iter().copied().reduce(pick).unwrap_or_default());
    let margin = surface::margin(shape);
    let first = ((low - margin) / shape.width).floor();
    let nodes = ((high + margin) / shape.width).ceil() - first + 1.0;
    if nodes.max_element() > f64::from(MOST_NODES) {
        return Err(Error::usage(
            format!("{:.1e} voxels would stand along one side", nodes.max_element()),
            format!("make voxels larger with --cube-size or --radius: at most {MOST_NODES} along a side"),
        ));
    }
    Ok(Lattice {
        lower: (first * shape.width - origin).as_vec3(),
        size: nodes.to_array().map(|n| n as u32),
    })
}

fn add(sum: &mut Figures, one: &Figures) {
    *sum = Figures {
        shell: sum.shell + one.shell,
        voxels: sum.voxels + one.voxels,
        box_voxels: sum.box_voxels + one.box_voxels,
        bytes: sum.bytes + one.bytes,
        box_bytes: sum.box_bytes + one.box_bytes,
        seconds: sum.seconds + one.seconds,
    };
}
