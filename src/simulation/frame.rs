//! Stub: the real module comes from another branch.

#[derive(Debug, Clone)]
pub struct Frame {
    pub index: u32,
    pub time: f64,
    pub steps: u64,
    pub step_s: f64,
    pub particles: u32,
    pub pixels: Option<Vec<u8>>,
    pub statistics: Option<Statistics>,
    pub columns: Vec<ColumnData>,
    pub pass_ms: Vec<(String, f64)>,
}

#[derive(Debug, Clone)]
pub struct ColumnData {
    pub name: &'static str,
    pub values: Values,
}

#[derive(Debug, Clone)]
pub enum Values {
    Float(Vec<f32>),
    Double { columns: usize, values: Vec<f64> },
    Unsigned(Vec<u32>),
    Vector { columns: usize, values: Vec<f32> },
}

#[derive(Debug, Clone, Default)]
pub struct Statistics {
    pub kinetic_energy: f64,
    pub potential_energy: f64,
    pub max_speed: f64,
    pub max_overlap: f64,
    pub contacts: u64,
    pub voxels_allocated: u32,
    pub voxels_occupied: u32,
    pub voxels_with: [u32; 4],
    pub voxels_with_more: u32,
    pub overflow: u32,
    pub overflow_since_last_frame: u64,
}
