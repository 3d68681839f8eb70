//! `stats.jsonl`: one JSON object per frame, on one line.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::PathBuf;
use std::sync::Arc;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::{Map, Value};

use super::{Sink, disk};
use crate::error::Result;
use crate::files;
use crate::physics::layout::Convergence;
use crate::simulation::frame::{AdaptiveSteps, Frame, Statistics};

/// Appends a line as soon as a frame is there, so that a run can be followed with `tail -f`.
pub struct StatisticsFile {
    path: PathBuf,
    file: File,
}

impl StatisticsFile {
    /// Goes on behind the lines that are there.
    pub fn open(path: PathBuf) -> Result<Self> {
        let file = files::append(&path).map_err(|reason| disk::failed(&path, "create", reason))?;
        Ok(Self { path, file })
    }
}

impl Sink for StatisticsFile {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        let mut line = line(frame);
        line.push('\n');
        // An open file can be written although nobody can find it any more.
        if !self.path.exists() {
            return Err(disk::failed(&self.path, "find", ErrorKind::NotFound.into()));
        }
        self.file
            .write_all(line.as_bytes())
            .map_err(|reason| disk::failed(&self.path, "write", reason))
    }

    fn flush(&mut self) -> Result<()> {
        self.file
            .sync_all()
            .map_err(|reason| disk::failed(&self.path, "save", reason))
    }

    fn finish(&mut self) -> Result<()> {
        self.flush()
    }
}

/// A frame in `stats.jsonl`.
#[derive(Serialize, JsonSchema)]
struct Line {
    /// Number of the frame, from 0.
    frame: u32,
    /// Simulated time, seconds.
    time_s: f64,
    /// Steps since the run began.
    steps: u64,
    /// Length of the steps since the last frame, or their mean where they differ, seconds.
    step_s: f64,
    /// What limited most of these steps.
    step_limited_by: &'static str,
    #[serde(flatten)]
    adaptive: Option<Adaptive>,
    /// Particles in the scene at this time, boundary particles apart.
    particles: u32,
    /// Particles of walls.
    boundary_particles: u32,
    /// How often a particle found its voxel of a `pool` full, in all searches since the last frame; contacts are then
    /// missed. Zero is what one wants, and with every other storage it is.
    overflow_since_last_frame: u64,
    /// Particles farther from the domain than the neighbor search follows; they find no neighbors.
    quarantined: u32,
    #[serde(flatten)]
    measured: Option<Measured>,
    /// With the solver `dfsph`: how its loops went since the last frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pressure_solver: Option<PressureSolver>,
    /// With `--timings`: milliseconds that each pass of a step takes, and those that a frame adds, by the pass's name.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pass_ms: Map<String, Value>,
}

/// Where `time.adaptive` is set: of the steps since the last frame.
#[derive(Serialize, JsonSchema)]
struct Adaptive {
    /// The shortest of them, seconds.
    step_min_s: f64,
    /// The longest of them, seconds.
    step_max_s: f64,
    /// How many of them each limit shortened, by the limit's name.
    steps_limited_by: Map<String, Value>,
}

impl From<&AdaptiveSteps> for Adaptive {
    fn from(from: &AdaptiveSteps) -> Self {
        let limited = from.limited_by.iter();
        Self {
            step_min_s: from.shortest_s,
            step_max_s: from.longest_s,
            steps_limited_by: limited
                .map(|(name, steps)| ((*name).to_owned(), (*steps).into()))
                .collect(),
        }
    }
}

/// How the loops of an iterative pressure solver went.
#[derive(Serialize, JsonSchema)]
struct PressureSolver {
    /// Iterations of the loop of density in a step, on average.
    density_iterations_mean: f64,
    /// Its iterations in the step that took most.
    density_iterations_max: u32,
    /// What the worst step stopped at: mean of max(ρ/ρ₀ − 1, 0) over the particles.
    density_error_max: f64,
    /// Steps that stopped at `fluid.max_iterations` before the density was good enough.
    density_unconverged_steps: u32,
    /// Iterations of the loop of divergence in a step, on average.
    divergence_iterations_mean: f64,
    /// Its iterations in the step that took most.
    divergence_iterations_max: u32,
    /// What the worst step stopped at: mean of what its divergence adds to ρ/ρ₀.
    divergence_error_max: f64,
    /// Steps that stopped at `fluid.max_iterations` before the divergence was good enough.
    divergence_unconverged_steps: u32,
    /// Where viscosity is found implicitly: iterations of its loop in a step, on average.
    #[serde(skip_serializing_if = "Option::is_none")]
    viscosity_iterations_mean: Option<f64>,
    /// Its iterations in the step that took most.
    #[serde(skip_serializing_if = "Option::is_none")]
    viscosity_iterations_max: Option<u32>,
    /// What the worst step stopped at: share of what viscosity had to change.
    #[serde(skip_serializing_if = "Option::is_none")]
    viscosity_error_max: Option<f64>,
    /// Steps that stopped at `fluid.max_iterations` before that share was small enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    viscosity_unconverged_steps: Option<u32>,
}

impl From<&Convergence> for PressureSolver {
    fn from(from: &Convergence) -> Self {
        let mean = |iterations: u32| f64::from(iterations) / f64::from(from.steps.max(1));
        // Each step with such a loop has an iteration.
        let is_implicit = from.viscosity_iterations > 0;
        Self {
            density_iterations_mean: mean(from.density_iterations),
            density_iterations_max: from.most_density_iterations,
            density_error_max: from.density_error.into(),
            density_unconverged_steps: from.density_unconverged,
            divergence_iterations_mean: mean(from.divergence_iterations),
            divergence_iterations_max: from.most_divergence_iterations,
            divergence_error_max: from.divergence_error.into(),
            divergence_unconverged_steps: from.divergence_unconverged,
            viscosity_iterations_mean: is_implicit.then(|| mean(from.viscosity_iterations)),
            viscosity_iterations_max: is_implicit.then_some(from.most_viscosity_iterations),
            viscosity_error_max: is_implicit.then_some(from.viscosity_error.into()),
            viscosity_unconverged_steps: is_implicit.then_some(from.viscosity_unconverged),
        }
    }
}

/// Figures over all particles and voxels; absent with `--no-statistics`.
#[derive(Serialize, JsonSchema)]
struct Measured {
    /// Energy of motion of all particles, joules (per metre of depth in 2D).
    kinetic_energy_j: f64,
    /// Energy of height of all particles, joules, zero at the domain's lower corner.
    potential_energy_j: f64,
    /// Speed of the fastest particle, m/s.
    max_speed_m_per_s: f64,
    /// Grains: deepest overlap, as a share of the radius; above 0.2 grains are too soft.
    max_overlap: f64,
    /// Grains: contacts as each grain sees them; one of two grains counts twice, one with a wall once.
    contacts: u64,
    /// Fluids: mean of |ρ/ρ₀ − 1| over the particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    density_error_mean: Option<f64>,
    /// Fluids: greatest |ρ/ρ₀ − 1|.
    #[serde(skip_serializing_if = "Option::is_none")]
    density_error_max: Option<f64>,
    /// Fluids whose negative pressures are clamped: particles whose pressure counts as zero therefore.
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped_pressures: Option<u32>,
    /// Those of them whose density is the lowest that is allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped_densities: Option<u32>,
    /// Voxels that the neighbor search has memory for.
    voxels_allocated: u32,
    /// Voxels with at least one particle.
    voxels_occupied: u32,
    /// Voxels with one particle.
    voxels_with_1: u32,
    /// Voxels with two particles.
    voxels_with_2: u32,
    /// Voxels with three particles.
    voxels_with_3: u32,
    /// Voxels with four particles.
    voxels_with_4: u32,
    /// Voxels with five particles or more.
    voxels_with_more: u32,
    /// Particles that found their voxel of a `pool` full in the search for this frame.
    overflow: u32,
}

impl From<&Statistics> for Measured {
    fn from(from: &Statistics) -> Self {
        let [voxels_with_1, voxels_with_2, voxels_with_3, voxels_with_4] = from.voxels_with;
        Self {
            kinetic_energy_j: from.kinetic_energy,
            potential_energy_j: from.potential_energy,
            max_speed_m_per_s: from.max_speed,
            max_overlap: from.max_overlap,
            contacts: from.contacts,
            density_error_mean: from.density_error.map(|[mean, _]| mean),
            density_error_max: from.density_error.map(|[_, most]| most),
            clamped_pressures: from.clamped.map(|[pressures, _]| pressures),
            clamped_densities: from.clamped.map(|[_, densities]| densities),
            voxels_allocated: from.voxels_allocated,
            voxels_occupied: from.voxels_occupied,
            voxels_with_1,
            voxels_with_2,
            voxels_with_3,
            voxels_with_4,
            voxels_with_more: from.voxels_with_more,
            overflow: from.overflow,
        }
    }
}

/// The JSON schema of a line.
pub fn schema() -> Value {
    let written = SchemaSettings::draft2020_12().for_serialize();
    written.into_generator().into_root_schema_for::<Line>().to_value()
}

fn line(frame: &Frame) -> String {
    Value::Object(figures(frame)).to_string()
}

/// A frame's figures by key; units are in the keys.
pub fn figures(frame: &Frame) -> Map<String, Value> {
    let line = Line {
        frame: frame.index,
        time_s: frame.time,
        steps: frame.steps,
        step_s: frame.step_s,
        step_limited_by: frame.step_limited_by,
        adaptive: frame.adaptive.as_ref().map(Adaptive::from),
        particles: frame.particles,
        boundary_particles: frame.boundary_particles,
        overflow_since_last_frame: frame.overflow,
        quarantined: frame.quarantined,
        measured: frame.statistics.as_ref().map(Measured::from),
        pressure_solver: frame.convergence.as_ref().map(PressureSolver::from),
        pass_ms: by_pass(&frame.pass_ms),
    };
    match serde_json::to_value(line) {
        Ok(Value::Object(figures)) => figures,
        _ => unreachable!("a struct becomes an object, and numbers that JSON lacks become null"),
    }
}

/// Sums times of passes with the same label; the order is that of first appearance.
fn by_pass(times: &[(String, f64)]) -> Map<String, Value> {
    let mut sums = Map::new();
    for (label, ms) in times {
        let sum = sums.get(label).and_then(Value::as_f64).unwrap_or(0.0) + ms;
        sums.insert(label.clone(), sum.into());
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_object_a_frame_with_units_in_its_keys() {
        let mut frame = Frame {
            index: 3,
            time: 0.1,
            steps: 300,
            step_s: 1e-3,
            step_limited_by: "viscosity",
            particles: 10,
            ..Default::default()
        };
        assert_eq!(
            line(&frame),
            r#"{"frame":3,"time_s":0.1,"steps":300,"step_s":0.001,"step_limited_by":"viscosity","particles":10,"boundary_particles":0,"overflow_since_last_frame":0,"quarantined":0}"#
        );

        frame.adaptive = Some(AdaptiveSteps {
            shortest_s: 1e-4,
            longest_s: 2e-3,
            limited_by: vec![("viscosity", 3), ("motion", 7)],
        });
        frame.statistics = Some(Statistics {
            voxels_with: [4, 3, 2, 1],
            ..Default::default()
        });
        frame.pass_ms = [("push", 1.0), ("count", 0.5), ("push", 2.0)]
            .map(|(l, t)| (l.to_owned(), t))
            .into();
        let value: Value = serde_json::from_str(&line(&frame)).unwrap();
        assert_eq!(value["voxels_with_1"], 4);
        assert_eq!(value["step_max_s"], 2e-3);
        let limits = &value["steps_limited_by"];
        assert_eq!(limits.to_string(), r#"{"viscosity":3,"motion":7}"#);
        assert_eq!(value["voxels_with_4"], 1);
        assert_eq!(value["pass_ms"].to_string(), r#"{"push":3.0,"count":0.5}"#);
    }
}
