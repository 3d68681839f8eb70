//! Other programs beside ours, on the same machine and in the same run: `assets/peers/` has a script for each, which a
//! Python that has the program runs.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::output::write_file;
use crate::study::accuracy::cases::martin_moyce;
use crate::study::accuracy::series::Series;

/// A program and the script that runs it.
pub struct Peer {
    pub program: &'static str,
    file: &'static str,
    script: &'static str,
    /// Of our cases, those that the script knows.
    pub cases: &'static [&'static str],
}

pub const PEERS: [Peer; 2] = [
    Peer {
        program: "SPlisHSPlasH",
        file: "splishsplash.py",
        script: include_str!("../../../assets/peers/splishsplash.py"),
        cases: &["martin_moyce"],
    },
    Peer {
        program: "PySPH",
        file: "pysph_cases.py",
        script: include_str!("../../../assets/peers/pysph_cases.py"),
        cases: &["taylor_green_2d"],
    },
];

/// One run of a peer, a line that its script prints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// With its version.
    pub program: String,
    pub method: String,
    pub resolution: u32,
    pub particles: u32,
    pub steps: u64,
    /// s.
    pub simulated: f64,
    /// Without setting up, s.
    pub wall: f64,
    /// Percent, where the script knows the truth.
    #[serde(default)]
    pub error: Option<f64>,
    /// Time over √(a/g) and place of the front over a, where the case judges that.
    #[serde(default, skip_serializing)]
    pub front: Vec<(f64, f64)>,
}

/// What came of a peer in a case.
pub enum Outcome {
    Ran(Vec<Told>),
    /// Why not.
    Missing(String),
}

/// Refuses what is no program, before anything is measured.
///
/// # Errors
///
/// Where an interpreter cannot be started.
pub fn check(interpreters: &[PathBuf]) -> Result<()> {
    for python in interpreters {
        let started = Command::new(python).arg("--version").output();
        let what = match started {
            Ok(output) if output.status.success() => continue,
            Ok(output) => format!("`{} --version` ends with {}", python.display(), output.status),
            Err(reason) => format!("cannot start {}: {reason}", python.display()),
        };
        return Err(Error::usage(
            what,
            "give the Python of an environment that has pysplishsplash or pysph, or leave --peers out",
        ));
    }
    Ok(())
}

/// Runs a peer's case at some resolutions, so many times each, with the first interpreter that has the program.
pub fn run(
    peer: &Peer,
    interpreters: &[PathBuf],
    folder: &Path,
    case: &str,
    resolutions: &[u32],
    repeats: u32,
) -> Result<Outcome> {
    let script = folder.join(peer.file);
    let mut why = "no --peers was given".to_owned();
    for python in interpreters {
        write_file(&script, peer.script.as_bytes())?;
        let mut command = Command::new(python);
        command.arg(&script).arg(case).arg(repeats.to_string());
        let output = command.args(resolutions.iter().map(u32::to_string)).output();
        let output =
            output.map_err(|reason| Error::file(python, "start", reason, "name another with --peers"))?;
        // Scripts are the program's own, so none stays.
        let _ = std::fs::remove_file(&script);
        match read(&String::from_utf8_lossy(&output.stdout)) {
            Ok(told) if output.status.success() && !told.is_empty() => return judged(told).map(Outcome::Ran),
            Err(told) => why = told,
            Ok(_) => {
                let complaint = String::from_utf8_lossy(&output.stderr);
                let last = complaint.lines().last().unwrap_or("it said nothing").to_owned();
                why = format!("its script ended with {}: {last}", output.status);
            }
        }
    }
    Ok(Outcome::Missing(why))
}

/// The runs among a script's lines; what it says instead. Programs print lines of their own.
fn read(text: &str) -> std::result::Result<Vec<Told>, String> {
    let mut all = Vec::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("POINT ")) {
        all.push(
            serde_json::from_str(line).map_err(|error| format!("its script printed `{line}`: {error}"))?,
        );
    }
    match text.lines().find_map(|line| line.strip_prefix("MISSING ")) {
        Some(why) if all.is_empty() => Err(why.to_owned()),
        _ => Ok(all),
    }
}

/// Fronts are judged as ours are.
fn judged(mut told: Vec<Told>) -> Result<Vec<Told>> {
    for run in told.iter_mut().filter(|run| !run.front.is_empty()) {
        run.error = martin_moyce::front_error(&Series::new(run.front.iter().copied()))?;
    }
    Ok(told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_are_heard_among_what_programs_print() {
        let line = r#"POINT {"program":"P 1","method":"DFSPH","resolution":20,"particles":400,"steps":10,"simulated":0.3,"wall":1.5,"error":2.5}"#;
        let all = read(&format!("hello\n{line}\nbye\n")).unwrap();
        assert_eq!((all.len(), all[0].resolution, all[0].error), (1, 20, Some(2.5)));
        assert_eq!(
            read("MISSING no module pysph\n"),
            Err("no module pysph".to_owned())
        );
        assert!(read("POINT {}\n").unwrap_err().contains("missing field"));
        assert!(read("nothing\n").unwrap().is_empty());
    }

    #[test]
    fn a_front_that_is_the_measured_one_has_no_error() {
        let [measured, _] = crate::study::accuracy::reference::martin_moyce(1).unwrap();
        // Straight lines between the measured points, begun before them and ended behind them.
        let mut front: Vec<_> = measured.points().collect();
        let (last, z) = front[front.len() - 1];
        front.insert(0, (-1.0, 1.0));
        front.push((last + 1.0, z + 1.0));
        let told = Told {
            program: "P".into(),
            method: "M".into(),
            resolution: 20,
            particles: 1,
            steps: 1,
            simulated: 1.0,
            wall: 1.0,
            error: None,
            front,
        };
        let error = judged(vec![told]).unwrap()[0].error.unwrap();
        assert!(error < 0.2, "{error}");
    }

    #[test]
    fn what_is_no_interpreter_is_refused() {
        let told = check(&["/no/such/python".into()]).unwrap_err().to_string();
        assert!(
            told.contains("/no/such/python") && told.contains("--peers"),
            "{told}"
        );
    }
}
