//! `sliceflow study speed-error`: what each choice costs and what it gains, case by case, and what nobody beats.

mod page;
mod peers;
mod rung;
mod subjects;

use std::path::PathBuf;
use std::time::Instant;

use super::bench::{Bench, first_line, pairs};
use super::page::Page;
use super::parts::{self, Part};
use super::{Settings, Size};
use crate::error::{Error, Result};
use crate::output::text::seconds;
use crate::output::{columns_named, now, write_file};
use crate::plan::Wanted;
use crate::plan::achieved::{Achieved, Achievement};
use crate::scene::Scene;
use peers::{Outcome, PEERS};
use rung::{Rung, front};
use subjects::{SUBJECTS, Subject, Way, ways};

/// What the study's parts share.
pub struct Shared {
    size: Size,
    folder: PathBuf,
    interpreters: Vec<PathBuf>,
    achieved: Achieved,
    ladders: Vec<Ladder>,
}

/// A case with all that was measured of it.
struct Ladder {
    subject: &'static Subject,
    rungs: Vec<Rung>,
    /// Name and resolution of what there was no time for.
    left_out: Vec<String>,
    peers: Vec<(&'static str, Outcome)>,
}

pub const PARTS: &[Part<Shared>] = &[
    Part {
        name: "martin_moyce",
        run: |page, bench, shared| ladder(page, bench, shared, 0),
    },
    Part {
        name: "lobovsky_dam",
        run: |page, bench, shared| ladder(page, bench, shared, 1),
    },
    Part {
        name: "still_water",
        run: |page, bench, shared| ladder(page, bench, shared, 2),
    },
    Part {
        name: "taylor_green_2d",
        run: |page, bench, shared| ladder(page, bench, shared, 3),
    },
    Part {
        name: "poiseuille",
        run: |page, bench, shared| ladder(page, bench, shared, 4),
    },
];

/// Runs of each rung.
const REPEATS: u32 = 3;
/// Longest run that is begun, s.
const LONGEST_RUN: f64 = 120.0;

/// Seconds for a case; rungs that have not begun by then are left out, and runs are not repeated any more.
fn limit(size: Size) -> f64 {
    match size {
        Size::Tiny | Size::Full => f64::INFINITY,
        Size::Small => 160.0,
    }
}

/// Runs the study and writes its page.
pub fn speed_error(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("speed-error", PARTS, &settings.cases)?;
    peers::check(&settings.peers)?;
    let mut page = Page::create(
        &settings.folder,
        "speed-error",
        "Speed and error: what each choice costs",
        settings.force,
    )?;
    let bench = Bench::open(settings)?;
    bench.environment(&mut page);
    page.paragraph(page::about(settings.size, limit(settings.size), REPEATS));
    let mut shared = Shared {
        size: settings.size,
        folder: settings.folder.clone(),
        interpreters: settings.peers.clone(),
        achieved: Achieved {
            machine: format!("{}, {}", bench.adapter(), super::suite::report::processor()),
            date: now(),
            sliceflow: env!("CARGO_PKG_VERSION").to_owned(),
            rungs: Vec::new(),
        },
        ladders: Vec::new(),
    };
    parts::run(page, &bench, &mut shared, &parts, |page, shared| {
        page::end(page, &shared.ladders)
    })
}

fn ladder(page: &mut Page, bench: &Bench, shared: &mut Shared, index: usize) -> Result<()> {
    let subject = &SUBJECTS[index];
    let start = Instant::now();
    let limit = limit(shared.size);
    let mut ladder = Ladder {
        subject,
        rungs: Vec::new(),
        left_out: Vec::new(),
        peers: Vec::new(),
    };
    for way in ways(subject, shared.size)? {
        let longest = expected(&ladder.rungs, &way);
        let is_late = start.elapsed().as_secs_f64() > limit;
        if is_late || longest > LONGEST_RUN {
            let what = format!("{} at {}", way.name, (subject.case.label)(way.resolution));
            ladder.left_out.push(match is_late {
                true => what,
                false => format!("{what} (about {})", seconds(longest)),
            });
            continue;
        }
        bench.tell(&format!(
            "speed-error: {}, {}, {}",
            subject.case.name,
            way.name,
            (subject.case.label)(way.resolution)
        ));
        let rung = match first_run(bench, subject, &way) {
            Err(error @ Error::Interrupted { .. }) => return Err(error),
            Err(error) => Rung::failed(subject.case.name, &way, why(&error)),
            Ok(rung) => rung,
        };
        bench.check()?;
        ladder.rungs.push(rung);
    }
    let repeats = if shared.size == Size::Tiny { 1 } else { REPEATS };
    for turn in 1..repeats {
        bench.tell(&format!(
            "speed-error: {}, turn {} of {repeats}",
            subject.case.name,
            turn + 1
        ));
        for rung in ladder.rungs.iter_mut().filter(|rung| rung.trouble.is_none()) {
            if start.elapsed().as_secs_f64() > limit {
                break;
            }
            let record = (subject.run)(bench, rung.resolution, &rung.set)?;
            bench.check()?;
            rung.wall.push(record.wall);
        }
    }
    for peer in PEERS
        .iter()
        .filter(|peer| peer.cases.contains(&subject.case.name))
    {
        if !shared.interpreters.is_empty() {
            bench.tell(&format!("speed-error: {}, {}", subject.case.name, peer.program));
        }
        let resolutions = (subject.resolutions)(shared.size);
        let few = &resolutions[..resolutions.len().min(2)];
        let outcome = peers::run(
            peer,
            &shared.interpreters,
            &shared.folder,
            subject.case.name,
            few,
            repeats,
        )?;
        bench.check()?;
        ladder.peers.push((peer.program, outcome));
    }
    page::ladder(page, &ladder, &bench.adapter())?;
    shared.achieved.rungs.extend(achieved(&ladder));
    let mut json = serde_json::to_vec_pretty(&shared.achieved).expect("keys are text");
    json.push(b'\n');
    write_file(&shared.folder.join("achieved.json"), &json)?;
    shared.ladders.push(ladder);
    Ok(())
}

/// What an error says, in one line; of a scene, its first problem.
fn why(error: &Error) -> String {
    match error {
        Error::Scene { problems, .. } => problems.first().map_or_else(String::new, |problem| {
            format!("refused: {}: {}", problem.path, problem.what)
        }),
        other => first_line(other),
    }
}

/// Seconds of a run, judged by the same way at the nearest lower resolution: steps become shorter as particles become
/// more.
fn expected(rungs: &[Rung], way: &Way) -> f64 {
    let lower = rungs
        .iter()
        .filter(|rung| rung.name == way.name && rung.resolution < way.resolution && !rung.wall.is_empty())
        .max_by_key(|rung| rung.resolution);
    lower.map_or(0.0, |rung| {
        rung.wall[0] * (f64::from(way.resolution) / f64::from(rung.resolution)).powi(3)
    })
}

fn first_run(bench: &Bench, subject: &Subject, way: &Way) -> Result<Rung> {
    let scene = (subject.scene)(way.resolution, &way.set)?;
    let pairs = pairs_at_start(bench, &scene)?;
    let record = (subject.run)(bench, way.resolution, &way.set)?;
    Ok(Rung::new(&record, way, subject.figure, pairs))
}

/// Particles in reach of one, on average.
fn pairs_at_start(bench: &Bench, scene: &Scene) -> Result<f64> {
    let wanted = Wanted {
        columns: columns_named(["contacts"])?,
        ..Wanted::default()
    };
    let mut simulation = bench.simulation(scene, &wanted)?;
    simulation.next_frame()?;
    let frame = simulation.finish_frame()?;
    Ok(frame.map_or(0.0, |frame| {
        pairs(&frame) as f64 / f64::from(frame.particles.max(1))
    }))
}

/// Places in the ladder, of rungs with a result, that nobody beats.
fn on_front(rungs: &[Rung]) -> Vec<&Rung> {
    let with_result: Vec<&Rung> = rungs.iter().filter(|rung| rung.point().is_some()).collect();
    let points: Vec<_> = with_result.iter().filter_map(|rung| rung.point()).collect();
    front(&points)
        .into_iter()
        .map(|index| with_result[index])
        .collect()
}

/// What `plan --error` may advise.
fn achieved(ladder: &Ladder) -> Vec<Achievement> {
    let of = |rung: &Rung| {
        Some(Achievement {
            case: rung.case.clone(),
            figure: ladder.subject.figure.to_owned(),
            set: advised(&rung.name, &rung.set),
            step: rung.step,
            resolution: rung.resolution,
            error: rung.error?,
            particles: rung.particles,
            wall_per_simulated: rung.wall_per_simulated()?,
        })
    };
    on_front(&ladder.rungs).into_iter().filter_map(of).collect()
}

/// The keys of a rung for another scene, whose steps have another length.
fn advised(name: &str, set: &[String]) -> Vec<String> {
    let solver = if name.starts_with("dfsph") {
        "dfsph"
    } else {
        "wcsph"
    };
    let kept = set
        .iter()
        .filter(|key| !key.starts_with("time.step=") && !key.starts_with("fluid.solver="));
    std::iter::once(format!("fluid.solver={solver}"))
        .chain(kept.cloned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_subjects_go_together() {
        let subjects: Vec<_> = SUBJECTS.iter().map(|subject| subject.case.name).collect();
        assert_eq!(parts::names(PARTS), subjects);
    }

    #[test]
    fn runs_of_twice_the_resolution_take_eight_times_as_long() {
        let way = |resolution: u32| Way {
            name: "wcsph".into(),
            set: Vec::new(),
            step: 1.0,
            resolution,
        };
        let mut rung = Rung::failed("a", &way(20), String::new());
        let way = way(40);
        rung.wall = vec![2.0];
        assert_eq!(expected(&[rung.clone()], &way), 16.0);
        rung.name = "dfsph".into();
        assert_eq!(expected(&[rung], &way), 0.0);
    }

    #[test]
    fn advice_names_the_solver_and_no_length_of_a_step() {
        let set = ["time.step=1e-4".to_owned(), "fluid.support=2".to_owned()];
        assert_eq!(
            advised("wcsph, steps", &set),
            ["fluid.solver=wcsph", "fluid.support=2"]
        );
        let set = ["fluid.solver=dfsph".to_owned()];
        assert_eq!(advised("dfsph", &set), ["fluid.solver=dfsph"]);
    }
}
