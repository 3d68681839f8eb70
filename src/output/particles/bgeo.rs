//! Houdini's binary geometry, version 5, as Partio, splashsurf and SPlisHSPlasH read it: big-endian, points only. The
//! velocity is `v`, as Houdini calls it. Packed by gzip as SPlisHSPlasH's are, since Blender's sequence loader reads no
//! other.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::cloud::{Attribute, Cloud, Moment};

const FLOAT: i32 = 0;
const INTEGER: i32 = 1;
const VECTOR: i32 = 5;

pub fn encode(moment: &Moment) -> Vec<u8> {
    let Cloud { position, attributes } = Cloud::new(moment);
    let mut bytes = b"BgeoV".to_vec();
    bytes.reserve(position.len() * 4 * (4 + 3 * attributes.len()));
    let mut put = |number: i32| bytes.extend(number.to_be_bytes());
    // Version; points, primitives; groups of points, of primitives.
    for number in [5, position.len() as i32, 0, 0, 0] {
        put(number);
    }
    // Attributes of points, vertices, primitives, the whole.
    for number in [attributes.len() as i32, 0, 0, 0] {
        put(number);
    }
    for (name, attribute) in &attributes {
        let (kind, size) = match attribute {
            Attribute::Float(_) => (FLOAT, 1),
            Attribute::Unsigned(_) => (INTEGER, 1),
            Attribute::Vector(_) => (VECTOR, 3u16),
        };
        let name = if *name == "velocity" { "v" } else { name };
        bytes.extend((name.len() as u16).to_be_bytes());
        bytes.extend(name.as_bytes());
        bytes.extend(size.to_be_bytes());
        bytes.extend(kind.to_be_bytes());
        // Defaults.
        bytes.extend(std::iter::repeat_n(0, 4 * usize::from(size)));
    }
    for (i, point) in position.iter().enumerate() {
        // Homogeneous coordinates.
        for coordinate in point.iter().chain(&[1.0]) {
            bytes.extend((*coordinate as f32).to_be_bytes());
        }
        for (_, attribute) in &attributes {
            match attribute {
                Attribute::Float(values) => bytes.extend(values[i].to_be_bytes()),
                // Ids and counts stay far below 2³¹.
                Attribute::Unsigned(values) => bytes.extend((values[i] as i32).to_be_bytes()),
                Attribute::Vector(values) => bytes.extend(values[i].iter().flat_map(|v| v.to_be_bytes())),
            }
        }
    }
    // No extra records, end.
    bytes.extend([0x00, 0xff]);
    packed(&bytes).expect("memory takes what is written")
}

fn packed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::with_capacity(bytes.len()), Compression::fast());
    encoder.write_all(bytes)?;
    encoder.finish()
}
