//! Structs that the shaders of `cells` share with the host.

use crate::shared_struct;

shared_struct! {
    pub struct SearchState {
        /// Not zero: there was too little room, and nothing runs.
        pub halted: u32,
        /// Voxels that the last search had, or would have had.
        pub voxels: u32,
        pub rows: u32,
        pub words: u32,
        /// Particles that the search does not follow.
        pub quarantined: u32,
        pub quarantined_so_far: u32,
        pub longest_list: u32,
        /// Boundary particles in reach of fluid.
        pub reached: u32,
    }
}

impl SearchState {
    /// Before a search.
    pub const BEFORE: Self = Self {
        halted: 0,
        voxels: 0,
        rows: 0,
        words: 0,
        quarantined: 0,
        quarantined_so_far: 0,
        longest_list: 0,
        reached: 0,
    };
}

shared_struct! {
    pub struct ListState {
        /// List of the last search, in full.
        pub longest: u32,
        /// Steps that searched, since the run began.
        pub searches: u32,
        /// Of the clock when the run began or went on.
        pub first_step: u32,
        /// Of the clock when the device stops and waits for the host.
        pub last_step: u32,
        /// Seconds that lists which expect straight paths look ahead; 0 for what the grid says.
        pub horizon: f32,
    }
}
