//! Other programs beside ours, on the same machine and in the same run: `assets/peers/` has a script for each, which a
//! Python that has the program runs.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::gpu::timing::median;
use crate::output::{interrupt, write_file};
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
    /// How many runs `wall` is the median of.
    #[serde(skip, default = "once")]
    pub runs: u32,
}

fn once() -> u32 {
    1
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

/// Runs a peer's case at some resolutions, so many times each, with the first interpreter that has the program. What it
/// has told until it is stopped for taking too long, or by Ctrl-C, counts.
///
/// # Errors
///
/// Where an interpreter cannot be started or its script cannot be written.
pub fn run(
    peer: &Peer,
    interpreters: &[PathBuf],
    folder: &Path,
    case: &str,
    resolutions: &[u32],
    repeats: u32,
) -> Result<Outcome> {
    let [script, told, complaint] =
        ["", ".out", ".err"].map(|end| folder.join(format!("{}{end}", peer.file)));
    let mut why = "no --peers was given".to_owned();
    for python in interpreters {
        write_file(&script, peer.script.as_bytes())?;
        let mut command = Command::new(python);
        command.arg(&script).arg(case).arg(repeats.to_string());
        command.args(resolutions.iter().map(u32::to_string));
        let ended = wait(&mut command, &told, &complaint)
            .map_err(|reason| Error::file(python, "run", reason, "name another with --peers"));
        let [said, complained] =
            [&told, &complaint].map(|path| std::fs::read_to_string(path).unwrap_or_default());
        for file in [&script, &told, &complaint] {
            // They are the study's own, so none stays; one that does does no harm.
            let _ = std::fs::remove_file(file);
        }
        let ended = ended?;
        match read(&said) {
            Ok(all) if !all.is_empty() => return judged(medians(all)).map(Outcome::Ran),
            Err(instead) => why = instead,
            Ok(_) => {
                let last = complained.lines().last().unwrap_or("it said nothing");
                why = format!("its script {ended}: {last}");
            }
        }
    }
    Ok(Outcome::Missing(why))
}

/// Longest that a script may take, s.
const LONGEST: u64 = 300;

/// Runs a command whose outputs go to files; says how it ended.
fn wait(command: &mut Command, told: &Path, complaint: &Path) -> std::io::Result<String> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(File::create(told)?)
        .stderr(File::create(complaint)?)
        .spawn()?;
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(format!("ended with {status}"));
        }
        if interrupt::asked() || start.elapsed().as_secs() >= LONGEST {
            child.kill()?;
            child.wait()?;
            return Ok(format!("was stopped after {LONGEST} s"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
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

/// Runs of the same method and resolution as one.
fn medians(all: Vec<Told>) -> Vec<Told> {
    let mut groups: Vec<Vec<Told>> = Vec::new();
    for told in all {
        let same = |group: &&mut Vec<Told>| {
            (&group[0].method, group[0].resolution) == (&told.method, told.resolution)
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(told),
            None => groups.push(vec![told]),
        }
    }
    let middle = |group: Vec<Told>| Told {
        wall: median(group.iter().map(|told| told.wall).collect()),
        runs: group.len() as u32,
        ..group.into_iter().next().expect("a group has one")
    };
    groups.into_iter().map(middle).collect()
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
        let slower = Told {
            wall: 3.5,
            ..all[0].clone()
        };
        let middle = medians(vec![all[0].clone(), slower]);
        assert_eq!((middle.len(), middle[0].runs, middle[0].wall), (1, 2, 2.5));
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
            runs: 1,
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
