//! Reads points from Houdini's binary geometry, version 5 (.bgeo): big-endian, packed by gzip or not.

use std::io::{self, Read as _};
use std::path::Path;

use flate2::read::GzDecoder;

use super::particle_file::{NamedColumn, Table, columns_of};
use crate::files;

pub(super) fn read(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let bytes = unpacked(path).map_err(|reason| format!("{name}: {reason}"))?;
    parse(&bytes).ok_or_else(|| {
        format!(
            "{name} is not a readable BGEO file, or cut off: export its points again as binary geometry of version 5, \
             with numbers and vectors as attributes"
        )
    })
}

/// What a packed file may grow to: particles do not lie so evenly that gzip finds more in them.
const USUAL_GROWTH: u64 = 64;
/// Small files may grow to this in any case, bytes.
const SMALL: u64 = 64 << 20;

fn unpacked(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = files::read(path)?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let most = SMALL.max(USUAL_GROWTH * bytes.len() as u64);
    let mut unpacked = Vec::new();
    GzDecoder::new(&bytes[..])
        .take(most + 1)
        .read_to_end(&mut unpacked)?;
    match unpacked.len() as u64 > most {
        true => Err(io::Error::new(
            io::ErrorKind::InvalidData,
            format!(
                "its {} bytes unpack to more than {most}, as no particles do; export it again without packing",
                bytes.len()
            ),
        )),
        false => Ok(unpacked),
    }
}

fn parse(mut rest: &[u8]) -> Option<Table> {
    let rest = &mut rest;
    if rest.split_off(..5)? != b"BgeoV" || int(rest)? != 5 {
        return None;
    }
    let points = usize::try_from(int(rest)?).ok()?;
    let [_primitives, _point_groups, _primitive_groups] = [int(rest)?, int(rest)?, int(rest)?];
    let count = int(rest)?;
    let [_of_vertices, _of_primitives, _of_all] = [int(rest)?, int(rest)?, int(rest)?];

    let column = |name: String| (name, Vec::new());
    let mut columns: Vec<NamedColumn> = ["x", "y", "z"].map(|axis| column(axis.into())).into();
    let mut are_integers = Vec::new();
    for _ in 0..count {
        let length = short(rest)?;
        let name = String::from_utf8_lossy(rest.split_off(..length)?);
        let size = short(rest)?;
        // 0: float, 1: integer, 5: vector. Words (4) carry a list that points do not need.
        let kind = int(rest)?;
        if ![0, 1, 5].contains(&kind) {
            return None;
        }
        rest.split_off(..4 * size)?;
        columns.extend(columns_of(&name, size).into_iter().map(column));
        are_integers.extend(std::iter::repeat_n(kind == 1, size));
    }

    let (coordinates, attributes) = columns.split_at_mut(3);
    let stride = 4 * (4 + attributes.len());
    let mut data = rest.split_off(..stride.checked_mul(points)?)?;
    let data = &mut data;
    for _ in 0..points {
        for (_, values) in &mut *coordinates {
            values.push(float(data)?);
        }
        let _weight = float(data)?;
        for ((_, values), &is_integer) in attributes.iter_mut().zip(&are_integers) {
            values.push(match is_integer {
                true => f64::from(int(data)?),
                false => float(data)?,
            });
        }
    }
    Some(Table::new("point", columns))
}

fn int(rest: &mut &[u8]) -> Option<i32> {
    let bytes = rest.split_off(..4)?;
    Some(i32::from_be_bytes(bytes.try_into().ok()?))
}

fn float(rest: &mut &[u8]) -> Option<f64> {
    let bytes = rest.split_off(..4)?;
    Some(f64::from(f32::from_be_bytes(bytes.try_into().ok()?)))
}

fn short(rest: &mut &[u8]) -> Option<usize> {
    let bytes = rest.split_off(..2)?;
    Some(usize::from(u16::from_be_bytes(bytes.try_into().ok()?)))
}
