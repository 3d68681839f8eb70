//! Stub: the real module comes from another branch.

pub mod frame;

use crate::error::Result;
use crate::gpu::Gpu;
use crate::plan::Plan;
use crate::scene::Scene;
use frame::{ColumnData, Frame, Statistics, Values};

pub struct Simulation {
    gpu: Gpu,
    scene: Scene,
    next: u32,
}

impl Simulation {
    pub fn new(gpu: Gpu, scene: &Scene, _plan: &Plan) -> Result<Self> {
        Ok(Self {
            gpu,
            scene: scene.clone(),
            next: 0,
        })
    }

    pub fn set_timings(&mut self, _on: bool) {}

    pub fn next_frame(&mut self) -> Result<Option<Frame>> {
        let index = self.next;
        self.next += 1;
        let [width, height] = self.scene.render.size;
        std::thread::sleep(std::time::Duration::from_millis(20));
        Ok(Some(Frame {
            index,
            time: f64::from(index) / self.scene.time.fps,
            steps: u64::from(index) * u64::from(self.scene.time.steps_per_frame),
            step_s: self.scene.time.step,
            particles: self.scene.capacity,
            pixels: Some([40, 80, 160, 255].repeat((width * height) as usize)),
            statistics: Some(Statistics { voxels_allocated: 1000 - 500 * self.scene.neighbors.addressing as u32, ..Statistics::default() }),
            columns: vec![
                ColumnData {
                    name: "position",
                    values: Values::Double { columns: 3, values: vec![0.0; 3 * self.scene.capacity as usize] },
                },
                ColumnData { name: "id", values: Values::Unsigned((0..self.scene.capacity).collect()) },
            ],
            pass_ms: vec![("integrate".into(), 0.5)],
        }))
    }

    pub fn finish_frame(&mut self) -> Result<Option<Frame>> {
        Ok(None)
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}
