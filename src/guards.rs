//! Guards, which stop a run whose numbers can no longer be right: one table. Their codes on the device, their words in files,
//! what messages say of cause and help, and whether smaller steps may help follow from it.

/// A guard, by what it finds; a row of [`GUARDS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuardKind {
    NotFinite,
    Lost,
    Edge,
    Runaway,
    TooFast,
    Crowded,
    StalledStep,
    Energy,
    Density,
    Overlap,
    Overflow,
    Unconverged,
}

/// What solvers have in common where something goes wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    Grains,
    WeaklyCompressible,
    Incompressible,
}

/// Everything about a guard that does not depend on the run.
pub struct GuardRow {
    pub kind: GuardKind,
    /// In files, and where users name it.
    pub word: &'static str,
    /// What it finds, for the guide.
    pub finds: &'static str,
    /// What it looks at, and how often.
    pub looks_at: &'static str,
    /// The constant that stands for it in shaders, where the device itself finds it.
    pub constant: Option<&'static str>,
    /// Begins the message.
    pub what: &'static str,
    /// The likely cause.
    pub cause: &'static str,
    help: Help,
    /// Whether the run may come through with smaller steps.
    pub may_come_of_steps: bool,
}

/// What to change.
enum Help {
    Any(&'static str),
    By {
        grains: &'static str,
        weakly_compressible: &'static str,
        incompressible: &'static str,
    },
}

impl Help {
    const fn of_fluids(weakly_compressible: &'static str, incompressible: &'static str) -> Self {
        // Grains do not have these guards.
        Self::By {
            grains: incompressible,
            weakly_compressible,
            incompressible,
        }
    }
}

const EACH_STEP: &str = "each particle, each step";
const EACH_FRAME: &str = "each frame";

/// Every guard there is, in the order of [`GuardKind`].
pub const GUARDS: [GuardRow; 12] = [
    GuardRow {
        kind: GuardKind::NotFinite,
        word: "not_finite",
        finds: "a position, velocity, energy or density that is no number",
        looks_at: "each particle, each step; sums, each frame",
        constant: Some("GUARD_NOT_FINITE"),
        what: "a position, velocity, energy or density is not a finite number",
        cause: "a step was too long for what happened in it",
        help: Help::By {
            grains: "lower time.step, raise time.steps_per_contact, or set time.adaptive",
            weakly_compressible: "raise fluid.max_speed, lower time.step, or set time.adaptive",
            incompressible: "lower fluid.courant_number or time.step",
        },
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Lost,
        word: "lost",
        finds: "a particle beyond a closed side",
        looks_at: EACH_STEP,
        constant: Some("GUARD_LOST"),
        what: "a particle left the domain through a closed side",
        cause: "it was too fast for the step, or was pressed through the wall",
        help: Help::By {
            grains: "raise grains.spring, lower time.step, or open that side",
            weakly_compressible: "raise fluid.max_speed, lower time.step, or open that side",
            incompressible: "lower fluid.courant_number or time.step, or open that side",
        },
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Edge,
        word: "edge",
        finds: "a particle so far away that single precision no longer resolves it (2²⁴ radii)",
        looks_at: EACH_STEP,
        constant: Some("GUARD_EDGE"),
        what: "a particle is so far away that its coordinates no longer resolve it",
        cause: "it left through an open side long ago, or was thrown out",
        help: Help::Any("close that side, end the run earlier, or lower time.step if it was thrown out"),
        may_come_of_steps: false,
    },
    GuardRow {
        kind: GuardKind::Runaway,
        word: "runaway",
        finds: "fluid a hundred times faster than sound; of `dfsph`, a thousand times faster than expected",
        looks_at: EACH_STEP,
        constant: Some("GUARD_RUNAWAY"),
        what: "a particle is so fast that the fluid no longer flows",
        cause: "pressures push it on without end, or the time step is too long",
        help: Help::of_fluids(
            "raise fluid.max_speed, lower time.step, or set fluid.negative_pressure to `clamp`",
            "lower fluid.courant_number or time.step",
        ),
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::TooFast,
        word: "too_fast",
        finds: "with steps of one length: a particle that moves farther in a step than its neighbors are",
        looks_at: EACH_STEP,
        constant: Some("GUARD_TOO_FAST"),
        what: "a particle moves farther than its neighbors are in one step",
        cause: "something throws it, or the time step is too long: it would pass through others",
        help: Help::By {
            grains: "lower time.step, or set time.adaptive",
            weakly_compressible: "raise fluid.max_speed, lower time.step, or set time.adaptive",
            incompressible: "lower fluid.courant_number or time.step",
        },
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Crowded,
        word: "crowded",
        finds: "a grain with more contacts than it can remember",
        looks_at: "each grain, each step",
        constant: Some("GUARD_CROWDED"),
        what: "a grain touches more grains and walls than it can remember contacts",
        cause: "grains overlap far too much",
        help: Help::Any("make them stiffer (grains.spring, or grains.young_modulus)"),
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::StalledStep,
        word: "stalled_step",
        finds: "adaptive steps 10⁴ times shorter than expected, with which the run would never end",
        looks_at: "each step",
        constant: None,
        what: "steps have become so short that the run would never end",
        cause: "a particle is far too fast, or two lie in one another",
        help: Help::Any(
            "look at the frame before for particles that are far too fast, begin with a scene whose particles do not lie in \
             one another, or set time.adaptive to false",
        ),
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Energy,
        word: "energy",
        finds: "energy that grows by more than a quarter of what there is to gain it from, although nothing adds any",
        looks_at: EACH_FRAME,
        constant: None,
        what: "energy grows without a source",
        cause: "steps are too long, or pressures push the fluid apart",
        help: Help::By {
            grains: "lower time.step, or raise time.steps_per_contact",
            weakly_compressible: "lower time.step, raise fluid.max_speed, or set fluid.negative_pressure to `clamp`",
            incompressible: "lower fluid.courant_number or time.step",
        },
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Density,
        word: "density",
        finds: "a fluid of three times its density at rest, or less than none",
        looks_at: EACH_FRAME,
        constant: None,
        what: "the density of the fluid is out of range",
        cause: "particles are pressed into one another: the flow is faster than expected, or the step is too long",
        help: Help::of_fluids(
            "raise fluid.max_speed, lower time.step, or give the fluid more room",
            "lower fluid.courant_number or time.step, or give the fluid more room",
        ),
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Overlap,
        word: "overlap",
        finds: "grains that have each sunk by half a radius into the other",
        looks_at: EACH_FRAME,
        constant: None,
        what: "grains overlap too deeply",
        cause: "they are too soft for their weight or for how fast they meet, or the step is too long",
        help: Help::Any(
            "make them stiffer (grains.spring, or grains.young_modulus); four times the spring halves the overlap",
        ),
        may_come_of_steps: true,
    },
    GuardRow {
        kind: GuardKind::Overflow,
        word: "overflow",
        finds: "a pool that has no slot for a twentieth of all particles",
        looks_at: EACH_FRAME,
        constant: None,
        what: "the pool has no slot for many particles",
        cause: "more particles stand in voxels than these have slots, so many contacts are missed",
        help: Help::Any("give voxels more room with --set neighbors.slots=8, or use --grid sliced-counting"),
        may_come_of_steps: false,
    },
    GuardRow {
        kind: GuardKind::Unconverged,
        word: "unconverged",
        finds: "`dfsph` in 300 steps in a row without convergence, off by more than a hundredth of the density and twenty times \
                as far as asked for",
        looks_at: EACH_FRAME,
        constant: None,
        what: "the pressure solver does not converge, step after step",
        cause: "the fluid is pressed into less room than it needs, or steps are too long",
        help: Help::Any("give the fluid more room, set time.step lower, or raise fluid.max_iterations"),
        may_come_of_steps: true,
    },
];

impl GuardKind {
    pub fn row(self) -> &'static GuardRow {
        &GUARDS[self as usize]
    }

    /// The number that stands for it on the device, where zero is none.
    pub fn code(self) -> u32 {
        self as u32 + 1
    }

    /// The guard of a code.
    pub fn of(code: u32) -> Option<Self> {
        let place = code.checked_sub(1)?;
        GUARDS.get(place as usize).map(|row| row.kind)
    }
}

impl GuardRow {
    /// What to change.
    pub fn help(&self, family: Family) -> &'static str {
        match self.help {
            Help::Any(help) => help,
            Help::By {
                grains,
                weakly_compressible,
                incompressible,
            } => match family {
                Family::Grains => grains,
                Family::WeaklyCompressible => weakly_compressible,
                Family::Incompressible => incompressible,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_their_kinds() {
        for row in &GUARDS {
            assert_eq!(row.kind.row().word, row.word);
            assert_eq!(GuardKind::of(row.kind.code()), Some(row.kind));
        }
        assert_eq!((GuardKind::of(0), GuardKind::of(13)), (None, None));
    }
}
