//! Which files of a folder a run has written, by what its manifest says. A name alone proves nothing: somebody else may have
//! a `frame_000123.png` too.

use std::collections::BTreeSet;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;

use serde::Deserialize;

use super::folder::{POST_MORTEM, numbered};
use super::manifest::Files;
use super::{bodies, disk, sensors};
use crate::error::Result;
use crate::files;
use crate::scene::column::{COLUMNS, VECTORS};

/// Stands for a frame's number in names of the manifest.
const NUMBER: &str = "NNNNNN";
/// What frames' files begin with.
const KINDS: [&str; 4] = ["frame_", "particles_", "checkpoint_", "surface_"];
/// What other files of runs begin with.
const OTHERS: [&str; 7] = [
    "run.json",
    POST_MORTEM,
    "stats.jsonl",
    "particles.pvd",
    "sensor",
    bodies::NAME,
    ".sliceflow",
];

/// Files that a run has written, or will write.
#[derive(Debug, Default)]
pub struct Record {
    /// As in the manifest.
    names: BTreeSet<String>,
    /// Numbers of the frames; `None` for any, in manifests of earlier versions.
    frames: Option<RangeInclusive<u32>>,
}

/// What of a manifest is read.
#[derive(Deserialize)]
struct Manifest {
    program: String,
    files: Vec<Name>,
    first_frame: Option<u32>,
    last_frame: Option<u32>,
}

#[derive(Deserialize)]
struct Name {
    name: String,
}

impl Record {
    pub fn new(files: &[Files], frames: RangeInclusive<u32>) -> Self {
        Self {
            names: files.iter().map(|file| file.name.clone()).collect(),
            frames: Some(frames),
        }
    }

    /// What the manifest in a folder says; nothing where there is none that Sliceflow has written.
    pub fn read(folder: &Path) -> Self {
        let text = files::read(&folder.join("run.json")).unwrap_or_default();
        match serde_json::from_slice::<Manifest>(&text) {
            Ok(manifest) if manifest.program == env!("CARGO_PKG_NAME") => Self {
                names: manifest.files.into_iter().map(|file| file.name).collect(),
                frames: manifest
                    .first_frame
                    .zip(manifest.last_frame)
                    .map(|(first, last)| first..=last),
            },
            _ => Self::default(),
        }
    }

    /// Whether the run has written a file of this name, or half of it. Names are as [`names`] gives them.
    pub fn has(&self, name: &str) -> bool {
        let name = name.strip_suffix(".part").unwrap_or(name);
        if name == "run.json" {
            return self.names.contains(name);
        }
        if let Some(frame) = frame_of(name) {
            let is_made = self.frames.as_ref().is_none_or(|frames| frames.contains(&frame));
            return is_made && self.has_kind(name);
        }
        self.names.contains(name) || self.has_chart(name)
    }

    fn has_kind(&self, name: &str) -> bool {
        let digits = |c: char| c.is_ascii_digit();
        let Some((kind, rest)) = name.split_once('_') else {
            return false;
        };
        let pattern = format!("{kind}_{NUMBER}{}", rest.trim_start_matches(digits));
        let column = pattern
            .split_once('/')
            .and_then(|(_, file)| file.strip_suffix(".npy"));
        match column {
            Some(column) => {
                let mut known = VECTORS.iter().chain(COLUMNS.iter());
                known.any(|known| known.name == column)
                    && self.names.contains(&format!("{kind}_{NUMBER}/COLUMN.npy"))
            }
            None => self.names.contains(&pattern),
        }
    }

    /// Charts stand beside their tables.
    fn has_chart(&self, name: &str) -> bool {
        let Some(stem) = name.strip_suffix(".png") else {
            return false;
        };
        let is_of_all = sensors::chart_names().any(|chart| chart == name);
        self.names.contains(&format!("{stem}.csv")) || is_of_all && self.names.contains("sensors.csv")
    }
}

/// Files in a run's folder, in its folders of arrays and in that of a post-mortem: `run.json`, `particles_000007/id.npy`. Links are among them, and
/// are not followed.
pub fn names(folder: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for (name, is_folder) in entries(folder)? {
        match is_folder {
            false => found.push(name),
            true if name == POST_MORTEM || numbered(&name, "particles_", "").is_some() => {
                let inside = entries(&folder.join(&name))?.into_iter();
                found.extend(inside.map(|(file, _)| format!("{name}/{file}")));
            }
            true => {}
        }
    }
    found.sort_unstable();
    Ok(found)
}

fn entries(folder: &Path) -> Result<Vec<(String, bool)>> {
    let failed = |reason| disk::failed(folder, "list", reason);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let is_folder = entry.file_type().map_err(failed)?.is_dir();
        // A name that is no text is none of ours.
        if let Ok(name) = entry.file_name().into_string() {
            found.push((name, is_folder));
        }
    }
    Ok(found)
}

/// Whether a run could have written a file of this name.
pub fn is_like_ours(name: &str) -> bool {
    frame_of(name).is_some() || OTHERS.iter().any(|other| name.starts_with(other))
}

/// 12 of `frame_000012.png`, `particles_000012/id.npy`, `checkpoint_000012.bin.part` and their like.
pub fn frame_of(name: &str) -> Option<u32> {
    let rest = KINDS.iter().find_map(|kind| name.strip_prefix(kind))?;
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, behind) = rest.split_at(end);
    let is_ours = digits.len() >= 6 && (behind.is_empty() || behind.starts_with(['.', '/']));
    is_ours.then(|| digits.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(names: &[&str], frames: RangeInclusive<u32>) -> Record {
        let file = |name: &&str| Files {
            name: (*name).into(),
            about: String::new(),
        };
        Record::new(&names.iter().map(file).collect::<Vec<_>>(), frames)
    }

    #[test]
    fn a_record_has_kinds_frames_and_columns() {
        let all = [
            "run.json",
            "frame_NNNNNN.png",
            "particles_NNNNNN/COLUMN.npy",
            "sensors.csv",
        ];
        let run = record(&all, 2..=9);
        for name in [
            "run.json",
            "frame_000002.png",
            "frame_000009.png.part",
            "particles_000003/position.npy",
            "particles_000003/id.npy.part",
            "sensors.csv",
            "sensors_pressure.png",
        ] {
            assert!(run.has(name), "{name}");
        }
        for name in [
            "frame_000001.png",
            "frame_000123.png",
            "frame_000002.jpg",
            "my_frame_000002.png",
            "particles_000003/mine.npy",
            "particles_000003/mine.txt",
            "particles_000003.ply",
            "surface_000003.ply",
            "checkpoint_000003.bin",
            "stats.jsonl",
            "sensors_of_mine.png",
            "sensor_gate.png",
        ] {
            assert!(!run.has(name), "{name}");
        }
    }

    #[test]
    fn the_manifest_of_another_program_says_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        let text = r#"{"program":"NAME","files":[{"name":"run.json"},{"name":"frame_NNNNNN.png"}],"first_frame":0,"last_frame":3}"#;
        for (program, expected) in [("sliceflow", true), ("other", false)] {
            fs::write(&path, text.replace("NAME", program)).unwrap();
            let record = Record::read(folder.path());
            assert_eq!(
                (record.has("frame_000003.png"), record.has("frame_000004.png")),
                (expected, false)
            );
        }
        fs::write(&path, "[]").unwrap();
        assert!(!Record::read(folder.path()).has("run.json"));
    }
}
