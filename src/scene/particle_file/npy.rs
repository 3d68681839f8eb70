//! An N×2 or N×3 array of float32 or float64, in C or Fortran order.

use std::path::Path;

use super::{COLUMNS, Table};
use crate::files;
use crate::scene::npy::Array;

pub fn read(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let file = files::read(path).map_err(|error| format!("{name}: {error}"))?;
    let array = Array::parse(&file).map_err(|error| format!("{name}: {error}; save it with numpy.save"))?;
    let [rows, columns @ 2..=3] = array.shape[..] else {
        return Err(format!(
            "{name}: the array has shape {:?}; save positions as N×2 or N×3",
            array.shape
        ));
    };
    let (row_stride, column_stride) = match array.is_fortran {
        false => (columns, 1),
        true => (1, rows),
    };
    let Some(values) = array.numbers().filter(|_| array.is_float()) else {
        return Err(format!(
            "{name}: the array holds {}; save float32 or float64",
            array.told_kind()
        ));
    };

    let column = |axis: usize| {
        let value = |row: usize| values[row * row_stride + axis * column_stride];
        (COLUMNS[axis][0].to_owned(), (0..rows).map(value).collect())
    };
    Ok(Table::new("row", (0..columns).map(column).collect()))
}
