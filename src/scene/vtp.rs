//! Reads points from VTK's XML format for `PolyData` (.vtp), in the form in which Sliceflow writes it: arrays appended as
//! raw bytes, little-endian, not compressed.

use std::path::Path;

use roxmltree::{Document, Node};

use super::particle_file::{NamedColumn, Table, columns_of, is_known};
use crate::files;

/// Numbers of an attribute.
const MOST_COMPONENTS: usize = 64;
/// Numbers in memory per byte of a file, where pieces lack attributes.
const MOST_FILLED: usize = 8;

pub(super) fn read(path: &Path) -> Result<Table, String> {
    let name = path.display();
    let bytes = files::read(path).map_err(|reason| format!("{name}: {reason}"))?;
    parse(&bytes).map_err(|what| {
        format!(
            "{name}: {what}; save it as VTK PolyData (.vtp) with its data appended raw, without compression, or as PLY"
        )
    })
}

fn parse(bytes: &[u8]) -> Result<Table, String> {
    let appended = find(bytes, b"<AppendedData").ok_or("no appended data is in it")?;
    let header = String::from_utf8_lossy(&bytes[..appended]) + "</VTKFile>";
    let document = Document::parse(&header).map_err(|reason| reason.to_string())?;
    let file = document.root_element();
    let is = |name, value| file.attribute(name) == Some(value);
    if !is("type", "PolyData") || !is("byte_order", "LittleEndian") || file.has_attribute("compressor") {
        return Err("it is no PolyData that is little-endian and not compressed".into());
    }
    let rest = &bytes[appended..];
    let tag = find(rest, b">").map_or(rest, |end| &rest[..end]);
    if find(tag, b"\"raw\"").is_none() {
        return Err("its data is encoded".into());
    }
    let start = find(rest, b"_").ok_or("its data has no start")?;
    let data = Data {
        bytes: &rest[start + 1..],
        length_bytes: if is("header_type", "UInt64") { 8 } else { 4 },
    };

    let mut columns: Vec<NamedColumn> = Vec::new();
    let mut rows: usize = 0;
    let too_many = || "it announces more numbers than it holds".to_owned();
    // A number has a byte at least, so that what is still to come can hold no more than these.
    let mut left = data.bytes.len();
    for piece in file.descendants().filter(|node| node.has_tag_name("Piece")) {
        let count: usize = number(piece, "NumberOfPoints")?;
        let all = rows.checked_add(count).filter(|&all| all <= data.bytes.len());
        let all = all.ok_or_else(too_many)?;
        let arrays = |within| {
            let parent = piece.children().find(move |node| node.has_tag_name(within));
            parent
                .into_iter()
                .flat_map(|node| node.children())
                .filter(|node| node.has_tag_name("DataArray"))
        };
        let points = arrays("Points").map(|array| (array, ["x", "y", "z"].map(String::from).into()));
        let attributes = arrays("PointData").map(|array| {
            let components = number(array, "NumberOfComponents").unwrap_or(1);
            let name = array.attribute("Name").unwrap_or_default();
            let names = match components {
                0..=MOST_COMPONENTS => columns_of(name, components),
                _ => Vec::new(),
            };
            (array, names)
        });
        for (array, names) in points.chain(attributes) {
            if names.is_empty() {
                return Err(format!(
                    "it has an array of no or more than {MOST_COMPONENTS} components"
                ));
            }
            if !names.iter().any(|name| is_known(name)) && !Data::can_read(array) {
                continue;
            }
            let numbers = count.checked_mul(names.len()).ok_or_else(too_many)?;
            left = left.checked_sub(numbers).ok_or_else(too_many)?;
            let values = data.array(array, numbers)?;
            for (component, name) in names.iter().enumerate() {
                let place = columns
                    .iter()
                    .position(|(known, _)| known == name)
                    .unwrap_or_else(|| {
                        columns.push((name.clone(), Vec::new()));
                        columns.len() - 1
                    });
                let column = &mut columns[place].1;
                if column.len() <= rows {
                    // Earlier pieces may lack it.
                    column.resize(rows, 0.0);
                    column.extend(values.iter().skip(component).step_by(names.len()));
                }
            }
        }
        rows = all;
        // Where pieces lack what others have, zeros stand for it; that these are most of a file is a trick.
        if rows.saturating_mul(columns.len()) > data.bytes.len().saturating_mul(MOST_FILLED) {
            return Err(too_many());
        }
    }
    for (_, column) in &mut columns {
        column.resize(rows, 0.0);
    }
    Ok(Table::new("point", columns))
}

/// What follows the underscore.
struct Data<'a> {
    bytes: &'a [u8],
    /// Of the number before each array that says its bytes.
    length_bytes: usize,
}

impl Data<'_> {
    /// Text, and what stands between the tags, is passed over.
    fn can_read(array: Node) -> bool {
        array.has_attribute("offset") && array.attribute("type").and_then(width).is_some()
    }

    fn array(&self, array: Node, count: usize) -> Result<Vec<f64>, String> {
        let name = array.attribute("Name").unwrap_or("an array");
        let offset: usize = number(array, "offset")?;
        let kind = array.attribute("type").unwrap_or_default();
        let width = width(kind).ok_or_else(|| format!("{name} has the type `{kind}`"))?;
        let first = offset.checked_add(self.length_bytes);
        let end = first
            .zip(count.checked_mul(width))
            .and_then(|(first, bytes)| first.checked_add(bytes));
        let values = first
            .zip(end)
            .and_then(|(first, end)| self.bytes.get(first..end))
            .ok_or_else(|| format!("{name} is cut off"))?;
        let value = |bytes: &[u8]| match kind {
            "Float64" => f64::from_le_bytes(fixed(bytes)),
            "Int64" => i64::from_le_bytes(fixed(bytes)) as f64,
            "UInt64" => u64::from_le_bytes(fixed(bytes)) as f64,
            "Float32" => f32::from_le_bytes(fixed(bytes)).into(),
            "Int32" => i32::from_le_bytes(fixed(bytes)).into(),
            "UInt32" => u32::from_le_bytes(fixed(bytes)).into(),
            "Int16" => i16::from_le_bytes(fixed(bytes)).into(),
            "UInt16" => u16::from_le_bytes(fixed(bytes)).into(),
            "Int8" => i8::from_le_bytes(fixed(bytes)).into(),
            _ => bytes[0].into(),
        };
        Ok(values.chunks_exact(width).map(value).collect())
    }
}

/// Bytes of a number.
fn width(kind: &str) -> Option<usize> {
    match kind {
        "Float64" | "Int64" | "UInt64" => Some(8),
        "Float32" | "Int32" | "UInt32" => Some(4),
        "Int16" | "UInt16" => Some(2),
        "Int8" | "UInt8" => Some(1),
        _ => None,
    }
}

/// As many bytes as the type of a number has.
fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.try_into().expect("chunks of the type's width")
}

fn number(node: Node, name: &str) -> Result<usize, String> {
    let given = node.attribute(name).and_then(|text| text.trim().parse().ok());
    given.ok_or_else(|| format!("<{}> lacks a whole number `{name}`", node.tag_name().name()))
}

fn find(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes.windows(pattern.len()).position(|window| window == pattern)
}
