//! VTK's XML format for `PolyData` (.vtp), version 1.0: arrays appended as raw bytes, positions in double precision, one
//! vertex cell a point, without which ParaView draws nothing, and the time as `TimeValue`.

use super::cloud::{Attribute, Cloud, Moment};

pub fn encode(moment: &Moment) -> Vec<u8> {
    let Cloud { position, attributes } = Cloud::new(moment);
    let count = position.len();
    let mut appended = Appended::default();
    let mut point_data = String::new();
    for (name, attribute) in &attributes {
        point_data += &match attribute {
            Attribute::Float(values) => appended.array("Float32", name, 1, bytemuck::cast_slice(values)),
            Attribute::Unsigned(values) => appended.array("UInt32", name, 1, bytemuck::cast_slice(values)),
            Attribute::Vector(values) => appended.array("Float32", name, 3, bytemuck::cast_slice(values)),
        };
    }
    let points = appended.array("Float64", "Points", 3, bytemuck::cast_slice(&position));
    let first_to_last: Vec<i32> = (0..count as i32).collect();
    let connectivity = appended.array("Int32", "connectivity", 1, bytemuck::cast_slice(&first_to_last));
    let ends: Vec<i32> = (1..=count as i32).collect();
    let offsets = appended.array("Int32", "offsets", 1, bytemuck::cast_slice(&ends));

    let mut bytes = format!(
        r#"<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData>
<FieldData>
<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray>
</FieldData>
<Piece NumberOfPoints="{count}" NumberOfVerts="{count}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
<PointData>
{point_data}</PointData>
<Points>
{points}</Points>
<Verts>
{connectivity}{offsets}</Verts>
</Piece>
</PolyData>
<AppendedData encoding="raw">
_"#,
        moment.time
    )
    .into_bytes();
    bytes.append(&mut appended.bytes);
    bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
    bytes
}

/// What follows the underscore: each array's length in bytes, and the array.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Appends an array; returns the element that stands for it.
    fn array(&mut self, kind: &str, name: &str, components: usize, bytes: &[u8]) -> String {
        let offset = self.bytes.len();
        self.bytes.extend((bytes.len() as u64).to_le_bytes());
        self.bytes.extend(bytes);
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{offset}\"/>\n"
        )
    }
}
