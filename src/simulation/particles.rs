//! The particles of the present state, on the host.

use glam::Vec3;

use super::Simulation;
use crate::error::Result;
use crate::gpu::readback;
use crate::scene::{Dimensions, Particles};

impl Simulation {
    /// Local positions and velocities after the last [`Simulation::next_frame`], in order of id. Waits for the device.
    pub fn particles(&self) -> Result<Particles> {
        let count = self.count as usize;
        let buffer = |name| self.buffers.get(name, "(host)");
        let ids: Vec<u32> = readback::read(&self.gpu, buffer("id")?, count)?;
        let column = |name| -> Result<Vec<Vec3>> {
            let stored: Vec<Vec3> = match self.scene.dimensions {
                Dimensions::Two => readback::read::<[f32; 2]>(&self.gpu, buffer(name)?, count)?
                    .into_iter()
                    .map(|[x, y]| Vec3::new(x, y, 0.0))
                    .collect(),
                Dimensions::Three => readback::read::<[f32; 4]>(&self.gpu, buffer(name)?, count)?
                    .into_iter()
                    .map(|[x, y, z, _]| Vec3::new(x, y, z))
                    .collect(),
            };
            let mut by_id = vec![Vec3::ZERO; count];
            for (&id, value) in ids.iter().zip(stored) {
                by_id[id as usize] = value;
            }
            Ok(by_id)
        };
        Ok(Particles {
            position: column("position")?,
            velocity: column("velocity")?,
        })
    }
}
