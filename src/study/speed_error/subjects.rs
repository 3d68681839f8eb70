//! Cases of `sliceflow study accuracy` that a ladder is made for, and the rungs of each.

use crate::error::Result;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::cases::{
    Case, channel, lobovsky_dam, martin_moyce, still_water, taylor_green_2d,
};
use crate::study::accuracy::record::Record;
use crate::study::bench::Bench;

/// A case, and how one run of it is made with keys of its scene changed.
pub struct Subject {
    pub case: Case,
    /// Name of the figure that counts.
    pub figure: &'static str,
    pub scene: fn(u32, &[String]) -> Result<Scene>,
    pub run: fn(&Bench, u32, &[String]) -> Result<Record>,
    pub resolutions: fn(Size) -> &'static [u32],
    /// What has to be left out of the scene for `dfsph`.
    pub dfsph: &'static [&'static str],
}

/// Keys that `dfsph` does not know are left out; it clamps pressures.
pub const SUBJECTS: [Subject; 5] = [
    Subject {
        case: martin_moyce::CASE,
        figure: martin_moyce::CASE.figure,
        scene: martin_moyce::scene,
        run: martin_moyce::one,
        resolutions: |size| match size {
            Size::Tiny => &[8],
            Size::Small => &[10, 20, 40],
            Size::Full => &[10, 20, 40, 80],
        },
        dfsph: &["fluid.surface_tension=0", "fluid.negative_pressure=clamp"],
    },
    Subject {
        case: lobovsky_dam::CASE,
        figure: lobovsky_dam::ARRIVAL,
        scene: lobovsky_dam::arrival_scene,
        run: lobovsky_dam::arrival,
        resolutions: |size| match size {
            Size::Tiny => &[8],
            Size::Small => &[10, 20, 40],
            Size::Full => &[10, 20, 40, 80],
        },
        dfsph: &[
            "fluid.support=2",
            "fluid.sound_speed=null",
            "fluid.shifting=0",
            "fluid.wall_friction=0",
        ],
    },
    Subject {
        case: still_water::CASE,
        figure: still_water::CASE.figure,
        scene: |n, changes| still_water::scene(Size::Small, n, changes),
        run: |bench, n, changes| still_water::one(bench, Size::Small, n, changes),
        resolutions: |size| match size {
            Size::Tiny => &[8],
            Size::Small => &[15, 30, 45],
            Size::Full => &[15, 30, 45, 90],
        },
        dfsph: &[],
    },
    Subject {
        case: taylor_green_2d::CASE,
        figure: taylor_green_2d::CASE.figure,
        scene: taylor_green_2d::scene,
        run: taylor_green_2d::one,
        resolutions: |size| match size {
            Size::Tiny => &[16],
            Size::Small => &[16, 25, 50],
            Size::Full => &[25, 50, 100],
        },
        dfsph: &[
            "fluid.density_diffusion=null",
            "fluid.negative_pressure=clamp",
            "fluid.pressure_force=symmetric",
            "fluid.gradient_correction=false",
            "fluid.shifting=0",
        ],
    },
    Subject {
        case: channel::POISEUILLE,
        figure: channel::POISEUILLE.figure,
        scene: channel::poiseuille_scene,
        run: channel::poiseuille,
        resolutions: |size| match size {
            Size::Tiny => &[10],
            Size::Small => &[10, 20, 40],
            Size::Full => &[20, 40, 80],
        },
        dfsph: &["fluid.negative_pressure=clamp"],
    },
];

/// One way to compute a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// What it changes beside the scene as it ships: `dfsph, support 2.6`.
    pub name: String,
    pub set: Vec<String>,
    /// Factor on the length of a step.
    pub step: f64,
    pub resolution: u32,
}

/// What a rung of `wcsph` changes: its name, and keys. The length of a step is changed too, by a factor.
const WCSPH: [(&str, &[&str], f64); 13] = [
    ("support 2", &["fluid.support=2"], 1.0),
    ("support 2.5", &["fluid.support=2.5"], 1.0),
    ("support 4", &["fluid.support=4"], 1.0),
    ("cubic spline", &["fluid.kernel=cubic_spline"], 1.0),
    ("Wendland C2", &["fluid.kernel=wendland_c2"], 1.0),
    ("Wendland C4", &["fluid.kernel=wendland_c4"], 1.0),
    ("quintic spline", &["fluid.kernel=quintic_spline"], 1.0),
    ("velocity Verlet", &["time.integrator=velocity_verlet"], 1.0),
    ("steps half as long", &[], 0.5),
    ("steps 1.5 times as long", &[], 1.5),
    ("adaptive steps", &["time.adaptive=true"], 1.0),
    ("no lists", &["neighbors.skin=0"], 1.0),
    ("skin 0.3", &["neighbors.skin=0.3"], 1.0),
];

const DFSPH: [(&str, &[&str]); 6] = [
    ("Courant number 0.2", &["fluid.courant_number=0.2"]),
    ("Courant number 0.8", &["fluid.courant_number=0.8"]),
    ("support 2.5", &["fluid.support=2.5"]),
    ("Wendland C2", &["fluid.kernel=wendland_c2"]),
    ("density error 0.1 %", &["fluid.max_density_error=1e-3"]),
    ("skin 0.3", &["neighbors.skin=0.3"]),
];

/// All rungs, the most telling ones first: both solvers up to the middle resolution, then what else can be chosen there,
/// then finer ones, which take longest. What would change nothing is left out.
pub fn ways(subject: &Subject, size: Size) -> Result<Vec<Way>> {
    let resolutions = (subject.resolutions)(size);
    let middle = resolutions[resolutions.len() / 2];
    let owned = |set: &[&str]| -> Vec<String> { set.iter().map(|&key| key.to_owned()).collect() };
    let dfsph = [&["fluid.solver=dfsph"], subject.dfsph].concat();
    let mut ways = Vec::new();
    for &resolution in resolutions {
        for (name, set) in [("wcsph", owned(&[])), ("dfsph", owned(&dfsph))] {
            ways.push(Way {
                name: name.to_owned(),
                set,
                step: 1.0,
                resolution,
            });
        }
    }
    let plain = (subject.scene)(middle, &[])?;
    let is_new = |set: &[String]| match (subject.scene)(middle, set) {
        Ok(scene) => !same(&scene, &plain),
        // The run tells why it is refused.
        Err(_) => true,
    };
    let few = size == Size::Tiny;
    for (name, set, factor) in &WCSPH[..if few { 1 } else { WCSPH.len() }] {
        let mut set = owned(set);
        if *factor != 1.0 {
            set.push(format!("time.step={:e}", plain.time.step * factor));
        }
        if is_new(&set) {
            ways.push(Way {
                name: format!("wcsph, {name}"),
                set,
                step: *factor,
                resolution: middle,
            });
        }
    }
    for (name, set) in &DFSPH[..if few { 1 } else { DFSPH.len() }] {
        ways.push(Way {
            name: format!("dfsph, {name}"),
            set: owned(&[&dfsph[..], set].concat()),
            step: 1.0,
            resolution: middle,
        });
    }
    // A stable sort: all else keeps its order.
    ways.sort_by_key(|way| way.resolution > middle);
    Ok(ways)
}

/// Whether two scenes are computed alike.
fn same(a: &Scene, b: &Scene) -> bool {
    a.fluid() == b.fluid() && a.time == b.time && a.neighbors == b.neighbors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    #[test]
    fn every_rung_of_every_size_is_a_scene() {
        for subject in &SUBJECTS {
            for size in [Size::Tiny, Size::Small] {
                let ways = ways(subject, size).unwrap();
                assert!(ways.len() >= 4);
                for way in &ways {
                    let scene = (subject.scene)(way.resolution, &way.set);
                    // What a scene refuses stands on the page with the reason; both solvers as they are run.
                    let is_plain = ["wcsph", "dfsph"].contains(&way.name.as_str());
                    match scene {
                        Err(Error::Scene { .. }) if !is_plain => {}
                        other => {
                            drop(other.unwrap_or_else(|error| {
                                panic!("{}, {}: {error}", subject.case.name, way.name)
                            }))
                        }
                    }
                }
                let named = |name: &str| ways.iter().filter(|way| way.name == name).count();
                let resolutions = (subject.resolutions)(size).len();
                assert_eq!([named("wcsph"), named("dfsph")], [resolutions; 2]);
            }
        }
    }

    #[test]
    fn what_changes_nothing_is_no_rung() {
        let names = |subject: &Subject| -> Vec<String> {
            let ways = ways(subject, Size::Small).unwrap();
            ways.into_iter().map(|way| way.name).collect()
        };
        let [martin_moyce, lobovsky, ..] = &SUBJECTS;
        assert!(!names(martin_moyce).contains(&"wcsph, Wendland C2".to_owned()));
        assert!(names(martin_moyce).contains(&"wcsph, support 4".to_owned()));
        assert!(!names(lobovsky).contains(&"wcsph, support 4".to_owned()));
    }
}
