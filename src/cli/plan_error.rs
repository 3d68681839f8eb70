//! What `sliceflow plan --error` proposes.

use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::{Error, Result};
use crate::files;
use crate::output::text::{count, metres};
use crate::plan::achieved::{Achieved, Advice, KINDS, percent};
use crate::scene::{Scene, load};

#[derive(clap::Args)]
pub struct ErrorArgs {
    /// Proposes solver, spacing and step for an error like this: 2%. Takes what `study speed-error` measured in the case
    /// that is most like the scene
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    error: Option<f64>,
    /// Takes the results of this case: martin_moyce, lobovsky_dam, still_water, taylor_green_2d or poiseuille
    #[arg(long, value_name = "CASE", requires = "error", value_parser = case)]
    like: Option<String>,
    /// Results of this machine, `achieved.json` of a study, in place of those that ship
    #[arg(long, value_name = "FILE", requires = "error")]
    results: Option<PathBuf>,
}

fn case(name: &str) -> std::result::Result<String, String> {
    let names: Vec<_> = KINDS.iter().map(|kind| kind.case).collect();
    match names.contains(&name) {
        true => Ok(name.to_owned()),
        false => Err(format!("name one of {}", names.join(", "))),
    }
}

impl ErrorArgs {
    /// What is proposed for a scene, where an error is asked for.
    pub fn proposal(&self, scene: &Scene) -> Result<Option<Proposal>> {
        let Some(error) = self.error else {
            return Ok(None);
        };
        let achieved = match &self.results {
            Some(path) => read(path)?,
            None => Achieved::shipped(),
        };
        let advice = achieved.advise(scene, error, self.like.as_deref())?;
        Proposal::new(scene, advice).map(Some)
    }
}

fn read(path: &Path) -> Result<Achieved> {
    let help = "give the `achieved.json` that `sliceflow study speed-error` wrote beside its page";
    let text = files::read_text(path).map_err(|reason| Error::file(path, "read", reason, help))?;
    serde_json::from_str(&text).map_err(|reason| Error::file(path, "read", reason, help))
}

/// Advice, and the scene that follows it.
pub struct Proposal {
    advice: Advice,
    /// With the advice's keys.
    scene: Scene,
    /// The scene, as it was given on the command line.
    given: String,
    /// As `--set` takes them: the given ones, then the advice's, and the step where it is another one.
    set: Vec<String>,
}

impl Proposal {
    fn new(scene: &Scene, advice: Advice) -> Result<Self> {
        let written = &scene.written;
        let with = |set: &[String]| {
            let all = [&written.overrides[..], set].concat();
            load::parse(&written.text, &written.file_name, &written.folder, &all)
        };
        let mut set = advice.set.clone();
        let mut proposed = with(&set)?;
        if advice.step != 1.0 {
            set.push(format!("time.step={:.4e}", proposed.time.step * advice.step));
            proposed = with(&set)?;
        }
        // A scene that ships is known by its name.
        let given = match Path::new(&written.file_name).is_file() {
            true => written.file_name.clone(),
            false => written.file_name.trim_end_matches(".json").to_owned(),
        };
        Ok(Self {
            set: [&written.overrides[..], &set].concat(),
            scene: proposed,
            given,
            advice,
        })
    }

    pub fn json(&self) -> Value {
        let fluid = self.scene.fluid();
        json!({
            "scene": self.scene.name,
            "proposal": {
                "solver": fluid.map(|fluid| fluid.solver),
                "spacing_m": fluid.map(|fluid| fluid.spacing),
                "step_s": self.scene.time.step,
                "step_adaptive": self.scene.time.adaptive.is_some(),
                "particles": self.scene.first_boundary(),
                "set": self.set,
            },
            "basis": self.advice,
        })
    }
}

impl fmt::Display for Proposal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { advice, scene, .. } = self;
        let Some(fluid) = scene.fluid() else {
            return Ok(());
        };
        let solver = serde_json::to_value(fluid.solver).unwrap_or_default();
        writeln!(
            f,
            "proposal   {}, spacing {} ({} across {}), {} particles",
            solver.as_str().unwrap_or_default(),
            metres(fluid.spacing),
            advice.across,
            metres(advice.length),
            count(scene.first_boundary().into())
        )?;
        let adaptive = scene.time.adaptive.is_some();
        writeln!(
            f,
            "step       {}{:.3e} s, limited by the {}",
            if adaptive { "adaptive, about " } else { "" },
            scene.time.step,
            scene.time.limited_by
        )?;
        writeln!(
            f,
            "basis      error {:.2} % of “{}” in `{}` at this resolution ({})",
            advice.error, advice.figure, advice.like, advice.why
        )?;
        writeln!(
            f,
            "measured   {}, {}: there {} wall seconds of {} particles made one simulated second",
            advice.machine,
            advice.date,
            digits(advice.wall_per_simulated),
            count(advice.particles.into())
        )?;
        let set: String = self.set.iter().map(|key| format!(" --set '{key}'")).collect();
        writeln!(f, "run        sliceflow run {}{set}", self.given)?;
        writeln!(
            f,
            "\nnote: the error is that of the named case, in 2D; another scene's error is another one, of this order at most \
             where its flow is as smooth. Keys that are not set stay the scene's own. `plan --measure` with the same --set tells how long \
             the run takes here."
        )
    }
}

/// Three digits.
fn digits(value: f64) -> String {
    let decimals = (2 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 5) as usize;
    format!("{value:.decimals$}")
}
