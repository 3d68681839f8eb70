//! What plans are made of: buffers and passes, each with the reason why a scene needs it.

use serde::Serialize;

use super::buffers::Usage;

/// A buffer that a plan asks for.
#[derive(Debug, Clone, Serialize)]
pub struct BufferPlan {
    pub name: String,
    pub bytes: u64,
    #[serde(skip)]
    pub usage: Usage,
    pub why: String,
}

impl BufferPlan {
    /// A storage buffer of `count` elements of `element` bytes each.
    pub fn storage(name: &str, count: u64, element: u64, why: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            bytes: count * element,
            usage: Usage::Storage,
            why: why.into(),
        }
    }

    /// A uniform buffer of one struct.
    pub fn uniform(name: &str, bytes: usize, why: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            bytes: bytes as u64,
            usage: Usage::Uniform,
            why: why.into(),
        }
    }
}

/// How many threads a pass needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Items {
    /// One a particle that exists when the pass runs.
    Particles,
    /// One a voxel that the grid may have.
    Voxels(u32),
    /// A number known beforehand.
    Fixed(u32),
}

/// A compute pass that a plan asks for. Its label is its entry point: a verb.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PassPlan {
    /// File below `shaders/`, without its ending.
    pub shader: String,
    pub entry: String,
    pub items: Items,
    pub why: String,
}

impl PassPlan {
    pub fn new(shader: &str, entry: &str, items: Items, why: impl Into<String>) -> Self {
        Self {
            shader: shader.to_owned(),
            entry: entry.to_owned(),
            items,
            why: why.into(),
        }
    }
}
