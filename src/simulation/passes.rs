//! A plan's passes on a device.

use crate::error::Result;
use crate::gpu::pass::INDEX_STRIDE;
use crate::gpu::{Buffers, Gpu, Groups, Items, Kernels, Pass, PassPlan, Repeat};
use crate::plan::{Phase, Plan};

/// A pass and how many threads it runs.
pub struct Step {
    pub pass: Pass,
    pub items: Items,
    pub repeat: Option<Repeat>,
}

/// The steps in the order in which they are recorded, loops as often as they may run.
pub fn recorded(steps: &[Step]) -> Vec<&Step> {
    let mut order = Vec::new();
    let number = |step: &Step| step.repeat.map(|repeat| repeat.number);
    for passes in steps.chunk_by(|a, b| number(a).is_some() && number(a) == number(b)) {
        for time in 0..passes[0].repeat.map_or(1, |repeat| repeat.times) {
            let is_sparse = |step: &Step| step.repeat.is_some_and(|repeat| repeat.sparse);
            let recorded = |step: &&Step| !is_sparse(step) || time == 0 || time.is_power_of_two();
            order.extend(passes.iter().filter(recorded));
        }
    }
    order
}

impl Step {
    pub fn groups<'a>(&self, buffers: &'a Buffers) -> Result<Groups<'a>> {
        Ok(match (self.items, self.items.dispatch_entry()) {
            (_, Some((buffer, entry))) => Groups::From(buffers.get(buffer, "(host)")?, 16 * entry),
            (Items::Fixed(count), _) => Groups::For(count),
            _ => unreachable!("only a fixed number is in no buffer"),
        })
    }
}

/// The passes of a plan, by when they run.
pub struct Passes {
    pub start: Vec<Step>,
    pub step: Vec<Step>,
    /// The step after it, where steps go by twos: from the `next_` buffers to those without.
    pub step_back: Vec<Step>,
    pub observe: Vec<Step>,
    /// Whenever sensors are sampled.
    pub sample: Vec<Step>,
}

impl Passes {
    pub fn new(gpu: &Gpu, plan: &Plan, buffers: &Buffers, kernels: &mut Kernels) -> Result<Self> {
        let indices = plan.indices();
        for (place, index) in indices.iter().enumerate() {
            let first = place * INDEX_STRIDE as usize / size_of::<u32>();
            buffers.write(gpu, "pass_index", first, &[*index])?;
        }
        let mut made = |phase, back: bool| -> Result<Vec<Step>> {
            let variant = plan.variant_of(phase);
            let step = |planned: &PassPlan| {
                let kernel = kernels.get(gpu, &variant, &planned.shader, &planned.entry)?;
                let place = planned.index.and_then(|index| indices.binary_search(&index).ok());
                let pass = match place {
                    Some(place) => kernel.numbered_pass(gpu, buffers, place)?,
                    None if planned.flipped != back => kernel.flipped_pass(gpu, buffers)?,
                    None => kernel.pass(gpu, buffers)?,
                };
                let items = if back {
                    planned.items.returning()
                } else {
                    planned.items
                };
                Ok(Step {
                    pass,
                    items,
                    repeat: planned.repeat,
                })
            };
            plan.in_phase(phase).map(step).collect()
        };
        let back = plan.goes_by_twos();
        Ok(Self {
            start: made(Phase::Start, false)?,
            step: made(Phase::Step, false)?,
            step_back: if back {
                made(Phase::Step, true)?
            } else {
                Vec::new()
            },
            observe: made(Phase::Observe, false)?,
            sample: made(Phase::Sample, false)?,
        })
    }
}
