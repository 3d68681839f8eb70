//! An N×2 or N×3 array of float32 or float64, in C or Fortran order.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::{COLUMNS, Table};

pub fn read(path: &Path) -> Result<Table, String> {
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

    let column = |axis: usize| {
        let value = |row: usize| values[row * row_stride + axis * column_stride];
        (COLUMNS[axis][0].to_owned(), (0..rows).map(value).collect())
    };
    Ok(Table::new("row", (0..columns).map(column).collect()))
}
