//! Offline, headless particle simulator and renderer on wgpu.

pub mod error;
pub mod gpu;
pub mod scene;
