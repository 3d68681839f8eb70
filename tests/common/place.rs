//! A folder with a scene, and the program run in it.

// Each test program uses a part.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;

/// A scene with everything that may be lost between two frames: an emitter, a moving obstacle, a change of gravity, samples of
/// sensors.
const SCENE: &str = r#"{
  "dimensions": 2,
  "domain": { "min": [-0.3, -0.3], "max": [0.3, 0.4] },
  "grains": { "radius": 0.01, "density": 1000, "spring": 2000, "restitution": 0.6 },
  "bodies": [ { "shape": { "kind": "box", "min": [-0.25, 0], "max": [0.1, 0.3] }, "jitter": 0.01, "spacing": 0.0205 } ],
  "colliders": [
    { "name": "ball", "shape": { "kind": "sphere", "center": [0, -0.2], "radius": 0.06 },
      "path": [ { "at": 0, "offset": [0, 0] }, { "at": 0.1, "offset": [0.1, 0] } ] }
  ],
  "emitters": [ { "name": "tap", "center": [0.2, 0.3], "velocity": [0, -1], "radius": 0.05 } ],
  "events": [ { "at": 0.05, "set": { "gravity": [3, -9] } } ],
  "sensors": [
    { "name": "ball", "kind": "force", "obstacle": "ball" },
    { "name": "fastest", "kind": "extremes", "field": "speed" },
    { "name": "layers", "kind": "profile", "axis": "y", "layers": 5 }
  ],
  "time": { "duration": 0.12, "fps": 200, "integrator": "velocity_verlet", "sensor_interval": 0.002 },
  "render": { "size": [160, 120] }
}"#;
pub const FRAMES: u32 = 25;

pub struct Place {
    temporary: tempfile::TempDir,
}

impl Place {
    pub fn new() -> Self {
        let temporary = tempfile::tempdir().unwrap();
        fs::write(temporary.path().join("scene.json"), SCENE).unwrap();
        Self { temporary }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.temporary.path().join(name)
    }

    pub fn sliceflow(&self, args: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
        command.current_dir(self.temporary.path()).args(args);
        command.args(["--progress", "plain"]);
        command
    }

    /// A run that writes one checkpoint, at its end, unless `more` says otherwise: on a slow machine, more minutes
    /// would mean more of them.
    pub fn run(&self, out: &str, more: &[&str]) -> Command {
        let args = ["run", "scene.json", "--out", out, "--particles", "npy"];
        let at_the_end = ["--checkpoint-every", "1000000"];
        let checkpoints = match more.contains(&"--checkpoint-every") {
            true => &[][..],
            false => &at_the_end,
        };
        self.sliceflow(&[&args, checkpoints, more].concat())
    }

    /// Standard error of a command that ends with this status.
    pub fn told(&self, command: &mut Command, status: i32) -> String {
        let output = command.output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{told}");
        told
    }

    pub fn files(&self, run: &str) -> BTreeMap<String, Vec<u8>> {
        let root = self.path(run);
        let mut found = BTreeMap::new();
        let mut folders = vec![root.clone()];
        while let Some(inside) = folders.pop() {
            for entry in fs::read_dir(inside).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(&root).unwrap().display().to_string();
                if path.is_dir() {
                    folders.push(path);
                } else if name != "run.json" && !name.starts_with("checkpoint_") {
                    found.insert(name, fs::read(path).unwrap());
                }
            }
        }
        found
    }

    /// Frames, particle files and statistics of two runs from frame `first` on are the same bytes, and nothing is
    /// missing or too much.
    pub fn assert_same(&self, one: &str, two: &str, what: &str) {
        let (one, two) = (self.files(one), self.files(two));
        assert_eq!(
            one.keys().collect::<Vec<_>>(),
            two.keys().collect::<Vec<_>>(),
            "{what}"
        );
        for (name, bytes) in &one {
            assert!(bytes == &two[name], "{what}: {name} differs");
        }
    }

    pub fn manifest(&self, run: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(run).join("run.json")).unwrap()).unwrap()
    }

    pub fn checkpoints(&self, run: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(run)).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|n| n.starts_with("checkpoint_")).collect();
        names.sort();
        names
    }
}

pub fn start(command: &mut Command) -> Child {
    command.stderr(Stdio::null()).spawn().unwrap()
}

/// Waits until a run has made a file or folder, or has ended, however long that takes.
pub fn wait_for(path: &Path, run: &mut Child) {
    while !path.exists() && run.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(2));
    }
}
