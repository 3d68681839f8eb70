//! Sliceflow: an offline, headless particle simulator and renderer on wgpu.
//!
//! Four ideas, in the order data flows:
//!
//! ```text
//!  Scene ──► Plan ──► Simulation ──► Sinks
//!  what a    which     runs the       PNG frames, particle files,
//!  user      buffers   plan on one    statistics, the manifest
//!  writes    and       wgpu device
//!  (JSON)    passes
//! ```
//!
//! # Rooms
//!
//! Imports point one way: a room uses those above it in this list, never those below.
//!
//! - `src/guards.rs`: what stops a run whose numbers can no longer be right, as a table.
//! - `src/error.rs`: the one error type; every message says what to do next.
//! - `src/files.rs`: files that others name: none that never ends is read, nothing is written through a link.
//! - `src/scene/`: what a user writes (`src/scene/model.rs`), checked against its own schema (`src/scene/check.rs`),
//!   explained key by key (`src/scene/keys.rs`), made into numbers (`src/scene/validate.rs`); shapes, meshes and files
//!   become particles, and rigid bodies of these (`src/scene/rigid.rs`; those in a fluid, `src/scene/floating.rs`). Points alone
//!   are a scene without physics (`src/scene/points.rs`). Radii are drawn from distributions (`src/scene/sizes.rs`), and grains of
//!   several sizes packed without order (`src/scene/shapes/packing.rs`). What a particle has is a row of `src/scene/field.rs`, what events may
//!   change a row of `src/scene/changes.rs`. How many particles, how much memory and which files a scene may ask for
//!   (`src/scene/allowance.rs`) is settled before anything is made of it.
//! - `src/gpu/`: the only user of wgpu. Shaders are composed (`src/gpu/compose.rs`) and reflected
//!   (`src/gpu/reflect.rs`); a pass binds buffers by the name that they have everywhere (`src/gpu/pass.rs`).
//! - `src/neighbors/`: neighbor search = `src/neighbors/addressing.rs` × `src/neighbors/storage.rs`.
//!   Neighbor lists serve several steps (`src/neighbors/lists.rs`). `src/neighbors/occupancy/` counts on the host what
//!   each grid needs for any positions.
//! - `src/physics/`: solvers, each a row of the table in `src/physics/model.rs`: grains (`src/physics/dem.rs`),
//!   rigid bodies made of them (`src/physics/bodies.rs`) and obstacles, weakly compressible fluids (`src/physics/fluid.rs`) and
//!   incompressible ones (`src/physics/dfsph.rs`; honey, `src/physics/implicit_viscosity.rs`; bodies that float,
//!   `src/physics/floating.rs`) with their smoothing kernels (`src/physics/kernels.rs`). Buffers and shader modules that fields are made into
//!   (`src/physics/fields.rs`). Steps whose length the device chooses (`src/physics/step_control.rs`). Probes of sensors, and what
//!   their readings mean (`src/physics/sensors.rs`).
//! - `src/surface/`: a surface around particles, made on the device: an implicit function in the voxels of a grid of its own,
//!   and marching cubes (`shaders/surface/`).
//! - `src/render/`: pictures from the simulation's own buffers: splats, matte grains (`src/render/matte.rs`), water
//!   (`src/render/water.rs`), meshes (`src/render/mesh.rs`), colliders, slices, the pool's heatmap, legends. Extra images for compositing
//!   (`src/render/passes.rs`), motion blur and depth of field (`src/render/blur.rs`).
//! - `src/plan/`: scene + limits → every buffer and pass, with the reason for each. Needs no GPU. What is good enough for an
//!   error, from what was measured (`src/plan/achieved.rs`).
//! - `src/simulation/`: executes a plan: steps, frames, what comes back. Grids that need more room get it
//!   (`src/simulation/reallocation.rs`); steps with lists are recorded in rounds (`src/simulation/rounds.rs`).
//! - `src/output/`: sinks, each fed by bounded threads, and the run that drives them (`src/output/drive.rs`); its
//!   checkpoints, and how it goes on from them (`src/output/resume.rs`); guards that look at frames (`src/output/guards.rs`; those
//!   that look at particles are in `shaders/physics/guard.wgsl`), what a run leaves that one of them stops
//!   (`src/output/post_mortem/`), and how it tries again (`src/output/retry.rs`); which files of a folder are a run's own
//!   (`src/output/record.rs`); recordings for the Rerun viewer
//!   (`src/output/rerun.rs`). Meshes around a run's particles (`src/output/surface/`), and runs as USD (`src/output/usd/`).
//!   What sensors found, as tables and charts (`src/output/sensors.rs`), also afterwards from
//!   particle files (`src/output/sensors/from_files.rs`).
//! - `src/study/`: what the papers measured, measured again, a page each; errors against theory and experiment, beside
//!   what they cost (`src/study/accuracy/`); what each choice costs and gains (`src/study/speed_error/`); which steps and
//!   hard cases hold (`src/study/stability/`). The benchmark that machines are compared by (`src/study/suite/`).
//! - `src/cli/`: one file a command.
//!
//! `shaders/` mirrors this: `shaders/common/`, `shaders/cells/` (addressing), `shaders/storage/`, `shaders/physics/`,
//! `shaders/surface/`, `shaders/render/`; `shaders/probes/` measure what an adapter can do at best.
//!
//! # Cargo features
//!
//! All are on by default: `cli` (the program), `plots` (charts), `rerun` (recordings for the Rerun viewer), `study`
//! (`src/study/`), `surface` (meshes around particles), `video` (encoders). Without any there is the library: scenes,
//! plans, simulation, pictures, particle files. What is asked of a build that lacks it is refused with an error.
//!
//! # One particle's trip from scene file to pixel
//!
//! `src/scene/shapes.rs` places it, relative to the scene's origin, which is subtracted in f64. The simulation writes
//! it into `next_position`; the search's passes count it into a voxel and scatter it to its place in `position`, where
//! neighbors in space are neighbors in memory. Every step, `shaders/physics/dem/symplectic_euler.wgsl` (of a fluid, the
//! file of that name in `shaders/physics/fluid/`) asks the search for candidate ranges, sums contacts and writes
//! `next_position` again. At the end of a frame the renderer's vertex stage pulls the particle from the very same
//! buffer, the fragment stage shades a sphere, and the pixels, a few figures and only the columns that a sink wants
//! travel through a ring of staging buffers (`src/gpu/readback.rs`) to the encoder threads of `src/output/png.rs`.
//!
//! # A viscosity's way from key to acceleration
//!
//! 1. `src/scene/model/fluid.rs` has the key, its range and its text; `src/scene/changes.rs` lets events change it.
//! 2. `src/scene/fluid.rs` makes a number of each material of it, chooses its formula, and limits steps by it.
//! 3. The formula is a row of `src/physics/formulas.rs`, which says when it takes part.
//! 4. `src/physics/fluid.rs` writes the number for the device, into a struct of `src/physics/layout.rs`.
//! 5. `shaders/physics/fluid/material.wgsl` gives it to both particles of a pair.
//! 6. `shaders/physics/fluid/forces/laplacian_viscosity.wgsl`, or another file of that folder, makes a force of it.
//! 7. `shaders/physics/fluid/forces.wgsl` sums the forces that take part, and
//!    `shaders/physics/fluid/symplectic_euler.wgsl` moves the particle by them.
//!
//! # A kinetic energy's way from particle to file
//!
//! 1. `shaders/physics/fluid/measure.wgsl` finds it for a particle (of a grain, the file of that name in
//!    `shaders/physics/dem/`).
//! 2. `shaders/physics/sums.wgsl` says how two are added; the device adds those of all particles.
//! 3. `src/gpu/readback.rs` brings the sum to the host with the frame.
//! 4. `src/simulation/frame.rs` has it among the frame's figures.
//! 5. `src/output/statistics.rs` gives it a key and a unit in `stats.jsonl`; the guide's page of keys is made from there.
//! 6. `src/output/rerun/series.rs` draws it as a series.
//!
//! # To add
//!
//! - a scene: one JSON file in `assets/scenes/`;
//! - what another program calls a key or a word of scenes: one row in `src/scene/synonyms.rs`;
//! - a way to address voxels or to keep particles: one shader file and one row of the table in
//!   `src/neighbors/addressing.rs` or `src/neighbors/storage.rs`;
//! - a force on fluids, or what else makes their densities: one shader file in `shaders/physics/fluid/forces/` or
//!   `shaders/physics/fluid/density/` and one row in `src/physics/formulas.rs`;
//! - a contact law of grains that rotate, or a resistance to rolling: one shader file in
//!   `shaders/physics/dem/contact_laws/` or `shaders/physics/dem/rolling/`, one word in `src/scene/model/grains.rs`, its
//!   coefficients in `src/scene/friction.rs` and its file in `src/physics/dem.rs`;
//! - a smoothing kernel: one shader file in `shaders/physics/fluid/kernels/`, one word in `src/scene/model/fluid.rs` and
//!   its rows in `src/physics/kernels.rs`, which the tests hold to integrals and derivatives;
//! - what particles have: one row in `src/scene/field.rs`, which is sorted, saved, exported and drawn as it says; a column
//!   that follows from others: one row in `src/scene/column.rs` and one file in `shaders/render/columns/`;
//! - a solver: one file in `src/physics/`, its shaders, and one row in `src/physics/model.rs`;
//! - a parameter that events change: one key in `src/scene/model.rs` and one row in `src/scene/changes.rs`;
//! - a format of particle files: one row in `src/output/particles/formats.rs`; a kind of video: one in
//!   `src/output/video/mod.rs`;
//! - an extra image of frames: one row in `src/render/passes.rs` and one in `src/output/passes.rs`, and its entry point in
//!   `shaders/render/passes/images.wgsl`;
//! - a look: what marks its pixels and where they see it, in `shaders/render/passes/`, so that it has extra images too; one of matte grains: one
//!   shader file in `shaders/render/looks/` and one row in `src/render/matte.rs`;
//! - a picture of `sliceflow gallery`: one row in `src/cli/gallery/scenes.rs`;
//! - a format of surfaces: one row in `src/output/surface/mesh_file.rs`;
//! - a color map: one row in `src/scene/color_maps.rs`;
//! - a guard: one row in `src/guards.rs`, and what looks for it: `shaders/physics/guard.wgsl` at particles, `src/output/guards.rs` at
//!   frames;
//! - a study: one row in `src/study/mod.rs`, whose parts (`src/study/parts.rs`) run alone too;
//! - a case with a known truth: one file and one row in `src/study/accuracy/cases/`, its data in `assets/reference/`;
//! - a scene of `sliceflow bench`: one row in `src/study/suite/scenes.rs`;
//! - another program beside ours: a script in `assets/peers/` and its row in `src/study/speed_error/peers.rs`;
//! - a page of the guide: one file in `assets/guide/src/` and one line in its summary; `tests/guide.rs` holds commands,
//!   links and scenes there to the code, and makes the pages of keys.

#[cfg(feature = "cli")]
pub mod cli;
pub mod error;
mod files;
pub mod gpu;
pub mod guards;
pub mod neighbors;
pub mod output;
pub mod physics;
pub mod plan;
pub mod render;
pub mod scene;
pub mod simulation;
#[cfg(feature = "study")]
pub mod study;
pub mod surface;
