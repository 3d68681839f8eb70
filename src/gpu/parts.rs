//! What plans are made of: buffers and passes, each with the reason why a scene needs it.

use std::ops::Range;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;

use super::buffers::Usage;

/// What a buffer holds before anything runs.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Contents {
    #[default]
    Zeros,
    /// A pattern, over and over.
    Pattern(&'static [i32]),
    /// Its first bytes; zeros follow.
    Bytes(Arc<[u8]>),
}

/// A buffer that a plan asks for. Whoever plans it also says what is written into it and who reads it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BufferPlan {
    /// Its name, the same in shaders and messages.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    #[serde(skip)]
    pub usage: Usage,
    /// What it holds before anything runs.
    #[serde(skip)]
    pub contents: Contents,
    /// Whether the host writes its contents again before each search.
    #[serde(skip)]
    pub renewed: bool,
    /// Where every frame brings it to the host: the bytes that are zeroed after that.
    #[serde(skip)]
    pub reported: Option<Range<u64>>,
    /// What it is for.
    pub why: String,
}

impl BufferPlan {
    /// A storage buffer of `count` elements of `element` bytes each.
    pub fn storage(name: &str, count: u64, element: u64, why: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            bytes: count * element,
            usage: Usage::Storage,
            contents: Contents::Zeros,
            renewed: false,
            reported: None,
            why: why.into(),
        }
    }

    /// A uniform buffer of one struct.
    pub fn uniform(name: &str, bytes: usize, why: impl Into<String>) -> Self {
        Self {
            usage: Usage::Uniform,
            ..Self::storage(name, 1, bytes as u64, why)
        }
    }

    /// A storage buffer that also holds arguments of dispatches.
    pub fn indirect(name: &str, count: u64, element: u64, why: impl Into<String>) -> Self {
        Self {
            usage: Usage::Indirect,
            ..Self::storage(name, count, element, why)
        }
    }

    /// A uniform buffer that holds one struct from the start.
    pub fn constant<T: bytemuck::NoUninit>(name: &str, value: &T, why: impl Into<String>) -> Self {
        Self::uniform(name, size_of::<T>(), why).holding(std::slice::from_ref(value))
    }

    /// A uniform buffer that holds a small table from the start.
    pub fn uniforms<T: bytemuck::NoUninit>(name: &str, values: &[T], why: impl Into<String>) -> Self {
        Self::uniform(name, size_of_val(values), why).holding(values)
    }

    /// A storage buffer that holds these elements from the start.
    pub fn table<T: bytemuck::NoUninit>(name: &str, values: &[T], why: impl Into<String>) -> Self {
        Self::storage(name, values.len() as u64, size_of::<T>() as u64, why).holding(values)
    }

    /// The same buffer, beginning with a pattern over and over instead of zeros.
    pub fn filled_with(self, pattern: &'static [i32]) -> Self {
        Self {
            contents: Contents::Pattern(pattern),
            ..self
        }
    }

    /// The same buffer, beginning with these elements.
    pub fn holding<T: bytemuck::NoUninit>(self, values: &[T]) -> Self {
        Self {
            contents: Contents::Bytes(bytemuck::cast_slice(values).into()),
            ..self
        }
    }

    /// The same buffer, whose contents the host writes again before each search.
    pub fn renewed(self) -> Self {
        Self {
            renewed: true,
            ..self
        }
    }

    /// The same buffer, which every frame brings to the host.
    pub fn reported(self) -> Self {
        Self {
            reported: Some(0..0),
            ..self
        }
    }

    /// The same, and from this byte on it counts from one frame to the next.
    pub fn reported_from(self, first: u64) -> Self {
        Self {
            reported: Some(first..self.bytes),
            ..self
        }
    }
}

/// How many threads a pass runs. All but a fixed number come from the buffer `dispatch` on the device, so that a search
/// without room can stop what follows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Items {
    /// One per particle that exists when the pass runs.
    Particles,
    /// One per voxel that the search has.
    Voxels,
    /// For prefix sums over the voxels: a workgroup for each block of them.
    VoxelBlocks,
    /// One workgroup.
    Once,
    /// One per particle, when particles are searched anew; with neighbor lists that is not every step.
    SearchedParticles,
    /// One workgroup, when particles are searched anew.
    SearchedOnce,
    /// One per particle, behind a move after which the lists of an earlier search serve.
    KeptParticles,
    /// One per particle, when lists serve and steps are left to do.
    MovingParticles,
    /// The same, for moves from the `next_` buffers to those without (see `flipped`).
    ReturningParticles,
    /// One per particle, when the last move left them in the `next_` buffers and their lists serve.
    AwayParticles,
    /// One per particle, when the last move returned them and they are searched anew.
    ReturnedParticles,
    /// One per particle that is no boundary particle; where the search does not sort, one per particle.
    FreeParticles,
    /// The same, when particles are searched anew.
    SearchedFreeParticles,
    /// The same, behind a move after which lists serve.
    KeptFreeParticles,
    /// The same, when lists serve and steps are left to do.
    MovingFreeParticles,
    /// The same, for moves from the `next_` buffers to those without.
    ReturningFreeParticles,
    /// One per particle that is no boundary particle, then one per boundary particle in reach that there is room for
    /// (`shaders/storage/lists/reached.wgsl`); where the search does not know which are in reach, one per particle.
    ReachedParticles,
    /// The same, when particles are searched anew.
    SearchedReachedParticles,
    /// The same, behind a move after which lists serve.
    KeptReachedParticles,
    /// The same, when lists serve and steps are left to do.
    MovingReachedParticles,
    /// The same, for moves from the `next_` buffers to those without.
    ReturningReachedParticles,
    /// One per particle that is no boundary particle, as long as the loop of this number goes on.
    Loop(u32),
    /// The same, for the second pass of an iteration.
    LoopSecond(u32),
    /// One workgroup, as long as the loop of this number went on when that was last looked up.
    LoopOnce(u32),
    /// A number known beforehand, come what may.
    Fixed(u32),
}

/// Which particles a pass runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    All,
    /// All but boundary particles.
    Free,
    /// All but the boundary particles that no fluid can reach before the next search.
    Reached,
}

/// What the entries of the buffer `dispatch` are for, in order, each with its name in shaders. Those over all particles
/// stand first, then those without boundary particles, then those with boundary particles in reach
/// (`shaders/storage/lists/decide.wgsl`).
pub const DISPATCHES: &[(Items, &str)] = &[
    (Items::Particles, "DISPATCH_PARTICLES"),
    (Items::Voxels, "DISPATCH_VOXELS"),
    (Items::VoxelBlocks, "DISPATCH_SCAN"),
    (Items::Once, "DISPATCH_ONCE"),
    (Items::SearchedParticles, "DISPATCH_SEARCHED"),
    (Items::KeptParticles, "DISPATCH_KEPT"),
    (Items::MovingParticles, "DISPATCH_MOVING"),
    (Items::ReturningParticles, "DISPATCH_RETURNING"),
    (Items::AwayParticles, "DISPATCH_AWAY"),
    (Items::ReturnedParticles, "DISPATCH_RETURNED"),
    (Items::FreeParticles, "DISPATCH_FREE"),
    (Items::SearchedFreeParticles, "DISPATCH_SEARCHED_FREE"),
    (Items::KeptFreeParticles, "DISPATCH_KEPT_FREE"),
    (Items::MovingFreeParticles, "DISPATCH_MOVING_FREE"),
    (Items::ReturningFreeParticles, "DISPATCH_RETURNING_FREE"),
    (Items::ReachedParticles, "DISPATCH_REACHED"),
    (Items::SearchedReachedParticles, "DISPATCH_SEARCHED_REACHED"),
    (Items::KeptReachedParticles, "DISPATCH_KEPT_REACHED"),
    (Items::MovingReachedParticles, "DISPATCH_MOVING_REACHED"),
    (Items::ReturningReachedParticles, "DISPATCH_RETURNING_REACHED"),
];

/// Entries of `loop_dispatch` that each loop has: for the first and for the second pass of an iteration.
const LOOP_ENTRIES: u64 = 2;

/// The shader module `host/dispatch`: the same numbers by name.
pub(super) fn dispatch_module() -> String {
    let entries = DISPATCHES.iter().enumerate();
    let named = entries.map(|(entry, (_, name))| format!("const {name}: u32 = {entry}u;\n"));
    let count = DISPATCHES.len();
    let numbers: String = named.collect();
    format!("{numbers}const DISPATCHES: u32 = {count}u;\nconst LOOP_ENTRIES: u32 = {LOOP_ENTRIES}u;\n")
}

impl Items {
    /// Which buffer, and which of its entries, has the number of workgroups; `None` for a fixed number.
    ///
    /// A pass cannot be dispatched from the buffer that it writes, so what decides about `dispatch` while a search is
    /// under way has a buffer of its own.
    pub fn dispatch_entry(self) -> Option<(&'static str, u64)> {
        match self {
            Self::SearchedOnce => Some(("search_dispatch", 0)),
            Self::Loop(number) => Some(("loop_dispatch", LOOP_ENTRIES * u64::from(number))),
            Self::LoopSecond(number) => Some(("loop_dispatch", LOOP_ENTRIES * u64::from(number) + 1)),
            Self::LoopOnce(number) => Some(("check_dispatch", number.into())),
            Self::Fixed(_) => None,
            _ => Some(("dispatch", self.entry() as u64)),
        }
    }

    /// Which particles they are; `None` where threads stand for something else.
    pub fn over(self) -> Option<Over> {
        match self {
            Self::Particles
            | Self::SearchedParticles
            | Self::KeptParticles
            | Self::MovingParticles
            | Self::ReturningParticles
            | Self::AwayParticles
            | Self::ReturnedParticles => Some(Over::All),
            Self::FreeParticles
            | Self::SearchedFreeParticles
            | Self::KeptFreeParticles
            | Self::MovingFreeParticles
            | Self::ReturningFreeParticles
            | Self::Loop(_)
            | Self::LoopSecond(_) => Some(Over::Free),
            Self::ReachedParticles
            | Self::SearchedReachedParticles
            | Self::KeptReachedParticles
            | Self::MovingReachedParticles
            | Self::ReturningReachedParticles => Some(Over::Reached),
            Self::Voxels
            | Self::VoxelBlocks
            | Self::Once
            | Self::SearchedOnce
            | Self::LoopOnce(_)
            | Self::Fixed(_) => None,
        }
    }

    /// The same particles in steps that leave them in the buffers without `next_`.
    pub fn returning(self) -> Self {
        match self {
            Self::MovingParticles => Self::ReturningParticles,
            Self::MovingFreeParticles => Self::ReturningFreeParticles,
            Self::MovingReachedParticles => Self::ReturningReachedParticles,
            other => other,
        }
    }

    /// The entry of `dispatch` that has their number.
    pub fn entry(self) -> usize {
        let found = DISPATCHES.iter().position(|(items, _)| *items == self);
        found.expect("only what has a buffer of its own is in no entry of `dispatch`")
    }
}

/// Passes in a row that are recorded several times. The device leaves out what it does not need ([`Items::Loop`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Repeat {
    /// Tells loops of a step apart.
    pub number: u32,
    /// How often they are recorded: as often as they may run.
    pub times: u32,
    /// Whether this pass is recorded in the repetitions 0, 1, 2, 4, 8 and so on only.
    pub sparse: bool,
}

/// A compute pass that a plan asks for. Its label is its entry point: a verb.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct PassPlan {
    /// File below `shaders/`, without its ending.
    pub shader: String,
    /// Its function there, which is also the name of the pass.
    pub entry: String,
    /// How many threads it has.
    pub items: Items,
    /// Which one it is, where a pass runs several times: `pass_index` of `common/pass_index.wgsl`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub index: Option<u32>,
    /// The loop that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeat: Option<Repeat>,
    /// Whether particles' buffers and their `next_` buffers change places.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub flipped: bool,
    /// What it does.
    pub why: String,
}

impl PassPlan {
    pub fn new(shader: &str, entry: &str, items: Items, why: impl Into<String>) -> Self {
        Self {
            shader: shader.to_owned(),
            entry: entry.to_owned(),
            items,
            index: None,
            repeat: None,
            flipped: false,
            why: why.into(),
        }
    }

    /// The same pass with a number of its own.
    pub fn index(self, index: u32) -> Self {
        Self {
            index: Some(index),
            ..self
        }
    }
}
