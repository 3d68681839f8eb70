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
    }
}
