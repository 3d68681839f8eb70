//! Arguments that name a scene and change it. All of them become overrides, so the scene stays the one source of what
//! is run.

use std::path::{Path, PathBuf};

use super::grid;
use super::look_args::LookArgs;
use crate::error::Result;
use crate::files;
use crate::scene::allowance::{Allowance, MOST_PARTICLES};
use crate::scene::{Scene, library, load, model, set};

#[derive(clap::Args)]
pub struct SceneArgs {
    /// Scene file, or name of a scene that ships (see `sliceflow scenes`)
    scene: PathBuf,
    /// Changes a key of the scene: grains.radius=0.01, bodies[0].velocity=[0,1,0] (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Frames per simulated second
    #[arg(long, value_name = "F")]
    fps: Option<f64>,
    /// Seed of every random choice
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Size of pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Refuses scenes of more particles, boundary particles included
    #[arg(long, value_name = "N", default_value_t = MOST_PARTICLES, value_parser = clap::value_parser!(u64).range(1..=MOST_PARTICLES))]
    max_particles: u64,
    /// Refuses scenes that need more memory before the run, for particles and meshes [default: half of the machine's; of
    /// `plan` 500MB]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    max_memory: Option<u64>,
    /// Lets the scene read files in this folder too; without it, those in its own folder and those that --set names
    /// (repeatable)
    #[arg(long, value_name = "DIR")]
    allow_read: Vec<PathBuf>,
    #[command(flatten)]
    looks: LookArgs,
}

/// Choices that not every command leaves to the user.
#[derive(Default)]
pub struct Choices<'a> {
    /// Frames to make, the first state included.
    pub frames: Option<u32>,
    pub grid: Option<&'a str>,
    pub view: Option<&'a str>,
    /// Whether extra images are left out, whatever the scene says.
    pub no_passes: bool,
    /// Bytes that the scene may take where the user does not say.
    pub memory: Option<u64>,
}

impl SceneArgs {
    pub fn load(&self, choices: &Choices) -> Result<Scene> {
        let usual = Allowance::default();
        let allowance = Allowance {
            particles: self.max_particles,
            memory: self.max_memory.or(choices.memory).unwrap_or(usual.memory),
            folders: Some(self.allow_read.clone()),
        };
        load::load_within(&self.scene, &self.overrides(choices)?, &allowance)
    }

    /// The particle file that stands where a scene is expected.
    pub fn particle_file(&self) -> Option<&Path> {
        let ending = self.scene.extension()?.to_string_lossy().to_ascii_lowercase();
        matches!(ending.as_str(), "ply" | "csv" | "npy").then_some(&self.scene)
    }

    /// Whether a key of the scene is changed, which a particle file has not.
    pub fn changes_scene(&self) -> bool {
        !self.set.is_empty()
            || self.fps.is_some()
            || self.seed.is_some()
            || self.size.is_some()
            || self.looks.is_given()
    }

    fn overrides(&self, choices: &Choices) -> Result<Vec<String>> {
        let mut overrides = self.set.clone();
        let mut put = |key: &str, value: Option<String>| {
            overrides.extend(value.map(|value| format!("{key}={value}")));
        };
        put("time.fps", self.fps.map(|fps| fps.to_string()));
        put("seed", self.seed.map(|seed| seed.to_string()));
        put(
            "render.size",
            self.size.map(|[width, height]| format!("[{width},{height}]")),
        );
        self.looks.put(&mut put);
        put("render.passes", choices.no_passes.then(|| "[]".to_owned()));
        put("render.view", choices.view.map(str::to_owned));
        if let Some(name) = choices.grid {
            overrides.extend(grid::overrides(name)?);
        }
        if let Some(frames) = choices.frames {
            let duration = duration(frames, self.written_fps(&overrides));
            overrides.push(format!("time.duration={duration:e}"));
        }
        Ok(overrides)
    }

    /// The scene's frames per second before it is checked: a scene counts time in seconds, `--frames` in frames.
    /// Whatever is wrong with the scene is told when it is loaded.
    fn written_fps(&self, overrides: &[String]) -> f64 {
        let text = match files::read_text(&self.scene) {
            Ok(text) => text,
            Err(_) => library::find(&self.scene.to_string_lossy())
                .unwrap_or_default()
                .to_owned(),
        };
        let mut scene = load::json(&text).unwrap_or_default();
        for one in overrides {
            // A broken override is told by `load`.
            let _ = set::apply(&mut scene, one);
        }
        let fps = scene["time"]["fps"].as_f64().filter(|&fps| fps > 0.0);
        fps.unwrap_or(model::Time::default().fps)
    }
}

/// Seconds whose frames, the first state included, are `frames` many.
pub fn duration(frames: u32, fps: f64) -> f64 {
    // One frame is the first state alone; a scene's duration is never zero.
    f64::from(frames.saturating_sub(1)).max(1e-3) / fps
}

pub fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides = text
        .split_once(['x', 'X', '×'])
        .map(|(w, h)| (w.trim().parse(), h.trim().parse()));
    match sides {
        Some((Ok(width), Ok(height))) if width > 0 && height > 0 => Ok([width, height]),
        _ => Err("write width and height in pixels: 1280x720".into()),
    }
}

/// A number of bytes with a unit: 500MB, 2 GB, 64MiB.
pub fn bytes(text: &str) -> std::result::Result<u64, String> {
    let text = text.trim();
    let unit_at = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_at);
    let factor = match unit.to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "kb" | "k" => 1e3,
        "mb" | "m" => 1e6,
        "gb" | "g" => 1e9,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => return Err("units are kB, MB, GB, KiB, MiB and GiB: 500MB".into()),
    };
    match number.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number * factor < 1e15 => Ok((number * factor) as u64),
        _ => Err("write a size, as in 500MB".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(set: &[&str]) -> SceneArgs {
        SceneArgs {
            scene: "column_2d".into(),
            set: set.iter().map(|&one| one.to_owned()).collect(),
            fps: None,
            seed: None,
            size: None,
            max_particles: MOST_PARTICLES,
            max_memory: None,
            allow_read: Vec::new(),
            looks: LookArgs::default(),
        }
    }

    #[test]
    fn frames_are_as_many_as_asked_for() {
        for (set, frames) in [
            (&[][..], 1),
            (&[], 2),
            (&["time.fps=24"], 30),
            (&["time.fps=59.94"], 600),
        ] {
            let choices = Choices {
                frames: Some(frames),
                ..Choices::default()
            };
            assert_eq!(args(set).load(&choices).unwrap().time.frames, frames, "{set:?}");
        }
    }

    #[test]
    fn flags_win_over_set() {
        let mut args = args(&["time.fps=24", "seed=1"]);
        args.fps = Some(60.0);
        args.seed = Some(7);
        args.size = Some([320, 200]);
        let choices = Choices {
            grid: Some("sliced-pool"),
            view: Some("both"),
            ..Choices::default()
        };
        let scene = args.load(&choices).unwrap();
        assert_eq!(
            (scene.time.fps, scene.file.seed, scene.render.size),
            (60.0, 7, [320, 200])
        );
        assert_eq!(grid::name(&scene.neighbors), "sliced-pool");
        assert_eq!(scene.render.view, model::View::Both);
    }

    #[test]
    fn bytes_have_units() {
        assert_eq!(bytes("500MB"), Ok(500_000_000));
        assert_eq!(bytes("2 GB"), Ok(2_000_000_000));
        assert_eq!(bytes("1.5MiB"), Ok(1_572_864));
        assert_eq!(bytes("4096"), Ok(4096));
        for wrong in ["", "MB", "0", "-1MB", "5 apples", "1e99"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes() {
        assert_eq!(size("1280x720"), Ok([1280, 720]));
        for wrong in ["1280", "x720", "0x10", "-1x5", "axb"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
