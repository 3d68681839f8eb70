//! Reads points from Houdini's binary geometry, version 5 (.bgeo): big-endian, packed by gzip or not.

use std::fs;
use std::io::Read as _;
use std::path::Path;

use flate2::read::GzDecoder;

use super::particle_file::{Row, Table, attribute};

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

fn unpacked(path: &Path) -> std::io::Result<Vec<u8>> {
    let bytes = fs::read(path)?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut unpacked = Vec::new();
    GzDecoder::new(&bytes[..]).read_to_end(&mut unpacked)?;
    Ok(unpacked)
}

/// Where an attribute's numbers go, how many they are, and whether they are integers.
struct Attribute {
    column: Option<usize>,
    size: usize,
    is_integer: bool,
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

    let mut present = [true, true, true, false, false, false, false];
    let mut attributes = Vec::new();
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
        let column = attribute(&name, size);
        if let Some(column) = column {
            present[column..column + size].fill(true);
        }
        attributes.push(Attribute {
            column,
            size,
            is_integer: kind == 1,
        });
    }

    let stride = 4 * (4 + attributes.iter().map(|a| a.size).sum::<usize>());
    let mut data = rest.split_off(..stride.checked_mul(points)?)?;
    let data = &mut data;
    let mut rows = Vec::with_capacity(points);
    for number in 0..points {
        let mut row = Row::default();
        for coordinate in &mut row.0[..3] {
            *coordinate = float(data)?;
        }
        let _weight = float(data)?;
        for attribute in &attributes {
            for component in 0..attribute.size {
                let value = if attribute.is_integer {
                    f64::from(int(data)?)
                } else {
                    float(data)?
                };
                if let Some(column) = attribute.column {
                    row.0[column + component] = value;
                }
            }
        }
        rows.push((number, row));
    }
    Some(Table {
        present,
        noun: "point",
        rows,
    })
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
