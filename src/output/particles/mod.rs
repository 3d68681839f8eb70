//! Particle files: every n-th frame, rows in order of `id`, in each format of [`FORMATS`] that was asked for.

mod bgeo;
mod cloud;
mod formats;
pub(super) mod found;
mod ply;
mod pvd;
#[cfg(test)]
mod tests;
mod vtk;

use std::sync::Arc;
use std::time::{Duration, Instant};

use cloud::Moment;
pub use formats::{FORMATS, Format};

use super::Sink;
use super::folder::Folder;
use super::manifest::Files;
use super::text::metres;
use super::workers::Workers;
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::column::{COLUMNS, Column, VECTORS};
use crate::scene::synonyms::suggest_word;
use crate::simulation::frame::Frame;

/// What particle files hold unless `--columns` says otherwise.
pub const DEFAULT_COLUMNS: &[&str] = &["position", "velocity", "id", "density", "pressure", "contacts"];

/// Threads that encode and write; files are large, and one disk takes them.
const THREADS: usize = 2;
/// Between two updates of the index of a run that goes on.
const INDEX_PAUSE: Duration = Duration::from_secs(5);
/// Share of a grain's radius that coordinates in single precision may be off by before it is told.
const COARSE: f64 = 0.01;

/// The columns with these names, each once.
pub fn columns_named<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Vec<Column>> {
    let mut columns: Vec<Column> = Vec::new();
    for name in names {
        let found = VECTORS
            .iter()
            .chain(COLUMNS.iter())
            .find(|column| column.name == name)
            .ok_or_else(|| {
                let known = VECTORS.iter().chain(COLUMNS.iter()).map(|column| column.name);
                Error::usage(format!("no column is named `{name}`"), suggest_word(name, known))
            })?;
        if !columns.contains(found) {
            columns.push(*found);
        }
    }
    Ok(columns)
}

/// Which particle files a run writes.
#[derive(Debug, Clone)]
pub struct ParticleOutput {
    pub formats: Vec<&'static Format>,
    pub columns: Vec<Column>,
    /// Of frames 0, 1, 2, … every n-th gets files: 0, n, 2n, …
    pub every: u32,
}

impl ParticleOutput {
    /// Files of points hold positions whether `columns` names them or not.
    pub fn new(formats: Vec<&'static Format>, mut columns: Vec<Column>, every: u32) -> Self {
        let position = VECTORS[0];
        if formats.iter().any(|format| format.is_points) && !columns.contains(&position) {
            columns.insert(0, position);
        }
        Self {
            formats,
            columns,
            every,
        }
    }

    /// Has files hold this column too.
    pub fn add(&mut self, column: Column) {
        if !self.columns.contains(&column) {
            self.columns.push(column);
        }
    }

    /// Frames of a run that get files.
    pub fn frames(&self, frames: u32) -> u32 {
        frames.div_ceil(self.every)
    }

    /// Bytes of one frame's files, at most.
    pub fn frame_bytes(&self, particles: u32) -> f64 {
        let row = |format: &&Format| -> usize {
            let bytes = |column: &Column| match column.name {
                "position" => format.position_bytes,
                _ if VECTORS.contains(column) => 12,
                _ => 4,
            };
            self.columns.iter().map(bytes).sum()
        };
        let rows: usize = self.formats.iter().map(row).sum();
        f64::from(particles) * rows as f64
    }

    /// For the manifest.
    pub fn files(&self) -> Vec<Files> {
        let names: Vec<_> = self.columns.iter().map(|column| column.name).collect();
        let which = match self.every {
            1 => String::new(),
            n => format!(", of frames 0, {n}, {} …", 2 * n),
        };
        let about = format!(
            "particles of a frame{which}, in order of id: {}",
            names.join(", ")
        );
        let mut files = Vec::new();
        for format in &self.formats {
            files.push(Files {
                name: format.file.into(),
                about: about.clone(),
            });
            if format.index.is_some() {
                files.push(Files {
                    name: "particles.pvd".into(),
                    about: "the VTK files with their times".into(),
                });
            }
        }
        files
    }

    /// What to mind about these files: single precision is coarse far from zero.
    pub fn warning(&self, scene: &Scene) -> Option<String> {
        let names: Vec<_> = self
            .formats
            .iter()
            .filter(|f| f.is_single_precision)
            .map(|f| f.name)
            .collect();
        let corners = [scene.domain.min, scene.domain.max].map(|corner| corner.as_dvec3() + scene.origin);
        let far = corners.iter().map(|c| c.abs().max_element()).fold(0.0, f64::max);
        let step = far * f64::from(f32::EPSILON);
        (!names.is_empty() && step > COARSE * scene.radius()).then(|| {
            format!(
                "{} keep coordinates in single precision, which resolves {} so far from zero; --particles vtk and npy \
                 keep double precision",
                names.join(" and "),
                metres(step)
            )
        })
    }
}

/// Writes the files of every frame that is due.
pub struct ParticleFiles {
    folder: Arc<Folder>,
    output: ParticleOutput,
    fps: f64,
    workers: Workers,
    indexed: Instant,
}

impl ParticleFiles {
    pub fn new(folder: Arc<Folder>, output: ParticleOutput, scene: &Scene) -> Self {
        Self {
            folder,
            output,
            fps: scene.time.fps,
            workers: Workers::new(THREADS),
            indexed: Instant::now(),
        }
    }

    fn write_index(&mut self) -> Result<()> {
        self.indexed = Instant::now();
        self.output
            .formats
            .iter()
            .filter_map(|format| format.index)
            .try_for_each(|index| index(self.folder.path(), self.fps))
    }
}

impl Sink for ParticleFiles {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        if !frame.index.is_multiple_of(self.output.every) {
            return Ok(());
        }
        for format in &self.output.formats {
            let (frame, stem) = (frame.clone(), self.folder.particles(frame.index));
            let (write, columns) = (format.write, self.output.columns.clone());
            self.workers
                .submit(move || write(&Moment::new(&frame, &columns), &stem))?;
        }
        if self.indexed.elapsed() > INDEX_PAUSE {
            self.write_index()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<()> {
        self.workers.wait()
    }

    fn finish(&mut self) -> Result<()> {
        let written = self.workers.finish();
        written.and(self.write_index())
    }
}
