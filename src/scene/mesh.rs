//! Triangle meshes (stub; replaced on merging).

use std::path::Path;

use glam::DVec3;

#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    pub fn load(path: &Path) -> Result<Mesh, String> {
        Err(format!("{} cannot be read yet", path.display()))
    }

    pub fn placed(mut self, scale: f64, _rotate_degrees: DVec3, translate: DVec3) -> Mesh {
        for vertex in &mut self.vertices {
            *vertex = *vertex * scale + translate;
        }
        self
    }

    pub fn open_edges(&self) -> usize {
        0
    }

    pub fn bounds(&self) -> (DVec3, DVec3) {
        let first = self.vertices.first().copied().unwrap_or_default();
        let grow = |(low, high): (DVec3, DVec3), v: &DVec3| (low.min(*v), high.max(*v));
        self.vertices.iter().fold((first, first), grow)
    }
}
