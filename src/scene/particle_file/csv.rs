//! Comma-separated values. A header names the columns, unknown ones are passed over; without a header: x, y or x, y, z.
//! Empty lines and lines that start with `#` are skipped.

use std::path::Path;

use super::{COLUMNS, NamedColumn, Table, place};
use crate::files;

pub fn read(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let text = files::read_text(path).map_err(|error| format!("{name}: {error}"))?;
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .peekable();

    let Some(&(number, first)) = lines.peek() else {
        return Err(format!(
            "{name}: the file is empty; write a header `x,y,z` and one line per particle"
        ));
    };
    let cells: Vec<&str> = first.split(',').map(str::trim).collect();
    let places: Vec<Option<usize>> = if cells.iter().all(|cell| cell.parse::<f64>().is_ok()) {
        if !(2..=3).contains(&cells.len()) {
            return Err(format!(
                "{name}, line {number}: {} columns without a header; give 2 or 3, or name them in a first line like \
                 `x,y,z,vx,vy,vz,id`",
                cells.len()
            ));
        }
        (0..cells.len()).map(Some).collect()
    } else {
        lines.next();
        cells.iter().map(|cell| place(cell.trim_matches('"'))).collect()
    };
    let mut columns: Vec<NamedColumn> = Vec::new();
    for &place in places.iter().flatten() {
        let column = COLUMNS[place][0];
        if columns.iter().any(|(known, _)| known == column) {
            return Err(format!(
                "{name}, line {number}: the column {column} is there twice; rename one"
            ));
        }
        columns.push((column.to_owned(), Vec::new()));
    }

    let mut numbers = Vec::new();
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != places.len() {
            return Err(format!(
                "{name}, line {number}: {} columns instead of {}; separate them by commas",
                cells.len(),
                places.len()
            ));
        }
        let known = cells.iter().zip(&places).filter(|(_, place)| place.is_some());
        for ((cell, _), (column, values)) in known.zip(&mut columns) {
            values.push(cell.parse().map_err(|_| {
                // The file may be somebody's secret, which one short word of it is not.
                let is_short = cell.len() <= 12
                    && cell
                        .chars()
                        .all(|c| c.is_ascii_alphanumeric() || "+-. ".contains(c));
                let quoted = if is_short {
                    format!("{cell:?}, which is ")
                } else {
                    String::new()
                };
                format!("{name}, line {number}: {column} is {quoted}not a number; write it like 0.25")
            })?);
        }
        numbers.push(number);
    }
    Ok(Table {
        noun: "line",
        columns,
        numbers: Some(numbers),
    })
}
