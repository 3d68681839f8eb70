//! One grid on one state: its figures from the device, its picture.

use std::collections::BTreeMap;

use image::RgbaImage;

use super::subject::Subject;
use crate::cli::grid;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::neighbors::occupancy::{Allocation, Census};
use crate::output::{Progress, compose_picture, progress};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::Scene;
use crate::scene::model::{Addressing, View};
use crate::simulation::Simulation;
use crate::simulation::frame::{Frame, Statistics};

pub struct Measured {
    /// As `--grid` calls it.
    pub name: String,
    pub addressing: Addressing,
    /// Counted on the host.
    pub allocation: Allocation,
    /// Voxels of each of the state's slices that have memory, where memory follows slices.
    pub slices: Option<BTreeMap<i32, u64>>,
    /// Of a search on the device, where the grid fits it.
    pub device: Option<Statistics>,
    /// The grid's memory, one texel per voxel (Harada 2007, Figure 7).
    pub heatmap: Option<RgbaImage>,
    /// The allocated boxes around the particles (Harada 2007, Figure 2).
    pub boxes: Option<RgbaImage>,
}

impl Measured {
    /// Searches the subject's state through the grid of `through`.
    pub fn new(gpu: &Gpu, subject: &Subject, through: Scene, pictures: bool) -> Result<Self> {
        let mut scene = subject.scene.clone();
        scene.neighbors = through.neighbors;
        let name = grid::name(&scene.neighbors);
        let census = Census::of(&scene, &scene.positions());
        let allocation = Allocation::of(&scene, &census);
        let along = census.slices().into_iter().map(|slice| slice.at);
        let slices = allocation.slices.clone();
        let slices = slices
            .filter(|_| census.grid.axis == subject.census.grid.axis)
            .map(|voxels| along.zip(voxels).collect());
        let addressing = scene.neighbors.addressing;
        let mut measured = Self {
            name,
            addressing,
            allocation,
            slices,
            device: None,
            heatmap: None,
            boxes: None,
        };
        let searched = search(gpu, &scene, pictures.then_some(View::Pool));
        let frame = match searched {
            Ok(frame) => frame,
            Err(Error::Limit { what, .. }) => {
                let note = format!("{}: counted on the host only, because {what}", measured.name);
                Progress::new(progress::Style::Plain, 0).note(&note);
                return Ok(measured);
            }
            Err(error) => return Err(error),
        };
        measured.device = frame.statistics;
        measured.heatmap = picture(frame, subject, &scene, View::Pool)?;
        if pictures && addressing == Addressing::Sliced {
            scene.render.show.slices = true;
            let frame = search(gpu, &scene, Some(View::Scene))?;
            measured.boxes = picture(frame, subject, &scene, View::Scene)?;
        }
        Ok(measured)
    }

    /// Voxels that have memory in a slice.
    pub fn in_slice(&self, at: i32) -> Option<u64> {
        let slices = self.slices.as_ref()?;
        Some(slices.get(&at).copied().unwrap_or(0))
    }

    /// Voxels that have memory.
    pub fn voxels(&self) -> u64 {
        self.device
            .map_or(self.allocation.voxels, |device| device.voxels_allocated.into())
    }

    /// Particles that find no slot.
    pub fn overflow(&self) -> Option<u64> {
        let device = self.device.map(|device| device.overflow.into());
        device.or(self.allocation.overflow)
    }
}

fn search(gpu: &Gpu, scene: &Scene, view: Option<View>) -> Result<Frame> {
    let wanted = Wanted {
        statistics: true,
        view,
        ..Wanted::default()
    };
    let plan = Plan::new(scene, &gpu.limits, &wanted)?.with_its_lists()?;
    let mut simulation = Simulation::new(gpu.clone(), scene, &plan)?;
    let first = simulation.next_frame()?;
    let frame = first.map_or_else(|| simulation.finish_frame(), |frame| Ok(Some(frame)))?;
    Ok(frame.expect("a scene has a first frame"))
}

fn picture(mut frame: Frame, subject: &Subject, scene: &Scene, view: View) -> Result<Option<RgbaImage>> {
    (frame.index, frame.time) = (subject.frame, subject.time);
    compose_picture(&frame, &Overlay::new(scene, view)?)
}
