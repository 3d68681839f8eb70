//! Two runs, compared: where they begin to differ, by how much, and how the difference grows.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::read_back::{Column, ReadBack};
use super::rewind::numbered;
use crate::error::{Error, Result};
use crate::files;

/// What two runs have in common and in what they differ; A and B are the first and the second.
#[derive(Debug, Default, Serialize)]
pub struct Comparison {
    /// Frames whose particles were compared.
    pub particle_frames: u32,
    /// The first difference of particles: the lowest id of the first frame.
    pub first: Option<First>,
    /// Columns of frames that differ, by frame.
    pub growth: Vec<Growth>,
    /// Frames whose statistics were compared.
    pub statistics_frames: u32,
    /// The first line of statistics that differs.
    pub statistics: Option<Figure>,
    pub picture_frames: u32,
    /// Frames whose pictures are not the same bytes.
    pub pictures: Vec<u32>,
    /// What only one of the runs has.
    pub only: Vec<String>,
}

/// A value of a particle that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct First {
    pub frame: u32,
    /// Its id.
    pub particle: u32,
    pub column: String,
    /// Of a vector: 0 is x.
    pub component: usize,
    pub a: f64,
    pub b: f64,
}

/// How far a column of a frame differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Growth {
    pub frame: u32,
    pub column: String,
    /// Particles that differ.
    pub particles: u32,
    /// The largest difference of a number.
    pub max: f64,
    /// Root of the mean square of the differences of all particles' numbers or vectors.
    pub rms: f64,
}

/// A figure of `stats.jsonl` that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    pub frame: u64,
    pub key: String,
    pub a: Value,
    pub b: Value,
}

impl Comparison {
    pub fn is_equal(&self) -> bool {
        self.growth.is_empty()
            && self.statistics.is_none()
            && self.pictures.is_empty()
            && self.only.is_empty()
    }

    /// Compares particles, statistics and pictures of two runs, as far as both have them.
    pub fn of(a: &Path, b: &Path) -> Result<Self> {
        let mut comparison = Self::default();
        comparison.particles(a, b)?;
        comparison.statistics(a, b)?;
        comparison.pictures(a, b)?;
        let compared = comparison.particle_frames + comparison.statistics_frames + comparison.picture_frames;
        if compared == 0 {
            return Err(Error::usage(
                format!("{} and {} have no frame in common", a.display(), b.display()),
                "give the folders of two runs; the same --particles vtk (or ply, bgeo, npy) in both shows the most",
            ));
        }
        Ok(comparison)
    }

    fn particles(&mut self, a: &Path, b: &Path) -> Result<()> {
        let sources = (ReadBack::open(a)?, ReadBack::open(b)?);
        let frames_a: BTreeSet<u32> = sources.0.frames().collect();
        let frames_b: BTreeSet<u32> = sources.1.frames().collect();
        let mut told = BTreeSet::new();
        for &frame in frames_a.intersection(&frames_b) {
            let (Some(one), Some(two)) = (sources.0.read(frame)?, sources.1.read(frame)?) else {
                continue;
            };
            let mut compared = false;
            for column in &one.columns {
                if let Some(other) = two
                    .column(&column.name)
                    .filter(|other| other.width == column.width)
                {
                    compared = true;
                    self.column(frame, column, other);
                }
            }
            self.particle_frames += u32::from(compared);
            if one.particles() != two.particles() && told.insert("count") {
                let (a, b) = (one.particles(), two.particles());
                self.only
                    .push(format!("frame {frame} has {a} particles in A and {b} in B"));
            }
        }
        Ok(())
    }

    fn column(&mut self, frame: u32, a: &Column, b: &Column) {
        let width = a.width;
        let rows = a.values.chunks_exact(width).zip(b.values.chunks_exact(width));
        let (mut particles, mut max, mut squares) = (0, 0.0f64, 0.0);
        let count = a.particles().min(b.particles());
        // What one file has rounded is compared as such.
        let rounded = |value: f64| match a.is_rounded == b.is_rounded {
            true => value,
            false => f64::from(value as f32),
        };
        for (id, (one, two)) in rows.enumerate() {
            let differs = |i: &usize| rounded(one[*i]).to_bits() != rounded(two[*i]).to_bits();
            let Some(component) = (0..width).find(differs) else {
                continue;
            };
            particles += 1;
            for (x, y) in one.iter().zip(two) {
                let difference = (rounded(*x) - rounded(*y)).abs();
                // Where one is not a number, the difference is as large as can be.
                let difference = if difference.is_nan() {
                    f64::INFINITY
                } else {
                    difference
                };
                max = max.max(difference);
                squares += difference * difference;
            }
            let first = First {
                frame,
                particle: id as u32,
                column: a.name.clone(),
                component,
                a: one[component],
                b: two[component],
            };
            let is_first = |known: &First| (frame, first.particle) < (known.frame, known.particle);
            if self.first.as_ref().is_none_or(is_first) {
                self.first = Some(first);
            }
        }
        if particles > 0 {
            self.growth.push(Growth {
                frame,
                column: a.name.clone(),
                particles,
                max,
                rms: (squares / count as f64).sqrt(),
            });
        }
    }

    fn statistics(&mut self, a: &Path, b: &Path) -> Result<()> {
        let (Some(a), Some(b)) = (lines(a)?, lines(b)?) else {
            return Ok(());
        };
        for one in &a {
            let Some(two) = b.iter().find(|two| two["frame"] == one["frame"]) else {
                continue;
            };
            self.statistics_frames += 1;
            if self.statistics.is_some() {
                continue;
            }
            let keys = one.as_object().into_iter().flatten();
            // Times of passes are never the same twice.
            let differs = keys
                .filter(|(key, _)| *key != "pass_ms")
                .find(|(key, value)| two[*key] != **value);
            self.statistics = differs.map(|(key, value)| Figure {
                frame: one["frame"].as_u64().unwrap_or_default(),
                key: key.clone(),
                a: value.clone(),
                b: two[key].clone(),
            });
        }
        Ok(())
    }

    fn pictures(&mut self, a: &Path, b: &Path) -> Result<()> {
        let (a, b) = (pictures(a)?, pictures(b)?);
        let frames =
            |all: &[(u32, PathBuf)]| -> BTreeSet<u32> { all.iter().map(|(frame, _)| *frame).collect() };
        let in_both = frames(&a);
        for (name, mine, others) in [("A", &a, &b), ("B", &b, &a)] {
            let alone = frames(mine).difference(&frames(others)).count();
            if alone > 0 && !mine.is_empty() && !others.is_empty() {
                self.only.push(format!("{alone} pictures are in {name} only"));
            }
        }
        let read = |path: &Path| {
            files::read(path).map_err(|reason| Error::file(path, "read", reason, "check that folder"))
        };
        for (frame, path) in &b {
            if !in_both.contains(frame) {
                continue;
            }
            self.picture_frames += 1;
            let other = a.iter().find(|(known, _)| known == frame).map(|(_, path)| path);
            if other.map(|other| read(other)).transpose()? != Some(read(path)?) {
                self.pictures.push(*frame);
            }
        }
        Ok(())
    }
}

/// The lines of a run's statistics; `None` where it has none.
fn lines(folder: &Path) -> Result<Option<Vec<Value>>> {
    let path = folder.join("stats.jsonl");
    match files::read_text(&path) {
        Ok(text) => Ok(Some(
            text.lines()
                .filter_map(|line| serde_json::from_str(line).ok())
                .collect(),
        )),
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(reason) => Err(Error::file(&path, "read", reason, "check that folder")),
    }
}

fn pictures(folder: &Path) -> Result<Vec<(u32, PathBuf)>> {
    let mut found = numbered(folder)?;
    found.retain(|(_, path)| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("frame_") && name.ends_with(".png")
    });
    Ok(found)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::output::npy;

    fn run(positions: &[[f32; 6]]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (frame, values) in positions.iter().enumerate() {
            let arrays = folder.path().join(format!("particles_{frame:06}"));
            fs::create_dir(&arrays).unwrap();
            npy::write(&arrays.join("position.npy"), 2, values).unwrap();
            npy::write(&arrays.join("id.npy"), 1, &[0u32, 1, 2]).unwrap();
        }
        folder
    }

    #[test]
    fn names_frame_particle_and_column_and_how_it_grows() {
        let same = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let a = run(&[same, same, same]);
        let b = run(&[
            same,
            [1.0, 2.0, 3.0, 4.5, 5.0, 6.0],
            [1.0, 2.0, 6.0, 8.0, 5.0, 7.0],
        ]);
        let equal = Comparison::of(a.path(), a.path()).unwrap();
        assert!(equal.is_equal() && equal.particle_frames == 3);

        let found = Comparison::of(a.path(), b.path()).unwrap();
        assert!(!found.is_equal());
        let first = found.first.unwrap();
        assert_eq!((first.frame, first.particle, first.component), (1, 1, 1));
        assert_eq!((first.column.as_str(), first.a, first.b), ("position", 4.0, 4.5));
        let growth: Vec<_> = found
            .growth
            .iter()
            .map(|g| (g.frame, g.particles, g.max))
            .collect();
        assert_eq!(growth, [(1, 1, 0.5), (2, 2, 4.0)]);
        assert!((found.growth[1].rms - (26.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn statistics_and_pictures_are_compared_too() {
        let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        assert!(Comparison::of(a.path(), b.path()).is_err(), "nothing to compare");
        for (folder, energy, picture) in [(&a, 1, "x"), (&b, 2, "y")] {
            let lines = format!(
                "{{\"frame\":0,\"energy\":0,\"pass_ms\":{{\"a\":{energy}}}}}\n{{\"frame\":1,\"energy\":{energy}}}\n"
            );
            fs::write(folder.path().join("stats.jsonl"), lines).unwrap();
            fs::write(folder.path().join("frame_000000.png"), "same").unwrap();
            fs::write(folder.path().join("frame_000001.png"), picture).unwrap();
        }
        fs::write(b.path().join("frame_000002.png"), "").unwrap();
        let found = Comparison::of(a.path(), b.path()).unwrap();
        let figure = found.statistics.as_ref().unwrap();
        assert_eq!((figure.frame, figure.key.as_str()), (1, "energy"));
        assert_eq!((found.statistics_frames, found.picture_frames), (2, 2));
        assert_eq!(found.pictures, [1]);
        assert_eq!(found.only, ["1 pictures are in B only"]);
    }
}
