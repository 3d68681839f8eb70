//! What `sliceflow resume` needs to make a run again: kept in `run.json`, read back from there.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::retry::Retry;
use crate::error::{Error, Result};
use crate::files;
use crate::scene::{Scene, library, load};

/// A run, as it was asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Configuration {
    /// The run's identity, which stays when it is resumed or made longer; a variant gets its own.
    pub run_id: String,
    /// The scene file's text, to the letter, so that every number is read as it was.
    pub scene_text: String,
    /// Name of the scene file, as it was given.
    pub scene_file: String,
    /// Where paths in the scene start from; null for the scenes that ship.
    pub scene_folder: Option<PathBuf>,
    /// `--set` and what other arguments changed in the scene.
    pub overrides: Vec<String>,
    /// Meshes and particle files that the scene names.
    pub inputs: Vec<Input>,
    /// What `sliceflow run` was called with: it says which files to write.
    pub arguments: Vec<String>,
    /// Where relative paths among the arguments start from.
    pub working_folder: PathBuf,
    /// The first frame in the folder: 0, or where a variant begins.
    pub first_frame: u32,
    /// Folder of the run that this is a variant of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variant_of: Option<PathBuf>,
}

/// A mesh or particle file that the scene names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Input {
    /// Its path, as the scene writes it.
    pub file: String,
    /// SHA-256 of what it held when the run began.
    pub sha256: String,
}

/// What of a run's manifest is read back.
#[derive(Debug, Clone, Deserialize)]
pub struct Recorded {
    #[serde(skip)]
    pub folder: PathBuf,
    pub status: String,
    pub frames_done: u32,
    pub wall_s: f64,
    /// Unknown, and taken as none, in runs of earlier versions.
    #[serde(default)]
    pub boundary_particles: usize,
    /// Absent where frames were drawn from another run's particles.
    #[serde(alias = "recipe")]
    pub configuration: Option<Configuration>,
    /// That other run.
    pub drawn_from: Option<PathBuf>,
    /// When it went back with half the step.
    #[serde(default)]
    pub retries: Vec<Retry>,
}

impl Configuration {
    pub fn new(scene: &Scene, arguments: &[String]) -> Result<Self> {
        let written = &scene.written;
        let ships = library::folder_for(&written.text).is_ok_and(|folder| folder == written.folder);
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let mut hash = Sha256::new();
        hash.update(&written.text);
        for one in &written.overrides {
            hash.update([0]);
            hash.update(one);
        }
        Ok(Self {
            run_id: hex(&hash.finalize()),
            scene_text: written.text.clone(),
            scene_file: written.file_name.clone(),
            scene_folder: (!ships).then(|| absolute(&written.folder)),
            overrides: written.overrides.clone(),
            inputs: inputs(scene)?,
            arguments: arguments.to_vec(),
            working_folder: std::env::current_dir().unwrap_or_default(),
            first_frame: 0,
            variant_of: None,
        })
    }

    /// The scene, with more overrides.
    pub fn scene(&self, more: &[String]) -> Result<Scene> {
        let folder = match &self.scene_folder {
            Some(folder) => folder.clone(),
            None => library::folder_for(&self.scene_text)?,
        };
        let overrides = [self.overrides.as_slice(), more].concat();
        load::parse(&self.scene_text, &self.scene_file, &folder, &overrides)
    }

    /// The same, refusing files that have changed since the run began.
    pub fn scene_unchanged(&self, more: &[String]) -> Result<Scene> {
        let scene = self.scene(more)?;
        for found in inputs(&scene)? {
            let was = self.inputs.iter().find(|input| input.file == found.file);
            if was.is_some_and(|was| was.sha256 != found.sha256) {
                return Err(Error::usage(
                    format!("{} has changed since the run began", found.file),
                    "put it back as it was, or start a new run",
                ));
            }
        }
        Ok(scene)
    }
}

impl Recorded {
    /// Reads `run.json` in a run's folder.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join("run.json");
        let text = files::read(&path).map_err(|reason| {
            let help = "give the folder of a run: what `sliceflow run` wrote with --out";
            Error::file(&path, "read", reason, help)
        })?;
        let mut recorded: Self = serde_json::from_slice(&text).map_err(|reason| {
            let help = "it is not as `sliceflow run` writes it; start a new run";
            Error::file(&path, "understand", reason, help)
        })?;
        recorded.folder = folder.to_owned();
        Ok(recorded)
    }

    /// What the run was asked for.
    pub fn configuration(&self) -> Result<&Configuration> {
        let folder = self.folder.display();
        self.configuration.as_ref().ok_or_else(|| match &self.drawn_from {
            Some(from) => Error::usage(
                format!(
                    "{folder} holds no simulation: it was drawn from {}",
                    from.display()
                ),
                format!("give {} instead", from.display()),
            ),
            None => Error::usage(
                format!("{folder} was written by a version that could not resume"),
                "start a new run",
            ),
        })
    }
}

fn inputs(scene: &Scene) -> Result<Vec<Input>> {
    let input = |file: &str| {
        let path = scene.written.folder.join(file);
        let bytes = files::read(&path)
            .map_err(|reason| Error::file(&path, "read", reason, "put it back where the scene names it"))?;
        Ok(Input {
            file: file.to_owned(),
            sha256: hex(&Sha256::digest(bytes)),
        })
    };
    scene.file.files().into_iter().map(input).collect()
}

/// Bytes as hexadecimal text.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
