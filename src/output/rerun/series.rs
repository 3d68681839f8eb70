//! Figures of a frame as named curves, in groups that share a plot.

use serde_json::{Map, Value};

/// A plot: entity below `statistics/`, what the view is called, and its curves by key of `stats.jsonl`.
pub struct Group {
    pub name: &'static str,
    pub title: &'static str,
    curves: &'static [(&'static str, &'static str)],
}

pub const GROUPS: &[Group] = &[
    Group {
        name: "energy",
        title: "energy, J",
        curves: &[
            ("kinetic_energy_j", "kinetic energy, J"),
            ("potential_energy_j", "potential energy, J"),
        ],
    },
    Group {
        name: "throughput",
        title: "particle·steps/s",
        curves: &[(PARTICLE_STEPS_PER_S, "particle·steps/s since the start")],
    },
    Group {
        name: "contacts",
        title: "contacts",
        curves: &[("contacts", "contacts as each particle sees them")],
    },
    Group {
        name: "overlap",
        title: "greatest overlap",
        curves: &[("max_overlap", "greatest overlap, share of the radius")],
    },
    Group {
        name: "clamped",
        title: "clamped particles",
        curves: &[
            ("clamped_pressures", "pressure held at zero"),
            ("clamped_densities", "density held at its lowest"),
        ],
    },
    Group {
        name: "speed",
        title: "greatest speed",
        curves: &[("max_speed_m_per_s", "greatest speed, m/s")],
    },
    Group {
        name: "voxels",
        title: "voxels",
        curves: &[
            ("voxels_allocated", "allocated"),
            ("voxels_occupied", "occupied"),
            ("voxels_with_1", "with 1 particle"),
            ("voxels_with_2", "with 2"),
            ("voxels_with_3", "with 3"),
            ("voxels_with_4", "with 4"),
            ("voxels_with_more", "with more"),
        ],
    },
    Group {
        name: "overflow",
        title: "overflow",
        curves: &[
            ("overflow", "particles without a slot"),
            (
                "overflow_since_last_frame",
                "the same, summed since the last frame",
            ),
        ],
    },
    Group {
        name: "particles",
        title: "particles",
        curves: &[("particles", "particles")],
    },
    Group {
        name: "time_step",
        title: "time step",
        curves: &[
            ("step_s", "time step, s"),
            ("step_min_s", "shortest since the last frame, s"),
            ("step_max_s", "longest, s"),
        ],
    },
    Group {
        name: STEP_LIMITS,
        title: "steps by what limited them",
        curves: &[],
    },
    Group {
        name: PASSES,
        title: "ms a pass",
        curves: &[],
    },
];

/// Key of what a run measures itself, in the place of a figure of `stats.jsonl`.
pub const PARTICLE_STEPS_PER_S: &str = "particle_steps_per_s";
/// The group that has one curve a pass.
pub const PASSES: &str = "passes";
/// The group that has one curve a term that limits adaptive steps.
pub const STEP_LIMITS: &str = "step_limits";
/// Where a frame stands in the run, which the timelines show.
const PLACE: &[&str] = &["frame", "time_s", "steps"];

/// Names and values of the curves of one group.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    pub group: String,
    pub values: Vec<(String, f64)>,
}

/// A frame's figures by group. `figures` is the frame's line of `stats.jsonl`; a key that no group knows is a group of
/// its own.
pub fn curves(figures: &Map<String, Value>) -> Vec<Curves> {
    let mut all: Vec<Curves> = Vec::new();
    let mut add = |group: &str, name: &str, value: f64| {
        let curve = (name.to_owned(), value);
        match all.iter_mut().find(|curves| curves.group == group) {
            Some(curves) => curves.values.push(curve),
            None => all.push(Curves {
                group: group.to_owned(),
                values: vec![curve],
            }),
        }
    };
    for (key, value) in figures.iter().filter(|(key, _)| !PLACE.contains(&key.as_str())) {
        match value {
            Value::Number(number) => {
                let (group, name) = place(key);
                add(group, name, number.as_f64().unwrap_or(f64::NAN));
            }
            Value::Object(passes) if key == "pass_ms" => {
                for (pass, ms) in passes {
                    add(PASSES, pass, ms.as_f64().unwrap_or(f64::NAN));
                }
            }
            Value::Object(limits) if key == "steps_limited_by" => {
                for (limit, steps) in limits {
                    add(STEP_LIMITS, limit, steps.as_f64().unwrap_or(f64::NAN));
                }
            }
            _ => {}
        }
    }
    all
}

/// Group and name of a key's curve.
fn place(key: &str) -> (&str, &str) {
    for group in GROUPS {
        if let Some((_, name)) = group.curves.iter().find(|(known, _)| *known == key) {
            return (group.name, name);
        }
    }
    (key, key)
}

/// The curves of each group in the order in which they appeared, so that a curve keeps its place.
#[derive(Debug, Default)]
pub struct Order {
    groups: Vec<(String, Vec<String>)>,
}

impl Order {
    /// Values of a group in its fixed order (NaN for a curve that this frame lacks), and all names where there are new
    /// ones.
    pub fn arrange(&mut self, curves: &Curves) -> (Vec<f64>, Option<&[String]>) {
        let at = match self.groups.iter().position(|(group, _)| *group == curves.group) {
            Some(at) => at,
            None => {
                self.groups.push((curves.group.clone(), Vec::new()));
                self.groups.len() - 1
            }
        };
        let names = &mut self.groups[at].1;
        let known = names.len();
        for (name, _) in &curves.values {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        let value = |name: &String| {
            let found = curves.values.iter().find(|(known, _)| known == name);
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        let values = names.iter().map(value).collect();
        (values, (names.len() > known).then_some(names.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn figures(value: Value) -> Map<String, Value> {
        value.as_object().unwrap().clone()
    }

    #[test]
    fn figures_become_curves_and_unknown_ones_a_group_of_their_own() {
        let found = curves(&figures(json!({
            "frame": 3, "time_s": 0.1, "kinetic_energy_j": 2.0, "potential_energy_j": 3.0,
            "density_error": 0.01, "pass_ms": { "push": 1.5 },
        })));
        let groups: Vec<_> = found.iter().map(|curves| curves.group.as_str()).collect();
        assert_eq!(groups, ["energy", "density_error", "passes"]);
        assert_eq!(found[0].values[1], ("potential energy, J".into(), 3.0));
        assert_eq!(found[2].values, [("push".into(), 1.5)]);
    }

    #[test]
    fn curves_keep_their_place() {
        let mut order = Order::default();
        let passes = |pass_ms| curves(&figures(json!({ "pass_ms": pass_ms }))).remove(0);
        assert_eq!(
            order.arrange(&passes(json!({ "count": 1.0 }))).1.unwrap(),
            ["count"]
        );
        let both = passes(json!({ "push": 3.0, "count": 2.0 }));
        let (values, names) = order.arrange(&both);
        assert_eq!((values, names.unwrap().len()), (vec![2.0, 3.0], 2));
        let (values, names) = order.arrange(&passes(json!({ "push": 4.0 })));
        assert!(values[0].is_nan() && values[1] == 4.0 && names.is_none());
    }
}
