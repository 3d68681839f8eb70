//! Offline, headless particle simulator and renderer on wgpu.

pub mod cli;
pub mod error;
pub mod gpu;
pub mod output;
pub mod plan;
pub mod render;
pub mod scene;
pub mod simulation;
