//! Triangle meshes (stub of the render branch).

use glam::DVec3;

#[derive(Debug, Clone, Default)]
pub struct Mesh {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}
