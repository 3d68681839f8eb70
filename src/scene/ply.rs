//! Reads from a PLY file what scenes need: the numbers of its vertices, and its faces.

use std::io::BufReader;
use std::path::Path;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::particle_file::NamedColumn;
use crate::files;

pub struct PlyFile {
    /// The numbers that each vertex has, as the file names them.
    pub vertices: Vec<NamedColumn>,
    /// Vertex indices of each polygon, counted from 0, unchecked.
    pub faces: Vec<Vec<i64>>,
}

pub fn read(path: &Path) -> Result<PlyFile, String> {
    let open = |error| format!("{}: {error}", path.display());
    let file = files::open(path).map_err(open)?;
    let length = file.metadata().map_err(open)?.len();
    let explain = |error: ParseError| {
        // Its first line tells where; the others repeat the text.
        let error = error.to_string();
        format!(
            "{} is not a readable PLY file: {}; export it again as PLY 1.0, with finite numbers",
            path.display(),
            error.lines().next().unwrap_or_default().trim_end_matches('.')
        )
    };

    let mut reader = Reader::new(BufReader::new(file));
    let header = Parser::<Row>::new().read_header(&mut reader).map_err(explain)?;
    let mut ply = PlyFile {
        vertices: Vec::new(),
        faces: Vec::new(),
    };
    for (name, element) in &header.elements {
        let least = least_bytes(element, &header.encoding).saturating_mul(element.count as u64);
        if element.properties.is_empty() && element.count > 0 || least > length.saturating_add(1) {
            return Err(format!(
                "{} is cut off or wrong: it announces {} times `{name}`, which is more than its {length} bytes hold; export \
                 it again",
                path.display(),
                element.count
            ));
        }
        if name == "face" {
            let faces = Parser::<Face>::new()
                .read_payload_for_element(&mut reader, element, &header)
                .map_err(explain)?;
            ply.faces = faces.into_iter().map(|face| face.0).collect();
        } else {
            let rows = Parser::<Row>::new()
                .read_payload_for_element(&mut reader, element, &header)
                .map_err(explain)?;
            if name == "vertex" {
                let numbers = element.properties.iter();
                let numbers =
                    numbers.filter(|(_, property)| matches!(property.data_type, PropertyType::Scalar(_)));
                let value = |row: &Row, place: usize| row.0.get(place).copied().unwrap_or(f64::NAN);
                let column = |place: usize| rows.iter().map(|row| value(row, place)).collect();
                let named = numbers
                    .enumerate()
                    .map(|(place, (name, _))| (name.clone(), column(place)));
                ply.vertices = named.collect();
            }
        }
    }
    Ok(ply)
}

/// Bytes that one element takes at least: a digit and what parts it from the next, or its numbers and the lengths of its
/// lists.
fn least_bytes(element: &ElementDef, encoding: &Encoding) -> u64 {
    let width = |kind: &ScalarType| match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let properties = element.properties.iter();
    let bytes = properties.map(|(_, property)| match (encoding, &property.data_type) {
        (Encoding::Ascii, _) => 2,
        (_, PropertyType::Scalar(kind)) => width(kind),
        (_, PropertyType::List(length, _)) => width(length),
    });
    bytes.sum()
}

/// An element's numbers in the order of its properties, without its lists.
struct Row(Vec<f64>);

impl PropertyAccess for Row {
    fn new() -> Self {
        Row(Vec::new())
    }

    fn set_property(&mut self, _name: &str, value: Property) -> PropertyAccessResult {
        self.0.push(match value {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::Ignored,
        });
        PropertyAccessResult::Set
    }
}

struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Face(Vec::new())
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match value {
            Property::ListChar(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUChar(v) => v.into_iter().map(i64::from).collect(),
            Property::ListShort(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUShort(v) => v.into_iter().map(i64::from).collect(),
            Property::ListInt(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUInt(v) => v.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}
