//! Particles that a user brings or a run has written: PLY (ASCII or binary), VTK, BGEO, CSV, or a NumPy array.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::BufReader;
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
}

/// Reads particles; the extension names the format. An error is a sentence with the place and the mend.
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
    table.present[VELOCITY..].fill(false);
    for (_, Row(values)) in &mut table.rows {
        values[VELOCITY..].fill(0.0);
    }
    let dimensions = dimensions.unwrap_or(match table.present[Z] {
        true => Dimensions::Three,
        false => Dimensions::Two,
    });
    let loaded = table
        .check(dimensions)
        .map_err(|what| format!("{}: {what}", path.display()))?;
    Ok((loaded.position, dimensions))
}

fn read(path: &Path) -> Result<Table, String> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    match extension.to_ascii_lowercase().as_str() {
        "ply" => from_ply(path),
        "vtp" => vtp::read(path),
        "bgeo" => bgeo::read(path),
        "csv" => from_csv(path),
        "npy" => from_npy(path),
        _ => Err(format!(
            "{}: particles are read from .ply, .vtp, .bgeo, .csv and .npy files; convert it to one of them",
            path.display()
        )),
    }
}

/// What a particle can have, in the order of [`Row`]: name and alias.
const COLUMNS: [[&str; 2]; 7] = [
    ["x", "position_x"],
    ["y", "position_y"],
    ["z", "position_z"],
    ["vx", "velocity_x"],
    ["vy", "velocity_y"],
    ["vz", "velocity_z"],
    ["id", "particle_id"],
];
const Z: usize = 2;
const VELOCITY: usize = 3;
const VZ: usize = 5;
const ID: usize = 6;

/// One particle's numbers, by [`COLUMNS`]; 0 for those that its file lacks.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Row(pub [f64; 7]);

/// The place of an attribute of so many components in a [`Row`]: of its first number.
pub(super) fn attribute(name: &str, components: usize) -> Option<usize> {
    match components {
        1 => column(name),
        3 if ["v", "velocity"]
            .iter()
            .any(|known| known.eq_ignore_ascii_case(name)) =>
        {
            Some(VELOCITY)
        }
        _ => None,
    }
}

/// The place of a property in a [`Row`], whatever the case of its name.
pub(super) fn column(name: &str) -> Option<usize> {
    COLUMNS
        .iter()
        .position(|names| names.iter().any(|known| known.eq_ignore_ascii_case(name)))
}

/// A particle file of any format, read but not yet checked.
pub(super) struct Table {
    pub present: [bool; 7],
    /// What the file calls a row: "line 3", "vertex 3", "row 3".
    pub noun: &'static str,
    /// Number of the row in the file.
    pub rows: Vec<(usize, Row)>,
}

impl Table {
    fn check(self, dimensions: Dimensions) -> Result<Loaded, String> {
        let axes = dimensions.count();
        let has = |columns: std::ops::Range<usize>| {
            let found = columns.clone().filter(|&c| self.present[c]).count();
            (found, columns.len())
        };
        let (found, wanted) = has(0..axes);
        if found < wanted {
            let missing: Vec<_> = (0..axes)
                .filter(|&c| !self.present[c])
                .map(|c| COLUMNS[c][0])
                .collect();
            return Err(format!(
                "{axes}D needs the columns {}, and {} is missing; add it or name it in the header",
                ["x, y", "x, y, z"][axes - 2],
                missing.join(", ")
            ));
        }
        let (found, wanted) = has(VELOCITY..VELOCITY + axes);
        if found != 0 && found < wanted {
            return Err(format!(
                "velocity has {found} of {wanted} components; give {} or none",
                ["vx and vy", "vx, vy and vz"][axes - 2]
            ));
        }
        if self.rows.is_empty() {
            return Err("there are no particles in it; write at least one".into());
        }

        let mut first_with_id = HashMap::new();
        for (number, Row(values)) in &self.rows {
            let place = format_args!("{} {number}", self.noun);
            for (value, [name, _]) in values.iter().zip(COLUMNS) {
                if !value.is_finite() {
                    return Err(format!("{place}: {name} is {value}; give a finite number"));
                }
            }
            for flat in [Z, VZ] {
                if dimensions == Dimensions::Two && values[flat] != 0.0 {
                    let name = COLUMNS[flat][0];
                    return Err(format!(
                        "{place}: {name} is {} in 2D; leave the column out or set `dimensions` to 3",
                        values[flat]
                    ));
                }
            }
            if self.present[ID] {
                let id = values[ID];
                if id.fract() != 0.0 || !(0.0..=f64::from(u32::MAX)).contains(&id) {
                    return Err(format!(
                        "{place}: id is {id}; ids are whole numbers from 0 to {}",
                        u32::MAX
                    ));
                }
                if let Some(earlier) = first_with_id.insert(id as u32, number) {
                    return Err(format!(
                        "{place}: id {id} is that of {} {earlier}; give each particle its own, or leave the column out",
                        self.noun
                    ));
                }
            }
        }

        let vectors = |first: usize| {
            let vector = |(_, Row(values)): &(usize, Row)| DVec3::from_slice(&values[first..]);
            self.rows.iter().map(vector).collect::<Vec<_>>()
        };
        let id = |(_, Row(values)): &(usize, Row)| values[ID] as u32;
        Ok(Loaded {
            position: vectors(0),
            velocity: self.present[VELOCITY].then(|| vectors(VELOCITY)),
            id: self.present[ID].then(|| self.rows.iter().map(id).collect()),
        })
    }
}

fn from_ply(path: &Path) -> Result<Table, String> {
    let file = ply::read(path)?;
    let mut present = [false; 7];
    for index in file.properties.iter().filter_map(|name| column(name)) {
        present[index] = true;
    }
    Ok(Table {
        present,
        noun: "vertex",
        rows: file.vertices.into_iter().enumerate().collect(),
    })
}

/// Comma-separated; a header names the columns, unknown ones are passed over. Without a header: x, y or x, y, z.
/// Empty lines and lines that start with `#` are skipped.
fn from_csv(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let text = fs::read_to_string(path).map_err(|error| format!("{name}: {error}"))?;
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .peekable();

    let mut table = Table {
        present: [false; 7],
        noun: "line",
        rows: Vec::new(),
    };
    let Some(&(number, first)) = lines.peek() else {
        return Err(format!(
            "{name}: the file is empty; write a header `x,y,z` and one line a particle"
        ));
    };
    let cells: Vec<&str> = first.split(',').map(str::trim).collect();
    let columns: Vec<Option<usize>> = if cells.iter().all(|cell| cell.parse::<f64>().is_ok()) {
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
        cells.iter().map(|cell| column(cell.trim_matches('"'))).collect()
    };
    for &index in columns.iter().flatten() {
        if std::mem::replace(&mut table.present[index], true) {
            return Err(format!(
                "{name}, line {number}: the column {} is there twice; rename one",
                COLUMNS[index][0]
            ));
        }
    }

    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != columns.len() {
            return Err(format!(
                "{name}, line {number}: {} columns instead of {}; separate them by commas",
                cells.len(),
                columns.len()
            ));
        }
        let mut row = Row::default();
        for (cell, column) in cells.iter().zip(&columns) {
            if let Some(column) = *column {
                row.0[column] = cell.parse().map_err(|_| {
                    format!(
                        "{name}, line {number}: {} is {cell:?}, which is not a number; write it like 0.25",
                        COLUMNS[column][0]
                    )
                })?;
            }
        }
        table.rows.push((number, row));
    }
    Ok(table)
}

/// An N×2 or N×3 array of float32 or float64, in C or Fortran order.
fn from_npy(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let unreadable = |error| format!("{name}: {error}; save it with numpy.save");
    let file = File::open(path).map_err(|error| format!("{name}: {error}"))?;
    let array = npyz::NpyFile::new(BufReader::new(file)).map_err(unreadable)?;
    let &[rows, columns @ 2..=3] = array.shape() else {
        return Err(format!(
            "{name}: the array has shape {:?}; save positions as N×2 or N×3",
            array.shape()
        ));
    };
    let (rows, columns) = (rows as usize, columns as usize);
    let (row_stride, column_stride) = match array.order() {
        npyz::Order::C => (columns, 1),
        npyz::Order::Fortran => (1, rows),
    };
    let values: Vec<f64> = match array.try_data::<f64>() {
        Ok(data) => data.collect::<Result<_, _>>().map_err(unreadable)?,
        Err(array) => match array.try_data::<f32>() {
            Ok(data) => data
                .map(|value| value.map(f64::from))
                .collect::<Result<_, _>>()
                .map_err(unreadable)?,
            Err(array) => {
                return Err(format!(
                    "{name}: the array holds {}; save float32 or float64",
                    array.dtype().descr()
                ));
            }
        },
    };

    let row = |index: usize| {
        let mut row = Row::default();
        for column in 0..columns {
            row.0[column] = values[index * row_stride + column * column_stride];
        }
        (index, row)
    };
    Ok(Table {
        present: std::array::from_fn(|column| column < columns),
        noun: "row",
        rows: (0..rows).map(row).collect(),
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::output::npy;
    use Dimensions::{Three, Two};

    fn file(folder: &tempfile::TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    /// Two particles with velocity and id, in the formats that can carry them.
    #[test]
    fn ply_and_csv_give_the_same_particles() {
        let folder = tempfile::tempdir().unwrap();
        let header = |encoding: &str| {
            format!(
                "ply\nformat {encoding} 1.0\ncomment made by a test\nelement vertex 2\nproperty float x\n\
                 property double y\nproperty float z\nproperty float velocity_x\nproperty float velocity_y\n\
                 property float velocity_z\nproperty uint id\nproperty uchar red\nend_header\n"
            )
        };
        let rows = [
            ([0.5f32, 2.0], 0.1f64, [3.0f32, -4.0, 1e-3], 4_000_000_000u32),
            ([-1.5, 0.25], 7.0, [0.0, 0.0, 9.0], 3),
        ];
        let binary = |big: bool| {
            let mut bytes =
                header(["binary_little_endian", "binary_big_endian"][usize::from(big)]).into_bytes();
            let mut put = |mut number: Vec<u8>| {
                if big {
                    number.reverse();
                }
                bytes.extend(number);
            };
            for ([x, z], y, velocity, id) in rows {
                put(x.to_le_bytes().to_vec());
                put(y.to_le_bytes().to_vec());
                put(z.to_le_bytes().to_vec());
                velocity.iter().for_each(|v| put(v.to_le_bytes().to_vec()));
                put(id.to_le_bytes().to_vec());
                put(vec![255]);
            }
            bytes
        };
        let mut ascii = header("ascii");
        let mut csv = "\u{feff}# a comment\n\nID, x,Y,z,vx,vy,vz,speed\n".to_owned();
        for ([x, z], y, [vx, vy, vz], id) in rows {
            ascii += &format!("{x} {y} {z} {vx} {vy} {vz} {id} 255\n");
            // What f32 holds, in full.
            let vz = f64::from(vz);
            csv += &format!("{id},{x}, {y},{z},{vx},{vy},{vz},fast\r\n");
        }

        let expected = Loaded {
            position: vec![DVec3::new(0.5, 0.1, 2.0), DVec3::new(-1.5, 7.0, 0.25)],
            velocity: Some(vec![
                DVec3::new(3.0, -4.0, f64::from(1e-3f32)),
                DVec3::new(0.0, 0.0, 9.0),
            ]),
            id: Some(vec![4_000_000_000, 3]),
        };
        for (name, bytes) in [
            ("little.ply", binary(false)),
            ("big.ply", binary(true)),
            ("ascii.PLY", ascii.into_bytes()),
            ("table.csv", csv.into_bytes()),
        ] {
            let loaded = load(&file(&folder, name, bytes), Three);
            assert_eq!(loaded.as_ref(), Ok(&expected), "{name}");
        }
    }

    #[test]
    fn csv_without_a_header_holds_positions() {
        let folder = tempfile::tempdir().unwrap();
        let flat = file(&folder, "flat.csv", "1,2\n3,4.5e0\n");
        let loaded = load(&flat, Two).unwrap();
        assert_eq!(
            loaded.position,
            [DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 4.5, 0.0)]
        );
        assert_eq!((loaded.velocity, loaded.id), (None, None));
        let deep = file(&folder, "deep.csv", "1,2,3");
        assert_eq!(load(&deep, Three).unwrap().position, [DVec3::new(1.0, 2.0, 3.0)]);
    }

    #[test]
    fn positions_alone_follow_the_columns_and_the_rows() {
        let folder = tempfile::tempdir().unwrap();
        let flat = file(&folder, "flat.csv", "y,id,x,vx\n2,7,1,nan\n4,7,3,0\n");
        let (position, dimensions) = load_positions(&flat, None).unwrap();
        assert_eq!(position, [DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 4.0, 0.0)]);
        assert_eq!(dimensions, Two);
        let deep = file(&folder, "deep.csv", "1,2,0\n1,2,nan\n");
        let message = load_positions(&deep, None).unwrap_err();
        assert!(message.contains("deep.csv: line 2: z is NaN"), "{message}");
        assert!(
            load_positions(&flat, Some(Three))
                .unwrap_err()
                .contains("z is missing")
        );
    }

    #[test]
    fn npy_of_both_widths_precisions_and_orders() {
        use npyz::WriterBuilder;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("position.npy");
        let (first, second) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.5));

        npy::write(&path, 3, &[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.5]).unwrap();
        assert_eq!(load(&path, Three).unwrap().position, [first, second]);
        npy::write(&path, 2, &[1.0f64, 2.0, 4.0, 5.0]).unwrap();
        assert_eq!(
            load(&path, Two).unwrap().position,
            [first.with_z(0.0), second.with_z(0.0)]
        );
        assert!(load(&path, Three).unwrap_err().contains("z is missing"));

        let mut bytes = Vec::new();
        let mut array = npyz::WriteOptions::new()
            .dtype(npyz::DType::Plain(">f8".parse().unwrap()))
            .shape(&[2, 3])
            .order(npyz::Order::Fortran)
            .writer(&mut bytes)
            .begin_nd()
            .unwrap();
        array.extend([1.0f64, 4.0, 2.0, 5.0, 3.0, 6.5]).unwrap();
        array.finish().unwrap();
        fs::write(&path, bytes).unwrap();
        assert_eq!(load(&path, Three).unwrap().position, [first, second]);
    }

    #[test]
    fn broken_files_are_told_by_place_and_mend() {
        let folder = tempfile::tempdir().unwrap();
        let ply = |properties: &str, rows: &str| {
            let count = rows.lines().count();
            format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{rows}")
        };
        let xyz = "property float x\nproperty float y\nproperty float z\n";
        for (name, text, dimensions, expected) in [
            (
                "a.csv",
                "x,y,z\n0,0,0\n\n1,nan,0\n".into(),
                Three,
                "line 4: y is NaN",
            ),
            ("b.csv", "x,y\n0,0\n0,inf\n".into(), Two, "line 3: y is inf"),
            (
                "c.csv",
                "x,y\n0,0\n0,0,0\n".into(),
                Two,
                "line 3: 3 columns instead of 2",
            ),
            (
                "d.csv",
                "0,0,0,0\n".into(),
                Three,
                "line 1: 4 columns without a header",
            ),
            ("e.csv", "x,y\n0,zero\n".into(), Two, "line 2: y is \"zero\""),
            ("f.csv", String::new(), Two, "empty"),
            ("g.csv", "x,y\n".into(), Two, "no particles"),
            ("h.csv", "x,y\n0,0\n".into(), Three, "z is missing"),
            (
                "i.csv",
                "x,y,z\n0,0,0\n0,0,0.1\n".into(),
                Two,
                "line 3: z is 0.1 in 2D",
            ),
            (
                "j.csv",
                "x,y,id\n0,0,5\n0,0,6\n0,0,5\n".into(),
                Two,
                "line 4: id 5 is that of line 2",
            ),
            ("k.csv", "x,y,id\n0,0,1.5\n".into(), Two, "line 2: id is 1.5"),
            ("l.csv", "x,y,id\n0,0,-1\n".into(), Two, "line 2: id is -1"),
            ("m.csv", "x,y,vx\n0,0,1\n".into(), Two, "1 of 2 components"),
            ("n.csv", "x,y,X\n0,0,1\n".into(), Two, "column x is there twice"),
            (
                "o.csv",
                "x,y,vx,vy,vz\n0,0,0,0,2\n".into(),
                Two,
                "line 2: vz is 2",
            ),
            ("p.ply", ply(xyz, "0 0 0\n0 nan 0\n"), Three, "Line 9"),
            (
                "q.ply",
                ply("property float x\nproperty float y\n", "0 0\n"),
                Three,
                "z is missing",
            ),
            ("r.ply", ply(xyz, ""), Three, "no particles"),
            ("s.ply", "ply\nformat".into(), Three, "not a readable PLY"),
            ("t.npy", "not numpy".into(), Three, "numpy.save"),
            ("u.txt", "0 0 0".into(), Three, ".ply, .vtp, .bgeo, .csv and .npy"),
        ] {
            let message = load(&file(&folder, name, text), dimensions).unwrap_err();
            assert!(
                message.contains(name) && message.contains(expected),
                "{name}: {message}"
            );
        }

        let path = folder.path().join("v.npy");
        npy::write(&path, 4, &[0.0f32; 8]).unwrap();
        assert!(load(&path, Three).unwrap_err().contains("[2, 4]"));
        npy::write(&path, 3, &[0i32; 6]).unwrap();
        assert!(
            load(&path, Three)
                .unwrap_err()
                .contains("save float32 or float64")
        );
        npy::write(&path, 3, &[0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0]).unwrap();
        assert!(load(&path, Three).unwrap_err().contains("row 1: x is NaN"));
        npy::write::<f32>(&path, 3, &[]).unwrap();
        assert!(load(&path, Three).unwrap_err().contains("no particles"));
        assert!(
            load(&folder.path().join("absent.csv"), Three)
                .unwrap_err()
                .contains("absent.csv")
        );
    }
}
