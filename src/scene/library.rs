//! The scenes that ship with the program, with the files they need.

use std::io::Write as _;
use std::path::PathBuf;
use std::sync::OnceLock;

use include_dir::{Dir, File, include_dir};
use sha2::{Digest, Sha256};

use super::{json, load, text};
use crate::error::{Error, Result};
use crate::files;

static SCENES: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/scenes");
static MESHES: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/meshes");

/// One scene that ships.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// What `sliceflow run NAME` takes.
    pub name: String,
    pub description: String,
    pub source: String,
    /// At the end of the run, boundary particles apart.
    pub particles: u32,
}

/// Names of all scenes that ship, sorted.
pub fn names() -> Vec<&'static str> {
    let stems = SCENES
        .files()
        .filter(|file| file.path().extension().is_some_and(|e| e == "json"));
    let mut names: Vec<_> = stems
        .filter_map(|file| file.path().file_stem()?.to_str())
        .collect();
    names.sort_unstable();
    names
}

/// The JSON text of a scene that ships.
pub fn find(name: &str) -> Option<&'static str> {
    SCENES.get_file(format!("{name}.json"))?.contents_utf8()
}

/// Whether a scene that ships has this text, to the letter.
pub fn ships(text: &str) -> bool {
    SCENES.files().any(|file| file.contents() == text.as_bytes())
}

/// A mesh that ships.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// The path as scenes that ship write it.
    pub written: String,
    /// The file's own name.
    pub name: &'static str,
    pub bytes: &'static [u8],
}

/// The meshes that a scene that ships reads; `text` is the scene's.
pub fn meshes_of(text: &str) -> Vec<Mesh> {
    let mesh = |file: &'static File<'static>| {
        let name = file.path().file_name()?.to_str()?;
        let written = format!("../meshes/{name}");
        text.contains(&format!("\"{written}\"")).then_some(Mesh {
            written,
            name,
            bytes: file.contents(),
        })
    };
    MESHES.files().filter_map(mesh).collect()
}

/// All scenes that ship; each is loaded to count its particles.
pub fn entries() -> Result<Vec<Entry>> {
    let entry = |name: &str| {
        let text = find(name).unwrap_or_default();
        let file = json::parse(text).unwrap_or_default();
        let word = |key: &str| file[key].as_str().unwrap_or_default().to_string();
        let scene = load::parse(text, &format!("{name}.json"), &folder_for(text)?, &[])?;
        Ok(Entry {
            name: name.to_string(),
            description: word("description"),
            source: word("source"),
            particles: scene.first_boundary(),
        })
    };
    names().into_iter().map(entry).collect()
}

/// The error for a name that is neither a file nor a scene that ships.
pub fn unknown(name: &str) -> Error {
    let help = format!(
        "{} (or give the path of a scene file)",
        text::suggest(name, names())
    );
    Error::usage(format!("there is no scene or file \"{name}\""), help)
}

/// The folder that paths in the text of a scene that ships start from: that of [`folder`], where it names files. One that
/// names none needs no folder that can be written.
pub fn folder_for(text: &str) -> Result<PathBuf> {
    match meshes_of(text).is_empty() {
        true => Ok(folder().unwrap_or_else(|_| place())),
        false => folder(),
    }
}

/// The folder that paths in scenes that ship start from. What they name is unpacked once into the system's folder for
/// temporary files, under a name that changes with the content.
pub fn folder() -> Result<PathBuf> {
    static UNPACKED: OnceLock<PathBuf> = OnceLock::new();
    if let Some(folder) = UNPACKED.get() {
        return Ok(folder.clone());
    }
    let scenes = place();
    let root = scenes.parent().unwrap_or(&scenes).to_owned();
    let meshes = root.join("meshes");
    let unpack = || {
        std::fs::create_dir_all(&scenes)?;
        std::fs::create_dir_all(&meshes)?;
        for file in MESHES.files() {
            let target = meshes.join(file.path());
            if std::fs::read(&target).is_ok_and(|present| present == file.contents()) {
                continue;
            }
            // Renamed into place, so that a second program never reads half a file.
            let partial = target.with_extension(format!("partial-{}", std::process::id()));
            files::create(&partial)?.write_all(file.contents())?;
            std::fs::rename(&partial, &target)?;
        }
        Ok(())
    };
    unpack().map_err(|reason: std::io::Error| {
        Error::file(
            &root,
            "unpack meshes into",
            reason,
            "free space there, or set TMPDIR to a folder you may write",
        )
    })?;
    Ok(UNPACKED.get_or_init(|| scenes).clone())
}

/// Where [`folder`] is, whether it can be made or not.
fn place() -> PathBuf {
    let mut hash = Sha256::new();
    for file in MESHES.files() {
        hash.update(file.path().as_os_str().as_encoded_bytes());
        hash.update(file.contents());
    }
    let tag: String = hash
        .finalize()
        .iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let root = std::env::temp_dir().join(format!("sliceflow-assets-{tag}"));
    root.join("scenes")
}
