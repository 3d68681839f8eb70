//! From particles to a mesh: marching cubes over a smoothed density, cleaned and smoothed as splashsurf does it (Löschner et
//! al. 2023), ended at walls, with values of the particles at its vertices.

use glam::DVec3;
use splashsurf_lib::halfedge_mesh::HalfEdgeTriMesh;
use splashsurf_lib::mesh::{Mesh3d as _, TriMesh3d};
use splashsurf_lib::nalgebra::Vector3;
use splashsurf_lib::postprocessing::{
    marching_cubes_cleanup, par_laplacian_smoothing_inplace, par_laplacian_smoothing_normals_inplace,
};
use splashsurf_lib::sph_interpolation::SphInterpolator;
use splashsurf_lib::{Parameters, SurfaceReconstruction, reconstruct_surface};

use super::walls::Walls;
use super::{SurfaceMesh, SurfaceSettings, VertexColumn};

/// Rounds in which vertices beside the same corner of a cube are joined; splashsurf's own number.
const CLEANUP_ROUNDS: usize = 5;
/// Of normals, which shows waves and hides cubes.
const NORMAL_SMOOTHING: usize = 10;
/// Weighted neighbors of a particle inside of a fluid; splashsurf's own number.
const FULL_NEIGHBORHOOD: f32 = 13.0;
/// Share of a cube that vertices on a side of the domain are apart at least.
const APART: f32 = 0.3;
/// Cosine between a side of the domain and normals that become the side's own.
const FACES_SIDE: f32 = 0.3;

/// Particles of a frame.
pub struct Cloud {
    pub frame: u32,
    /// Metres.
    pub position: Vec<DVec3>,
    pub columns: Vec<VertexColumn>,
}

/// Makes a mesh of a frame; `None` where no place is dense enough.
///
/// # Errors
///
/// What splashsurf says, where it cannot.
pub fn reconstruct(
    cloud: &Cloud,
    radius: f64,
    walls: &Walls,
    settings: &SurfaceSettings,
) -> Result<Option<SurfaceMesh>, String> {
    let spacing = 2.0 * radius;
    let copies = walls.copies(&cloud.position, spacing);
    // Single precision around the particles' own corner, so that nothing is lost far from zero.
    let origin = cloud
        .position
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let copied = copies.iter().map(|(_, place)| *place);
    let local: Vec<Vector3<f32>> = cloud
        .position
        .iter()
        .copied()
        .chain(copied)
        .map(|p| Vector3::from((p - origin).as_vec3().to_array()))
        .collect();
    let mut parameters = Parameters::new_relative(
        radius as f32,
        2.0 * settings.smoothing_length as f32,
        settings.cube_size as f32,
    );
    parameters.iso_surface_threshold = settings.threshold as f32;
    parameters.global_neighborhood_list = true;
    let mut made =
        reconstruct_surface::<i64, f32>(&local, &parameters).map_err(|reason| reason.to_string())?;
    let mut mesh = std::mem::take(&mut made.mesh);
    if mesh.triangles.is_empty() {
        return Ok(None);
    }
    let density = made.particle_densities.as_deref().unwrap_or_default();
    let mass = parameters.rest_density * (spacing as f32).powi(3);
    let interpolator = SphInterpolator::new(&local, density, mass, parameters.compact_support_radius);

    let connectivity = match settings.cleanup {
        true => marching_cubes_cleanup(&mut mesh, &made.grid, None, CLEANUP_ROUNDS, false),
        false => mesh.vertex_vertex_connectivity(),
    };
    if settings.smoothing > 0 {
        let weights = smoothing_weights(
            &local,
            &made,
            &interpolator,
            &mesh,
            parameters.compact_support_radius,
        );
        par_laplacian_smoothing_inplace(
            &mut mesh,
            &connectivity,
            settings.smoothing as usize,
            1.0,
            &weights,
        );
    }
    let mut normals: Vec<Vector3<f32>> = mesh.par_vertex_normals().iter().map(|n| n.into_inner()).collect();
    par_laplacian_smoothing_normals_inplace(&mut normals, &connectivity, NORMAL_SMOOTHING);

    let mut vertices: Vec<DVec3> = Vec::with_capacity(mesh.vertices.len());
    let mut sides = vec![0; mesh.vertices.len()];
    for (index, vertex) in mesh.vertices.iter().enumerate() {
        let mut place = DVec3::new(vertex.x.into(), vertex.y.into(), vertex.z.into()) + origin;
        place = walls.way_out(place, cloud.frame, spacing);
        let outward = walls.clamp(&mut place).as_vec3();
        for axis in (0..3).filter(|&axis| outward[axis] != 0.0) {
            sides[index] += 1;
            if normals[index][axis] * outward[axis] > FACES_SIDE {
                normals[index] = Vector3::ith(axis, outward[axis]);
            }
        }
        vertices.push(place);
    }
    if sides.iter().any(|&sides| sides > 0) {
        for (vertex, place) in mesh.vertices.iter_mut().zip(&vertices) {
            *vertex = Vector3::from((*place - origin).as_vec3().to_array());
        }
        join_flattened(&mut mesh, &sides, APART * parameters.cube_size);
    }
    let kept = used_vertices(&mesh);
    let places: Vec<Vector3<f32>> = kept.iter().map(|&index| mesh.vertices[index]).collect();
    let columns = cloud
        .columns
        .iter()
        .map(|column| at_vertices(column, &copies, &interpolator, &places))
        .collect();
    let mut number = vec![0; mesh.vertices.len()];
    for (new, &old) in kept.iter().enumerate() {
        number[old] = new as u32;
    }
    Ok(Some(SurfaceMesh {
        vertices: kept.iter().map(|&index| vertices[index]).collect(),
        normals: match settings.normals {
            true => kept.iter().map(|&index| unit(normals[index])).collect(),
            false => Vec::new(),
        },
        columns,
        triangles: mesh
            .triangles
            .iter()
            .map(|t| t.map(|index| number[index]))
            .collect(),
    }))
}

/// A normal that was computed, or some direction where triangles without area have none.
fn unit(normal: Vector3<f32>) -> [f32; 3] {
    if normal.iter().all(|x| x.is_finite()) {
        normal.into()
    } else {
        [0.0, 1.0, 0.0]
    }
}

/// How far each vertex goes along when the mesh is smoothed, 0 to 1: drops and splashes, which have few neighbors, keep their
/// shape (Löschner et al. 2023, section 4.2).
fn smoothing_weights(
    particles: &[Vector3<f32>],
    made: &SurfaceReconstruction<i64, f32>,
    interpolator: &SphInterpolator<f32>,
    mesh: &TriMesh3d<f32>,
    support: f32,
) -> Vec<f32> {
    let lists = made.particle_neighbors.as_deref().unwrap_or_default();
    let weighted: Vec<f32> = lists
        .iter()
        .enumerate()
        .map(|(i, list)| {
            let share = |&j: &usize| 1.0 - (particles[i] - particles[j]).norm_squared() / support.powi(2);
            list.iter().map(share).map(|share| share.max(0.0)).sum()
        })
        .collect();
    interpolator
        .interpolate_scalar_quantity(&weighted, &mesh.vertices, true)
        .into_iter()
        .map(|neighbors| {
            // Beyond the reach of all particles it is not a number, and the vertex stays.
            let x = (neighbors / FULL_NEIGHBORHOOD).clamp(0.0, 1.0);
            let smooth = x.powi(3) * (x * (6.0 * x - 15.0) + 10.0);
            if smooth.is_finite() { smooth } else { 0.0 }
        })
        .collect()
}

/// Joins vertices on sides of the domain that lie upon each other since they were moved there; those on more sides stay, so
/// that corners and edges do.
fn join_flattened(mesh: &mut TriMesh3d<f32>, sides: &[u8], apart: f32) {
    let mut halves = HalfEdgeTriMesh::from(std::mem::take(mesh));
    let mut near = Vec::new();
    for _ in 0..CLEANUP_ROUNDS {
        let mut joined = false;
        for vertex in (0..sides.len()).filter(|&vertex| sides[vertex] > 0) {
            if !halves.is_valid_vertex(vertex) {
                continue;
            }
            let place = halves.vertices[vertex];
            let may_go = |&other: &usize| {
                (1..=sides[vertex]).contains(&sides[other]) && (halves.vertices[other] - place).norm() < apart
            };
            near.clear();
            near.extend(halves.vertex_one_ring(vertex).filter(may_go));
            for &other in &near {
                if halves.is_valid_vertex(other)
                    && let Some(edge) = halves.half_edge(other, vertex)
                {
                    joined |= halves.try_half_edge_collapse(edge).is_ok();
                }
            }
        }
        if !joined {
            break;
        }
    }
    *mesh = halves.into_parts(true).0;
}

/// Vertices that triangles have, in order.
fn used_vertices(mesh: &TriMesh3d<f32>) -> Vec<usize> {
    let mut is_used = vec![false; mesh.vertices.len()];
    for &index in mesh.triangles.iter().flatten() {
        is_used[index] = true;
    }
    (0..is_used.len()).filter(|&index| is_used[index]).collect()
}

/// A column's values at places among the particles: their mean, weighted by the kernel.
fn at_vertices(
    column: &VertexColumn,
    copies: &[(usize, DVec3)],
    interpolator: &SphInterpolator<f32>,
    places: &[Vector3<f32>],
) -> VertexColumn {
    let VertexColumn { name, width, values } = column;
    let sources = (0..values.len() / width).chain(copies.iter().map(|(source, _)| *source));
    let components: Vec<Vec<f32>> = (0..*width)
        .map(|component| {
            let of_particles: Vec<f32> = sources
                .clone()
                .map(|row| values[row * width + component])
                .collect();
            interpolator.interpolate_scalar_quantity(&of_particles, places, true)
        })
        .collect();
    let row = |row: usize| components.iter().map(move |component| component[row]);
    VertexColumn {
        name: name.clone(),
        width: *width,
        values: (0..places.len())
            .flat_map(row)
            .map(|value| if value.is_finite() { value } else { 0.0 })
            .collect(),
    }
}
