//! The page of an accuracy study: tables beside what others reach, diagrams, and all records as JSON.

use std::path::Path;

use super::cases::Case;
use super::norms;
use super::record::{Bar, Figure, Record};
use super::work_precision::{Against, diagram, errors};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::study::page::{Cell, Page, Table};

const DIAGRAMS: [(Against, &str, &str); 3] = [
    (Against::Time, "time", "error against wall time"),
    (Against::Updates, "updates", "error against particle updates"),
    (Against::Resolution, "resolution", "error against resolution"),
];

/// Fills the page, and writes three diagrams for every case, each as PNG and SVG.
pub fn write(page: &mut Page, cases: &[&Case], records: &[Record]) -> Result<()> {
    if let Some(record) = records.first() {
        page.paragraph(format!(
            "Measured on {}, Sliceflow {}. Wall times leave out what compiled the shaders.",
            record.adapter,
            env!("CARGO_PKG_VERSION")
        ));
    }
    page.heading("All cases");
    page.paragraph(
        "Figures that have a bar to meet, or that others have published. `not met` and `diverged` stay on this page.",
    );
    let judged = |figure: &Figure| figure.bar.is_some() || figure.best.is_some();
    page.table("figures", &figures(cases, records, judged));
    for case in cases {
        let of_case: Vec<_> = records.iter().filter(|r| r.case == case.name).cloned().collect();
        page.heading(case.title);
        page.paragraph(case.about);
        page.table(&format!("{}_runs", case.name), &runs(case, &of_case));
        let all = figures(&[case], &of_case, |_| true);
        page.table(&format!("{}_figures", case.name), &all);
        page.table(&format!("{}_order", case.name), &orders(case, &of_case));
        diagrams(page, case, &of_case)?;
        for published in case.published {
            page.paragraph(format!("{}: {}.", published.method, published.source));
        }
    }
    page.value(
        "records",
        serde_json::to_value(records).expect("records are numbers and text"),
    );
    Ok(())
}

fn diagrams(page: &mut Page, case: &Case, records: &[Record]) -> Result<()> {
    for (against, ending, caption) in DIAGRAMS {
        let Some(plot) = diagram(case, records, against) else {
            page.paragraph(format!("No run has a figure for {caption}."));
            continue;
        };
        let file = format!("{}_{ending}.png", case.name);
        page.picture(&file, &format!("{}: {caption}.", case.title), |path| {
            both(&plot, path)
        })?;
    }
    Ok(())
}

/// A PNG, and an SVG beside it.
fn both(plot: &Plot, png: &Path) -> Result<()> {
    plot.save(png)?;
    plot.save(&png.with_extension("svg"))
}

/// One row a figure that is `wanted`: ours beside the best of others and the bar.
fn figures(cases: &[&Case], records: &[Record], wanted: impl Fn(&Figure) -> bool) -> Table {
    let mut table = Table::new([
        "case",
        "method",
        "resolution",
        "figure",
        "ours",
        "best of others",
        "who",
        "bar",
        "verdict",
    ]);
    for case in cases {
        for record in records.iter().filter(|record| record.case == case.name) {
            for figure in record.figures.iter().filter(|figure| wanted(figure)) {
                let best = figure.best.as_ref();
                table.row([
                    Cell::text(case.name),
                    Cell::text(record.method.name()),
                    Cell::text((case.label)(record.resolution)),
                    Cell::text(figure.label()),
                    small(figure.value),
                    small(best.map(|best| best.value)),
                    best.map_or(Cell::Nothing, |best| Cell::text(best.source.as_str())),
                    figure.bar.map_or(Cell::Nothing, |bar| Cell::text(words(bar))),
                    record.verdict(figure).word().map_or(Cell::Nothing, Cell::text),
                ]);
            }
        }
    }
    table
}

/// One row a run: what it was and what it cost.
fn runs(case: &Case, records: &[Record]) -> Table {
    let mut table = Table::new([
        "method",
        case.resolution,
        "particles",
        "spacing, m",
        "step, s",
        "steps",
        "simulated, s",
        "wall, s",
        "wall over simulated",
        "particle updates",
        "remark",
    ]);
    for record in records {
        table.row([
            Cell::text(record.method.name()),
            Cell::text((case.label)(record.resolution)),
            Cell::count(record.particles.into()),
            small(Some(record.spacing)),
            small(Some(record.time_step)),
            Cell::count(record.steps),
            small(Some(record.simulated)),
            small(Some(record.wall)),
            small(Some(record.wall_per_simulated())),
            Cell::count(record.particle_updates),
            record
                .diverged
                .as_deref()
                .map_or(Cell::Nothing, |why| Cell::text(format!("diverged: {why}"))),
        ]);
    }
    table
}

/// One row a method: order of convergence of the case's figure, over all resolutions and from each to the next.
fn orders(case: &Case, records: &[Record]) -> Table {
    let mut table = Table::new(["method", "figure", "order over all", "from each to the next"]);
    let mut methods: Vec<_> = records.iter().map(|record| &record.method).collect();
    methods.dedup();
    let mut seen = Vec::new();
    for method in methods {
        if seen.contains(&method) {
            continue;
        }
        seen.push(method);
        let runs = records
            .iter()
            .filter(|r| r.method == *method && r.diverged.is_none());
        let errors = errors(case, runs);
        let steps = norms::orders(&errors);
        let steps = steps
            .iter()
            .map(|order| order.map_or("–".to_owned(), |order| format!("{order:.2}")));
        let steps = steps.collect::<Vec<_>>().join(", ");
        table.row([
            Cell::text(method.name()),
            Cell::text(case.figure),
            Cell::maybe(norms::order(&errors)),
            if steps.is_empty() {
                Cell::Nothing
            } else {
                Cell::text(steps)
            },
        ]);
    }
    table
}

/// Three significant digits, small numbers with an exponent.
fn small(value: Option<f64>) -> Cell {
    match value {
        Some(value) if value != 0.0 && value.is_finite() && value.abs() < 1e-2 => Cell::Number {
            value,
            shown: format!("{value:.2e}"),
        },
        other => Cell::maybe(other),
    }
}

fn words(bar: Bar) -> String {
    match bar {
        Bar::AtMost(most) => format!("≤ {most}"),
        Bar::AtLeast(least) => format!("≥ {least}"),
        Bar::Within(least, most) => format!("{least} to {most}"),
    }
}

/// One line a figure with a bar, for standard error.
pub fn line(case: &Case, record: &Record, figure: &Figure) -> String {
    let value = match small(figure.value) {
        Cell::Number { shown, .. } => shown,
        _ => "–".to_owned(),
    };
    let bar = figure
        .bar
        .map_or(String::new(), |bar| format!(", bar {}", words(bar)));
    let verdict = record
        .verdict(figure)
        .word()
        .map_or(String::new(), |word| format!(": {word}"));
    format!(
        "accuracy: {}, {}, {}: {} {value}{bar}{verdict}",
        case.name,
        record.method.name(),
        (case.label)(record.resolution),
        figure.label()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::accuracy::cases::tests::vortices;
    use crate::study::accuracy::record::tests::record;

    #[test]
    fn the_page_says_what_was_met_and_what_was_not() {
        let folder = tempfile::tempdir().unwrap();
        let mut records: Vec<_> = [(25, 3.0), (50, 1.5), (100, 0.7)]
            .map(|(n, e)| record("edac", n, e))
            .into();
        records.push(record("wcsph", 100, 52.0));
        records.push(Record {
            diverged: Some("a particle left the domain".into()),
            ..record("sph", 100, 1.0)
        });
        let mut page = Page::create(folder.path(), "accuracy", "Accuracy", false).unwrap();
        write(&mut page, &[&vortices()], &records).unwrap();
        let path = page.save().unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        for words in [
            "| vortices | edac, wendland_c2, velocity_verlet | 100² | L1 of speed, % | 0.700 | 1.38 | PySPH, EDAC, 100² | ≤ 1 | met |",
            "| 52.0 | 1.38 | PySPH, EDAC, 100² | ≤ 1 | not met |",
            "≤ 1 | diverged |",
            "diverged: a particle left the domain",
            "Measured on llvmpipe",
            "| edac, wendland_c2, velocity_verlet | L1 of speed | 1.05 | 1.00, 1.10 |",
            "](vortices_time.png)",
        ] {
            assert!(text.contains(words), "{words}\n{text}");
        }
        for file in [
            "vortices_time.svg",
            "vortices_updates.png",
            "vortices_resolution.svg",
        ] {
            assert!(folder.path().join(file).exists(), "{file}");
        }
        let json = std::fs::read_to_string(folder.path().join("accuracy.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let again: Vec<Record> = serde_json::from_value(json["records"].clone()).unwrap();
        assert_eq!(again, records);
        let told = line(&vortices(), &records[3], &records[3].figures[0]);
        assert!(
            told.contains("100²: L1 of speed, % 52.0, bar ≤ 1: not met"),
            "{told}"
        );
    }
}
