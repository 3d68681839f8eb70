//! Particles on their way to the device and back.

use glam::Vec3;

use super::Simulation;
use super::state::put_beside;
use crate::error::Result;
use crate::gpu::readback;
use crate::physics::layout::Packed;
use crate::scene::Particles;
use crate::scene::field::{Field, Newcomers, Travels};

impl Simulation {
    /// Particles besides boundary particles.
    pub(super) fn free_particles(&self) -> u32 {
        self.count.saturating_sub(self.scene.boundary.len() as u32)
    }

    /// Boundary particles as they stand at the start.
    pub(super) fn boundary_as_particles(&self) -> Particles {
        let boundary = &self.scene.boundary;
        Particles {
            position: boundary.position.clone(),
            velocity: boundary.surface_velocity.clone(),
            ..Particles::default()
        }
    }

    /// Adds particles behind those that exist, and boundary particles behind these, and searches neighbors anew,
    /// without moving anything.
    pub(super) fn add_particles(&mut self, free: &Particles, boundary: Option<&Particles>) -> Result<()> {
        let none = Particles::default();
        let boundary = boundary.unwrap_or(&none);
        let first_id = self.free_particles();
        let (more, all) = (free.len() as u32, free.len() + boundary.len());
        if all == 0 {
            return Ok(());
        }
        let first = self.count as usize;
        let first_boundary = self.scene.first_boundary();
        let ids: Vec<u32> = (first_id..first_id + more)
            .chain(first_boundary..first_boundary + boundary.len() as u32)
            .collect();
        let newcomers = Newcomers {
            free,
            boundary,
            ids: &ids,
        };
        let mut encoder = self.encoder("add particles");
        let travels = |field: &&Field| field.travels != Travels::No && field.beside.is_none();
        for field in self.scene.fields().filter(travels) {
            let (gpu, next) = (&self.gpu, field.before_search());
            let each = field.kind.bytes(&self.scene) as usize;
            let mut values = field.start.map_or_else(Vec::new, |start| start(&newcomers));
            values.resize(each * all, 0);
            let beside = self.scene.beside(field);
            if let Some(start) = beside.and_then(|beside| beside.start) {
                put_beside(&mut values, &start(&newcomers));
            }
            self.buffers.write(gpu, &next, each * first, &values)?;
            if first == 0 {
                continue;
            }
            // The others have by now what their last step left.
            if field.ends_in.is_none() && beside.is_none_or(|beside| beside.ends_in.is_none()) {
                self.copy_for_search(&mut encoder, field)?;
                continue;
            }
            let left = self.left_by_step(field, |name| {
                let buffer = self.buffers.get(name, "(host)")?;
                readback::read(gpu, buffer, self.bytes_of(name)).map(Some)
            })?;
            self.buffers.write(gpu, &next, 0, &left.expect("it was read"))?;
        }
        self.count += all as u32;
        if let Some(limits) = &self.scene.time.adaptive {
            let speeds = free.velocity.iter().map(|v| v.length());
            self.step_control.heed(limits, speeds.fold(0.0, f32::max));
        }
        // With a time step of zero, the passes behind the search find accelerations and leave velocities alone.
        self.hold()?;
        self.gpu.submit(encoder)?;
        self.search()?;
        self.settle()
    }

    /// Local positions and velocities after the last [`Simulation::next_frame`], in order of id, without boundary
    /// particles; of a fluid with ρ/ρ₀ − 1 too. Waits for the device.
    pub fn particles(&self) -> Result<Particles> {
        let count = self.count as usize;
        let ids: Vec<u32> = readback::read(&self.gpu, self.buffers.get("id", "(host)")?, count)?;
        let column = |name| -> Result<Vec<Vec3>> {
            let buffer = self.buffers.get(name, "(host)")?;
            let stored = readback::read::<Packed>(&self.gpu, buffer, count)?;
            let vectors = stored.into_iter().map(|[x, y, z, _]| Vec3::new(x, y, z));
            Ok(self.by_id(&ids, vectors.collect()))
        };
        Ok(Particles {
            position: column("position")?,
            velocity: column("velocity")?,
            density_deviation: self.fluid_column(&ids, 0)?,
            ..Particles::default()
        })
    }

    /// Pressures of a fluid's particles, Pa, in order of id. Empty for grains.
    pub fn pressures(&self) -> Result<Vec<f32>> {
        let ids: Vec<u32> =
            readback::read(&self.gpu, self.buffers.get("id", "(host)")?, self.count as usize)?;
        self.fluid_column(&ids, 1)
    }

    fn fluid_column(&self, ids: &[u32], component: usize) -> Result<Vec<f32>> {
        let state = self.fluid_state()?;
        if state.is_empty() {
            return Ok(Vec::new());
        }
        Ok(self.by_id(ids, state.into_iter().map(|state| state[component]).collect()))
    }

    /// Copies on the device what the last search found of a field to where the next one takes it from.
    pub(super) fn copy_for_search(&self, encoder: &mut wgpu::CommandEncoder, field: &Field) -> Result<()> {
        let from = self.buffers.get(field.name, "(host)")?;
        let to = self.buffers.get(&field.before_search(), "(host)")?;
        encoder.copy_buffer_to_buffer(from, 0, to, 0, self.bytes_of(field.name) as u64);
        Ok(())
    }

    /// Of the values that all particles have of a field.
    fn bytes_of(&self, field: &str) -> usize {
        let found = self.scene.fields().find(|known| known.name == field);
        found.map_or(0, |found| found.kind.bytes(&self.scene) as usize) * self.count as usize
    }

    /// ρ/ρ₀ − 1 and pressure (Pa) of a fluid's particles by slot; empty for grains.
    fn fluid_state(&self) -> Result<Vec<[f32; 2]>> {
        if !self.scene.has_field("fluid_state") || self.count == 0 {
            return Ok(Vec::new());
        }
        readback::read(
            &self.gpu,
            self.buffers.get("fluid_state", "(host)")?,
            self.count as usize,
        )
    }

    /// Values by slot in order of id, without those of boundary particles.
    fn by_id<T: Copy + Default>(&self, ids: &[u32], by_slot: Vec<T>) -> Vec<T> {
        let mut ordered = vec![T::default(); self.free_particles() as usize];
        for (&id, value) in ids.iter().zip(by_slot) {
            if let Some(place) = ordered.get_mut(id as usize) {
                *place = value;
            }
        }
        ordered
    }
}
