//! NumPy's array file, one array a file.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use crate::files;
use crate::scene::npy::{Number, header};

/// Writes `values` in C order: shape (N,) for one column, (N, columns) for more. Little-endian, as every machine that
/// wgpu's native backends run on.
///
/// The file appears under its name only when it is whole: it is written as `NAME.part` and renamed.
pub fn write<T: Number>(path: &Path, columns: usize, values: &[T]) -> io::Result<()> {
    assert!(
        columns > 0 && values.len().is_multiple_of(columns),
        "{} values do not make rows of {columns}",
        values.len()
    );
    let rows = (values.len() / columns) as u64;
    let shape = [rows, columns as u64];
    let shape = if columns == 1 { &shape[..1] } else { &shape[..] };

    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    let write = || {
        let mut file = files::create(Path::new(&name))?;
        file.write_all(&header::<T>(shape))?;
        file.write_all(bytemuck::cast_slice(values))?;
        drop(file);
        fs::rename(&name, path)
    };
    write().inspect_err(|_| {
        // The half-written file only takes room; what went wrong is in the error.
        let _ = fs::remove_file(&name);
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::npy::Array;

    #[test]
    fn writes_rows_and_leaves_no_partial_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("position.npy");
        write(&path, 3, &[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.5]).unwrap();

        let bytes = fs::read(&path).unwrap();
        let header = String::from_utf8_lossy(&bytes[..80]).into_owned();
        assert!(header.contains("'<f4'"), "{header}");
        let array = Array::parse(&bytes).unwrap();
        assert_eq!((array.is_fortran, &array.shape[..]), (false, &[2, 3][..]));
        assert_eq!(array.numbers().unwrap(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.5]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn one_column_is_a_vector_and_nothing_is_an_empty_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("id.npy");
        for values in [&[7u32, 8, 9][..], &[]] {
            write(&path, 1, values).unwrap();
            let bytes = fs::read(&path).unwrap();
            let array = Array::parse(&bytes).unwrap();
            assert_eq!(array.shape, [values.len()]);
            assert_eq!(
                array.numbers().unwrap(),
                values.iter().map(|&v| v.into()).collect::<Vec<f64>>()
            );
        }
    }

    #[test]
    #[should_panic(expected = "rows of 2")]
    fn values_that_make_no_whole_rows_are_a_defect() {
        let _ = write(Path::new("unused.npy"), 2, &[1.0f32]);
    }
}
