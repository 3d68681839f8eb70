//! Diagrams of error against cost and against resolution, all axes logarithmic, one curve a method.

use super::cases::Case;
use super::norms;
use super::record::{Bar, Record};
use crate::output::plot::Plot;

const SIZE: (u32, u32) = (1280, 640);
/// A run that broke off stands so many times higher than the largest error.
const ABOVE: f64 = 2.0;

/// What stands on the x axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// Wall seconds per simulated second, on the adapter that the title names.
    Time,
    /// Particle updates per simulated second, which do not depend on the machine.
    Updates,
    /// The legend names each curve's order of convergence.
    Resolution,
}

/// One point: x, the error, and the resolution as its label.
type Labelled = (f64, f64, String);

/// One method's runs.
struct Curve {
    name: String,
    points: Vec<Labelled>,
    /// x and label of runs that broke off.
    broken: Vec<(f64, String)>,
    order: Option<f64>,
}

/// The diagram of a case's records; none where no run has a figure to show.
pub fn diagram(case: &Case, records: &[Record], against: Against) -> Option<Plot> {
    let mut curves = ours(case, records, against);
    let shown = curves.iter().any(|curve| !curve.points.is_empty());
    if !shown {
        return None;
    }
    curves.extend(published(case, against));
    let adapter = records.first().map_or("", |record| record.adapter.as_str());
    let label = records
        .iter()
        .find_map(|record| record.figure(case.figure))?
        .label();
    let (title, x_label) = match against {
        Against::Time => (
            format!("{}: error against time on {}", case.title, short(adapter)),
            "wall seconds per simulated second".to_owned(),
        ),
        Against::Updates => (
            format!("{}: error against work", case.title),
            "particle updates per simulated second".to_owned(),
        ),
        Against::Resolution => (
            format!("{}: error against resolution", case.title),
            case.resolution.to_owned(),
        ),
    };
    let bars = bars(case, records);
    let errors = curves
        .iter()
        .flat_map(|curve| curve.points.iter().map(|point| point.1));
    let above = ABOVE * errors.chain(bars.iter().map(|bar| bar.0)).fold(0.0, f64::max);
    let mut plot = Plot::new(title, x_label, label)
        .size(SIZE.0, SIZE.1)
        .log_x()
        .log_y();
    for curve in curves {
        let name = match (against, curve.order) {
            (Against::Resolution, Some(order)) => format!("{} (order {order:.2})", curve.name),
            _ => curve.name,
        };
        let places = curve.points.iter().map(|point| (point.0, point.1));
        plot = plot.series(name, places);
        if against != Against::Resolution {
            plot = plot.labelled(curve.points.into_iter().map(|point| point.2));
        }
        plot = plot.crosses(curve.broken.into_iter().map(|(x, label)| ((x, above), label)));
    }
    for (bar, name) in bars {
        plot = plot.mark_y(bar, name);
    }
    Some(plot)
}

fn ours(case: &Case, records: &[Record], against: Against) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for record in records.iter().filter(|record| record.case == case.name) {
        let name = record.method.name();
        let x = match against {
            Against::Time => record.wall_per_simulated(),
            Against::Updates => record.updates_per_simulated(),
            Against::Resolution => f64::from(record.resolution),
        };
        let label = (case.label)(record.resolution);
        let at = match curves.iter().position(|curve| curve.name == name) {
            Some(at) => at,
            None => {
                curves.push(Curve::new(name));
                curves.len() - 1
            }
        };
        let figure = record.figure(case.figure).and_then(|figure| figure.value);
        match figure {
            _ if record.diverged.is_some() => curves[at].broken.push((x, format!("{label} diverged"))),
            Some(value) => curves[at].points.push((x, value.abs(), label)),
            None => {}
        }
    }
    for curve in &mut curves {
        let runs = records.iter().filter(|record| {
            record.case == case.name && record.diverged.is_none() && record.method.name() == curve.name
        });
        curve.order = norms::order(&errors(case, runs));
    }
    curves
}

/// Resolution and error of runs.
pub fn errors<'a>(case: &Case, records: impl Iterator<Item = &'a Record>) -> Vec<(f64, f64)> {
    let point = |record: &Record| {
        let value = record.figure(case.figure)?.value?;
        Some((f64::from(record.resolution), value.abs()))
    };
    records.filter_map(point).collect()
}

fn published(case: &Case, against: Against) -> Vec<Curve> {
    let curve = |published: &super::published::Published| {
        let mut curve = Curve::new(published.method.to_owned());
        for point in published.points {
            let x = match against {
                Against::Time => point.wall_per_simulated,
                Against::Updates => None,
                Against::Resolution => Some(f64::from(point.resolution)),
            };
            if let Some(x) = x {
                curve
                    .points
                    .push((x, point.error, (case.label)(point.resolution)));
            }
        }
        let all: Vec<_> = published
            .points
            .iter()
            .map(|point| (f64::from(point.resolution), point.error))
            .collect();
        curve.order = norms::order(&all);
        curve
    };
    let curves = case.published.iter().map(curve);
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// Bars of the figure, each once, with the resolutions that they hold for.
fn bars(case: &Case, records: &[Record]) -> Vec<(f64, String)> {
    let mut found: Vec<(f64, Vec<u32>)> = Vec::new();
    for record in records.iter().filter(|record| record.case == case.name) {
        let bar = record.figure(case.figure).and_then(|figure| figure.bar);
        let Some(Bar::AtMost(most) | Bar::Within(_, most)) = bar else {
            continue;
        };
        let at = found.iter().position(|(known, _)| *known == most);
        let at = at.unwrap_or_else(|| {
            found.push((most, Vec::new()));
            found.len() - 1
        });
        if !found[at].1.contains(&record.resolution) {
            found[at].1.push(record.resolution);
        }
    }
    let named = |(most, resolutions): (f64, Vec<u32>)| {
        let labels: Vec<_> = resolutions.into_iter().map(case.label).collect();
        (most, format!("bar at {}", labels.join(", ")))
    };
    found.into_iter().map(named).collect()
}

/// An adapter's name without its driver.
fn short(adapter: &str) -> &str {
    adapter.split(" (").next().unwrap_or(adapter)
}

impl Curve {
    fn new(name: String) -> Self {
        Self {
            name,
            points: Vec::new(),
            broken: Vec::new(),
            order: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::accuracy::cases::tests::vortices;
    use crate::study::accuracy::record::tests::record;

    fn svg(plot: &Plot) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        plot.save(&path).unwrap();
        std::fs::read_to_string(path).unwrap()
    }

    fn runs() -> Vec<Record> {
        let mut runs: Vec<_> = [(25, 3.2), (50, 1.6), (100, 0.8)]
            .map(|(n, error)| record("edac", n, error))
            .into();
        runs.extend([(25, 60.0), (50, 55.0)].map(|(n, error)| record("wcsph", n, error)));
        runs.push(Record {
            diverged: Some("a particle left the domain".into()),
            ..record("wcsph", 100, 1.0)
        });
        runs
    }

    #[test]
    fn diagrams_name_methods_resolutions_bars_and_what_broke_off() {
        let case = vortices();
        let time = svg(&diagram(&case, &runs(), Against::Time).unwrap());
        for words in [
            "edac, wendland_c2",
            "25²",
            "100² diverged",
            "bar at 100²",
            "PySPH, EDAC",
            "on llvmpipe",
            "L1 of speed, %",
        ] {
            assert!(time.contains(words), "{words}");
        }
        // Nobody tells how many particle updates PySPH made.
        let updates = svg(&diagram(&case, &runs(), Against::Updates).unwrap());
        assert!(!updates.contains("PySPH") && updates.contains("particle updates"));
        let resolution = svg(&diagram(&case, &runs(), Against::Resolution).unwrap());
        assert!(
            resolution.contains("edac, wendland_c2, velocity_verlet (order 1.00)"),
            "{resolution}"
        );
        assert!(resolution.contains("PySPH, EDAC (f64, one core) (order 0.50)"));
    }

    #[test]
    fn a_case_without_figures_has_no_diagram() {
        let broken: Vec<_> = runs().into_iter().filter(|run| run.diverged.is_some()).collect();
        assert!(diagram(&vortices(), &broken, Against::Time).is_none());
        assert!(diagram(&vortices(), &[], Against::Time).is_none());
    }
}
