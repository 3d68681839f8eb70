//! Particles that a user brings or a run has written: PLY (ASCII or binary), VTK, BGEO, CSV, or a NumPy array.

mod csv;
mod npy;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;

use super::{Dimensions, bgeo, ply, vtp};

#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Metres, in the file's own coordinates; z is 0 in 2D.
    pub position: Vec<DVec3>,
    /// Metres per second.
    pub velocity: Option<Vec<DVec3>>,
    /// Each one once.
    pub id: Option<Vec<u32>>,
    /// Metres.
    pub radius: Option<Vec<f64>>,
}

/// What a file says of its particles under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    pub name: String,
    /// Numbers per particle: 3 of `position` and `velocity`, 1 of all others.
    pub width: usize,
    /// In order of the rows.
    pub values: Vec<f64>,
}

/// Reads particles; the extension names the format. An error is a sentence with the place and the help.
pub fn load(path: &Path, dimensions: Dimensions) -> Result<Loaded, String> {
    let table = read(path)?;
    table
        .check(dimensions)
        .map_err(|what| format!("{}: {what}", path.display()))
}

/// Reads positions alone, in order of the rows; velocities and ids are passed over. Dimensions follow the file's
/// columns (2D where there is no z) unless they are given.
pub fn load_positions(
    path: &Path,
    dimensions: Option<Dimensions>,
) -> Result<(Vec<DVec3>, Dimensions), String> {
    let mut table = read(path)?;
    table
        .columns
        .retain(|(name, _)| place(name).is_some_and(|place| place <= Z));
    let dimensions = dimensions.unwrap_or(match table.find(Z) {
        Some(_) => Dimensions::Three,
        None => Dimensions::Two,
    });
    let loaded = table
        .check(dimensions)
        .map_err(|what| format!("{}: {what}", path.display()))?;
    Ok((loaded.position, dimensions))
}

/// Reads everything that a file says of its particles, as it stands there: unchecked, and not a number where a run went
/// wrong.
pub fn load_attributes(path: &Path) -> Result<Vec<Attribute>, String> {
    let mut table = read(path)?;
    let mut attributes = Vec::new();
    for (name, first) in [("position", 0), ("velocity", VELOCITY)] {
        let axes = [first, first + 1, first + 2];
        if axes.iter().any(|&axis| table.find(axis).is_none()) {
            continue;
        }
        let [x, y, z] = axes.map(|axis| table.take(axis));
        let vectors = x.iter().zip(y).zip(z);
        attributes.push(Attribute {
            name: name.into(),
            width: 3,
            values: vectors.flat_map(|((&x, y), z)| [x, y, z]).collect(),
        });
    }
    let others = table.columns.into_iter().map(|(name, values)| Attribute {
        name,
        width: 1,
        values,
    });
    attributes.extend(others);
    Ok(attributes)
}

fn read(path: &Path) -> Result<Table, String> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    match extension.to_ascii_lowercase().as_str() {
        "ply" => ply::read(path).map(|file| Table::new("vertex", file.vertices)),
        "vtp" => vtp::read(path),
        "bgeo" => bgeo::read(path),
        "csv" => csv::read(path),
        "npy" => npy::read(path),
        _ => Err(format!(
            "{}: particles are read from .ply, .vtp, .bgeo, .csv and .npy files; convert it to one of them",
            path.display()
        )),
    }
}

/// What a particle is known to have: name and alias.
const COLUMNS: [[&str; 2]; 8] = [
    ["x", "position_x"],
    ["y", "position_y"],
    ["z", "position_z"],
    ["vx", "velocity_x"],
    ["vy", "velocity_y"],
    ["vz", "velocity_z"],
    ["id", "particle_id"],
    ["radius", "pscale"],
];
const Z: usize = 2;
const VELOCITY: usize = 3;
const VZ: usize = 5;
const ID: usize = 6;
const RADIUS: usize = 7;

/// The place of a column in [`COLUMNS`], whatever the case of its name.
fn place(name: &str) -> Option<usize> {
    COLUMNS
        .iter()
        .position(|names| names.iter().any(|known| known.eq_ignore_ascii_case(name)))
}

/// Whether a column is of use to a scene.
pub(super) fn is_known(name: &str) -> bool {
    place(name).is_some()
}

/// The columns that an attribute of so many components becomes.
pub(super) fn columns_of(attribute: &str, components: usize) -> Vec<String> {
    let is_velocity = ["v", "velocity"]
        .iter()
        .any(|known| known.eq_ignore_ascii_case(attribute));
    match components {
        1 => vec![attribute.to_owned()],
        3 if is_velocity => ["vx", "vy", "vz"].map(String::from).into(),
        _ => (0..components)
            .map(|component| format!("{attribute}_{component}"))
            .collect(),
    }
}

/// A column's name, and one number per row.
pub(crate) type NamedColumn = (String, Vec<f64>);

/// A particle file of any format, read but not yet checked.
pub(super) struct Table {
    /// What the file calls a row: "line 3", "vertex 3", "row 3".
    noun: &'static str,
    columns: Vec<NamedColumn>,
    /// Number of each row in the file, where they do not count from zero.
    numbers: Option<Vec<usize>>,
}

impl Table {
    /// Rows count from zero.
    pub fn new(noun: &'static str, columns: Vec<NamedColumn>) -> Self {
        Self {
            noun,
            columns,
            numbers: None,
        }
    }

    /// Where one of [`COLUMNS`] is; under its short name where the file has both.
    fn index(&self, place: usize) -> Option<usize> {
        let named = |wanted: &str| {
            let mut names = self.columns.iter().map(|(name, _)| name);
            names.position(|name| name.eq_ignore_ascii_case(wanted))
        };
        let [name, alias] = COLUMNS[place];
        named(name).or_else(|| named(alias))
    }

    fn find(&self, place: usize) -> Option<&[f64]> {
        self.index(place).map(|index| self.columns[index].1.as_slice())
    }

    /// Takes it out; empty where there is none.
    fn take(&mut self, place: usize) -> Vec<f64> {
        self.index(place)
            .map_or_else(Vec::new, |index| self.columns.remove(index).1)
    }

    fn check(self, dimensions: Dimensions) -> Result<Loaded, String> {
        let axes = dimensions.count();
        let known: [Option<&[f64]>; 8] = std::array::from_fn(|place| self.find(place));
        let missing: Vec<_> = (0..axes)
            .filter(|&axis| known[axis].is_none())
            .map(|axis| COLUMNS[axis][0])
            .collect();
        if !missing.is_empty() {
            return Err(format!(
                "{axes}D needs the columns {}, and {} is missing; add it or name it in the header",
                ["x, y", "x, y, z"][axes - 2],
                missing.join(", ")
            ));
        }
        let found = known[VELOCITY..VELOCITY + axes].iter().flatten().count();
        if found != 0 && found < axes {
            return Err(format!(
                "velocity has {found} of {axes} components; give {} or none",
                ["vx and vy", "vx, vy and vz"][axes - 2]
            ));
        }
        let rows = known[0].map_or(0, <[f64]>::len);
        if rows == 0 {
            return Err("there are no particles in it; write at least one".into());
        }

        let number = |row: usize| self.numbers.as_ref().map_or(row, |numbers| numbers[row]);
        let mut first_with_id = HashMap::new();
        for row in 0..rows {
            let place = format_args!("{} {}", self.noun, number(row));
            for (values, [name, _]) in known.iter().zip(COLUMNS) {
                let value = values.map_or(0.0, |values| values[row]);
                if !value.is_finite() {
                    return Err(format!("{place}: {name} is {value}; give a finite number"));
                }
            }
            for flat in [Z, VZ] {
                let value = known[flat].map_or(0.0, |values| values[row]);
                if dimensions == Dimensions::Two && value != 0.0 {
                    let name = COLUMNS[flat][0];
                    return Err(format!(
                        "{place}: {name} is {value} in 2D; leave the column out or set `dimensions` to 3"
                    ));
                }
            }
            if let Some(ids) = known[ID] {
                let id = ids[row];
                if id.fract() != 0.0 || !(0.0..=f64::from(u32::MAX)).contains(&id) {
                    return Err(format!(
                        "{place}: id is {id}; ids are whole numbers from 0 to {}",
                        u32::MAX
                    ));
                }
                if let Some(earlier) = first_with_id.insert(id as u32, row) {
                    return Err(format!(
                        "{place}: id {id} is that of {} {}; give each particle its own, or leave the column out",
                        self.noun,
                        number(earlier)
                    ));
                }
            }
        }

        let vectors = |first: usize| -> Vec<DVec3> {
            let component = |row: usize, axis: usize| known[first + axis].map_or(0.0, |values| values[row]);
            let vector = |row| DVec3::from_array([0, 1, 2].map(|axis| component(row, axis)));
            (0..rows).map(vector).collect()
        };
        Ok(Loaded {
            position: vectors(0),
            velocity: known[VELOCITY].map(|_| vectors(VELOCITY)),
            id: known[ID].map(|ids| ids.iter().map(|&id| id as u32).collect()),
            radius: known[RADIUS].map(<[f64]>::to_vec),
        })
    }
}
