//! What one run came to.

use serde::{Deserialize, Serialize};

/// How a run was made: one curve of a diagram.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Method {
    /// `dem`, `sph`, `wcsph`, …
    pub solver: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kernel: Option<String>,
    /// Form of the viscous force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<String>,
    pub integrator: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<String>,
    /// What else is switched on: particle shifting, density diffusion, …
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
}

impl Method {
    /// `wcsph, wendland_c2, laplacian, symplectic_euler`
    pub fn name(&self) -> String {
        let parts = [
            Some(&self.solver),
            self.kernel.as_ref(),
            self.viscosity.as_ref(),
            self.walls.as_ref(),
            Some(&self.integrator),
        ];
        let parts = parts.into_iter().flatten().chain(&self.options);
        parts.map(String::as_str).collect::<Vec<_>>().join(", ")
    }
}

/// What a figure has to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bar {
    AtMost(f64),
    AtLeast(f64),
    Within(f64, f64),
}

impl Bar {
    fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(most) => value <= most,
            Self::AtLeast(least) => value >= least,
            Self::Within(least, most) => (least..=most).contains(&value),
        }
    }
}

/// What somebody else reached in the same case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Best {
    pub value: f64,
    /// Who, with what, at which resolution.
    pub source: String,
}

/// One number that a run is judged by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    pub name: String,
    /// None where the run had nothing to measure.
    pub value: Option<f64>,
    /// Empty for plain numbers.
    pub unit: String,
    /// Where one is set for this resolution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bar: Option<Bar>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub best: Option<Best>,
}

impl Figure {
    /// A value that is not finite is none.
    pub fn new(name: impl Into<String>, value: impl Into<Option<f64>>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value: value.into().filter(|value| value.is_finite()),
            unit: unit.into(),
            bar: None,
            best: None,
        }
    }

    pub fn bar(self, bar: impl Into<Option<Bar>>) -> Self {
        Self {
            bar: bar.into(),
            ..self
        }
    }

    pub fn best(self, value: f64, source: impl Into<String>) -> Self {
        let source = source.into();
        Self {
            best: Some(Best { value, source }),
            ..self
        }
    }

    /// `L1 of speed, %`
    pub fn label(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{}, {unit}", self.name),
        }
    }
}

/// Whether a figure is as it has to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    Met,
    NotMet,
    /// The run broke off.
    Diverged,
    /// No bar is set.
    Unjudged,
}

impl Verdict {
    /// For tables; none where there is nothing to say.
    pub fn word(self) -> Option<&'static str> {
        match self {
            Self::Met => Some("met"),
            Self::NotMet => Some("not met"),
            Self::Diverged => Some("diverged"),
            Self::Unjudged => None,
        }
    }
}

/// One run, or several that belong together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the case.
    pub case: String,
    pub method: Method,
    /// As the case counts it: particles across, steps per contact.
    pub resolution: u32,
    pub particles: u32,
    /// Distance of particles at the start, m; a grain's diameter.
    pub spacing: f64,
    /// Time step (the last one where it changes), s.
    pub time_step: f64,
    pub steps: u64,
    /// Simulated time, s.
    pub simulated: f64,
    /// Time that the run took, without what compiled its shaders, s.
    pub wall: f64,
    /// Particles times steps.
    pub particle_updates: u64,
    /// Name, kind and driver.
    pub adapter: String,
    pub figures: Vec<Figure>,
    /// Why the run broke off, if it did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diverged: Option<String>,
}

impl Record {
    pub fn figure(&self, name: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.name == name)
    }

    pub fn verdict(&self, figure: &Figure) -> Verdict {
        match (&self.diverged, figure.bar, figure.value) {
            (Some(_), ..) => Verdict::Diverged,
            (None, None, _) => Verdict::Unjudged,
            (None, Some(bar), Some(value)) if bar.holds(value) => Verdict::Met,
            (None, Some(_), _) => Verdict::NotMet,
        }
    }

    /// s/s.
    pub fn wall_per_simulated(&self) -> f64 {
        self.wall / self.simulated
    }

    /// Particle updates per simulated second, 1/s: what a machine's speed does not change.
    pub fn updates_per_simulated(&self) -> f64 {
        self.particle_updates as f64 / self.simulated
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A run that looks like one.
    pub fn record(solver: &str, resolution: u32, error: f64) -> Record {
        let n = f64::from(resolution);
        Record {
            case: "vortices".into(),
            method: Method {
                solver: solver.into(),
                kernel: Some("wendland_c2".into()),
                integrator: "velocity_verlet".into(),
                ..Default::default()
            },
            resolution,
            particles: resolution * resolution,
            spacing: 1.0 / n,
            time_step: 0.025 / n,
            steps: u64::from(80 * resolution),
            simulated: 2.0,
            wall: 2e-6 * n.powi(3) * 80.0,
            particle_updates: u64::from(80 * resolution.pow(3)),
            adapter: "llvmpipe".into(),
            figures: vec![
                Figure::new("L1 of speed", error, "%")
                    .bar((resolution == 100).then_some(Bar::AtMost(1.0)))
                    .best(1.38, "PySPH, EDAC, 100²"),
            ],
            diverged: None,
        }
    }

    #[test]
    fn bars_judge() {
        let verdict = |record: &Record| record.verdict(&record.figures[0]);
        assert_eq!(verdict(&record("a", 100, 0.9)), Verdict::Met);
        assert_eq!(verdict(&record("a", 100, 1.1)), Verdict::NotMet);
        assert_eq!(verdict(&record("a", 100, f64::NAN)), Verdict::NotMet);
        assert_eq!(verdict(&record("a", 50, 0.9)), Verdict::Unjudged);
        let broken = Record {
            diverged: Some("a particle left the domain".into()),
            ..record("a", 100, 0.9)
        };
        assert_eq!(verdict(&broken), Verdict::Diverged);
        assert!(Bar::Within(-15.0, 15.0).holds(-14.0) && !Bar::Within(-15.0, 15.0).holds(16.0));
        assert!(Bar::AtLeast(1.0).holds(1.2) && !Bar::AtLeast(1.0).holds(0.8));
    }

    #[test]
    fn records_survive_json() {
        let mut before = record("wcsph", 100, 0.9);
        before.figures.push(Figure::new("arrival", f64::NAN, "s"));
        let text = serde_json::to_string(&before).unwrap();
        assert_eq!(serde_json::from_str::<Record>(&text).unwrap(), before);
        assert_eq!(before.figures[1].value, None);
        assert_eq!(before.method.name(), "wcsph, wendland_c2, velocity_verlet");
        assert!((before.wall_per_simulated() - 80.0).abs() < 1e-9);
        assert_eq!(before.updates_per_simulated(), 40.0 * 1e6);
    }
}
