//! From a path or the name of a scene that ships to a [`Scene`].

use std::path::Path;

use serde_json::{Value, json};

use super::model::SceneFile;
use super::validate::validate;
use super::{Scene, Written, check, json as json_text, library, set};
use crate::error::{Error, Problem, Result};

/// Loads a scene file, or a scene that ships when no file has this path. `overrides` are `path=value`.
pub fn load(path: &Path, overrides: &[String]) -> Result<Scene> {
    if path.is_file() {
        let text = std::fs::read_to_string(path).map_err(|reason| {
            Error::file(
                path,
                "read",
                reason,
                "check that it is UTF-8 text and that you may read it",
            )
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        return parse(&text, &path.display().to_string(), folder, overrides);
    }
    let name = path.to_string_lossy();
    match library::find(&name) {
        Some(text) => parse(text, &format!("{name}.json"), &library::folder()?, overrides),
        None => Err(library::unknown(&name)),
    }
}

/// Parses a scene's JSON. `file_name` is for messages and the scene's name; paths in the scene start from `folder`.
pub fn parse(text: &str, file_name: &str, folder: &Path, overrides: &[String]) -> Result<Scene> {
    let mut scene = scene(text, file_name, folder, overrides).map_err(|problems| Error::Scene {
        file: file_name.to_string(),
        problems,
    })?;
    scene.written = Written {
        text: text.to_owned(),
        file_name: file_name.to_owned(),
        folder: folder.to_owned(),
        overrides: overrides.to_vec(),
    };
    Ok(scene)
}

fn scene(
    text: &str,
    file_name: &str,
    folder: &Path,
    overrides: &[String],
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
    validate(file, folder)
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
