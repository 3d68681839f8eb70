//! What `sliceflow bench` found: one JSON file, which `bench compare` reads again.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::probes::Probes;
use crate::error::{Error, Result};

/// Of the file; another one where a field is no longer what it was.
const FORMAT: u32 = 1;

/// All that a benchmark found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub format: u32,
    pub sliceflow: String,
    /// Begin, UTC.
    pub date: String,
    pub machine: Machine,
    /// `quick`, `default`, …
    pub size: String,
    /// None where the adapter has no clock for passes.
    pub probes: Option<Probes>,
    pub runs: Vec<Run>,
    pub left_out: Vec<LeftOut>,
    /// s.
    pub took_s: f64,
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
}

/// What computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    pub adapter: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: String,
    pub backend: String,
    pub driver: String,
    pub processor: String,
    pub threads: usize,
    /// Operating system and architecture.
    pub system: String,
}

/// A scene at one size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    pub scene: String,
    /// Boundary particles apart.
    pub particles: u32,
    pub boundary_particles: u32,
    pub rounds: usize,
    /// Steps of all rounds.
    pub steps: u64,
    /// Wall time of a step: the median of the rounds, the shortest and the longest one, ms.
    pub step_ms: Spread,
    pub particle_steps_per_s: f64,
    /// Particles that a particle's kernel reaches, boundary particles included; grains and walls that a grain touches.
    pub pairs_per_particle: f64,
    /// Each pair seen from both sides.
    pub pairs_per_s: f64,
    /// Steps from one neighbor search to the next.
    pub steps_per_search: f64,
    /// What a step must move at least over what could be copied in its time.
    pub copy_share: Option<f64>,
    /// What a step must compute at least over what could be computed in its time.
    pub arithmetic_share: Option<f64>,
    pub passes: Vec<PassTime>,
    pub outputs: Outputs,
    /// Placing particles, compiling shaders and the first steps, s.
    pub setup_s: f64,
    /// Buffers on the device.
    pub device_bytes: u64,
}

/// The middle and the ends of several values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    pub median: f64,
    pub least: f64,
    pub most: f64,
}

/// A pass of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PassTime {
    pub name: String,
    /// What it takes of a step, ms; a search's passes count by the share of steps that search.
    pub ms: f64,
    /// As those of a step.
    pub copy_share: Option<f64>,
    pub arithmetic_share: Option<f64>,
}

/// What a frame costs besides its steps, ms.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Drawing, and bringing the pixels to the host; none where pictures were not measured.
    pub picture_ms: Option<f64>,
    /// Legend and compression to PNG, on one thread.
    pub png_ms: Option<f64>,
    /// Figures over all particles, and bringing positions, velocities and counts of pairs to the host.
    pub columns_ms: f64,
}

/// What was not measured, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    pub scene: String,
    pub particles: u32,
    pub why: String,
}

impl Report {
    pub fn new(machine: Machine, size: &str, date: String) -> Self {
        Self {
            format: FORMAT,
            sliceflow: env!("CARGO_PKG_VERSION").to_owned(),
            date,
            machine,
            size: size.to_owned(),
            probes: None,
            runs: Vec::new(),
            left_out: Vec::new(),
            took_s: 0.0,
            interrupted: false,
        }
    }

    /// Reads what `bench --json` wrote.
    ///
    /// # Errors
    ///
    /// Where there is no such file, and where it is something else.
    pub fn read(path: &Path) -> Result<Self> {
        let help = "give a file that `sliceflow bench --json FILE` wrote";
        let text = std::fs::read_to_string(path).map_err(|reason| Error::file(path, "read", reason, help))?;
        let report: Self =
            serde_json::from_str(&text).map_err(|reason| Error::file(path, "read", reason, help))?;
        match report.format {
            FORMAT => Ok(report),
            other => Err(Error::usage(
                format!(
                    "{}: format {other}, and this version reads {FORMAT}",
                    path.display()
                ),
                "run `sliceflow bench` again, or compare with the version that wrote it",
            )),
        }
    }

    pub fn json(&self) -> Vec<u8> {
        let mut json = serde_json::to_vec_pretty(self).expect("keys are text");
        json.push(b'\n');
        json
    }
}

impl Spread {
    /// Of at least one value.
    pub fn of(values: &[f64]) -> Self {
        Self {
            median: crate::gpu::timing::median(values.to_vec()),
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            most: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Whether no value of one lies among those of the other.
    pub fn is_apart(&self, other: &Self) -> bool {
        self.most < other.least || other.most < self.least
    }
}

impl Machine {
    /// One line.
    pub fn name(&self) -> String {
        format!(
            "{} ({}, {}, {}); {}, {} threads, {}",
            self.adapter, self.kind, self.backend, self.driver, self.processor, self.threads, self.system
        )
    }
}

/// The processor's name, as the system tells it.
pub fn processor() -> String {
    let told = if cfg!(target_os = "linux") {
        std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.to_owned())
        })
    } else if cfg!(target_os = "macos") {
        let asked = std::process::Command::new("sysctl")
            .args(["-n", "machdep.cpu.brand_string"])
            .output();
        asked
            .ok()
            .map(|output| String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        std::env::var("PROCESSOR_IDENTIFIER").ok()
    };
    let told = told
        .map(|name| name.trim().to_owned())
        .filter(|name| !name.is_empty());
    told.unwrap_or_else(|| "unknown processor".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_are_apart_where_no_value_is_shared() {
        let of = |values: &[f64]| Spread::of(values);
        let middle = of(&[3.0, 1.0, 2.0]);
        assert_eq!((middle.least, middle.median, middle.most), (1.0, 2.0, 3.0));
        assert!(middle.is_apart(&of(&[3.1, 4.0])) && of(&[3.1, 4.0]).is_apart(&middle));
        assert!(!middle.is_apart(&of(&[2.9, 8.0])));
    }

    #[test]
    fn other_files_and_other_formats_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        let told = |text: &[u8]| {
            std::fs::write(&path, text).unwrap();
            Report::read(&path).map(|_| ()).unwrap_err().to_string()
        };
        assert!(told(b"{}").contains("bench --json"));
        let machine = Machine {
            adapter: "a".into(),
            kind: "software".into(),
            backend: "vulkan".into(),
            driver: "b".into(),
            processor: processor(),
            threads: 2,
            system: "c".into(),
        };
        let mut report = Report::new(machine, "tiny", "now".into());
        std::fs::write(&path, report.json()).unwrap();
        assert_eq!(Report::read(&path).unwrap(), report);
        report.format = 7;
        assert!(told(&report.json()).contains("format 7"));
    }
}
