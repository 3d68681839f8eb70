//! Flow between two plates that starts from rest, driven by a force (Poiseuille) or by the upper plate (Couette).

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::published;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::theory::channel;
use crate::study::bench::Bench;

pub const POISEUILLE: Case = Case {
    name: "poiseuille",
    title: "Start of Poiseuille flow",
    about: "A constant force drives fluid between two plates from rest (scene `poiseuille`; Morris 1997, Eq. 21). The \
            figure is the L2 norm of the particles' velocity errors over the final speed at the middle: the worst of \
            all moments from νt/d² = 0.02 to 1. Walls of boundary particles (Adami 2012) and planes (Rojas 2013).",
    resolution: "particles across",
    label: |n| n.to_string(),
    resolutions,
    figure: FIGURE,
    published: published::CHANNEL,
    run: |bench, _, n| both_walls(bench, POISEUILLE.name, n, channel::poiseuille),
};

pub const COUETTE: Case = Case {
    name: "couette",
    title: "Start of Couette flow",
    about: "The upper of two plates begins to slide over fluid at rest (scene `couette`; Morris 1997, Eq. 22). The \
            figure is the L2 norm of the particles' velocity errors over the plate's speed: the worst of all moments \
            from νt/d² = 0.02 to 1. Walls of boundary particles (Adami 2012) and planes (Rojas 2013).",
    resolution: "particles across",
    label: |n| n.to_string(),
    resolutions,
    figure: FIGURE,
    published: published::CHANNEL,
    run: |bench, _, n| both_walls(bench, COUETTE.name, n, channel::couette),
};

const FIGURE: &str = "L2 of velocity";
/// νt/d² from which errors count: before, the layer that moves is thinner than a kernel.
const FIRST: f64 = 0.02;

fn resolutions(size: Size) -> &'static [u32] {
    match size {
        Size::Tiny => &[20],
        Size::Small => &[20, 40],
        Size::Full => &[20, 40, 80],
    }
}

/// `truth` gives the velocity over height and time; distance of the plates, viscosity, density and scale of velocity
/// of both scenes are one.
fn both_walls(bench: &Bench, case: &str, n: u32, truth: fn(f64, f64) -> f64) -> Result<Vec<Record>> {
    let walls = ["particles", "planes"];
    walls
        .into_iter()
        .map(|walls| one(bench, case, n, &[format!("domain.walls={walls}")], truth))
        .collect()
}

/// A case's scene with other keys changed.
fn scene(case: &str, n: u32, changes: &[String]) -> Result<Scene> {
    shipped(case, &[&[spacing(1.0, n)], changes].concat())
}

/// The scene of [`POISEUILLE`] with other keys changed.
pub fn poiseuille_scene(n: u32, changes: &[String]) -> Result<Scene> {
    scene(POISEUILLE.name, n, changes)
}

/// The record of one run of [`POISEUILLE`].
pub fn poiseuille(bench: &Bench, n: u32, changes: &[String]) -> Result<Record> {
    one(bench, POISEUILLE.name, n, changes, channel::poiseuille)
}

fn one(bench: &Bench, case: &str, n: u32, changes: &[String], truth: fn(f64, f64) -> f64) -> Result<Record> {
    let scene = scene(case, n, changes)?;
    let (mut worst, mut last) = (0.0_f64, 0.0);
    let run = flow(bench, &scene, |flow| {
        let off = flow.position.iter().zip(&flow.velocity).map(|(p, v)| {
            let expected = truth(p.y, flow.time);
            ((*v - glam::DVec3::X * expected).length(), 0.0)
        });
        last = Norms::new(off).l2;
        if flow.time >= FIRST - 1e-9 {
            worst = worst.max(last);
        }
    })?;
    let bar = match n {
        40.. => Some(Bar::AtMost(0.15)),
        20.. => Some(Bar::AtMost(0.5)),
        _ => None,
    };
    let mut figure = Figure::new(FIGURE, 100.0 * worst, "%").bar(bar);
    if let Some(best) = published::CHANNEL[0].error_at(n) {
        figure = figure.best(best, published::CHANNEL[0].method);
    }
    let figures = vec![figure, Figure::new("L2 at the end", 100.0 * last, "%")];
    Ok(record(bench, case, &scene, n, run, figures))
}
