//! Scenes of SPlisHSPlasH become scenes of Sliceflow.
//!
//! [`keys`] takes what is understood out of the JSON, so that the rest is what is ignored; [`peer`] reads it into the
//! peer's own terms; [`fluid`] is the one place that decides what a fluid becomes; `convert` does the rest.

mod convert;
mod fluid;
mod keys;
mod peer;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::allowance::Allowance;
use super::{Scene, load, set};
use crate::error::{Error, Result};
use crate::files;

pub use keys::Ignored;

/// What an import gives.
#[derive(Debug)]
pub struct Imported {
    /// A scene file.
    pub json: Value,
    /// The same, loaded.
    pub scene: Scene,
    pub ignored: Vec<Ignored>,
    /// What was decided.
    pub notes: Vec<String>,
}

/// Reads a peer's scene file. Paths in the result start from the folder `into`, or are absolute.
pub fn import(path: &Path, into: Option<&Path>) -> Result<Imported> {
    import_within(path, into, &[], &Allowance::default())
}

/// The same with keys changed (`path=value`), where the result may not be larger than is allowed.
pub fn import_within(
    path: &Path,
    into: Option<&Path>,
    overrides: &[String],
    allowance: &Allowance,
) -> Result<Imported> {
    let help = "give a scene file of SPlisHSPlasH: JSON with Configuration, RigidBodies, FluidBlocks, …";
    let text = files::read_text(path).map_err(|reason| Error::file(path, "read", reason, help))?;
    let value: Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|reason| Error::file(path, "read", reason, help))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut keys = keys::Keys::new(value);
    let peer = peer::read(&mut keys).map_err(|problem| Error::Scene {
        file: path.display().to_string(),
        problems: vec![problem],
    })?;
    let mut ignored = keys.rest();
    let files = Files {
        folder: folder.to_owned(),
        into: into.map(Path::to_owned),
    };
    let mut notes = Vec::new();
    let mut json = convert::convert(&peer, &files, &mut ignored, &mut notes)?;
    // What is lost in the physics comes first.
    ignored.sort_by_key(|ignored| !ignored.changes_physics);
    let is_empty = |key: &str| json[key].as_array().is_none_or(Vec::is_empty);
    if is_empty("bodies") && is_empty("emitters") {
        return Err(nothing_left(path, &ignored));
    }
    let stem = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    json["name"] = stem.clone().into();
    json["source"] = format!(
        "SPlisHSPlasH scene {}",
        path.file_name().unwrap_or_default().display()
    )
    .into();
    for assignment in overrides {
        set::apply(&mut json, assignment).map_err(|problem| Error::Scene {
            file: path.display().to_string(),
            problems: vec![problem],
        })?;
    }
    // Loaded from where it will stand.
    let base = into.map_or_else(PathBuf::new, Path::to_owned);
    let scene = load::parse_within(
        &json.to_string(),
        &format!("{stem}, imported"),
        &base,
        &[],
        allowance,
    )?;
    notes.extend(scene.notes.iter().cloned());
    Ok(Imported {
        json,
        scene,
        ignored,
        notes,
    })
}

/// The error for a scene without particles, which lists what was ignored.
fn nothing_left(path: &Path, ignored: &[Ignored]) -> Error {
    let list: String = ignored
        .iter()
        .map(|ignored| format!("\n  ignored: {ignored}"))
        .collect();
    Error::usage(
        format!(
            "{}: it has no fluid that can be imported, so no particles remain{list}",
            path.display()
        ),
        "give it FluidBlocks, FluidModels or Emitters",
    )
}

/// Where the peer's files are, and how the new scene names them.
struct Files {
    folder: PathBuf,
    into: Option<PathBuf>,
}

impl Files {
    fn find(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The name for the new scene.
    fn name(&self, name: &str) -> Result<String> {
        let path = self.find(name);
        let real = |path: &Path| {
            std::path::absolute(path)
                .and_then(std::fs::canonicalize)
                .map_err(|reason| Error::file(path, "find", reason, "it is named in the scene; put it there"))
        };
        let target = real(&path)?;
        let Some(into) = &self.into else {
            return Ok(target.display().to_string());
        };
        Ok(relative(&target, &real(into)?).display().to_string())
    }
}

/// The way from a folder to a file; both absolute.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let shared = file
        .components()
        .zip(folder.components())
        .take_while(|(a, b)| a == b)
        .count();
    let up = folder.components().skip(shared).map(|_| Path::new(".."));
    let down = file
        .components()
        .skip(shared)
        .map(|part| Path::new(part.as_os_str()));
    up.chain(down).collect()
}
