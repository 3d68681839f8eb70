//! A frame's columns as points with attributes. What is flat has z = 0.

use crate::scene::column::Column;
use crate::simulation::frame::{ColumnData, Frame, Values};

/// What is written of a frame.
pub struct Moment<'a> {
    pub index: u32,
    /// Seconds.
    pub time: f64,
    pub columns: Vec<&'a ColumnData>,
}

impl<'a> Moment<'a> {
    /// The frame may have columns that others want.
    pub fn new(frame: &'a Frame, columns: &[Column]) -> Self {
        let is_wanted = |found: &&ColumnData| columns.iter().any(|column| column.name == found.name);
        Self {
            index: frame.index,
            time: frame.time,
            columns: frame.columns.iter().filter(is_wanted).collect(),
        }
    }
}

/// Points and attributes, in order of id.
pub struct Cloud<'a> {
    /// Metres, in the scene's own coordinates.
    pub position: Vec<[f64; 3]>,
    pub attributes: Vec<(&'static str, Attribute<'a>)>,
}

/// One value per point.
pub enum Attribute<'a> {
    Float(&'a [f32]),
    Unsigned(&'a [u32]),
    Vector(Vec<[f32; 3]>),
}

impl<'a> Cloud<'a> {
    pub fn new(moment: &Moment<'a>) -> Self {
        let mut cloud = Self {
            position: Vec::new(),
            attributes: Vec::new(),
        };
        for &column in &moment.columns {
            let attribute = match &column.values {
                Values::Double { columns, values } => {
                    cloud.position = values.chunks_exact(*columns).map(in_space).collect();
                    continue;
                }
                // The position has them.
                Values::Float(_) if ["x", "y", "z"].contains(&column.name) => continue,
                Values::Float(values) => Attribute::Float(values),
                Values::Unsigned(values) => Attribute::Unsigned(values),
                Values::Vector { columns, values } => {
                    Attribute::Vector(values.chunks_exact(*columns).map(in_space).collect())
                }
            };
            cloud.attributes.push((column.name, attribute));
        }
        cloud
    }
}

fn in_space<T: Copy + Default>(vector: &[T]) -> [T; 3] {
    std::array::from_fn(|axis| vector.get(axis).copied().unwrap_or_default())
}

#[cfg(test)]
pub mod samples {
    use crate::simulation::frame::{ColumnData, Frame, Values};

    /// Two particles of a 2D scene with columns of each kind.
    pub fn flat() -> Frame {
        let column = |name, values| ColumnData { name, values };
        Frame {
            index: 3,
            time: 0.1,
            steps: 30,
            step_s: 1e-3,
            step_limited_by: "",
            adaptive: None,
            boundary_particles: 0,
            convergence: None,
            particles: 2,
            overflow: 0,
            quarantined: 0,
            reallocations: 0,
            lists_left_out: None,
            searches: 0,
            pixels: None,
            passes: Vec::new(),
            voxels: None,
            statistics: None,
            samples: Vec::new(),
            bodies: Vec::new(),
            columns: vec![
                column("id", Values::Unsigned(vec![0, 1])),
                column(
                    "position",
                    Values::Double {
                        columns: 2,
                        values: vec![0.5, -1.25, 1e6 + 0.125, 3.0],
                    },
                ),
                column("x", Values::Float(vec![0.5, 1e6])),
                column(
                    "velocity",
                    Values::Vector {
                        columns: 2,
                        values: vec![1.0, 2.0, -3.0, 4.5],
                    },
                ),
                column("density", Values::Float(vec![1000.5, 998.25])),
                column("speed", Values::Float(vec![2.0, 5.5])),
            ],
            pass_ms: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::particles::columns_named;

    #[test]
    fn flat_points_lie_at_z_0_and_coordinates_come_once() {
        let frame = samples::flat();
        let wanted = columns_named(["position", "x", "velocity", "id", "density"]).unwrap();
        let cloud = Cloud::new(&Moment::new(&frame, &wanted));
        assert_eq!(cloud.position, [[0.5, -1.25, 0.0], [1e6 + 0.125, 3.0, 0.0]]);
        let names: Vec<_> = cloud.attributes.iter().map(|(name, _)| *name).collect();
        assert_eq!(
            names,
            ["id", "velocity", "density"],
            "and not `speed`, which others want"
        );
        let Attribute::Vector(velocity) = &cloud.attributes[1].1 else {
            panic!("velocity is a vector")
        };
        assert_eq!(velocity, &[[1.0, 2.0, 0.0], [-3.0, 4.5, 0.0]]);
    }
}
