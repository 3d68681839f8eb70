//! Columns: values that every particle has and that can be drawn, written or logged. Registered once, in [`COLUMNS`].

use std::sync::LazyLock;

use super::field::{FIELDS, Field, Kind};

/// One value per particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name in scene files, on the command line, and of the shader file `render/columns/NAME.wgsl` where it is no field of one number.
    pub name: &'static str,
    pub unit: &'static str,
    pub about: &'static str,
    pub source: Source,
}

impl Column {
    /// Whether it has a buffer of its name that nothing else needs on the host.
    pub fn is_field(&self) -> bool {
        matches!(self.source, Source::Field | Source::Measured)
    }
}

/// Where a column's values come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Position, velocity and id: always there.
    State,
    /// A field that only some scenes have.
    Field,
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

/// Columns that follow from position and velocity.
const DERIVED: &[Column] = &[
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
];

/// What the neighbor search knows of a particle.
const SLICE: Column = column(
    "slice",
    "",
    "voxel coordinate along the slicing axis",
    Source::Search,
);

/// Every column there is: those that follow from others, and fields ([`super::field`]) of one number.
pub static COLUMNS: LazyLock<Vec<Column>> = LazyLock::new(|| {
    let derived = DERIVED.iter().copied();
    derived
        .chain(columns_of(|kind| kind != Kind::Vector))
        .chain([SLICE])
        .collect()
});

/// Vectors, which particle files keep whole: one row per particle.
pub static VECTORS: LazyLock<Vec<Column>> =
    LazyLock::new(|| columns_of(|kind| kind == Kind::Vector).collect());

fn columns_of(is_wanted: fn(Kind) -> bool) -> impl Iterator<Item = Column> {
    let fields = FIELDS.iter().filter(move |field| is_wanted(field.kind));
    fields.filter_map(Field::column)
}

/// Of grains of several sizes: files that say where these are say how large they are too.
pub static RADIUS: LazyLock<Column> = LazyLock::new(|| find("radius").expect("a field of that name"));

/// The column with this name.
pub fn find(name: &str) -> Option<Column> {
    COLUMNS.iter().copied().find(|column| column.name == name)
}
