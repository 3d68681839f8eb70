//! Stub: the real module comes from another branch.

use serde::Serialize;

use crate::error::Result;
use crate::gpu::device::Limits;
use crate::scene::Scene;
use crate::scene::column::Column;
use crate::scene::model::View;

#[derive(Debug, Clone)]
pub struct Wanted {
    pub statistics: bool,
    pub columns: Vec<Column>,
    /// `None`: no pictures.
    pub view: Option<View>,
}

#[derive(Debug, Clone, Serialize)]
pub struct Plan {
    pub buffers: Vec<BufferPlan>,
    pub textures: Vec<TexturePlan>,
    pub passes: Vec<PassPlan>,
    pub draws: Vec<DrawPlan>,
    pub notes: Vec<String>,
    /// Voxels of the whole domain, which `uniform` keeps and `sliced` saves on.
    pub domain_voxels: u64,
}

#[derive(Debug, Clone, Serialize)]
pub struct BufferPlan {
    pub name: String,
    pub bytes: u64,
    pub why: String,
}

#[derive(Debug, Clone, Serialize)]
pub struct TexturePlan {
    pub name: String,
    pub bytes: u64,
    pub size: [u32; 2],
    pub why: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    Start,
    Step,
    Observe,
}

#[derive(Debug, Clone, Serialize)]
pub struct PassPlan {
    pub phase: Phase,
    pub label: String,
    pub shader: String,
    pub items: u32,
    pub why: String,
}

#[derive(Debug, Clone, Serialize)]
pub struct DrawPlan {
    pub label: String,
    pub shader: String,
    pub why: String,
}

impl Plan {
    pub fn new(scene: &Scene, _limits: &Limits, _wanted: &Wanted) -> Result<Self> {
        let n = u64::from(scene.capacity);
        Ok(Self {
            buffers: vec![BufferPlan {
                name: "position".into(),
                bytes: 16 * n,
                why: "where grains are".into(),
            }],
            textures: Vec::new(),
            passes: vec![PassPlan {
                phase: Phase::Step,
                label: "integrate".into(),
                shader: "physics/integrate.wgsl".into(),
                items: scene.capacity,
                why: "moves grains".into(),
            }],
            draws: Vec::new(),
            notes: Vec::new(),
            domain_voxels: 128 * 128 * 128,
        })
    }

    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(|b| b.bytes).sum::<u64>() + self.textures.iter().map(|t| t.bytes).sum::<u64>()
    }
}
