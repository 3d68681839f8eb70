//! The library: scenes, plans, simulations and pictures, without the program around them. Most of it needs an adapter; software
//! Vulkan will do.
//!
//! One program for many files: they share what is linked and what the device has compiled, and no core waits for the last
//! test of each file.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/fluid_reference.rs"]
mod fluid_reference;
#[path = "../common/reference.rs"]
mod reference;
#[path = "../common/rotating.rs"]
mod rotating;
#[path = "../common/stage.rs"]
mod stage;

mod adapters;
mod adaptive;
mod boundary_reach;
mod coincident;
mod dfsph;
mod fields;
mod floating;
mod fluids;
mod friction;
mod grain_materials;
mod grains;
mod implicit_viscosity;
mod map;
mod neighbors;
mod occupancy;
mod parameters;
mod plan;
mod reallocation;
mod render;
mod render_shaders;
mod resume;
mod rigid;
mod scene;
mod sensors;
mod shaders;
mod sizes;
mod sorts;
mod surface_tension;
mod voxel_map;
