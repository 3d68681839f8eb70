pub mod error;
pub mod gpu;
pub mod render;
pub mod scene;
