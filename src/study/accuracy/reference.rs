//! The tables in `assets/reference/`: measured and computed data, each with its source in its first lines.

use std::path::Path;

use include_dir::{Dir, include_dir};

use super::series::Series;
use crate::error::{Error, Result};

static TABLES: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/reference");

/// Numbers in named columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    file: String,
    /// What stands behind `#` in the file's first lines, a line each: source, set-up, units.
    pub remarks: Vec<String>,
    heads: Vec<String>,
    /// One list per column.
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// A table that ships, by its name without ending.
    pub fn shipped(name: &str) -> Result<Self> {
        let file = format!("{name}.csv");
        let text = TABLES.get_file(&file).and_then(|file| file.contents_utf8());
        let path = format!("assets/reference/{file}");
        match text {
            Some(text) => Self::parse(&path, text),
            None => Err(wrong(&path, "there is no such table", "name one that ships")),
        }
    }

    /// Comments behind `#`, one line of names, then as many numbers per line.
    pub fn parse(file: &str, text: &str) -> Result<Self> {
        let mut table = Self {
            file: file.to_owned(),
            remarks: Vec::new(),
            heads: Vec::new(),
            columns: Vec::new(),
        };
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if let Some(remark) = line.strip_prefix('#') {
                table.remarks.push(remark.trim().to_owned());
            } else if table.heads.is_empty() {
                table.heads = line.split(',').map(|name| name.trim().to_owned()).collect();
                table.columns = vec![Vec::new(); table.heads.len()];
            } else if !line.is_empty() {
                table.row(number + 1, line)?;
            }
        }
        Ok(table)
    }

    fn row(&mut self, number: usize, line: &str) -> Result<()> {
        let cells: Vec<&str> = line.split(',').collect();
        if cells.len() != self.heads.len() {
            let what = format!(
                "line {number} has {} of {} numbers",
                cells.len(),
                self.heads.len()
            );
            return Err(wrong(&self.file, what, "give each line a number for each name"));
        }
        for ((cell, head), column) in cells.iter().zip(&self.heads).zip(&mut self.columns) {
            match cell.trim().parse() {
                Ok(value) => column.push(value),
                Err(_) => {
                    let what = format!("line {number}, column `{head}`: `{cell}` is no number");
                    return Err(wrong(&self.file, what, "write it with a decimal point"));
                }
            }
        }
        Ok(())
    }

    /// Values of a column, from the first row to the last.
    pub fn column(&self, name: &str) -> Result<&[f64]> {
        match self.heads.iter().position(|head| head == name) {
            Some(index) => Ok(&self.columns[index]),
            None => Err(wrong(
                &self.file,
                format!("there is no column `{name}`"),
                format!("name one of {}", self.heads.join(", ")),
            )),
        }
    }

    /// Column `y` over column `x`, in ascending order of `x`.
    pub fn series(&self, x: &str, y: &str) -> Result<Series> {
        let (times, values) = (self.column(x)?, self.column(y)?);
        Ok(Series::new(times.iter().copied().zip(values.iter().copied())))
    }

    /// Columns `x` and `y` in the order of the file.
    pub fn points(&self, x: &str, y: &str) -> Result<Vec<(f64, f64)>> {
        let (xs, ys) = (self.column(x)?, self.column(y)?);
        Ok(xs.iter().copied().zip(ys.iter().copied()).collect())
    }
}

fn wrong(file: &str, what: impl std::fmt::Display, help: impl Into<String>) -> Error {
    Error::file(Path::new(file), "read", what, help)
}

/// Lid-driven cavity: u along the vertical center line over y, v along the horizontal one over x, for speed and side
/// one; Re is 100, 400 or 1000.
pub fn cavity(reynolds: u32) -> Result<[Series; 2]> {
    let table = Table::shipped("cavity_reference_computed")?;
    let of = |name: char| table.series("s", &format!("{name}_Re{reynolds}"));
    Ok([of('u')?, of('v')?])
}

/// Taylor–Green in 3D at Re = 100: dissipation −dE/dt and kinetic energy (1/8 at the start) over t U/L.
pub fn taylor_green_3d() -> Result<[Series; 2]> {
    let table = Table::shipped("tgv3d_Re100_reference")?;
    Ok([table.series("t", "dissipation")?, table.series("t", "E_kin")?])
}

/// Martin and Moyce 1952, a column a wide and n² a high with a = 2.25 in: the front Z = x/a over T = t √(n² g/a), and
/// the height at the back wall H = h/(n² a) over τ = t √(g/a).
pub fn martin_moyce(n_squared: u32) -> Result<[Series; 2]> {
    let of = |what: &str, x: &str, y: &str| {
        Table::shipped(&format!("mm1952_n2sq{n_squared}_a2.25in_{what}"))?.series(x, y)
    };
    Ok([of("front", "T", "Z")?, of("height", "tau", "H")?])
}

/// Lobovský 2014, H = 0.3 m: pressure p/(ρ g H) over t √(g/H) at the far wall.
pub struct Lobovsky {
    /// One run each, 3, 30 and 80 mm above the floor.
    pub sensors: [Series; 3],
    /// Over many runs, 15 mm above the floor: what 2.5 % stay below, the median, what 97.5 % stay below.
    pub band: [Series; 3],
}

pub fn lobovsky() -> Result<Lobovsky> {
    let sensor = |name: &str| Table::shipped(&format!("lobovsky2014_h300_{name}"))?.series("tstar", "pstar");
    let band = Table::shipped("lobovsky2014_h300_sensor2_percentiles")?;
    let of = |name: &str| band.series("tstar", name);
    Ok(Lobovsky {
        sensors: [sensor("p1")?, sensor("p3")?, sensor("p4")?],
        band: [of("p2.5")?, of("median")?, of("p97.5")?],
    })
}

/// SPHERIC benchmark 2 (Kleefsman 2005): a column over time in seconds; `P1` to `P8` in Pa, `H1` to `H4` in m.
pub fn spheric_2(column: &str) -> Result<Series> {
    Table::shipped("spheric2_marin_experiment")?.series("t", column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_that_ships_can_be_read_and_names_its_source() {
        for file in TABLES.files() {
            let name = file.path().file_stem().unwrap().to_str().unwrap();
            let table = Table::shipped(name).unwrap();
            assert!(!table.columns[0].is_empty(), "{name}");
            let first = &table.remarks[0];
            assert!(
                first.starts_with("Source") || first.starts_with("SOURCE") || first.starts_with("COMPUTED"),
                "{name}: {first}"
            );
        }
    }

    #[test]
    fn published_figures_are_where_they_belong() {
        // The primary vortex drives v down to −0.2538 (Ghia 1982: −0.24533 at Re 100, less 0.5 %) near x = 0.81.
        let [u, v] = cavity(100).unwrap();
        assert!((u.at(0.5).unwrap() + 0.2091).abs() < 5e-4, "{:?}", u.at(0.5));
        assert!((v.lowest() + 0.2538).abs() < 5e-4, "{}", v.lowest());
        assert!((martin_moyce(2).unwrap()[0].at(1.83).unwrap() - 2.11).abs() < 1e-12);
        assert!((martin_moyce(1).unwrap()[1].at(0.8).unwrap() - 0.89).abs() < 1e-12);
        let [dissipation, energy] = taylor_green_3d().unwrap();
        assert!((energy.at(0.1).unwrap() - 0.12432).abs() < 1e-12);
        assert!((dissipation.at(1.0).unwrap() - 0.007_772_82).abs() < 1e-12);
        let [low, median, high] = lobovsky().unwrap().band;
        for t in [1.0, 3.0, 5.0, 7.0] {
            let [low, median, high] = [&low, &median, &high].map(|series| series.at(t).unwrap());
            assert!(low <= median && median <= high, "t = {t}");
        }
        // 11.24 kPa at 0.415 s.
        let (time, peak) = spheric_2("P1").unwrap().peak().unwrap();
        assert!(
            (peak - 11_240.0).abs() < 20.0 && (time - 0.415).abs() < 2e-3,
            "{peak} Pa at {time} s"
        );
    }

    #[test]
    fn mistakes_name_file_and_column() {
        let told = |result: Result<()>| result.unwrap_err().to_string();
        let table = Table::shipped("ritter1892_profile").unwrap();
        let text = told(table.column("h").map(|_| ()));
        assert!(
            text.contains("ritter1892_profile.csv") && text.contains("`h`") && text.contains("h_over_H"),
            "{text}"
        );
        let text = told(Table::parse("a.csv", "x,y\n1,2\n3,b").map(|_| ()));
        assert!(
            text.contains("a.csv") && text.contains("line 3, column `y`"),
            "{text}"
        );
        let text = told(Table::parse("a.csv", "x,y\n1").map(|_| ()));
        assert!(text.contains("line 2 has 1 of 2 numbers"), "{text}");
        assert!(told(cavity(200).map(|_| ())).contains("u_Re200"));
        assert!(Table::shipped("nothing").is_err());
    }
}
