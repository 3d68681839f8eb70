//! Columns of frames as cases look at them: in f64, in order of id.

use glam::DVec3;

use crate::simulation::frame::{Frame, Values};

/// Vectors; positions in the scene's own coordinates, z = 0 in 2D. Empty where the frame has no such column.
pub fn vectors(frame: &Frame, name: &str) -> Vec<DVec3> {
    let Some(column) = frame.columns.iter().find(|column| column.name == name) else {
        return Vec::new();
    };
    let vector = |v: &[f64]| DVec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0));
    match &column.values {
        Values::Double { columns, values } => values.chunks_exact(*columns).map(vector).collect(),
        Values::Vector { columns, values } => {
            let values: Vec<f64> = values.iter().map(|&v| v.into()).collect();
            values.chunks_exact(*columns).map(vector).collect()
        }
        Values::Float(_) | Values::Unsigned(_) => Vec::new(),
    }
}

/// One number per particle. Empty where the frame has no such column.
pub fn scalars(frame: &Frame, name: &str) -> Vec<f64> {
    let column = frame.columns.iter().find(|column| column.name == name);
    match column.map(|column| &column.values) {
        Some(Values::Float(values)) => values.iter().map(|&v| v.into()).collect(),
        _ => Vec::new(),
    }
}
