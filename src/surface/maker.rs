//! From particles on the device, with a search made for them, to a mesh there.

use std::time::Instant;

use super::layout::{Surface, SurfaceTotals};
use super::{DEEP, FARTHEST, Lattice, Shape, cubes, radius, voxels};
use crate::error::{Error, Result};
use crate::gpu::buffers::Usage;
use crate::gpu::compose::{SCAN_ITEMS, SCAN_THREADS};
use crate::gpu::{Buffers, Contents, Gpu, Items, Kernel, Pass, Variant, readback};
use crate::neighbors::layout::SearchState;
use crate::neighbors::{FROM_VOXELS, Grid, Room};
use crate::scene::model::SurfaceKernel;

/// Stands for a side where there is none.
const FAR_AWAY: f32 = 1e18;
/// Bytes that each voxel has besides the grid's tables: node, value, cell, numbers of its first vertex and triangle.
const VOXEL_BYTES: u64 = 24;
/// The same where all voxels of a box have memory, and nobody has to say which node each is.
const BOX_VOXEL_BYTES: u64 = 16;
/// What makes the tables larger, beyond what was found missing.
const MORE: f64 = 1.25;

/// Particles on the device, as a search left them.
pub struct Searched<'a> {
    pub buffers: &'a Buffers,
    pub variant: &'a Variant,
    pub particles: u32,
}

/// A mesh on the device, in the maker's buffers `mesh_position` and `mesh_normal`, four f32 per vertex, in the search's
/// coordinates, and `mesh_triangle`, three u32 per triangle. It is closed, and its triangles face outward.
#[derive(Debug, Clone, Copy)]
pub struct Mesh {
    pub vertices: u32,
    pub triangles: u32,
    pub figures: Figures,
}

/// What a mesh has cost.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Figures {
    /// Particles near the surface.
    pub shell: u64,
    /// Voxels in memory.
    pub voxels: u64,
    /// Voxels of the box around the surface.
    pub box_voxels: u64,
    /// Of the voxels in memory and the grid's tables.
    pub bytes: u64,
    /// That all voxels of the box would have.
    pub box_bytes: u64,
    /// With the host's wait for the device, without the search.
    pub seconds: f64,
}

/// Makes surfaces, one after the other. What it has compiled and buffers that are large enough serve the next one too.
pub struct SurfaceMaker {
    gpu: Gpu,
    /// What all passes know by name besides the buffers of the search and of the grid; the mesh among them.
    own: Buffers,
    /// The grid that the surface is stored in.
    grid: Buffers,
    /// Of the grid's tables.
    room: Room,
}

/// What one surface is made of on the way.
struct Work<'a> {
    searched: &'a Searched<'a>,
    /// Of the shaders that look at particles.
    search_variant: Variant,
    /// Of those that look at voxels.
    voxel_variant: Variant,
    told: Surface,
}

/// A pass and its threads.
type Planned = (Pass, u32);

impl SurfaceMaker {
    pub fn new(gpu: Gpu) -> Self {
        Self {
            gpu,
            own: Buffers::default(),
            grid: Buffers::default(),
            room: Room::default(),
        }
    }

    /// The latest mesh among them; columns of its own may be added.
    pub fn buffers(&mut self) -> &mut Buffers {
        &mut self.own
    }

    /// Makes the mesh of the particles; it is empty where there are none.
    ///
    /// # Errors
    ///
    /// Where the device has no room for it.
    pub fn make(&mut self, searched: &Searched<'_>, shape: &Shape, lattice: &Lattice) -> Result<Mesh> {
        let started = Instant::now();
        let mut made = self.attempt(searched, shape, lattice, DEEP)?;
        if made.is_none() {
            // Somewhere the surface is not where its particles were looked for. With voxels around all of them it is.
            made = self.attempt(searched, shape, lattice, -1.0)?;
        }
        let mut mesh = made.ok_or_else(|| Error::Shader {
            message: "a surface is not closed, with voxels around all particles".into(),
        })?;
        mesh.figures.seconds = started.elapsed().as_secs_f64();
        Ok(mesh)
    }

    /// Makes it with voxels around the particles that stand apart from the mean of their neighbors by more than `deep`
    /// spacings; `None` where the mesh would not be closed.
    fn attempt(
        &mut self,
        searched: &Searched<'_>,
        shape: &Shape,
        lattice: &Lattice,
        deep: f64,
    ) -> Result<Option<Mesh>> {
        let mark_side = mark_side(shape);
        let mut work = Work::new(searched, shape, lattice, deep);
        self.begin(&work)?;
        self.find_shell(&mut work, shape)?;
        let marks = u64::from(work.told.shell) * u64::from(mark_side).pow(3);
        if marks > u64::from(u32::MAX) {
            return Err(too_large(format!(
                "{marks} marks around the particles near the surface"
            )));
        }
        let grid_bytes = self.lay_out(&mut work, shape, lattice, marks as u32)?;
        let totals = self.find_cells(&mut work, marks as u32)?;
        if totals.open > 0 {
            return Ok(None);
        }
        let box_voxels: u64 = lattice.size.iter().map(|&n| u64::from(n)).product();
        let figures = Figures {
            shell: work.told.shell.into(),
            voxels: work.told.voxels.into(),
            box_voxels,
            bytes: grid_bytes + VOXEL_BYTES * u64::from(work.told.voxels),
            box_bytes: BOX_VOXEL_BYTES * box_voxels,
            seconds: 0.0,
        };
        self.write_mesh(work, totals, figures).map(Some)
    }

    /// Writes what all passes read.
    fn begin(&mut self, work: &Work<'_>) -> Result<()> {
        let gpu = &self.gpu;
        let table = cubes::table();
        for (name, bytes, usage) in [
            ("surface", size_of::<Surface>(), Usage::Uniform),
            ("surface_totals", size_of::<SurfaceTotals>(), Usage::Storage),
            ("cube_table", size_of_val(&table[..]), Usage::Storage),
        ] {
            self.own.reserve(gpu, name, bytes as u64, usage)?;
        }
        self.own.write(gpu, "cube_table", 0, &table)?;
        self.own
            .write(gpu, "surface_totals", 0, &[SurfaceTotals::default()])?;
        self.tell(work)
    }

    /// Finds the kernels of the particles, and those near the surface.
    fn find_shell(&mut self, work: &mut Work<'_>, shape: &Shape) -> Result<()> {
        let particles = work.searched.particles;
        let vectors = kernel_vectors(shape.kernel);
        self.storage("surface_kernel", particles, 16 * u64::from(vectors))?;
        self.storage("shell_flag", particles, 4)?;
        self.storage("shell_position", particles, 16)?;
        self.storage("block_sum", blocks(particles), 4)?;
        let mut passes = vec![self.particle_pass(work, ["surface/find_shell", "find_shell"], particles)?];
        for (entry, threads) in scan(particles) {
            passes.push(self.particle_pass(work, ["surface/list_shell", entry], threads)?);
        }
        self.run(&[], &passes)?;
        work.told.shell = self.totals()?.shell;
        self.tell(work)
    }

    /// Lays out the grid around the particles near the surface. Gives the bytes of its tables.
    fn lay_out(&mut self, work: &mut Work<'_>, shape: &Shape, lattice: &Lattice, marks: u32) -> Result<u64> {
        let mut grid = voxels::grid(lattice, shape, self.room);
        loop {
            let layout = voxels::layout(shape, grid, &mut work.voxel_variant);
            let mut cleared = Vec::new();
            for buffer in &layout.buffers {
                if buffer.bytes > self.gpu.limits.largest() {
                    return Err(too_large(format!(
                        "the buffer `{}` of {} bytes",
                        buffer.name, buffer.bytes
                    )));
                }
                self.grid
                    .reserve(&self.gpu, &buffer.name, buffer.bytes, buffer.usage)?;
                match buffer.contents {
                    Contents::Zeros if buffer.name == "dispatch" => {}
                    Contents::Zeros => cleared.push(self.grid.get(&buffer.name, "(host)")?.clone()),
                    _ => self.grid.fill(&self.gpu, buffer)?,
                }
            }
            let groups = [0, 0, 0, self.gpu.limits.groups];
            let dispatch: Vec<u32> = groups.repeat(crate::gpu::DISPATCHES.len());
            self.grid.write(&self.gpu, "dispatch", 0, &dispatch)?;
            let mut passes = Vec::new();
            for planned in &layout.passes {
                let threads = match planned.items {
                    Items::Fixed(threads) => threads,
                    _ => marks,
                };
                let shader = [planned.shader.as_str(), planned.entry.as_str()];
                passes.push(self.voxel_pass(work, shader, threads)?);
            }
            self.run(&cleared, &passes)?;
            let state = self.grid.get("search_state", "(host)")?;
            let state = readback::read::<SearchState>(&self.gpu, state, 1)?[0];
            if state.halted == 0 {
                self.room = grid.room();
                work.told.voxels = state.voxels;
                self.tell(work)?;
                return Ok(layout.buffers.iter().map(|buffer| buffer.bytes).sum());
            }
            grid = grown(grid, &state);
        }
    }

    /// Finds the implicit function at the nodes, and what the surface passes through.
    fn find_cells(&mut self, work: &mut Work<'_>, marks: u32) -> Result<SurfaceTotals> {
        let voxels = work.told.voxels;
        self.storage("surface_node", voxels, 8)?;
        for name in ["surface_value", "surface_cell", "vertex_start", "triangle_start"] {
            self.storage(name, voxels, 4)?;
        }
        self.storage("block_sum", blocks(voxels), 4)?;
        // A node that nobody marks is zero.
        let nodes = self.own.get("surface_node", "(host)")?.clone();
        let mut passes = vec![
            self.voxel_pass(work, ["surface/list_nodes", "list_nodes"], marks)?,
            self.particle_pass(work, ["surface/evaluate_nodes", "evaluate_nodes"], voxels)?,
            self.voxel_pass(work, ["surface/find_cells", "find_cells"], voxels)?,
        ];
        for shader in ["surface/number_vertices", "surface/number_triangles"] {
            for (entry, threads) in scan(voxels) {
                passes.push(self.voxel_pass(work, [shader, entry], threads)?);
            }
        }
        self.run(&[nodes], &passes)?;
        self.totals()
    }

    /// Writes the mesh.
    fn write_mesh(&mut self, mut work: Work<'_>, totals: SurfaceTotals, figures: Figures) -> Result<Mesh> {
        let SurfaceTotals {
            vertices, triangles, ..
        } = totals;
        self.storage("mesh_position", vertices, 16)?;
        self.storage("mesh_normal", vertices, 16)?;
        self.storage("mesh_triangle", triangles, 12)?;
        work.told.vertices = vertices;
        self.tell(&work)?;
        let voxels = work.told.voxels;
        let passes = [
            self.voxel_pass(&work, ["surface/place_vertices", "place_vertices"], voxels)?,
            self.voxel_pass(&work, ["surface/write_triangles", "write_triangles"], voxels)?,
            self.particle_pass(&work, ["surface/find_normals", "find_normals"], vertices)?,
        ];
        self.run(&[], &passes)?;
        Ok(Mesh {
            vertices,
            triangles,
            figures,
        })
    }

    /// Values at the vertices of the latest mesh: means of those that the particles have, `width` numbers per particle in order
    /// of id.
    ///
    /// # Errors
    ///
    /// Where the device has no room for them.
    pub fn blend(
        &mut self,
        searched: &Searched<'_>,
        mesh: &Mesh,
        values: &[f32],
        width: u32,
    ) -> Result<Vec<f32>> {
        let count = mesh.vertices * width;
        self.storage("column_value", values.len() as u32, 4)?;
        self.own.write(&self.gpu, "column_value", 0, values)?;
        self.storage("vertex_value", count, 4)?;
        let mut variant = particle_variant(searched.variant);
        variant.constant("COLUMN_WIDTH", width);
        let kernel = Kernel::load(&self.gpu, "surface/blend_column", &variant, "blend_column")?;
        let pass = kernel.pass_with(&self.gpu, searched.buffers, &self.own.bindings())?;
        self.run(&[], &[(pass, mesh.vertices)])?;
        let found = self.own.get("vertex_value", "(host)")?;
        readback::read(&self.gpu, found, count as usize)
    }

    /// A pass that looks at particles.
    fn particle_pass(&mut self, work: &Work<'_>, shader: [&str; 2], threads: u32) -> Result<Planned> {
        let kernel = Kernel::load(&self.gpu, shader[0], &work.search_variant, shader[1])?;
        let pass = kernel.pass_with(&self.gpu, work.searched.buffers, &self.own.bindings())?;
        Ok((pass, threads))
    }

    /// A pass that looks at voxels of the surface.
    fn voxel_pass(&mut self, work: &Work<'_>, shader: [&str; 2], threads: u32) -> Result<Planned> {
        let kernel = Kernel::load(&self.gpu, shader[0], &work.voxel_variant, shader[1])?;
        let pass = kernel.pass_with(&self.gpu, &self.grid, &self.own.bindings())?;
        Ok((pass, threads))
    }

    /// Clears buffers, then runs passes.
    fn run(&self, cleared: &[wgpu::Buffer], passes: &[Planned]) -> Result<()> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for buffer in cleared {
            encoder.clear_buffer(buffer, 0, None);
        }
        let mut compute = encoder.begin_compute_pass(&Default::default());
        for (pass, threads) in passes.iter().filter(|(_, threads)| *threads > 0) {
            pass.encode(&mut compute, *threads);
        }
        drop(compute);
        self.gpu.submit(encoder)?;
        Ok(())
    }

    fn totals(&self) -> Result<SurfaceTotals> {
        let totals = self.own.get("surface_totals", "(host)")?;
        Ok(readback::read(&self.gpu, totals, 1)?[0])
    }

    /// Writes what passes are told.
    fn tell(&self, work: &Work<'_>) -> Result<()> {
        self.own.write(&self.gpu, "surface", 0, &[work.told])
    }

    /// Has room for so many elements, one at least, in a buffer that all passes know.
    fn storage(&mut self, name: &str, count: u32, element: u64) -> Result<()> {
        let bytes = element * u64::from(count.max(1));
        if bytes > self.gpu.limits.largest() {
            return Err(too_large(format!("the buffer `{name}` of {bytes} bytes")));
        }
        self.own.reserve(&self.gpu, name, bytes, Usage::Storage)
    }
}

impl<'a> Work<'a> {
    fn new(searched: &'a Searched<'a>, shape: &Shape, lattice: &Lattice, deep: f64) -> Self {
        let spacings = |factor: f64| (factor * shape.spacing) as f32;
        let sides = |upper: usize, none: f32| {
            let along = |axis: usize| shape.sides[axis][upper].map_or(none, |side| side as f32);
            [along(0), along(1), along(2), 0.0]
        };
        let [search_variant, voxel_variant] = variants(searched.variant, shape);
        Self {
            search_variant,
            voxel_variant,
            searched,
            told: Surface {
                lower: lattice.lower.extend(0.0).into(),
                low: sides(0, -FAR_AWAY),
                high: sides(1, FAR_AWAY),
                width: shape.width as f32,
                reach: shape.reach as f32,
                radius: radius(shape.spacing, shape.reach) as f32,
                farthest: spacings(FARTHEST),
                deep: spacings(deep),
                spacing: shape.spacing as f32,
                neighbor_reach: shape.drops.map_or(0.0, |drops| drops.reach as f32),
                fewest: shape.drops.map_or(0.0, |drops| drops.fewest as f32),
                ..Default::default()
            },
        }
    }
}

/// Vectors that each particle has in `surface_kernel`.
fn kernel_vectors(kernel: SurfaceKernel) -> u32 {
    match kernel {
        SurfaceKernel::Isotropic => 1,
        SurfaceKernel::Anisotropic => 2,
    }
}

/// The variant of passes that look at particles, whatever physics does with lists.
fn particle_variant(search: &Variant) -> Variant {
    let mut variant = search.clone();
    variant.role("candidates", FROM_VOXELS);
    variant
}

/// Variants of the passes that look at particles, and of those that look at voxels of the surface.
pub fn variants(search: &Variant, shape: &Shape) -> [Variant; 2] {
    let mut voxels = Variant::default();
    voxels.constant("CUBE_ROW", cubes::ROW as u32);
    voxels::layout(shape, Grid::default(), &mut voxels);
    let folder = match shape.kernel {
        SurfaceKernel::Isotropic => "surface/isotropic",
        SurfaceKernel::Anisotropic => "surface/anisotropic",
    };
    let mut particles = particle_variant(search);
    particles
        .role("implicit", format!("{folder}/field"))
        .role("fit_kernel", format!("{folder}/fit"))
        .constant("KERNEL_VECTORS", kernel_vectors(shape.kernel));
    [particles, voxels]
}

/// Nodes along a side of the box around a particle in which it may mark some.
pub(super) fn mark_side(shape: &Shape) -> u32 {
    (2.0 * (FARTHEST * shape.spacing / shape.width + 1.0)).floor() as u32 + 1
}

fn blocks(items: u32) -> u32 {
    items.div_ceil(SCAN_THREADS * SCAN_ITEMS)
}

/// The passes of a prefix sum, with their threads.
fn scan(items: u32) -> [(&'static str, u32); 3] {
    let threads = blocks(items) * SCAN_THREADS;
    [
        ("sum_blocks", threads),
        ("scan_blocks", 1),
        ("finish_scan", threads),
    ]
}

/// The grid with room for the tables that were too small.
fn grown(grid: Grid, state: &SearchState) -> Grid {
    let pick = |needed: u32, has: u32| match needed > has {
        true => (f64::from(needed) * MORE) as u32,
        false => has,
    };
    let has = grid.room();
    grid.with_room(Room {
        rows: pick(state.rows, has.rows),
        words: pick(state.words, has.words),
        ..has
    })
}

fn too_large(what: String) -> Error {
    Error::Limit {
        what: format!("the adapter has no room for {what} that a surface needs"),
        help: "make voxels larger, or choose another adapter (`sliceflow devices` lists them)".into(),
    }
}
