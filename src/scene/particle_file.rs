//! Particles from files (stub; replaced on merging).

use std::path::Path;

use glam::DVec3;

use super::Dimensions;

pub struct Loaded {
    pub position: Vec<DVec3>,
    pub velocity: Option<Vec<DVec3>>,
    pub id: Option<Vec<u32>>,
}

pub fn load(path: &Path, _dimensions: Dimensions) -> Result<Loaded, String> {
    Err(format!("{} cannot be read yet", path.display()))
}
