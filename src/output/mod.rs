//! Files that a run writes.

pub mod npy;
