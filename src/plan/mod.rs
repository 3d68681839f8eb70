//! From a scene and an adapter's limits to every buffer and every pass that this scene needs, and nothing else.
//!
//! A plan is made without a GPU; [`crate::simulation::Simulation`] executes it to the letter.

pub mod achieved;
mod fit;

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::gpu::compose::{GROUP_SIZE, SCAN_ITEMS, SCAN_THREADS};
use crate::gpu::pass::{INDEX_STRIDE, fold};
use crate::gpu::{BufferPlan, DISPATCHES, Demand, Items, Limits, Over, PassPlan, Variant};
use crate::guards::GUARDS;
use crate::neighbors::{self, Grid, Room, lists};
use crate::physics::collider::Obstacles;
use crate::physics::guard::guard;
use crate::physics::layout::{Clock, Guard, Occupancy, Parameters, Sums};
use crate::physics::{self, Model, Request, fields, sensors, step_control};
use crate::render;
use crate::scene::column::{Column, Source};
use crate::scene::field::Kind;
use crate::scene::model::View;
use crate::scene::{Dimensions, Scene};

/// What is wanted of a run besides simulating; what nobody wants has no pass and no buffer.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// Figures over all particles and voxels.
    pub statistics: bool,
    /// Columns to bring to the host.
    pub columns: Vec<Column>,
    /// Of frames 0, 1, 2, … every n-th brings them; all of them with 0.
    pub columns_every: u32,
    /// Pictures, and of what.
    pub view: Option<View>,
    /// Where voxels are and how full, as boxes and as a square picture with so many texels per side.
    pub voxel_map: Option<u32>,
    /// What the scene's sensors find.
    pub sensors: bool,
    /// That nothing watches particles, to measure what guards cost.
    pub unguarded: bool,
}

/// When a pass runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// When particles come; with neighbor lists, also when these no longer serve.
    Start,
    /// Every step.
    Step,
    /// Once a frame.
    Observe,
    /// Whenever the scene's sensors are sampled.
    Sample,
}

/// A pass and when it runs.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PassRow {
    /// When it runs.
    pub phase: Phase,
    #[serde(flatten)]
    pub pass: PassPlan,
    #[serde(flatten)]
    pub demand: Demand,
}

/// A texture that pictures need.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TexturePlan {
    /// Its name.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// What it is for.
    pub why: String,
}

/// Something that is drawn into a frame.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DrawPlan {
    /// Its name.
    pub label: String,
    /// The entry point that shades what is drawn, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fragment: Option<String>,
    /// File below `shaders/`, without its ending.
    pub shader: String,
    /// What it draws.
    pub why: String,
    #[serde(flatten)]
    pub demand: Demand,
}

/// Everything that a run will do on the device.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Plan {
    /// The scene's name.
    pub scene: String,
    /// 2 or 3.
    pub dimensions: usize,
    /// Particles that are there from the start, boundary particles apart.
    pub particles_at_start: u32,
    /// The same when every event has happened.
    pub particles: u32,
    /// Particles of walls and obstacles, which carry pressure and velocity of a fluid on.
    pub boundary_particles: u32,
    /// What buffers have room for: all of them.
    pub capacity: u32,
    /// Length of a step, seconds.
    pub time_step_s: f64,
    /// What limits the length of a step.
    pub time_step_limited_by: String,
    /// Steps from one frame to the next.
    pub steps_per_frame: u32,
    /// Frames, the first state included.
    pub frames: u32,
    /// Voxels of the whole domain.
    pub domain_voxels: u64,
    /// Bytes of a frame's picture before compression.
    pub picture_bytes: u64,
    /// Bytes of a frame's particle columns.
    pub column_bytes: u64,
    /// Buffers on the device.
    pub buffers: Vec<BufferPlan>,
    /// Textures on the device.
    pub textures: Vec<TexturePlan>,
    /// Compute passes, in the order in which they run.
    pub passes: Vec<PassRow>,
    /// What is drawn into a frame, in order.
    pub draws: Vec<DrawPlan>,
    /// What was decided where there was a choice.
    pub notes: Vec<String>,
    /// Why there are no neighbor lists where the scene asks for them.
    pub lists_left_out: Option<String>,
    #[serde(skip)]
    pub variant: Variant,
    #[serde(skip)]
    pub grid: Grid,
    #[serde(skip)]
    pub model: &'static Model,
    #[serde(skip)]
    pub obstacles: Obstacles,
    #[serde(skip)]
    pub wanted: Wanted,
}

impl Plan {
    /// The plan of a run of `scene` from its beginning. Where neighbor lists do not fit and the scene can do without, it
    /// has none ([`Plan::lists_left_out`]).
    ///
    /// # Errors
    ///
    /// Where the scene needs more than the limits allow.
    pub fn new(scene: &Scene, limits: &Limits, wanted: &Wanted) -> Result<Self> {
        let mut grid = neighbors::first_grid(scene);
        if lists::wanted(scene) {
            let least = Room {
                list: lists::usual_length(scene),
                reached: lists::reached_at_start(scene, &grid),
                ..grid.room()
            };
            match lists::largest(scene, least, grid.room(), limits) {
                Some(room) => grid = grid.with_room(room),
                None => {
                    let why = lists::left_out(scene, least, limits)?;
                    let scene = lists::without(scene);
                    return Self::without_lists(&scene, limits, wanted, neighbors::first_grid(&scene), why);
                }
            }
        }
        Self::of_grid(scene, limits, wanted, grid)?.demanding(scene, limits)
    }

    /// The plan, with this grid, of a scene whose lists were left out for a reason.
    pub fn without_lists(
        scene: &Scene,
        limits: &Limits,
        wanted: &Wanted,
        grid: Grid,
        why: String,
    ) -> Result<Self> {
        let plan = Self::of_grid(scene, limits, wanted, grid)?.demanding(scene, limits)?;
        Ok(Self {
            lists_left_out: Some(why),
            ..plan
        })
    }

    /// The same plan with this grid, whose buffers have room for what particles need by now.
    pub fn with_grid(&self, scene: &Scene, limits: &Limits, grid: Grid) -> Result<Self> {
        // A grid decides how large buffers are and how many digits a sort has, and nothing about shaders.
        let mut plan = Self::of_grid(scene, limits, &self.wanted, grid)?;
        for row in &mut plan.passes {
            let of = |pass: &PassPlan| (pass.shader.clone(), pass.entry.clone());
            let known = self.passes.iter().find(|known| of(&known.pass) == of(&row.pass));
            row.demand = known.map_or_else(Demand::default, |known| known.demand);
        }
        plan.draws.clone_from(&self.draws);
        plan.lists_left_out.clone_from(&self.lists_left_out);
        Ok(plan)
    }

    /// The plan with this grid. It does not say yet what its passes demand of the adapter.
    fn of_grid(scene: &Scene, limits: &Limits, wanted: &Wanted, grid: Grid) -> Result<Self> {
        let mut variant = Variant::default();
        variant
            .flag("two_dimensional", scene.dimensions == Dimensions::Two)
            .flag("unguarded", wanted.unguarded)
            .constant("DIMENSIONS", scene.dimensions.count() as u32)
            .constant("GUARD_NO_STEP", Guard::NO_STEP)
            .constant("ACCIDENTS", Guard::ACCIDENTS as u32);
        for row in &GUARDS {
            if let Some(name) = row.constant {
                variant.constant(name, row.kind.code());
            }
        }

        let mut columns = wanted.columns.clone();
        let colored = scene.color.column;
        let draws_scene = matches!(wanted.view, Some(View::Scene | View::Both));
        if draws_scene && !columns.contains(&colored) {
            columns.push(colored);
        }

        let missing = |column: &&Column| column.source == Source::Field && !scene.has_field(column.name);
        match columns.iter().find(missing).map(|column| column.name) {
            Some("material") => {
                return Err(Error::usage(
                    "all particles are of one material",
                    "leave the column `material` out, or describe several fluids in fluid.materials",
                ));
            }
            Some("body") => {
                return Err(Error::usage(
                    "no particle is part of a rigid body",
                    "leave the column `body` out, or make bodies `rigid`",
                ));
            }
            Some("radius") => {
                return Err(Error::usage(
                    "all particles are of one size",
                    "leave the column `radius` out, or give grains several sizes: grains.sizes",
                ));
            }
            Some(name) => {
                return Err(Error::usage(
                    format!("particles of this scene have no {}", name.replace('_', " ")),
                    format!("leave the column `{name}` out, or set grains.law to `linear` or `hertz`"),
                ));
            }
            None => {}
        }
        let search = neighbors::plan(scene, grid, &mut variant);
        let model = physics::model(&scene.matter);
        let sensors = match wanted.sensors {
            true => sensors::plan(scene, &mut variant),
            false => sensors::Planned::default(),
        };
        let request = Request {
            scene,
            columns: &columns,
            statistics: wanted.statistics,
            sensors: wanted.sensors,
            grid: &search.grid,
        };
        let solver = (model.plan)(&request, &mut variant);

        let [start, step] = if lists::wanted(scene) {
            lists::phases(
                &search,
                lists::every_step(scene),
                &solver.before_search,
                [&solver.after_search, &solver.once_searched],
            )
        } else {
            let start = [&search.passes[..], &solver.after_search].concat();
            let step = [&solver.before_search[..], &start].concat();
            [start, step]
        };

        let mut buffers = fields::plan(scene, &columns, &mut variant);
        buffers.extend(state_buffers(scene));
        buffers.extend(search.buffers);
        buffers.extend(solver.buffers);
        buffers.extend(step_control::plan(scene, &mut variant));
        buffers.extend(sensors.buffers);

        let row = |phase| {
            move |pass: &PassPlan| PassRow {
                phase,
                pass: pass.clone(),
                demand: Demand::default(),
            }
        };
        let mut passes: Vec<PassRow> = start.iter().map(row(Phase::Start)).collect();
        passes.extend(step.iter().map(row(Phase::Step)));
        passes.extend(sensors.passes.iter().map(row(Phase::Sample)));
        passes.extend(solver.measure.iter().map(row(Phase::Observe)));
        if wanted.statistics {
            let (more_buffers, more_passes) = statistics(scene);
            buffers.extend(more_buffers);
            passes.extend(more_passes.iter().map(row(Phase::Observe)));
        }

        if let Some(side) = wanted.voxel_map {
            variant.constant("VOXEL_MAP_SIDE", side);
            buffers.push(BufferPlan::storage(
                "voxel_map",
                u64::from(side) * u64::from(side),
                4,
                "how full the voxels are, as a picture",
            ));
            let pass = PassPlan::new(
                "storage/map_voxels",
                "map_voxels",
                Items::Fixed(side * side),
                "voxels in memory order, folded into a square",
            );
            passes.push(row(Phase::Observe)(&pass));
        }

        buffers.extend(pass_indices(&passes));

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
                fragment: draw.fragment,
                shader: draw.shader,
                why: draw.why,
                demand: Demand::default(),
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
            particles_at_start: scene.particles.len() as u32,
            particles: scene.first_boundary(),
            boundary_particles: scene.boundary.len() as u32,
            capacity: scene.capacity,
            time_step_s: scene.time.step,
            time_step_limited_by: scene.time.limited_by.to_owned(),
            steps_per_frame: scene.time.steps_per_frame,
            frames: scene.time.frames,
            domain_voxels: search.grid.domain_voxels(),
            picture_bytes,
            column_bytes: wanted.columns.iter().map(|c| column_bytes(scene, c)).sum(),
            buffers,
            textures,
            passes,
            draws,
            notes: [solver.notes, search.notes].concat(),
            lists_left_out: None,
            variant,
            grid: search.grid,
            model,
            obstacles: solver.obstacles,
            wanted: wanted.clone(),
        };
        plan.check_sizes(limits)?;
        Ok(plan)
    }

    /// What is good to know about the plan.
    pub fn told(&self) -> impl Iterator<Item = &String> {
        self.notes.iter().chain(&self.lists_left_out)
    }

    /// The plan, for measures that would be others without lists.
    ///
    /// # Errors
    ///
    /// Where lists were left out.
    pub fn with_its_lists(self) -> Result<Self> {
        match self.lists_left_out {
            None => Ok(self),
            Some(why) => Err(Error::Limit {
                what: why,
                help: "set neighbors.skin=0, or choose another adapter (`sliceflow devices` lists them)"
                    .into(),
            }),
        }
    }

    /// Bytes of all buffers and textures.
    pub fn bytes(&self) -> u64 {
        let buffers: u64 = self.buffers.iter().map(|b| b.bytes).sum();
        let textures: u64 = self.textures.iter().map(|t| t.bytes).sum();
        buffers + textures
    }

    /// Most items that a pass has with `particles` particles.
    pub fn most_items(&self, items: Items, particles: u32) -> u32 {
        match items {
            Items::Voxels => self.grid.capacity,
            Items::VoxelBlocks => self.scan_blocks(self.grid.capacity),
            Items::Once | Items::SearchedOnce | Items::LoopOnce(_) => 1,
            Items::Fixed(count) => count,
            _ => self.threads(
                items,
                particles,
                particles.saturating_sub(self.boundary_particles),
            ),
        }
    }

    /// Threads of a pass over particles, `free` of which are no boundary particles; 0 where it is over something else.
    fn threads(&self, items: Items, particles: u32, free: u32) -> u32 {
        let is_set = |flag| self.variant.flags.contains(flag);
        match items.over() {
            Some(Over::Free) if is_set("separated") => free,
            Some(Over::Reached) if is_set("boundary_in_reach") => {
                particles.min(free + self.grid.reached_capacity)
            }
            Some(_) => particles,
            None => 0,
        }
    }

    /// The buffer `dispatch` for so many particles that are searched anew, before any step; `free` of them are no boundary
    /// particles.
    ///
    /// Rows of x, y, z, and the groups that fit in one dimension.
    pub fn dispatch(&self, particles: u32, free: u32, limits: &Limits) -> Vec<[u32; 4]> {
        let voxels = self.grid.capacity;
        let groups = |items| match items {
            Items::Particles
            | Items::SearchedParticles
            | Items::FreeParticles
            | Items::SearchedFreeParticles
            | Items::ReachedParticles
            | Items::SearchedReachedParticles => self.threads(items, particles, free).div_ceil(GROUP_SIZE),
            Items::Voxels => voxels.div_ceil(GROUP_SIZE),
            Items::VoxelBlocks => self.scan_blocks(voxels),
            Items::Once => 1,
            _ => 0,
        };
        let entry = |(items, _): &(Items, &str)| {
            let (x, y) = fold(groups(*items), limits.groups);
            [x, y, 1, limits.groups]
        };
        DISPATCHES.iter().map(entry).collect()
    }

    /// Workgroups of a prefix sum over the entries of `voxel_start`.
    fn scan_blocks(&self, voxels: u32) -> u32 {
        let separated = self.variant.flags.contains("separated");
        let entries = neighbors::storage::entries(voxels, separated);
        entries.div_ceil(u64::from(SCAN_THREADS * SCAN_ITEMS)) as u32
    }

    /// What the shaders of a phase's passes are made of. Once a frame, when particles have just been searched, measures may
    /// look at the voxels.
    pub fn variant_of(&self, phase: Phase) -> Variant {
        let mut variant = self.variant.clone();
        if phase == Phase::Observe && self.model.measures_by_voxels {
            variant.role("candidates", neighbors::FROM_VOXELS);
        }
        variant
    }

    /// Whether steps go by twos: the first leaves particles in the `next_` buffers, and the second takes them back.
    pub fn goes_by_twos(&self) -> bool {
        let is_set = |flag| self.variant.flags.contains(flag);
        is_set("lists") && !is_set("lists_every_step")
    }

    pub fn in_phase(&self, phase: Phase) -> impl Iterator<Item = &PassPlan> {
        self.passes
            .iter()
            .filter(move |row| row.phase == phase)
            .map(|row| &row.pass)
    }

    /// The numbers that passes run with, ascending; each has its place in `pass_index`.
    pub fn indices(&self) -> Vec<u32> {
        indices(&self.passes)
    }
}

fn indices(passes: &[PassRow]) -> Vec<u32> {
    let numbers: BTreeSet<u32> = passes.iter().filter_map(|row| row.pass.index).collect();
    numbers.into_iter().collect()
}

/// The buffer of the numbers that passes run with, where some have one.
fn pass_indices(passes: &[PassRow]) -> Option<BufferPlan> {
    let bytes = indices(passes).len() * INDEX_STRIDE as usize;
    let why = "the number of each pass that runs several times";
    (bytes > 0).then(|| BufferPlan::uniform("pass_index", bytes, why))
}

/// Bytes of one frame of a column that is brought to the host.
fn column_bytes(scene: &Scene, column: &Column) -> u64 {
    let each = match column.name {
        "position" => 8 * scene.dimensions.count() as u64,
        "velocity" => 4 * scene.dimensions.count() as u64,
        name if column.source == Source::Field && scene.kind_of(name) == Kind::Vector => 12,
        _ => 4,
    };
    each * u64::from(scene.capacity)
}

/// Buffers of every simulation besides its particles' fields.
fn state_buffers(scene: &Scene) -> Vec<BufferPlan> {
    let guard = guard(scene);
    vec![
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
        )
        .reported(),
        BufferPlan::table(
            "guard",
            &[guard],
            "what moves note of particles: those that went wrong first, the fastest one",
        )
        .reported(),
    ]
}

/// Buffers and passes of the figures over all particles and voxels.
fn statistics(scene: &Scene) -> (Vec<BufferPlan>, Vec<PassPlan>) {
    let groups = u64::from(scene.capacity.div_ceil(GROUP_SIZE));
    let sums = Sums::LAYOUT.size as u64;
    let buffers = vec![
        BufferPlan::storage(
            "partial_sums",
            groups,
            sums,
            "sums of workgroups, added in a fixed order",
        ),
        BufferPlan::storage("sums", 1, sums, "figures over all particles").reported(),
        BufferPlan::storage(
            "occupancy_count",
            1,
            Occupancy::LAYOUT.size as u64,
            "how full the voxels are",
        )
        .reported_from(0),
    ];
    let passes = vec![
        PassPlan::new(
            "physics/total_sums",
            "total_sums",
            Items::Once,
            "adds the workgroups' sums",
        ),
        PassPlan::new(
            "storage/measure_voxels",
            "measure_voxels",
            Items::Voxels,
            "voxels by how many particles they hold",
        ),
    ];
    (buffers, passes)
}
