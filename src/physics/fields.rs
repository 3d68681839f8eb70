//! A scene's fields on the device: their buffers, and the shader modules that are made of their rows.
//!
//! - `fields/NAME` and `fields/next_NAME` declare a buffer for reading, `fields/NAME/write` and so on for writing too;
//! - `fields/place` takes a particle from where a step left it to its slot: `place(i, slot)`;
//! - `fields/keep` leaves for the search what no step changes: `keep_fields(i)`;
//! - `fields/NAME` of a field that is the spare number of a vector has `NAME_of(i)`, and `fields/VECTOR/pack` puts both
//!   together: `pack_VECTOR(v, NAME)`;
//! - `fields/measured` declares what a measure writes;
//! - `fields/NAME/color` is the role `<column>` of pictures: `column(i)`.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::gpu::{BufferPlan, Variant};
use crate::scene::Scene;
use crate::scene::column::{Column, Source};
use crate::scene::field::{FIELDS, Field, Kind, Travels};

/// Buffers of all fields that a scene has and of those that are measured for somebody; each of the latter has a flag.
pub fn plan(scene: &Scene, columns: &[Column], variant: &mut Variant) -> Vec<BufferPlan> {
    let mut fields: Vec<Field> = scene.fields().copied().collect();
    for field in measurable() {
        let is_asked_for = columns.iter().any(|column| column.name == field.name);
        variant.flag(&format!("column_{}", field.name), is_asked_for);
        if is_asked_for {
            fields.push(*field);
        }
    }
    variant.modules.extend(modules(&fields));
    let each = u64::from(scene.capacity);
    let mut buffers = Vec::new();
    for field in fields.iter().filter(|field| field.beside.is_none()) {
        let bytes = field.kind.bytes(scene.dimensions);
        buffers.push(BufferPlan::storage(field.name, each, bytes, field.about));
        if field.travels != Travels::No {
            let why = format!("`{}` after a step, before the search", field.name);
            buffers.push(BufferPlan::storage(&field.before_search(), each, bytes, why));
        }
    }
    buffers
}

fn measurable() -> impl Iterator<Item = &'static Field> {
    FIELDS
        .iter()
        .filter(|field| field.column == Some(Source::Measured))
}

/// Shader modules of these fields, by path.
pub fn modules(fields: &[Field]) -> BTreeMap<String, String> {
    let mut modules = BTreeMap::new();
    let [mut place, mut keep, mut measured] = [const { String::new() }; 3];
    let [mut placed, mut kept] = [const { String::new() }; 2];
    for field in fields {
        let name = field.name;
        if let Some(vector) = field.beside {
            put_beside(&mut modules, name, vector);
            continue;
        }
        declare(&mut modules, name, field);
        if field.travels != Travels::No {
            declare(&mut modules, &format!("next_{name}"), field);
            push(
                &mut place,
                format!("#import fields/next_{name}\n#import fields/{name}/write"),
            );
            push(&mut placed, format!("    {name}[slot] = next_{name}[i];"));
        }
        if field.travels == Travels::Kept {
            push(
                &mut keep,
                format!("#import fields/{name}\n#import fields/next_{name}/write"),
            );
            push(&mut kept, format!("    next_{name}[i] = {name}[i];"));
        }
        if field.column == Some(Source::Measured) {
            push(&mut measured, format!("#import fields/{name}/write"));
        }
        if let (Some(_), Kind::Float | Kind::Unsigned) = (field.column, field.kind) {
            let text =
                format!("#import fields/{name}\nfn column(i: u32) -> f32 {{\n    return f32({name}[i]);\n}}");
            modules.insert(format!("fields/{name}/color"), text);
        }
    }
    push(&mut place, format!("fn place(i: u32, slot: u32) {{\n{placed}}}"));
    push(&mut keep, format!("fn keep_fields(i: u32) {{\n{kept}}}"));
    modules.insert("fields/place".into(), place);
    modules.insert("fields/keep".into(), keep);
    modules.insert("fields/measured".into(), measured);
    modules
}

/// The modules of a field that is the spare number of a vector.
fn put_beside(modules: &mut BTreeMap<String, String>, name: &str, vector: &str) {
    let read = format!(
        "#import fields/{vector}\nfn {name}_of(i: u32) -> f32 {{\n    return number_of({vector}[i]);\n}}"
    );
    modules.insert(format!("fields/{name}"), read);
    let pack = format!(
        "#import common/vector\nfn pack_{vector}(v: Vector, {name}: f32) -> Packed {{\n    return pack_with(v, {name});\n}}"
    );
    modules.insert(format!("fields/{vector}/pack"), pack);
}

/// The modules that declare a buffer.
fn declare(modules: &mut BTreeMap<String, String>, buffer: &str, field: &Field) {
    let (needs, element) = match field.kind {
        Kind::Float => ("", "f32"),
        Kind::Unsigned => ("", "u32"),
        Kind::Pair => ("", "vec2f"),
        Kind::Vector => ("#import common/vector\n", "Packed"),
        Kind::Matrix => ("#import physics/fluid/matrix\n", "Matrix"),
    };
    for (path, access) in [
        (format!("fields/{buffer}"), "read"),
        (format!("fields/{buffer}/write"), "read_write"),
    ] {
        let text = format!("{needs}var<storage, {access}> {buffer}: array<{element}>;");
        modules.insert(path, text);
    }
}

fn push(text: &mut String, line: String) {
    writeln!(text, "{line}").expect("text grows");
}
