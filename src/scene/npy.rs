//! NumPy's array file (NEP 1): a header that is a Python dictionary, then the numbers in one piece.

use std::io;

const MAGIC: &[u8] = b"\x93NUMPY";
/// NumPy aligns the numbers to this many bytes.
const ALIGNMENT: usize = 64;

/// A type of numbers that arrays are written with, little-endian.
pub trait Number: bytemuck::NoUninit {
    /// NumPy's name of it.
    const NAME: &'static str;
}

impl Number for f32 {
    const NAME: &'static str = "<f4";
}

impl Number for f64 {
    const NAME: &'static str = "<f8";
}

impl Number for i32 {
    const NAME: &'static str = "<i4";
}

impl Number for u32 {
    const NAME: &'static str = "<u4";
}

impl Number for u64 {
    const NAME: &'static str = "<u8";
}

/// What an array file starts with; the numbers, in C order, follow at once.
pub fn header<T: Number>(shape: &[u64]) -> Vec<u8> {
    let sides: Vec<String> = shape.iter().map(u64::to_string).collect();
    // A comma makes one side a tuple.
    let sides = sides.join(", ") + if shape.len() == 1 { "," } else { "" };
    let mut text = format!(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({sides}), }}",
        T::NAME
    );
    let start = MAGIC.len() + 4;
    let end = (start + text.len() + 1).next_multiple_of(ALIGNMENT);
    text += &" ".repeat(end - start - text.len() - 1);
    text.push('\n');
    let length = text.len() as u16;
    [MAGIC, &[1, 0], &length.to_le_bytes(), text.as_bytes()].concat()
}

/// An array as it stands in its file.
#[derive(Debug, PartialEq)]
pub struct Array<'a> {
    /// NumPy's name of the numbers' type.
    pub kind: String,
    /// Whether the first index, and not the last, runs fastest.
    pub is_fortran: bool,
    pub shape: Vec<usize>,
    numbers: &'a [u8],
}

impl<'a> Array<'a> {
    pub fn parse(file: &'a [u8]) -> io::Result<Self> {
        let wrong = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what);
        let not_an_array = || wrong("not a NumPy array");
        let rest = file.strip_prefix(MAGIC).ok_or_else(not_an_array)?;
        let (length, rest) = match rest {
            [1, _, a, b, rest @ ..] => (u32::from_le_bytes([*a, *b, 0, 0]), rest),
            [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
            _ => return Err(not_an_array()),
        };
        let (header, numbers) = rest
            .split_at_checked(length as usize)
            .ok_or_else(|| wrong("the array's header is cut off"))?;
        let header = str::from_utf8(header).map_err(|_| not_an_array())?;
        let array = Self::parts(header, numbers).ok_or_else(|| wrong("the array's header is not NumPy's"))?;
        let count = array
            .shape
            .iter()
            .try_fold(1usize, |count, &side| count.checked_mul(side));
        let bytes = count
            .zip(array.size())
            .and_then(|(count, size)| count.checked_mul(size));
        match bytes {
            Some(bytes) if bytes > numbers.len() => Err(wrong("the array is cut off")),
            Some(bytes) => Ok(Self {
                numbers: &numbers[..bytes],
                ..array
            }),
            // Its type has no size here; whoever asks for numbers learns that there are none.
            None if array.size().is_none() => Ok(array),
            None => Err(wrong("the array's shape is larger than any memory")),
        }
    }

    fn parts(header: &str, numbers: &'a [u8]) -> Option<Self> {
        let value = |key: &str| {
            let after = header.split_once(&format!("'{key}'"))?.1;
            Some(after.trim_start().strip_prefix(':')?.trim_start())
        };
        let kind = value("descr")?;
        let kind = match kind.strip_prefix('\'') {
            Some(name) => name.split('\'').next()?,
            // Columns of several types.
            None => kind.split_inclusive(']').next()?,
        };
        let order = value("fortran_order")?;
        let shape = value("shape")?.strip_prefix('(')?.split(')').next()?;
        let sides = shape.split(',').map(str::trim).filter(|side| !side.is_empty());
        Some(Self {
            kind: kind.to_owned(),
            is_fortran: order.starts_with("True"),
            shape: sides.map(|side| side.parse().ok()).collect::<Option<_>>()?,
            numbers,
        })
    }

    /// Bytes a number, of the types that [`Self::numbers`] reads.
    fn size(&self) -> Option<usize> {
        match self.kind.trim_start_matches(['<', '>', '=', '|']) {
            "f4" | "u4" | "i4" => Some(4),
            "f8" | "u8" | "i8" => Some(8),
            _ => None,
        }
    }

    /// The type for a message, which quotes nothing but what looks like a type.
    pub fn told_kind(&self) -> &str {
        let is_type = |c: char| c.is_ascii_alphanumeric() || "<>=|[](), '_".contains(c);
        match self.kind.len() <= 60 && self.kind.chars().all(is_type) {
            true => &self.kind,
            false => "no numbers",
        }
    }

    /// Whether it holds float32 or float64.
    pub fn is_float(&self) -> bool {
        self.size().is_some() && self.kind.contains('f')
    }

    /// All numbers in the order of the file; `None` where they are of another type than float32, float64 and integers of
    /// 32 and 64 bits.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        macro_rules! read {
            ($number:ty) => {{
                let is_big = self.kind.starts_with('>');
                let chunks = self.numbers.chunks_exact(size_of::<$number>());
                let number = |bytes: &[u8]| {
                    let bytes = bytes.try_into().expect("as many bytes as the number has");
                    let number = match is_big {
                        true => <$number>::from_be_bytes(bytes),
                        false => <$number>::from_le_bytes(bytes),
                    };
                    number as f64
                };
                chunks.map(number).collect()
            }};
        }
        Some(match self.kind.trim_start_matches(['<', '>', '=', '|']) {
            "f4" => read!(f32),
            "f8" => read!(f64),
            "i4" => read!(i32),
            "i8" => read!(i64),
            "u4" => read!(u32),
            "u8" => read!(u64),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(version: u8, header: &str, numbers: &[u8]) -> Vec<u8> {
        let length = header.len() as u32;
        let length = &length.to_le_bytes()[..if version == 1 { 2 } else { 4 }];
        [MAGIC, &[version, 0], length, header.as_bytes(), numbers].concat()
    }

    /// Expected bytes are those of `numpy.save`, NumPy 2.4.6.
    #[test]
    fn agrees_with_numpy() {
        let spaces = |count: usize| " ".repeat(count);
        let numpy = |text: String| [MAGIC, b"\x01\x00v\x00", text.as_bytes(), b"\n"].concat();
        let vector =
            numpy("{'descr': '<u4', 'fortran_order': False, 'shape': (3,), }".to_owned() + &spaces(60));
        assert_eq!(header::<u32>(&[3]), vector);
        let matrix =
            numpy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }".to_owned() + &spaces(58));
        assert_eq!(header::<f32>(&[1, 2]), matrix);

        let bytes = [&vector[..], b"\x07\x00\x00\x00\x08\x00\x00\x00\x09\x00\x00\x00"].concat();
        let array = Array::parse(&bytes).unwrap();
        assert_eq!((array.is_float(), &array.shape[..]), (false, &[3][..]));
        assert_eq!(array.numbers().unwrap(), [7.0, 8.0, 9.0]);
        let bytes = [&matrix[..], b"\x00\x00\xc0?\x00\x00\x00\xc0"].concat();
        assert_eq!(Array::parse(&bytes).unwrap().numbers().unwrap(), [1.5, -2.0]);

        let mut bytes =
            numpy("{'descr': '>f8', 'fortran_order': True, 'shape': (2, 3), }".to_owned() + &spaces(59));
        for number in [1.0f64, 4.0, 2.0, 5.0, 3.0, 6.5] {
            bytes.extend(number.to_be_bytes());
        }
        let array = Array::parse(&bytes).unwrap();
        assert!(array.is_fortran && array.is_float());
        assert_eq!(array.shape, [2, 3]);
        assert_eq!(array.numbers().unwrap(), [1.0, 4.0, 2.0, 5.0, 3.0, 6.5]);
    }

    #[test]
    fn every_version_and_type_is_read() {
        let header = |kind: &str| format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (2,)}}\n");
        for version in [1, 2, 3] {
            for (kind, numbers) in [
                ("<u4", &[7, 0, 0, 0, 8, 0, 0, 0][..]),
                (">i4", &[0, 0, 0, 7, 0, 0, 0, 8]),
                ("<i8", &[7, 0, 0, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0]),
            ] {
                let bytes = file(version, &header(kind), numbers);
                let array = Array::parse(&bytes).unwrap();
                assert!(!array.is_float());
                assert_eq!(array.numbers().unwrap(), [7.0, 8.0]);
            }
        }
        for kind in ["<f2", "|O", "|b1"] {
            let bytes = file(1, &header(kind), &[0; 16]);
            let array = Array::parse(&bytes).unwrap();
            assert_eq!((array.kind.as_str(), array.numbers()), (kind, None));
        }
        let columns = "{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (2,), }";
        let bytes = file(1, columns, &[0; 16]);
        assert_eq!(Array::parse(&bytes).unwrap().kind, "[('x', '<f4'), ('y', '<f4')]");
    }

    #[test]
    fn broken_files_are_refused() {
        let whole = file(
            1,
            "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1), }\n",
            &[0; 8],
        );
        assert!(Array::parse(&whole).is_ok());
        for end in 0..whole.len() {
            assert!(Array::parse(&whole[..end]).is_err(), "the first {end} bytes");
        }
        for header in [
            "",
            "{'descr': '<f4', 'shape': (2,)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (two,)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (4611686018427387904, 4)}",
        ] {
            assert!(Array::parse(&file(1, header, &[0; 8])).is_err(), "{header}");
        }
    }
}
