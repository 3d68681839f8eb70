//! Grids that follow their particles: when a search finds too little room, nothing runs behind it until the host has
//! made more; then the search is done again, and the steps that are missing. Nothing is lost and no bit differs.

use glam::Vec3;

use super::Simulation;
use super::passes::Passes;
use crate::error::{Error, Result};
use crate::gpu::readback;
use crate::neighbors::layout::SearchState;
use crate::neighbors::{self, Grid, Room};
use crate::physics::layout::{Clock, Packed};
use crate::plan::Plan;

impl Simulation {
    /// Looks whether the last search had room, and makes room until every submitted step is done.
    pub(super) fn settle(&mut self) -> Result<()> {
        let listed = self.buffers.contains("list_state");
        let follows = self.buffers.contains("search_state") && self.scene.domain.is_open();
        if !listed && !follows && !neighbors::can_grow(&self.scene, &self.plan.grid) {
            return Ok(());
        }
        // Recorded steps are left out where lists stop serving, and where a search halts.
        let mut left_out = listed;
        loop {
            let state = self.search_state()?;
            if state.halted != 0 {
                self.grow(Room {
                    voxels: state.voxels,
                    rows: state.rows,
                    words: state.words,
                    list: state.longest_list,
                })?;
                // The particles have moved already; what halted is the search behind that.
                self.search()?;
                left_out = true;
                continue;
            }
            self.quarantined = state.quarantined;
            if !left_out {
                return Ok(());
            }
            let step = self.read_one::<Clock>("clock")?.step;
            if listed {
                self.note_searches(step)?;
            }
            if self.scene.time.adaptive.is_some() {
                self.pace = self.read_one("pace")?;
                self.submitted = step.into();
                return self.refuse_to_stall();
            }
            let missing = self
                .submitted
                .checked_sub(step.into())
                .expect("the device makes no step that nobody asked for");
            if missing == 0 {
                return Ok(());
            }
            self.submitted -= missing;
            self.submit_steps(missing)?;
        }
    }

    fn search_state(&self) -> Result<SearchState> {
        self.read_one("search_state")
    }

    /// What stands at the beginning of a buffer; waits for the device.
    pub(super) fn read_one<T: bytemuck::Pod>(&self, name: &str) -> Result<T> {
        let buffer = self.buffers.get(name, "(host)")?;
        Ok(readback::read(&self.gpu, buffer, 1)?[0])
    }

    /// Makes the grid's buffers as large as needed, with the scene's margin where the adapter allows it.
    fn grow(&mut self, needed: Room) -> Result<()> {
        let positions = match self.scene.neighbors.slicing_axis.fixed() {
            Some(_) => None,
            None => Some(self.read_next_positions()?),
        };
        let grid = neighbors::grown_grid(&self.scene, self.plan.grid, needed, positions.as_deref());
        let plan = |grid| Plan::with_grid(&self.scene, &self.gpu.limits, &self.plan.wanted, grid);
        let exact = || {
            let has = self.plan.grid.room();
            plan(self.plan.grid.with_room(Room {
                voxels: needed.voxels.max(has.voxels),
                rows: needed.rows.max(has.rows),
                words: needed.words.max(has.words),
                list: needed.list.max(has.list),
            }))
        };
        let plan = plan(grid).or_else(|_| exact()).map_err(|error| match error {
            Error::Limit { what, help } => Error::Limit {
                what: format!("the grid must grow after {} steps: {what}", self.submitted),
                help,
            },
            other => other,
        })?;
        self.growths += 1;
        self.rebuild(plan)
    }

    /// Gives the search exactly the room that its last one needed, for comparing policies; normally buffers only grow.
    pub fn resize_exactly(&mut self) -> Result<()> {
        let state = self.search_state()?;
        let grid: Grid = self.plan.grid.with_room(Room {
            voxels: state.voxels,
            rows: state.rows.max(self.plan.grid.row_capacity.min(1)),
            words: state.words,
            list: self.plan.grid.list_capacity,
        });
        let plan = Plan::with_grid(&self.scene, &self.gpu.limits, &self.plan.wanted, grid)?;
        self.rebuild(plan)
    }

    /// Takes over a plan that differs in its grid only. What the search made is gone; particles stay.
    pub(super) fn rebuild(&mut self, plan: Plan) -> Result<()> {
        let grid_turned = plan.grid.axis != self.plan.grid.axis;
        for buffer in &plan.buffers {
            let before = self.plan.buffers.iter().find(|b| b.name == buffer.name);
            if grid_turned && !buffer.fill.is_empty() || before.is_none_or(|b| b.bytes != buffer.bytes) {
                self.buffers.make(&self.gpu, buffer)?;
            }
        }
        self.passes = Passes::new(&self.gpu, &plan, &self.buffers, &mut self.kernels)?;
        if let Some(renderer) = &mut self.renderer {
            renderer.rebind(&self.gpu, &plan.variant, &self.buffers)?;
        }
        self.plan = plan;
        self.buffers.write(&self.gpu, "grid", 0, &[self.plan.grid])?;
        let dispatch = self.plan.dispatch(self.count, &self.gpu.limits);
        self.buffers.write(&self.gpu, "dispatch", 0, &dispatch)
    }

    /// Where the last step left the particles.
    fn read_next_positions(&self) -> Result<Vec<Vec3>> {
        let buffer = self.buffers.get("next_position", "(host)")?;
        let count = self.count as usize;
        let stored = readback::read::<Packed>(&self.gpu, buffer, count)?;
        Ok(stored
            .into_iter()
            .map(|[x, y, z, _]| Vec3::new(x, y, z))
            .collect())
    }
}
