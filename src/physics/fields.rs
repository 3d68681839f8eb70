//! A scene's fields on the device: their buffers, and the shader modules that are made of their rows.
//!
//! - `fields/NAME` and `fields/next_NAME` declare a buffer for reading, `fields/NAME/write` and so on for writing too;
//! - `fields/place` takes a particle from where a step left it to its slot: `place(i, slot)`. That is position and velocity;
//!   the rest comes in a pass of its own by `follow(i, slot)` of `fields/follow`, so that neither binds too many buffers;
//! - `fields/stay` takes what steps change to the same places in the other buffers: `stay(i)`;
//! - `fields/follow_too` and `fields/stay_too` go on where particles have more fields than one pass binds
//!   ([`Scene::goes_on`] says so);
//! - `fields/keep` leaves for the next search what no step changes: `keep(i)`;
//! - `fields/NAME` of a field that is the spare number of a vector has `NAME_of(i)`, and `fields/VECTOR/pack` puts both
//!   together: `pack_VECTOR(v, NAME)`;
//! - `fields/measured` declares what a measure writes;
//! - `host/largest` has the radius of the largest of grains of several sizes;
//! - `fields/NAME/color` is the role `<column>` of pictures: `column(i)`.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::gpu::{BufferPlan, Variant};
use crate::scene::Scene;
use crate::scene::column::{Column, Source};
use crate::scene::field::{COPIED_AT_ONCE, FIELDS, Field, Kind, PLACED, Travels};

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
    let has_sizes = scene.has_field("radius");
    variant.flag("sizes", has_sizes);
    if has_sizes {
        let largest = format!("const LARGEST_RADIUS: f32 = {:?}f;", scene.radius() as f32);
        variant.modules.insert("host/largest".into(), largest);
    }
    let each = u64::from(scene.capacity);
    let mut buffers = Vec::new();
    for field in fields.iter().filter(|field| field.beside.is_none()) {
        let bytes = field.kind.bytes(scene);
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
    let mut place = Function::new("place", "i: u32, slot: u32");
    let mut follow = Function::new("follow", "i: u32, slot: u32");
    let mut follow_too = Function::new("follow_too", "i: u32, slot: u32");
    let mut stay = Function::new("stay", "i: u32");
    let mut stay_too = Function::new("stay_too", "i: u32");
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
                follow.or(&mut follow_too)
            };
            goes.copy(field, &format!("next_{name}"), name, "slot");
        }
        match field.travels {
            Travels::No => {}
            Travels::Stepped => stay
                .or(&mut stay_too)
                .copy(field, &format!("next_{name}"), name, "i"),
            Travels::Kept => keep.copy(field, name, &format!("next_{name}"), "i"),
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
    for function in [place, follow, follow_too, stay, stay_too, keep] {
        modules.insert(format!("fields/{}", function.name), function.module());
    }
    modules.insert("fields/measured".into(), measured);
    modules
}

/// A shader function that copies elements of buffers.
struct Function {
    fields: usize,
    name: &'static str,
    parameters: &'static str,
    imports: String,
    body: String,
}

impl Function {
    fn new(name: &'static str, parameters: &'static str) -> Self {
        Self {
            fields: 0,
            name,
            parameters,
            imports: String::new(),
            body: String::new(),
        }
    }

    /// Itself while it may copy more, and then the one that goes on.
    fn or<'a>(&'a mut self, next: &'a mut Self) -> &'a mut Self {
        if self.fields < COPIED_AT_ONCE { self } else { next }
    }

    /// Copies element `i` of a buffer to a place in another one.
    fn copy(&mut self, field: &Field, from: &str, to: &str, place: &str) {
        self.fields += 1;
        push(
            &mut self.imports,
            format!("#import fields/{from}\n#import fields/{to}/write"),
        );
        let text = match field.kind {
            Kind::Contacts { .. } => slots_in_use(from, to, place),
            _ => format!("    {to}[{place}] = {from}[i];"),
        };
        push(&mut self.body, text);
    }

    fn module(&self) -> String {
        let Self {
            name,
            parameters,
            imports,
            body,
            ..
        } = self;
        format!("{imports}fn {name}({parameters}) {{\n{body}}}")
    }
}

/// Copies slots of contacts, up to the first one that is empty.
fn slots_in_use(from: &str, to: &str, place: &str) -> String {
    format!(
        "    for (var word = 0u; word < CONTACT_SLOTS * CONTACT_WORDS; word += CONTACT_WORDS) {{
        let first = {from}[i * CONTACT_SLOTS * CONTACT_WORDS + word];
        {to}[{place} * CONTACT_SLOTS * CONTACT_WORDS + word] = first;
        for (var more = word + 1u; more < word + CONTACT_WORDS; more++) {{
            {to}[{place} * CONTACT_SLOTS * CONTACT_WORDS + more] = {from}[i * CONTACT_SLOTS * CONTACT_WORDS + more];
        }}
        if first.w == 0.0 {{
            break;
        }}
    }}"
    )
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
        Kind::HalfStep => ("#import physics/dem/motion\n", "HalfStep"),
        Kind::Contacts { .. } => ("", "vec4f"),
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
