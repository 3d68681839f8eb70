//! What the study `speed-error` has measured, and what it advises for a scene: the cheapest settings that had an error as
//! small as is asked for.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::scene::Scene;

/// The table that ships.
const SHIPPED: &str = include_str!("../../assets/speed_error.json");

/// Results of one machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Achieved {
    /// Name, kind and driver of the adapter, the processor.
    pub machine: String,
    /// UTC.
    pub date: String,
    pub sliceflow: String,
    pub rungs: Vec<Achievement>,
}

/// One way to compute a case, and what came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Achievement {
    /// Name of the case, one of [`KINDS`].
    pub case: String,
    /// What its error is of.
    pub figure: String,
    /// Keys of the scene, as `--set` takes them, besides the spacing.
    pub set: Vec<String>,
    /// Factor on the length of a step that the scene gets.
    pub step: f64,
    /// Particles along the case's length.
    pub resolution: u32,
    /// Percent.
    pub error: f64,
    pub particles: u32,
    pub wall_per_simulated: f64,
}

/// A kind of flow with a case of its own.
pub struct Kind {
    /// Name of the case.
    pub case: &'static str,
    /// What its resolution counts particles along.
    pub length: &'static str,
    /// Which scenes are of this kind.
    pub about: &'static str,
}

/// Every kind that results are there for.
pub const KINDS: &[Kind] = &[
    Kind {
        case: "taylor_green_2d",
        length: "the shortest period",
        about: "flow without weight in a periodic box",
    },
    Kind {
        case: "poiseuille",
        length: "the distance of the walls",
        about: "flow along a periodic channel",
    },
    Kind {
        case: "still_water",
        length: "the depth of the water",
        about: "water that fills its tank from wall to wall",
    },
    Kind {
        case: "martin_moyce",
        length: "the height of the water",
        about: "water with room to fall",
    },
    Kind {
        case: "lobovsky_dam",
        length: "the height of the water",
        about: "water that runs against a wall",
    },
];

/// What a scene could be computed with.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Advice {
    /// The case that the advice rests on, and why.
    pub like: String,
    pub why: String,
    /// What the error is of, and its size there, percent.
    pub figure: String,
    pub error: f64,
    /// Particles along the scene's length, metres.
    pub across: u32,
    pub length: f64,
    /// What to add to the scene, as `--set` takes it.
    pub set: Vec<String>,
    /// Factor on the length of a step that the scene then gets.
    pub step: f64,
    /// What measured, and when.
    pub machine: String,
    pub date: String,
    /// Of the case, beside the wall seconds that its simulated second took there.
    pub particles: u32,
    pub wall_per_simulated: f64,
}

impl Achieved {
    /// The results that ship.
    pub fn shipped() -> Self {
        serde_json::from_str(SHIPPED).expect("the table is valid")
    }

    /// The cheapest way that had an error of at most `error` percent in the case that is like this scene, or in the case
    /// of the name given.
    ///
    /// # Errors
    ///
    /// Where no case is like the scene, and where no result is as good.
    pub fn advise(&self, scene: &Scene, error: f64, like: Option<&str>) -> Result<Advice> {
        let kind = kind_of(scene, like)?;
        let length = length(scene, kind)?;
        let mut fitting: Vec<_> = self.rungs.iter().filter(|rung| rung.case == kind.case).collect();
        if fitting.is_empty() {
            return Err(Error::usage(
                format!("no result is there for scenes like `{}`", kind.case),
                "name another case with --like, or measure it: sliceflow study speed-error",
            ));
        }
        fitting.sort_by(|a, b| a.wall_per_simulated.total_cmp(&b.wall_per_simulated));
        let Some(best) = fitting.iter().find(|rung| rung.error <= error) else {
            let least = fitting
                .iter()
                .map(|rung| rung.error)
                .fold(f64::INFINITY, f64::min);
            return Err(Error::usage(
                format!(
                    "no result of `{}` has an error of {error} % or less: the smallest is {least:.2} % of {}",
                    kind.case, fitting[0].figure
                ),
                format!(
                    "ask for --error {}%, or name another case with --like",
                    (least * 100.0).ceil() / 100.0
                ),
            ));
        };
        let mut set = best.set.clone();
        set.push(format!(
            "fluid.spacing={:.4e}",
            length / f64::from(best.resolution)
        ));
        Ok(Advice {
            like: kind.case.to_owned(),
            why: match like {
                Some(_) => "named by --like".to_owned(),
                None => kind.about.to_owned(),
            },
            figure: best.figure.clone(),
            error: best.error,
            across: best.resolution,
            length,
            set,
            step: best.step,
            machine: self.machine.clone(),
            date: self.date.clone(),
            particles: best.particles,
            wall_per_simulated: best.wall_per_simulated,
        })
    }
}

/// The kind of flow that a scene is.
fn kind_of(scene: &Scene, like: Option<&str>) -> Result<&'static Kind> {
    let names = || KINDS.iter().map(|kind| kind.case).collect::<Vec<_>>().join(", ");
    let find = |case: &str| KINDS.iter().find(|kind| kind.case == case);
    if scene.fluid().is_none() {
        return Err(Error::usage(
            "results are there for fluids only, and this scene has grains",
            "leave --error out; `sliceflow study accuracy --case collision` measures errors of grains",
        ));
    }
    if let Some(case) = like {
        return find(case).ok_or_else(|| {
            Error::usage(
                format!("no result is of a case `{case}`"),
                format!("name one of {}", names()),
            )
        });
    }
    let dimensions = scene.dimensions.count();
    let period = scene.domain.period();
    let periodic = (0..dimensions).filter(|&axis| period[axis] > 0.0).count();
    let weightless = scene.gravity == Vec3::ZERO;
    let case = match (weightless, periodic) {
        (true, n) if n == dimensions => "taylor_green_2d",
        (false, n) if n > 0 && n < dimensions && fills(scene, across_channel(scene)) => "poiseuille",
        (false, 0) if (0..dimensions).all(|axis| axis == vertical(scene) || fills(scene, axis)) => {
            "still_water"
        }
        (false, 0) => "martin_moyce",
        _ => {
            return Err(Error::usage(
                "no measured case is like this scene",
                format!("name one that is near with --like: {}", names()),
            ));
        }
    };
    Ok(find(case).expect("a row of the table"))
}

/// The axis along which gravity acts most.
fn vertical(scene: &Scene) -> usize {
    let weight = scene.gravity.abs();
    (0..3)
        .max_by(|&a, &b| weight[a].total_cmp(&weight[b]))
        .unwrap_or(1)
}

/// The shortest axis that is not periodic.
fn across_channel(scene: &Scene) -> usize {
    let period = scene.domain.period();
    let extent = scene.domain.max - scene.domain.min;
    let axes = (0..scene.dimensions.count()).filter(|&axis| period[axis] == 0.0);
    axes.min_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(1)
}

/// Lowest and highest coordinate of the fluid at the start, half a spacing farther than its particles.
fn ends(scene: &Scene, axis: usize) -> Option<[f32; 2]> {
    let half = (scene.fluid()?.spacing / 2.0) as f32;
    let along = || scene.particles.position.iter().map(|p| p[axis]);
    (!scene.particles.position.is_empty()).then(|| {
        [
            along().fold(f32::INFINITY, f32::min) - half,
            along().fold(f32::NEG_INFINITY, f32::max) + half,
        ]
    })
}

/// Whether the fluid reaches from one side of the domain to the other.
fn fills(scene: &Scene, axis: usize) -> bool {
    let domain = &scene.domain;
    let spacing = scene.fluid().map_or(0.0, |fluid| fluid.spacing) as f32;
    ends(scene, axis)
        .is_some_and(|[low, high]| low < domain.min[axis] + spacing && high > domain.max[axis] - spacing)
}

/// The length that the kind's resolution counts particles along, metres.
fn length(scene: &Scene, kind: &Kind) -> Result<f64> {
    let extent = scene.domain.max - scene.domain.min;
    let period = scene.domain.period();
    let length = match kind.case {
        "taylor_green_2d" => {
            let periods = (0..scene.dimensions.count())
                .map(|axis| period[axis])
                .filter(|&p| p > 0.0);
            periods.reduce(f32::min)
        }
        "poiseuille" => Some(extent[across_channel(scene)]),
        _ => ends(scene, vertical(scene)).map(|[low, high]| high - low),
    };
    length
        .map(f64::from)
        .filter(|&length| length > 0.0)
        .ok_or_else(|| {
            Error::usage(
                format!("the scene has no length like {} of `{}`", kind.length, kind.case),
                "give it particles at the start, or name another case with --like",
            )
        })
}

/// `2%` or `2`, in percent.
///
/// # Errors
///
/// Where it is no number above zero.
pub fn percent(text: &str) -> std::result::Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end();
    match number.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("write a percentage above zero: 2%".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{library, load};

    fn scene(name: &str, set: &[&str]) -> Scene {
        let set: Vec<String> = set.iter().map(|&s| s.to_owned()).collect();
        let text = library::find(name).unwrap();
        load::parse(text, &format!("{name}.json"), &library::folder().unwrap(), &set).unwrap()
    }

    fn table() -> Achieved {
        let rung = |case: &str, set: &str, resolution, error, wall| Achievement {
            case: case.into(),
            figure: "front".into(),
            set: vec![set.into()],
            step: 1.0,
            resolution,
            error,
            particles: resolution * resolution,
            wall_per_simulated: wall,
        };
        Achieved {
            machine: "an adapter".into(),
            date: "today".into(),
            sliceflow: "0".into(),
            rungs: vec![
                rung("martin_moyce", "fluid.solver=wcsph", 40, 1.0, 50.0),
                rung("martin_moyce", "fluid.solver=dfsph", 40, 1.9, 8.0),
                rung("martin_moyce", "fluid.solver=dfsph", 20, 4.0, 1.0),
            ],
        }
    }

    #[test]
    fn scenes_that_ship_are_what_their_names_say() {
        for (name, case) in [
            ("martin_moyce", "martin_moyce"),
            ("still_water", "still_water"),
            ("poiseuille", "poiseuille"),
            ("taylor_green_2d", "taylor_green_2d"),
            ("harada_dam", "martin_moyce"),
        ] {
            assert_eq!(kind_of(&scene(name, &[]), None).unwrap().case, case, "{name}");
        }
        let told = kind_of(&scene("column_2d", &[]), None).map(|_| ()).unwrap_err();
        assert!(told.to_string().contains("grains"), "{told}");
        let told = kind_of(&scene("ringing_drop", &[]), None)
            .map(|_| ())
            .unwrap_err();
        assert!(told.to_string().contains("--like"), "{told}");
    }

    #[test]
    fn the_cheapest_that_is_good_enough_is_advised() {
        let scene = scene("harada_dam", &[]);
        let of = |error: f64| table().advise(&scene, error, None);
        let advice = of(2.0).unwrap();
        assert_eq!(advice.set[0], "fluid.solver=dfsph");
        // 0.75 m high.
        assert!((advice.length - 0.75).abs() < 1e-3, "{}", advice.length);
        assert!(
            advice.set[1].starts_with("fluid.spacing=1.87"),
            "{:?}",
            advice.set
        );
        assert_eq!(of(1.5).unwrap().set[0], "fluid.solver=wcsph");
        assert_eq!(of(5.0).unwrap().across, 20);
        let told = of(0.5).unwrap_err().to_string();
        assert!(told.contains("1.00 %") && told.contains("--error 1%"), "{told}");
        let told = table()
            .advise(&scene, 2.0, Some("still_water"))
            .unwrap_err()
            .to_string();
        assert!(
            told.contains("still_water") && told.contains("speed-error"),
            "{told}"
        );
        assert!(table().advise(&scene, 2.0, Some("tea")).is_err());
    }

    #[test]
    fn the_table_that_ships_knows_its_cases() {
        let table = Achieved::shipped();
        for rung in &table.rungs {
            assert!(KINDS.iter().any(|kind| kind.case == rung.case), "{}", rung.case);
            assert!(rung.error.is_finite() && rung.wall_per_simulated > 0.0 && rung.resolution > 0);
        }
    }

    #[test]
    fn percentages_are_read() {
        assert_eq!(percent("2%"), Ok(2.0));
        assert_eq!(percent(" 0.5 % "), Ok(0.5));
        assert_eq!(percent("3"), Ok(3.0));
        for wrong in ["", "%", "two", "-1%", "0", "inf"] {
            assert!(percent(wrong).is_err(), "{wrong}");
        }
    }
}
