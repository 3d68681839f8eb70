//! What was found, as tables.

use super::Found;
use super::structures::structures;
use crate::cli::table::Align::{Left, Right};
use crate::cli::table::Table;
use crate::neighbors::occupancy::Figures;
use crate::output::text::{bytes, count};

/// A line about the state, then tables, each under a line that says what it shows.
pub struct Report {
    head: String,
    tables: Vec<(String, Table)>,
}

pub fn report(found: &Found, slices: bool) -> Report {
    let mut tables = vec![
        ("voxels with particles".to_owned(), occupied(found)),
        ("memory".to_owned(), memory(found)),
    ];
    if !found.subject.over_time.is_empty() {
        tables.push(("voxels that have memory, over time".to_owned(), over_time(found)));
    }
    if slices {
        let what = "slices along the slicing axis; the grids' columns are voxels that have memory";
        tables.push((what.to_owned(), by_slice(found)));
    }
    Report {
        head: head(found),
        tables,
    }
}

impl Report {
    pub fn to_text(&self) -> String {
        let tables = self
            .tables
            .iter()
            .map(|(what, table)| format!("\n{what}\n{table}"));
        format!("{}\n{}", self.head, tables.collect::<String>())
    }

    pub fn to_markdown(&self) -> String {
        let tables = self
            .tables
            .iter()
            .map(|(what, table)| format!("\n## {what}\n\n{}", table.to_markdown()));
        format!("# {}\n{}", self.head, tables.collect::<String>())
    }
}

fn head(found: &Found) -> String {
    let subject = &found.subject;
    let domain = subject.census.grid.domain_voxels();
    let moment = match subject.simulated {
        true => format!("frame {}, t = {:.3} s, ", subject.frame, subject.time),
        false => String::new(),
    };
    let boundary = match subject.scene.boundary.len() {
        0 => String::new(),
        walls => format!(" and {} boundary particles", count(walls as u64)),
    };
    format!(
        "{}: {moment}{} particles{boundary}, {} voxels in the domain",
        subject.scene.name,
        count(subject.scene.particles.len() as u64),
        count(domain)
    )
}

fn percent(part: u64, whole: u64) -> String {
    match 100.0 * part as f64 / whole.max(1) as f64 {
        small if small < 9.995 => format!("{small:.2} %"),
        large => format!("{large:.1} %"),
    }
}

fn occupied(found: &Found) -> Table {
    let mut table = Table::new([
        ("", Left),
        ("occupied", Right),
        ("with 1", Right),
        ("2", Right),
        ("3", Right),
        ("4", Right),
        ("more particles", Right),
    ]);
    let mut row = |name: &str, occupied: u64, with: [u64; 4], more: u64| {
        let cells = [occupied].into_iter().chain(with).chain([more]).map(count);
        table.row([name.to_owned()].into_iter().chain(cells));
    };
    let figures = found.subject.census.figures();
    row("positions", figures.occupied, figures.with, figures.with_more);
    for one in &found.grids {
        if let Some(device) = one.device {
            row(
                &one.name,
                device.voxels_occupied.into(),
                device.voxels_with.map(u64::from),
                device.voxels_with_more.into(),
            );
        }
    }
    table
}

fn memory(found: &Found) -> Table {
    let mut table = Table::new([
        ("", Left),
        ("cells", Right),
        ("of the domain", Right),
        ("without a slot", Right),
        ("bytes", Right),
        ("of uniform", Right),
    ]);
    for one in structures(found) {
        table.row([
            one.name,
            count(one.cells),
            percent(one.cells, found.subject.census.grid.domain_voxels()),
            one.overflow.map_or("".into(), count),
            bytes(one.bytes),
            percent(one.bytes, one.uniform_bytes),
        ]);
    }
    table
}

fn over_time(found: &Found) -> Table {
    let heads = ["frame", "time", "particles", "occupied", "octree nodes"].map(str::to_owned);
    let grids = found.grids.iter().map(|one| one.name.clone());
    let mut table = Table::with_heads(heads.into_iter().chain(grids).map(|head| (head, Right)));
    for sample in &found.subject.over_time {
        let cells = [
            sample.frame.to_string(),
            format!("{:.3} s", sample.time),
            count(sample.particles),
            count(sample.figures.occupied),
            count(sample.octree.nodes()),
        ];
        let grids = sample.grids.iter().map(|&(voxels, _)| count(voxels));
        table.row(cells.into_iter().chain(grids));
    }
    table
}

fn by_slice(found: &Found) -> Table {
    let heads = [
        "slice",
        "particles",
        "boundary",
        "occupied",
        "with 1",
        "2",
        "3",
        "4",
        "more",
    ];
    let heads = heads.map(str::to_owned);
    let grids = found.grids.iter().map(|one| one.name.clone());
    let mut table = Table::with_heads(heads.into_iter().chain(grids).map(|head| (head, Right)));
    let row = |slice: String, boundary: u64, figures: &Figures, voxels: &[Option<u64>]| {
        let figures = [figures.particles - boundary, boundary, figures.occupied]
            .into_iter()
            .chain(figures.with)
            .chain([figures.with_more]);
        let voxels = voxels.iter().map(|voxels| voxels.map_or("".into(), count));
        [slice]
            .into_iter()
            .chain(figures.map(count))
            .chain(voxels)
            .collect::<Vec<_>>()
    };
    for slice in found.subject.census.slices() {
        let voxels: Vec<_> = found.grids.iter().map(|one| one.in_slice(slice.at)).collect();
        if slice.figures.particles > 0 || voxels.iter().flatten().any(|&voxels| voxels > 0) {
            table.row(row(slice.at.to_string(), slice.boundary, &slice.figures, &voxels));
        }
    }
    let total = found.subject.census.figures();
    let boundary = found.subject.census.boundary.values().sum();
    let voxels: Vec<_> = found
        .grids
        .iter()
        .map(|one| Some(one.allocation.voxels))
        .collect();
    table.row(row("all".into(), boundary, &total, &voxels));
    table
}
