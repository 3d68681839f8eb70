//! A scene's fields on the device: their buffers, and the shader modules that are made of their rows.
//!
//! - `fields/NAME` and `fields/next_NAME` declare a buffer for reading, `fields/NAME/write` and so on for writing too;
//! - `fields/place` takes a particle from where a step left it to its slot: `place(i, slot)`. That is position and velocity;
//!   the rest comes in a pass of its own by `follow(i, slot)` of `fields/follow`, so that neither binds too many buffers;
//! - `fields/stay` takes what steps change to the same places in the other buffers: `stay(i)`;
//! - `fields/keep` leaves for the next search what no step changes: `keep(i)`;
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

/// Fields that a search takes to their places while it finds these.
const PLACED: [&str; 2] = ["position", "velocity"];

/// Shader modules of these fields, by path.
pub fn modules(fields: &[Field]) -> BTreeMap<String, String> {
    let mut modules = BTreeMap::new();
    let mut place = Function::new("place", "i: u32, slot: u32");
    let mut follow = Function::new("follow", "i: u32, slot: u32");
    let mut stay = Function::new("stay", "i: u32");
    let mut keep = Function::new("keep", "i: u32");
    let mut measured = String::new();
    for field in fields {
        let name = field.name;
        if let Some(vector) = field.beside {
            put_beside(&mut modules, name, vector);
            continue;
        }
        declare(&mut modules, name, field);
        if field.travels != Travels::No {
            declare(&mut modules, &format!("next_{name}"), field);
            let goes = if PLACED.contains(&name) {
                &mut place
            } else {
                &mut follow
            };
            goes.copy(&format!("next_{name}"), name, "slot");
        }
        match field.travels {
            Travels::No => {}
            Travels::Stepped => stay.copy(&format!("next_{name}"), name, "i"),
            Travels::Kept => keep.copy(name, &format!("next_{name}"), "i"),
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
    for function in [place, follow, stay, keep] {
        modules.insert(format!("fields/{}", function.name), function.module());
    }
    modules.insert("fields/measured".into(), measured);
    modules
}

/// A shader function that copies elements of buffers.
struct Function {
    name: &'static str,
    parameters: &'static str,
    imports: String,
    body: String,
}

impl Function {
    fn new(name: &'static str, parameters: &'static str) -> Self {
        Self {
            name,
            parameters,
            imports: String::new(),
            body: String::new(),
        }
    }

    /// Copies element `i` of a buffer to a place in another one.
    fn copy(&mut self, from: &str, to: &str, place: &str) {
        push(
            &mut self.imports,
            format!("#import fields/{from}\n#import fields/{to}/write"),
        );
        push(&mut self.body, format!("    {to}[{place}] = {from}[i];"));
    }

    fn module(&self) -> String {
        let Self {
            name,
            parameters,
            imports,
            body,
        } = self;
        format!("{imports}fn {name}({parameters}) {{\n{body}}}")
    }
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
