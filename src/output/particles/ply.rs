//! PLY 1.0 (Turk 1994), binary, little-endian. Coordinates are `float`, which splashsurf insists on; velocities are
//! `vx`, `vy`, `vz`.

use super::cloud::{Attribute, Cloud, Moment};

pub fn encode(moment: &Moment) -> Vec<u8> {
    let Cloud { position, attributes } = Cloud::new(moment);
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Sliceflow, frame {}, time {} s\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\n",
        moment.index,
        moment.time,
        position.len()
    );
    for (name, attribute) in &attributes {
        header += &match attribute {
            Attribute::Float(_) => format!("property float {name}\n"),
            Attribute::Unsigned(_) => format!("property uint {name}\n"),
            Attribute::Vector(_) => {
                let initial = &name[..1];
                format!("property float {initial}x\nproperty float {initial}y\nproperty float {initial}z\n")
            }
        };
    }
    header += "end_header\n";

    let mut bytes = header.into_bytes();
    bytes.reserve(position.len() * 4 * (3 + 3 * attributes.len()));
    for (i, point) in position.iter().enumerate() {
        for coordinate in point {
            bytes.extend((*coordinate as f32).to_le_bytes());
        }
        for (_, attribute) in &attributes {
            match attribute {
                Attribute::Float(values) => bytes.extend(values[i].to_le_bytes()),
                Attribute::Unsigned(values) => bytes.extend(values[i].to_le_bytes()),
                Attribute::Vector(values) => bytes.extend(values[i].iter().flat_map(|v| v.to_le_bytes())),
            }
        }
    }
    bytes
}
