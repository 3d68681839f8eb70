//! Columns: values that every particle has and that can be drawn, written or logged. Registered once, in [`COLUMNS`].

/// One value per particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name in scene files, on the command line and of the shader file `render/columns/NAME.wgsl`.
    pub name: &'static str,
    pub unit: &'static str,
    pub about: &'static str,
    pub source: Source,
}

/// Where a column's values come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Position, velocity and id: always there.
    State,
    /// Measured at the end of a frame, by a pass that runs only when somebody asks for the column.
    Measured,
    /// The neighbor search.
    Search,
    /// Files that a run has left, when its particles are drawn again.
    Given,
}

const fn column(name: &'static str, unit: &'static str, about: &'static str, source: Source) -> Column {
    Column {
        name,
        unit,
        about,
        source,
    }
}

/// Every column there is.
pub const COLUMNS: &[Column] = &[
    column("speed", "m/s", "magnitude of the velocity", Source::State),
    column(
        "x",
        "m",
        "position along x, in the scene's coordinates",
        Source::State,
    ),
    column(
        "y",
        "m",
        "position along y, in the scene's coordinates",
        Source::State,
    ),
    column(
        "z",
        "m",
        "position along z, in the scene's coordinates",
        Source::State,
    ),
    column("velocity_x", "m/s", "velocity along x", Source::State),
    column("velocity_y", "m/s", "velocity along y", Source::State),
    column("velocity_z", "m/s", "velocity along z", Source::State),
    column(
        "id",
        "",
        "the particle's number, stable during the run",
        Source::State,
    ),
    column(
        "contacts",
        "",
        "grains and walls that touch the grain; particles that a fluid particle's kernel reaches",
        Source::Measured,
    ),
    column(
        "density",
        "kg/m³",
        "mass of the grains in the block of voxels around, over the block's volume; of a fluid, its density",
        Source::Measured,
    ),
    column(
        "pressure",
        "Pa",
        "sum of the normal contact forces over the grain's surface; of a fluid, its pressure",
        Source::Measured,
    ),
    column(
        "material",
        "",
        "which of several fluids the particle belongs to, in the order of fluid.materials",
        Source::State,
    ),
    column(
        "slice",
        "",
        "voxel coordinate along the slicing axis",
        Source::Search,
    ),
];

/// Vectors, which particle files keep whole: one row per particle.
pub const VECTORS: &[Column] = &[
    column(
        "position",
        "m",
        "where the grain's center is, in the scene's coordinates",
        Source::State,
    ),
    column("velocity", "m/s", "velocity of the grain's center", Source::State),
];

/// The column with this name.
pub fn find(name: &str) -> Option<Column> {
    COLUMNS.iter().copied().find(|column| column.name == name)
}
