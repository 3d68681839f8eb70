//! Figures of a frame as named curves, in groups that share a plot.

use serde_json::{Map, Value};

/// A plot: entity below `statistics/`, what the view is called, and its curves by key of `stats.jsonl`.
pub struct Group {
    pub name: &'static str,
    pub title: &'static str,
    /// Whether only some solvers have it.
    is_own: bool,
    /// Whether a run without statistics lacks it.
    is_measured: bool,
    curves: &'static [(&'static str, &'static str)],
}

impl Group {
    /// Whether a solver with such figures of its own has it.
    fn fits(&self, own: &[&str]) -> bool {
        !self.is_own || self.curves.iter().any(|(key, _)| own.contains(key))
    }
}

const fn group(
    name: &'static str,
    title: &'static str,
    curves: &'static [(&'static str, &'static str)],
) -> Group {
    Group {
        name,
        title,
        is_own: false,
        is_measured: false,
        curves,
    }
}

const fn measured(
    name: &'static str,
    title: &'static str,
    curves: &'static [(&'static str, &'static str)],
) -> Group {
    Group {
        is_measured: true,
        ..group(name, title, curves)
    }
}

/// What only some solvers measure.
const fn own(
    name: &'static str,
    title: &'static str,
    curves: &'static [(&'static str, &'static str)],
) -> Group {
    Group {
        is_own: true,
        ..measured(name, title, curves)
    }
}

/// The most telling ones first.
const GROUPS: &[Group] = &[
    measured(
        "energy",
        "energy, J",
        &[
            ("kinetic_energy_j", "kinetic energy, J"),
            ("potential_energy_j", "potential energy, J"),
        ],
    ),
    own(
        "density",
        "error of density",
        &[
            ("density_error_mean", "mean, share of the rest density"),
            ("density_error_max", "greatest"),
        ],
    ),
    group(
        "throughput",
        "particle·steps/s",
        &[(PARTICLE_STEPS_PER_S, "particle·steps/s since the start")],
    ),
    own(
        "contacts",
        "contacts",
        &[("contacts", "contacts as each grain sees them")],
    ),
    own(
        "overlap",
        "greatest overlap",
        &[("max_overlap", "greatest overlap, share of the radius")],
    ),
    own(
        "clamped",
        "clamped particles",
        &[
            ("clamped_pressures", "pressure held at zero"),
            ("clamped_densities", "density held at its lowest"),
        ],
    ),
    measured(
        "speed",
        "greatest speed",
        &[("max_speed_m_per_s", "greatest speed, m/s")],
    ),
    measured(
        "voxels",
        "voxels",
        &[
            ("voxels_allocated", "allocated"),
            ("voxels_occupied", "occupied"),
            ("voxels_with_1", "with 1 particle"),
            ("voxels_with_2", "with 2"),
            ("voxels_with_3", "with 3"),
            ("voxels_with_4", "with 4"),
            ("voxels_with_more", "with more"),
        ],
    ),
    group(
        "overflow",
        "overflow",
        &[
            ("overflow", "particles without a slot"),
            (
                "overflow_since_last_frame",
                "the same, summed since the last frame",
            ),
        ],
    ),
    group(
        "particles",
        "particles",
        &[
            ("particles", "particles"),
            ("boundary_particles", "boundary particles"),
        ],
    ),
    group(
        "time_step",
        "time step",
        &[
            ("step_s", "time step, s"),
            ("step_min_s", "shortest since the last frame, s"),
            ("step_max_s", "longest, s"),
        ],
    ),
    group(STEP_LIMITS, "steps by what limited them", &[]),
    group(PASSES, "ms of each pass", &[]),
];

/// The plots of a solver with figures of its own ([`crate::physics::Model::figures`]); without statistics fewer.
pub fn groups(own: &'static [&'static str], statistics: bool) -> impl Iterator<Item = &'static Group> {
    GROUPS
        .iter()
        .filter(move |group| group.fits(own) && (statistics || !group.is_measured))
}

/// Key of what a run measures itself, in the place of a figure of `stats.jsonl`.
pub const PARTICLE_STEPS_PER_S: &str = "particle_steps_per_s";
/// The group that has one curve per pass.
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

/// The figures of a solver by group. `figures` is the frame's line of `stats.jsonl`; a key that no group
/// knows is a group of its own.
pub fn curves(figures: &Map<String, Value>, own: &[&str]) -> Vec<Curves> {
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
                if let Some((group, name)) = place(key, own) {
                    add(group, name, number.as_f64().unwrap_or(f64::NAN));
                }
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

/// Group and name of a key's curve; `None` for what only other solvers have.
fn place<'a>(key: &'a str, own: &[&str]) -> Option<(&'a str, &'a str)> {
    // Not every solver has boundary particles.
    if key == "boundary_particles" && !own.contains(&key) {
        return None;
    }
    for group in GROUPS {
        if let Some((_, name)) = group.curves.iter().find(|(known, _)| *known == key) {
            return group.fits(own).then_some((group.name, name));
        }
    }
    Some((key, key))
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

    const OF_GRAINS: &[&str] = &["contacts", "max_overlap"];
    const OF_FLUIDS: &[&str] = &["boundary_particles", "density_error_mean", "clamped_pressures"];

    fn figures(value: Value) -> Map<String, Value> {
        value.as_object().unwrap().clone()
    }

    #[test]
    fn figures_become_curves_and_unknown_ones_a_group_of_their_own() {
        let found = curves(
            &figures(json!({
                "frame": 3, "time_s": 0.1, "kinetic_energy_j": 2.0, "potential_energy_j": 3.0,
                "viscosity": 0.01, "pass_ms": { "push": 1.5 },
            })),
            OF_GRAINS,
        );
        let groups: Vec<_> = found.iter().map(|curves| curves.group.as_str()).collect();
        assert_eq!(groups, ["energy", "viscosity", "passes"]);
        assert_eq!(found[0].values[1], ("potential energy, J".into(), 3.0));
        assert_eq!(found[2].values, [("push".into(), 1.5)]);
    }

    #[test]
    fn solvers_have_their_own() {
        let line = figures(json!({
            "particles": 400, "boundary_particles": 516, "max_overlap": 0.0, "contacts": 7,
            "density_error_mean": 0.01, "density_error_max": 0.02, "clamped_pressures": 3,
        }));
        let names = |own| -> Vec<String> {
            curves(&line, own)
                .into_iter()
                .map(|curves| curves.group)
                .collect()
        };
        assert_eq!(names(OF_FLUIDS), ["particles", "density", "clamped"]);
        assert_eq!(names(OF_GRAINS), ["particles", "overlap", "contacts"]);
        assert_eq!(
            curves(&line, OF_FLUIDS)[0].values[1],
            ("boundary particles".into(), 516.0)
        );
        assert_eq!(curves(&line, OF_GRAINS)[0].values.len(), 1);
        let first = |statistics| groups(OF_FLUIDS, statistics).next().unwrap().name;
        assert_eq!((first(true), first(false)), ("energy", "throughput"));
        assert_eq!(groups(OF_FLUIDS, true).nth(1).unwrap().name, "density");
        assert!(groups(OF_FLUIDS, true).all(|group| group.name != "overlap"));
    }

    #[test]
    fn curves_keep_their_place() {
        let mut order = Order::default();
        let passes = |pass_ms| curves(&figures(json!({ "pass_ms": pass_ms })), OF_GRAINS).remove(0);
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
