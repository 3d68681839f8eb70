//! From a path or the name of a scene that ships to a [`Scene`].

use std::path::Path;

use serde_json::{Value, json};

use super::allowance::Allowance;
use super::model::SceneFile;
use super::validate::validate;
use super::{Scene, Written, check, json as json_text, library, set};
use crate::error::{Error, Problem, Result};
use crate::files;

/// Of a scene's text: particles are in other files.
const MOST_BYTES: u64 = 16 << 20;

/// Loads a scene file, or a scene that ships when no file has this path. `overrides` are `path=value`. The scene is
/// trusted: files that it names may lie anywhere.
pub fn load(path: &Path, overrides: &[String]) -> Result<Scene> {
    load_within(path, overrides, &Allowance::default())
}

/// The same, of a scene that is not trusted; a file that one of the overrides names may lie anywhere.
pub fn load_within(path: &Path, overrides: &[String], allowance: &Allowance) -> Result<Scene> {
    if path.is_file() {
        let length = path.metadata().map_or(0, |file| file.len());
        if length > MOST_BYTES {
            return Err(Error::file(
                path,
                "read",
                format!("it has {length} bytes, and a scene at most {MOST_BYTES}"),
                "put particles and meshes into files of their own, which the scene names",
            ));
        }
        let text = files::read_text(path).map_err(|reason| {
            Error::file(
                path,
                "read",
                reason,
                "check that it is UTF-8 text and that you may read it",
            )
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let allowance = &Allowance {
            // A copy of one that ships is as good.
            folders: allowance.folders.clone().filter(|_| !library::ships(&text)),
            ..allowance.clone()
        };
        return parse_within(&text, &path.display().to_string(), folder, overrides, allowance);
    }
    let name = path.to_string_lossy();
    let Some(text) = library::find(&name) else {
        return Err(library::unknown(&name));
    };
    // What it names besides comes from the command line.
    let allowance = Allowance {
        folders: None,
        ..allowance.clone()
    };
    let file_name = format!("{name}.json");
    parse_within(
        text,
        &file_name,
        &library::folder_for(text)?,
        overrides,
        &allowance,
    )
}

/// Parses a scene's JSON. `file_name` is for messages and the scene's name; paths in the scene start from `folder`, and may
/// lead anywhere: such a scene is trusted.
pub fn parse(text: &str, file_name: &str, folder: &Path, overrides: &[String]) -> Result<Scene> {
    parse_within(text, file_name, folder, overrides, &Allowance::default())
}

/// The same, of a scene that is not trusted.
pub fn parse_within(
    text: &str,
    file_name: &str,
    folder: &Path,
    overrides: &[String],
    allowance: &Allowance,
) -> Result<Scene> {
    let mut scene =
        scene(text, file_name, folder, overrides, allowance).map_err(|problems| Error::Scene {
            file: file_name.to_string(),
            problems,
        })?;
    scene.written = Written {
        text: text.to_owned(),
        file_name: file_name.to_owned(),
        folder: folder.to_owned(),
        overrides: overrides.to_vec(),
        allowance: allowance.clone(),
    };
    Ok(scene)
}

fn scene(
    text: &str,
    file_name: &str,
    folder: &Path,
    overrides: &[String],
    allowance: &Allowance,
) -> std::result::Result<Scene, Vec<Problem>> {
    let mut value = json(text).map_err(|problem| vec![problem])?;
    let failed: Vec<_> = overrides
        .iter()
        .filter_map(|one| set::apply(&mut value, one).err())
        .collect();
    if !failed.is_empty() {
        return Err(failed);
    }
    let problems = check::check(&value, &schema());
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut file: SceneFile = serde_json::from_value(value).map_err(|reason| {
        vec![Problem::new(
            "",
            reason.to_string(),
            "compare the scene with `sliceflow schema`",
        )]
    })?;
    if file.name.is_empty() {
        let stem = Path::new(file_name).file_stem().unwrap_or_default();
        file.name = stem.to_string_lossy().into_owned();
    }
    let mut allowance = allowance.clone();
    if let Some(folders) = &mut allowance.folders {
        folders.extend(set::words(overrides).map(|word| folder.join(word)));
    }
    validate(file, folder, allowance)
}

/// A scene's text as JSON, before it is checked.
pub fn json(text: &str) -> std::result::Result<Value, Problem> {
    // Editors on Windows put a byte order mark before the text.
    json_text::parse(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The JSON schema of scene files.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(SceneFile).to_value();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Sliceflow scene");
    schema
}
