//! What a step must move and compute at least, pass by pass, counted from the plan and its shaders.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::gpu::reflect::ResourceKind;
use crate::gpu::{Items, PassPlan, Shader};
use crate::neighbors::lists;
use crate::physics::dfsph::{DENSITY, DIVERGENCE, VISCOSITY};
use crate::plan::{Phase, Plan};
use crate::scene::Scene;

/// Bytes and floating-point operations.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Demand {
    pub bytes: f64,
    pub operations: f64,
}

/// How often things happen in a step.
#[derive(Debug, Clone, Copy)]
pub struct Rates {
    /// Searches a step.
    pub searches: f64,
    /// Iterations of the loops of `dfsph`.
    pub density_iterations: f64,
    pub divergence_iterations: f64,
    pub viscosity_iterations: f64,
    /// Pairs in reach, each from both sides.
    pub pairs: f64,
}

/// Arrays with more bytes for each particle hold something else.
const MOST_BYTES_PER_PARTICLE: u64 = 64;
const INDEX_BYTES: f64 = 4.0;
/// Of an entry of `pair_list`.
const PAIR_BYTES: f64 = 8.0;
/// Of an entry of `pair_weight`.
const WEIGHT_BYTES: f64 = 4.0;

/// The least that each pass of a step must move and compute, by label: every array with a value per particle that it binds,
/// once, and for each pair one entry of a list and one turn of its loop. What finds voxels, and what pairs out of reach
/// take, comes on top.
///
/// # Errors
///
/// Where a shader does not compile.
pub fn of_step(scene: &Scene, plan: &Plan, rates: Rates) -> Result<BTreeMap<String, Demand>> {
    let listed = lists::wanted(scene) && plan.lists_left_out.is_none();
    let mut demands = BTreeMap::new();
    for row in &plan.passes {
        let counts = match row.phase {
            Phase::Step => true,
            Phase::Start => listed,
            Phase::Observe | Phase::Sample => false,
        };
        if counts {
            let once = of_pass(plan, row.phase, &row.pass, rates.pairs)?;
            let times = times(&row.pass, rates);
            let sum: &mut Demand = demands.entry(row.pass.entry.clone()).or_default();
            sum.bytes += times * once.bytes;
            sum.operations += times * once.operations;
        }
    }
    Ok(demands)
}

/// How often a pass has work in a step.
fn times(pass: &PassPlan, rates: Rates) -> f64 {
    match pass.items {
        Items::SearchedParticles
        | Items::SearchedFreeParticles
        | Items::SearchedReachedParticles
        | Items::SearchedOnce
        | Items::ReturnedParticles
        | Items::Voxels
        | Items::VoxelBlocks => rates.searches,
        Items::KeptParticles | Items::KeptFreeParticles | Items::KeptReachedParticles => 1.0 - rates.searches,
        // Where lists last for an even number of steps there is nothing to take back.
        Items::AwayParticles => 0.0,
        // The first one of each loop starts it, before any iteration.
        Items::Loop(_) if pass.repeat.is_none() => 1.0,
        Items::Loop(DENSITY) | Items::LoopSecond(DENSITY) => rates.density_iterations,
        Items::Loop(DIVERGENCE) | Items::LoopSecond(DIVERGENCE) => rates.divergence_iterations,
        Items::Loop(VISCOSITY) | Items::LoopSecond(VISCOSITY) => rates.viscosity_iterations,
        _ => 1.0,
    }
}

/// Of a pass that runs once.
fn of_pass(plan: &Plan, phase: Phase, pass: &PassPlan, pairs: f64) -> Result<Demand> {
    let particles = u64::from(plan.capacity);
    // Threads of other passes go over voxels or sums, and move little beside those over particles.
    if pass.items.over().is_none() || particles == 0 {
        return Ok(Demand::default());
    }
    let shader = Shader::load(&pass.shader, &plan.variant_of(phase))?;
    let work = shader.work(&pass.entry)?;
    let pairs = if work.per_turn > 0 { pairs } else { 0.0 };
    let mut bytes = 0.0;
    for resource in shader.resources(&pass.entry)? {
        if !matches!(resource.kind, ResourceKind::Storage { .. }) {
            continue;
        }
        bytes += match resource.name.as_str() {
            "neighbor_list" => pairs * INDEX_BYTES,
            "pair_list" => pairs * PAIR_BYTES,
            "pair_weight" => pairs * WEIGHT_BYTES,
            name => {
                let planned = plan.buffers.iter().find(|buffer| buffer.name == name);
                let size = planned.map_or(0, |buffer| buffer.bytes);
                let is_array = size % particles == 0 && size / particles <= MOST_BYTES_PER_PARTICLE;
                if is_array { size as f64 } else { 0.0 }
            }
        };
    }
    Ok(Demand {
        bytes,
        operations: particles as f64 * work.once as f64 + pairs * work.per_turn as f64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Limits;
    use crate::plan::Wanted;
    use crate::study::suite::scenes::SUBJECTS;

    #[test]
    fn a_step_needs_more_where_pairs_are_more() {
        for subject in SUBJECTS {
            let scene = (subject.scene)(1_000).unwrap();
            let plan = Plan::new(&scene, &Limits::PROMISED, &Wanted::default()).unwrap();
            let of = |pairs: f64| {
                let rates = Rates {
                    searches: 0.1,
                    density_iterations: 3.0,
                    divergence_iterations: 2.0,
                    viscosity_iterations: 0.0,
                    pairs,
                };
                let demands = of_step(&scene, &plan, rates).unwrap();
                let sum = |of: fn(&Demand) -> f64| demands.values().map(of).sum::<f64>();
                (sum(|d| d.bytes), sum(|d| d.operations))
            };
            let particles = f64::from(scene.capacity);
            let ((none, alone), (bytes, operations)) = (of(0.0), of(30.0 * particles));
            // At least position and velocity are read and written.
            assert!(none >= 64.0 * particles * 0.5, "{}: {none}", subject.name);
            assert!(
                alone > 0.0 && operations > alone + 30.0 * particles,
                "{}",
                subject.name
            );
            assert!(
                bytes >= none + 4.0 * 30.0 * particles,
                "{}: {bytes}",
                subject.name
            );
        }
    }
}
