//! What a solver is to the rest of the program: a row of [`MODELS`].

use super::collider::Obstacles;
use super::layout::Sums;
use super::{dem, dfsph, fluid};
use crate::gpu::{BufferPlan, PassPlan, Variant};
use crate::guards::Family;
use crate::neighbors::Grid;
use crate::scene::column::{Column, Source};
use crate::scene::{Matter, Scene};

/// A solver. Nothing outside of `scene` and `physics` asks what particles are made of; it asks the row.
#[derive(Debug)]
pub struct Model {
    /// Whether it moves such particles.
    pub moves: fn(&Matter) -> bool,
    /// Buffers and passes, and what the shaders of this scene are made of.
    pub plan: fn(&Request, &mut Variant) -> Solver,
    /// What is written when a run begins and whenever an event changes what particles are.
    pub parameters: fn(&Scene, &Matter) -> Vec<Written>,
    /// What sets moving obstacles on their way from one time to another, seconds.
    pub place_obstacles: fn(&Scene, &Obstacles, from: f64, to: f64) -> Vec<Written>,
    /// Whether its measures go over voxels instead of neighbor lists, which end where forces do.
    pub measures_by_voxels: bool,
    /// Keys of `stats.jsonl` that it has, and other models may not have.
    pub figures: &'static [&'static str],
    /// What its shaders summed over so many particles, for [`Model::figures`].
    pub sums: fn(&Scene, particles: u32, &Sums) -> OwnFigures,
    /// Columns that follow from the state which a checkpoint holds.
    pub from_state: &'static [FromState],
    /// Of a particle at rest, kg; of grains of several sizes, the largest.
    pub particle_mass: fn(&Scene) -> f64,
    /// Shader that finds what particles do to walls and obstacles, for sensors; and whether that is known only while a step is
    /// made, where its solver runs the pass itself.
    pub sense_walls: (&'static str, bool),
    /// Where something goes wrong.
    pub family: Family,
}

/// Every solver there is.
pub const MODELS: &[Model] = &[dem::MODEL, fluid::MODEL, dfsph::MODEL];

/// The solver that moves these particles.
pub fn model(matter: &Matter) -> &'static Model {
    let found = MODELS.iter().find(|model| (model.moves)(matter));
    found.expect("every kind of matter has a solver")
}

/// What a plan asks of a solver.
pub struct Request<'a> {
    pub scene: &'a Scene,
    /// Those that somebody asked for.
    pub columns: &'a [Column],
    /// Whether figures over all particles are wanted.
    pub statistics: bool,
    /// Whether the scene's sensors are read.
    pub sensors: bool,
    pub grid: &'a Grid,
}

impl Request<'_> {
    /// Whether columns are measured once a frame.
    pub fn measures_columns(&self) -> bool {
        let mut columns = self.columns.iter();
        columns.any(|column| column.source == Source::Measured)
    }

    /// Whether somebody asked for this column.
    pub fn has_column(&self, name: &str) -> bool {
        self.columns.iter().any(|column| column.name == name)
    }
}

/// What a solver contributes to a plan, around the neighbor search of a step.
#[derive(Default)]
pub struct Solver {
    pub buffers: Vec<BufferPlan>,
    /// From `position` and the other columns to `next_position` and so on.
    pub before_search: Vec<PassPlan>,
    /// On the particles as the search left them.
    pub after_search: Vec<PassPlan>,
    /// Behind those, in steps that search. Where no step does without a search, none of them is needed.
    pub once_searched: Vec<PassPlan>,
    /// Once a frame, when somebody asks for what it measures.
    pub measure: Vec<PassPlan>,
    pub obstacles: Obstacles,
    /// What was decided where there was a choice.
    pub notes: Vec<String>,
}

/// Bytes for the beginning of a buffer.
pub struct Written {
    pub buffer: &'static str,
    pub bytes: Vec<u8>,
}

impl Written {
    pub fn new<T: bytemuck::NoUninit>(buffer: &'static str, values: &[T]) -> Self {
        Self {
            buffer,
            bytes: bytemuck::cast_slice(values).to_vec(),
        }
    }
}

/// Figures that not every solver has.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OwnFigures {
    /// Mean and greatest |ρ/ρ₀ − 1| over all particles.
    pub density_error: Option<[f64; 2]>,
    /// Particles whose pressure counts as zero because it would be negative, and those of them whose density is the
    /// lowest allowed.
    pub clamped: Option<[u32; 2]>,
}

/// A column that follows from a buffer of the state.
#[derive(Debug)]
pub struct FromState {
    pub column: &'static str,
    /// Buffer with `width` numbers for each particle.
    pub buffer: &'static str,
    pub width: usize,
    /// From these numbers and the index of the particle's material.
    pub value: fn(&Scene, &[f32], material: usize) -> f32,
}
