//! From a scene and an adapter's limits to every buffer and every pass that this scene needs, and nothing else.
//!
//! A plan is made without a GPU; [`crate::simulation::Simulation`] executes it to the letter.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::gpu::compose::GROUP_SIZE;
use crate::gpu::device::Limits;
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::neighbors::{self, Grid};
use crate::physics::collider::Obstacles;
use crate::physics::dem;
use crate::physics::layout::{Clock, Guard, Occupancy, Parameters, Sums};
use crate::render;
use crate::scene::column::{Column, Source};
use crate::scene::model::View;
use crate::scene::{Dimensions, Scene};

/// What is wanted of a run besides simulating; what nobody wants has no pass and no buffer.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// Figures over all grains and voxels.
    pub statistics: bool,
    /// Columns to bring to the host.
    pub columns: Vec<Column>,
    /// Pictures, and of what.
    pub view: Option<View>,
}

/// When a pass runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// When particles come or parameters change.
    Start,
    /// Every step.
    Step,
    /// Once a frame.
    Observe,
}

/// A pass and when it runs.
#[derive(Debug, Clone, Serialize)]
pub struct PassRow {
    pub phase: Phase,
    #[serde(flatten)]
    pub pass: PassPlan,
}

#[derive(Debug, Clone, Serialize)]
pub struct TexturePlan {
    pub name: String,
    pub bytes: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    pub why: String,
}

#[derive(Debug, Clone, Serialize)]
pub struct DrawPlan {
    pub label: String,
    pub shader: String,
    pub why: String,
}

/// Everything that a run will do on the device.
#[derive(Debug, Clone, Serialize)]
pub struct Plan {
    pub scene: String,
    pub dimensions: usize,
    /// Particles at the start, and when every event has happened.
    pub particles: usize,
    pub capacity: u32,
    /// Seconds, and what limits it.
    pub time_step_s: f64,
    pub time_step_limited_by: String,
    pub steps_per_frame: u32,
    pub frames: u32,
    /// Voxels of the whole domain.
    pub domain_voxels: u64,
    /// Bytes of a frame's picture before compression.
    pub picture_bytes: u64,
    /// Bytes of a frame's particle columns.
    pub column_bytes: u64,
    pub buffers: Vec<BufferPlan>,
    pub textures: Vec<TexturePlan>,
    pub passes: Vec<PassRow>,
    pub draws: Vec<DrawPlan>,
    pub notes: Vec<String>,
    #[serde(skip)]
    pub variant: Variant,
    #[serde(skip)]
    pub grid: Grid,
    #[serde(skip)]
    pub obstacles: Obstacles,
    #[serde(skip)]
    pub wanted: Wanted,
}

impl Plan {
    pub fn new(scene: &Scene, limits: &Limits, wanted: &Wanted) -> Result<Self> {
        let mut variant = Variant::default();
        variant
            .flag("two_dimensional", scene.dimensions == Dimensions::Two)
            .constant("DIMENSIONS", scene.dimensions.count() as u32);

        let mut columns = wanted.columns.clone();
        let colored = scene.color.column;
        let draws_scene = matches!(wanted.view, Some(View::Scene | View::Both));
        if draws_scene && !columns.contains(&colored) {
            columns.push(colored);
        }

        let obstacles = Obstacles::new(scene);
        let search = neighbors::plan(scene, &mut variant);
        let solver = dem::plan(scene, &obstacles, &columns, wanted.statistics, &mut variant);

        let mut buffers = state_buffers(scene);
        buffers.extend(search.buffers);
        buffers.extend(solver.buffers);

        let row = |phase| {
            move |pass: &PassPlan| PassRow {
                phase,
                pass: pass.clone(),
            }
        };
        let mut passes = Vec::new();
        passes.extend(search.passes.iter().map(row(Phase::Start)));
        passes.extend(solver.after_search.iter().map(row(Phase::Start)));
        passes.extend(solver.before_search.iter().map(row(Phase::Step)));
        passes.extend(search.passes.iter().map(row(Phase::Step)));
        passes.extend(solver.after_search.iter().map(row(Phase::Step)));
        passes.extend(solver.measure.iter().map(row(Phase::Observe)));
        if wanted.statistics {
            let (more_buffers, more_passes) = statistics(scene, &search.grid);
            buffers.extend(more_buffers);
            passes.extend(more_passes.iter().map(row(Phase::Observe)));
        }

        let mut textures = Vec::new();
        let mut draws = Vec::new();
        let mut picture_bytes = 0;
        if let Some(view) = wanted.view {
            let needs = render::needs(scene, view);
            buffers.extend(needs.buffers);
            textures.extend(needs.textures.into_iter().map(|texture| TexturePlan {
                name: texture.name,
                bytes: texture.bytes,
                size: texture.size,
                why: texture.why,
            }));
            draws.extend(needs.draws.into_iter().map(|draw| DrawPlan {
                label: draw.label,
                shader: draw.shader,
                why: draw.why,
            }));
            picture_bytes = scene
                .render
                .size
                .iter()
                .map(|&side| u64::from(side))
                .product::<u64>()
                * 4;
        }

        let plan = Self {
            scene: scene.name.clone(),
            dimensions: scene.dimensions.count(),
            particles: scene.particles.len(),
            capacity: scene.capacity,
            time_step_s: scene.time.step,
            time_step_limited_by: scene.time.limited_by.to_owned(),
            steps_per_frame: scene.time.steps_per_frame,
            frames: scene.time.frames,
            domain_voxels: u64::from(search.grid.capacity),
            picture_bytes,
            column_bytes: wanted.columns.iter().map(|c| column_bytes(scene, c)).sum(),
            buffers,
            textures,
            passes,
            draws,
            notes: obstacles.notes.clone(),
            variant,
            grid: search.grid,
            obstacles,
            wanted: wanted.clone(),
        };
        plan.check(limits)?;
        Ok(plan)
    }

    /// Bytes of all buffers and textures.
    pub fn bytes(&self) -> u64 {
        let buffers: u64 = self.buffers.iter().map(|b| b.bytes).sum();
        let textures: u64 = self.textures.iter().map(|t| t.bytes).sum();
        buffers + textures
    }

    /// Threads that a pass runs with `particles` particles.
    pub fn threads(items: Items, particles: u32) -> u32 {
        match items {
            Items::Particles => particles,
            Items::Voxels(count) | Items::Fixed(count) => count,
        }
    }

    pub fn in_phase(&self, phase: Phase) -> impl Iterator<Item = &PassPlan> {
        self.passes
            .iter()
            .filter(move |row| row.phase == phase)
            .map(|row| &row.pass)
    }

    /// Refuses what the adapter cannot hold, with the number that would fit.
    fn check(&self, limits: &Limits) -> Result<()> {
        let most = limits.binding.min(limits.buffer);
        if let Some(buffer) = self.buffers.iter().find(|b| b.bytes > most) {
            let fitting = |count: u32| u128::from(count) * u128::from(most) / u128::from(buffer.bytes);
            return Err(Error::Limit {
                what: format!(
                    "buffer `{}` ({}) needs {} bytes; this adapter binds at most {most} at once",
                    buffer.name, buffer.why, buffer.bytes
                ),
                mend: if !VOXEL_BUFFERS.contains(&buffer.name.as_str()) {
                    format!(
                        "{} particles would fit; or choose another adapter",
                        fitting(self.capacity)
                    )
                } else {
                    format!(
                        "{} voxels would fit instead of {}: shrink the domain, enlarge the grains or the search radius, \
                         use fewer slots, or choose another adapter",
                        fitting(self.grid.capacity),
                        self.grid.capacity
                    )
                },
            });
        }
        if let Some(texture) = self
            .textures
            .iter()
            .find(|t| t.size[0].max(t.size[1]) > limits.texture)
        {
            return Err(Error::Limit {
                what: format!(
                    "texture `{}` needs {}×{} pixels; this adapter has at most {} a side",
                    texture.name, texture.size[0], texture.size[1], limits.texture
                ),
                mend: "choose a smaller --size or a lower render.antialias".into(),
            });
        }
        Ok(())
    }
}

/// Buffers that grow with the number of voxels; the others grow with the number of particles.
const VOXEL_BUFFERS: &[&str] = &["voxel_count", "voxel_start", "index_pool", "block_sum"];

/// Bytes of one frame of a column that is brought to the host.
fn column_bytes(scene: &Scene, column: &Column) -> u64 {
    let each = match column.name {
        "position" => 8 * scene.dimensions.count() as u64,
        "velocity" => 4 * scene.dimensions.count() as u64,
        _ => 4,
    };
    each * u64::from(scene.capacity)
}

/// Buffers of every simulation.
fn state_buffers(scene: &Scene) -> Vec<BufferPlan> {
    let vector = dem::packed_bytes(scene.dimensions);
    let column =
        |name: &str, bytes, why: &str| BufferPlan::storage(name, u64::from(scene.capacity), bytes, why);
    vec![
        column(
            "position",
            vector,
            "state, in the order that the search made; the renderer binds it too",
        ),
        column("velocity", vector, "state"),
        column("id", 4, "a particle's number, which travels with it"),
        column("next_position", vector, "state after a step, before the search"),
        column("next_velocity", vector, "state after a step, before the search"),
        column("next_id", 4, "state after a step, before the search"),
        BufferPlan::uniform(
            "parameters",
            Parameters::LAYOUT.size,
            "gravity, particle count, time step",
        ),
        BufferPlan::storage(
            "clock",
            1,
            Clock::LAYOUT.size as u64,
            "steps done, for the guard and moving obstacles",
        ),
        BufferPlan::storage(
            "guard",
            1,
            Guard::LAYOUT.size as u64,
            "the first particle that went wrong, if any",
        ),
    ]
}

/// Buffers and passes of the figures over all grains and voxels.
fn statistics(scene: &Scene, grid: &Grid) -> (Vec<BufferPlan>, Vec<PassPlan>) {
    let groups = u64::from(scene.capacity.div_ceil(GROUP_SIZE));
    let sums = Sums::LAYOUT.size as u64;
    let buffers = vec![
        BufferPlan::storage(
            "partial_sums",
            groups,
            sums,
            "sums of workgroups, added in a fixed order",
        ),
        BufferPlan::storage("sums", 1, sums, "energies, greatest speed and overlap, contacts"),
        BufferPlan::storage(
            "occupancy_count",
            1,
            Occupancy::LAYOUT.size as u64,
            "how full the voxels are",
        ),
    ];
    let passes = vec![
        PassPlan::new(
            "physics/total_sums",
            "total_sums",
            Items::Fixed(1),
            "adds the workgroups' sums",
        ),
        PassPlan::new(
            "storage/measure_voxels",
            "measure_voxels",
            Items::Voxels(grid.capacity),
            "voxels by how many particles they hold",
        ),
    ];
    (buffers, passes)
}

/// Whether a column has to be read from a buffer of its own name.
pub fn has_buffer(column: &Column) -> bool {
    column.source == Source::Measured || matches!(column.name, "position" | "velocity" | "id")
}
