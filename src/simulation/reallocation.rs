//! Grids that follow their particles: when a search finds too little room, nothing runs behind it until the host has
//! made more; then the search is done again, and the steps that are missing. Nothing is lost and no bit differs.

use glam::Vec3;

use super::Simulation;
use super::passes::Passes;
use crate::error::{Error, Result};
use crate::gpu::{Contents, readback};
use crate::neighbors::layout::SearchState;
use crate::neighbors::{self, Grid, Room, lists};
use crate::physics::layout::{Clock, Packed};
use crate::plan::Plan;
use crate::render::Renderer;

impl Simulation {
    /// Looks whether the last search had room, and makes room until every submitted step is done.
    pub(super) fn settle(&mut self) -> Result<()> {
        // Recorded steps are left out where lists stop serving, and where a search halts.
        let mut left_out = lists::wanted(&self.scene);
        loop {
            let listed = lists::wanted(&self.scene);
            if self.can_halt(listed) {
                let state = self.search_state()?;
                if state.halted != 0 {
                    self.grow(Room {
                        voxels: state.voxels,
                        rows: state.rows,
                        words: state.words,
                        list: state.longest_list,
                        reached: state.reached,
                    })?;
                    // The particles have moved already; what halted is the search behind that.
                    self.search()?;
                    left_out = true;
                    continue;
                }
                self.quarantined = state.quarantined;
            }
            if !left_out {
                return Ok(());
            }
            let step = self.read_one::<Clock>("clock")?.step;
            if listed {
                self.note_searches(step)?;
            }
            if self.scene.time.adaptive.is_some() {
                self.step_control = self.read_one("step_control")?;
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

    /// Whether a search may find too little room, or particles that it does not follow.
    fn can_halt(&self, listed: bool) -> bool {
        let follows = self.buffers.contains("search_state") && self.scene.domain.is_open();
        listed || follows || neighbors::can_grow(&self.scene, &self.plan.grid)
    }

    fn search_state(&self) -> Result<SearchState> {
        self.read_one("search_state")
    }

    /// What stands at the beginning of a buffer; waits for the device.
    pub(super) fn read_one<T: bytemuck::Pod>(&self, name: &str) -> Result<T> {
        let buffer = self.buffers.get(name, "(host)")?;
        Ok(readback::read(&self.gpu, buffer, 1)?[0])
    }

    /// Makes the grid's buffers as large as needed, with the scene's margin where the adapter allows it. Goes on without
    /// lists where these have become longer than it allows at all.
    fn grow(&mut self, needed: Room) -> Result<()> {
        let limits = self.gpu.limits;
        let positions = match self.scene.neighbors.slicing_axis.fixed() {
            Some(_) => None,
            None => Some(self.read_next_positions()?),
        };
        let has = self.plan.grid.room();
        let mut grid = neighbors::grown_grid(&self.scene, self.plan.grid, needed, positions.as_deref());
        let exact = self.plan.grid.with_room(Room {
            voxels: needed.voxels.max(has.voxels),
            rows: needed.rows.max(has.rows),
            words: needed.words.max(has.words),
            list: needed.list.max(has.list),
            reached: needed.reached.max(has.reached),
        });
        if lists::wanted(&self.scene) {
            let least = Room {
                list: exact.list_capacity,
                reached: exact.reached_capacity,
                ..grid.room()
            };
            match lists::largest(&self.scene, least, grid.room(), &limits) {
                Some(room) => grid = grid.with_room(room),
                None => {
                    let why = self.after_steps(lists::left_out(&self.scene, least, &limits))?;
                    let done = self.leave_lists_out(why);
                    return self.after_steps(done);
                }
            }
        }
        let plan = |grid| self.plan.with_grid(&self.scene, &limits, grid);
        let plan = self.after_steps(plan(grid).or_else(|_| plan(exact)))?;
        self.reallocations += 1;
        self.rebuild(plan)
    }

    /// Says of an error when more room was needed.
    fn after_steps<T>(&self, result: Result<T>) -> Result<T> {
        result.map_err(|error| match error {
            Error::Limit { what, help } => Error::Limit {
                what: format!("the grid must grow after {} steps: {what}", self.submitted),
                help,
            },
            other => other,
        })
    }

    /// Goes on without neighbor lists, for which there is no room. The particles stand in the `next_` buffers.
    pub(super) fn leave_lists_out(&mut self, why: String) -> Result<()> {
        let scene = lists::without(&self.scene);
        let grid = neighbors::grid_for(&scene, &self.read_next_positions()?);
        let plan = Plan::without_lists(&scene, &self.gpu.limits, &self.plan.wanted, grid, why)?;
        self.scene = scene;
        for buffer in &self.plan.buffers {
            if !plan.buffers.iter().any(|kept| kept.name == buffer.name) {
                self.buffers.remove(&buffer.name);
            }
        }
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
            reached: self.plan.grid.reached_capacity,
        });
        let plan = self.plan.with_grid(&self.scene, &self.gpu.limits, grid)?;
        self.rebuild(plan)
    }

    /// Takes over a plan with another grid. What the search made is gone; particles stay.
    pub(super) fn rebuild(&mut self, plan: Plan) -> Result<()> {
        let empty = |grid: Grid| grid.with_room(Room::default());
        let same_voxels = empty(plan.grid) == empty(self.plan.grid);
        for buffer in &plan.buffers {
            let is_pattern = matches!(buffer.contents, Contents::Pattern(_));
            let before = self.plan.buffers.iter().find(|b| b.name == buffer.name);
            match before {
                Some(before) if before.bytes == buffer.bytes && (same_voxels || !is_pattern) => {
                    if before.contents != buffer.contents {
                        self.buffers.fill(&self.gpu, buffer)?;
                    }
                }
                _ => self.buffers.make(&self.gpu, buffer)?,
            }
        }
        self.passes = Passes::new(&self.gpu, &plan, &self.buffers)?;
        match (&mut self.renderer, plan.wanted.view) {
            (Some(renderer), _) if same_voxels => {
                renderer.rebind(&self.gpu, &plan.variant, &self.buffers)?;
            }
            (Some(renderer), Some(view)) => {
                *renderer = Renderer::new(&self.gpu, &self.scene, &plan.variant, &mut self.buffers, view)?;
            }
            _ => {}
        }
        self.plan = plan;
        let dispatch = self
            .plan
            .dispatch(self.count, self.free_particles(), &self.gpu.limits);
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
