//! The program as a user meets it: commands, messages, files. One test program for many files, as in `tests/library/`.

#![cfg(feature = "cli")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/place.rs"]
mod place;
#[path = "../common/stage.rs"]
mod stage;

mod afterwards;
mod bench;
mod camera;
mod cli;
mod command;
mod counts;
mod disks;
mod first_scene;
mod gallery;
mod guards;
mod hostile;
mod interrupt;
mod looks;
mod neighbors_tool;
mod outputs;
mod passes;
mod render_command;
mod rerun;
mod resume_command;
mod study;
