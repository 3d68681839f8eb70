//! `sliceflow study grains`: grains that rotate and rub against closed forms, and heaps of them.

mod bodies;
mod collapse;
mod collisions;
mod heaps;
mod hopper;
mod surfaces;

use std::path::PathBuf;

use glam::Vec3;
use serde_json::{Value, json};

use hopper::Bin;

use super::bench::Bench;
use super::page::Page;
use super::parts::{self, Part};
use super::{Settings, Size, scenes};
use crate::error::Result;
use crate::scene::{Particles, Scene};

pub struct Scale {
    /// Steps in a contact, ascending.
    steps: &'static [u32],
    /// Impact angles from the normal, degrees.
    angles: &'static [f64],
    /// Coefficients of friction of heaps.
    friction: &'static [f64],
    seeds: u64,
    /// Discs of a heap, about.
    discs: u32,
    /// Height over width of columns that collapse.
    aspects: &'static [f64],
    /// Steps that a stack stands.
    rest: u32,
    /// Bins that empty.
    bins: &'static [Bin],
    /// Of particles on a ball that rolls, in their radii.
    spacings: &'static [f64],
}

/// In two and in three dimensions.
const BINS: &[Bin] = &[
    Bin {
        dimensions: 2,
        width: 36,
        height: 44,
        openings: &[6.0, 8.0, 10.0, 12.0, 14.0],
        grains: 500.0,
    },
    Bin {
        dimensions: 3,
        width: 18,
        height: 20,
        openings: &[4.0, 5.0, 6.0, 7.0],
        grains: 400.0,
    },
];

fn scale(size: Size) -> Scale {
    match size {
        Size::Tiny => Scale {
            steps: &[20, 50],
            angles: &[20.0, 45.0],
            friction: &[0.1, 0.6],
            seeds: 1,
            discs: 60,
            aspects: &[1.0],
            rest: 1000,
            bins: &[Bin {
                dimensions: 2,
                width: 22,
                height: 30,
                openings: &[6.0, 8.0, 10.0],
                grains: 150.0,
            }],
            spacings: &[1.0],
        },
        Size::Small => Scale {
            steps: &[20, 50, 100, 200],
            angles: &[5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0],
            friction: &[0.1, 0.2, 0.4, 0.6, 0.8],
            seeds: 3,
            discs: 300,
            aspects: &[0.5, 1.0, 2.0, 4.0, 8.0],
            rest: 20_000,
            bins: BINS,
            spacings: &[1.0, 1.25, 1.5, 2.0],
        },
        Size::Full => Scale {
            steps: &[20, 50, 100, 200, 500, 1000],
            angles: &[5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 70.0],
            friction: &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8],
            seeds: 5,
            discs: 2000,
            aspects: &[0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0],
            rest: 1_000_000,
            bins: BINS,
            spacings: &[1.0, 1.1, 1.25, 1.5, 1.75, 2.0],
        },
    }
}

pub const PARTS: &[Part<Scale>] = &[
    Part {
        name: "restitution",
        run: |page, bench, scale| collisions::restitution(page, bench, scale),
    },
    Part {
        name: "hertz",
        run: |page, bench, scale| collisions::hertz(page, bench, scale),
    },
    Part {
        name: "oblique",
        run: |page, bench, scale| surfaces::oblique(page, bench, scale),
    },
    Part {
        name: "rolling",
        run: |page, bench, scale| surfaces::rolling(page, bench, scale),
    },
    Part {
        name: "stack",
        run: |page, bench, scale| surfaces::stack(page, bench, scale),
    },
    Part {
        name: "heap",
        run: |page, bench, scale| heaps::heap(page, bench, scale),
    },
    Part {
        name: "collapse",
        run: |page, bench, scale| collapse::collapse(page, bench, scale),
    },
    Part {
        name: "hopper",
        run: |page, bench, scale| hopper::hopper(page, bench, scale),
    },
    Part {
        name: "bodies",
        run: |page, bench, scale| bodies::bodies(page, bench, scale),
    },
];

pub fn grains(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("grains", PARTS, &settings.cases)?;
    let title = "Grains that rotate and rub, against closed forms";
    let mut page = Page::create(&settings.folder, "grains", title, settings.force)?;
    let bench = Bench::open(settings)?;
    let mut scale = scale(settings.size);
    page.paragraph(
        "Contact laws `linear` and `hertz` with friction that remembers, rotation and resistance to rolling. A contact \
         begins and ends where the overlap does. Truth is a closed form in f64 wherever one is named. Everything is \
         computed in f32.",
    );
    bench.environment(&mut page);
    parts::run(page, &bench, &mut scale, &parts, |_, _| {})
}

/// A number of metres that scenes are wide, and their grains.
fn empty(name: &str, size: f64, grains: Value) -> Value {
    json!({
        "name": name,
        "domain": { "min": [0, 0, 0], "max": [size, size, size], "walls": "open" },
        "gravity": [0, 0, 0],
        "grains": grains,
        "time": { "duration": 1, "fps": 1 },
    })
}

/// The same on a floor, with weight.
fn floor(name: &str, size: f64, gravity: f64, grains: Value) -> Value {
    let mut file = empty(name, size, grains);
    file["domain"]["sides"] = json!({ "y_min": "contact" });
    file["gravity"] = json!([0, -gravity, 0]);
    file
}

/// These grains, stepped by `step` seconds, `a_frame` times per frame, up to frame `last`.
fn placed(file: &Value, particles: Particles, step: f64, a_frame: u32, last: u32) -> Result<Scene> {
    let mut scene = scenes::with_particles(file, particles)?;
    scene.time.step = step;
    scene.time.steps_per_frame = a_frame;
    scene.time.fps = 1.0 / (step * f64::from(a_frame));
    scene.time.frames = last + 1;
    Ok(scene)
}

fn particles(all: impl IntoIterator<Item = (Vec3, Vec3)>) -> Particles {
    let (position, velocity) = all.into_iter().unzip();
    Particles {
        position,
        velocity,
        ..Particles::default()
    }
}
