//! Pages that list every key of scenes and of what runs write, made from the schemas that the code derives.

use std::collections::BTreeMap;

use serde_json::Value;
use sliceflow::output::{manifest_schema, post_mortem_schema, statistics_schema};
use sliceflow::scene::load;

const SCENE_PAGE: &str = "scene_keys.md";
const OUTPUT_PAGE: &str = "output_keys.md";
const MADE: &str = "<!-- Made by `UPDATE_GUIDE=1 cargo test --release --test guide`. -->\n";

/// Name and text of each page.
pub fn pages() -> [(&'static str, String); 2] {
    let scene = format!(
        "# Every key of a scene\n\n{MADE}\nUnits are SI. A point has two numbers in a 2D scene and three in a 3D scene. \
         `./sliceflow schema KEY` prints one key, `./sliceflow schema` all of them as a JSON schema for editors.\n{}",
        sections(&load::schema(), "The scene", Kind::Input)
    );
    let output = format!(
        "# Every key of stats.jsonl and run.json\n\n{MADE}\nUnits are in the keys or in the text. Keys that may be absent say \
         so.\n{}{}{}",
        sections(&statistics_schema(), "stats.jsonl", Kind::Output),
        sections(&manifest_schema(), "run.json", Kind::Output),
        sections(&post_mortem_schema(), "post_mortem/report.json", Kind::Output),
    );
    [(SCENE_PAGE, scene), (OUTPUT_PAGE, output)]
}

/// Keys, words and kinds that say nothing of themselves.
pub fn without_description() -> Vec<String> {
    let schemas = [
        ("scene", load::schema()),
        ("stats.jsonl", statistics_schema()),
        ("run.json", manifest_schema()),
        ("post_mortem/report.json", post_mortem_schema()),
    ];
    let mut missing = Vec::new();
    for (name, schema) in &schemas {
        let mut look = |place: &str, part: &Value| {
            for (key, property) in part["properties"].as_object().into_iter().flatten() {
                // Which kind it is, the variant says.
                if property["const"].is_null() && property["description"].is_null() {
                    missing.push(format!("{name} {place}.{key}"));
                }
            }
            for variant in list(part, "oneOf") {
                if variant["description"].is_null() {
                    let tags = variant["properties"].as_object().into_iter().flatten();
                    let tag = tags
                        .map(|(_, property)| &property["const"])
                        .find(|tag| !tag.is_null());
                    missing.push(format!("{name} {place} {}", tag.unwrap_or(variant)));
                }
            }
        };
        look("", schema);
        for (place, definition) in schema["$defs"].as_object().into_iter().flatten() {
            look(place, definition);
            for variant in list(definition, "oneOf")
                .iter()
                .filter(|one| !one["properties"]["kind"].is_null())
            {
                look(place, variant);
            }
        }
    }
    missing
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// What somebody writes: ranges and defaults matter.
    Input,
    /// What a run writes.
    Output,
}

fn list<'a>(schema: &'a Value, name: &str) -> &'a [Value] {
    schema[name].as_array().map_or(&[], Vec::as_slice)
}

/// Walks a schema from its root, one section for each kind of object.
struct Walk<'a> {
    kind: Kind,
    definitions: &'a Value,
    /// Where a definition has its section, or its words.
    places: BTreeMap<&'a str, String>,
    /// Sections to come: path and definition.
    ahead: Vec<(String, &'a Value)>,
    out: String,
}

fn sections(schema: &Value, title: &str, kind: Kind) -> String {
    let mut walk = Walk {
        kind,
        definitions: &schema["$defs"],
        places: BTreeMap::new(),
        ahead: Vec::new(),
        out: String::new(),
    };
    walk.section(title, "", schema);
    while !walk.ahead.is_empty() {
        let (path, schema) = walk.ahead.remove(0);
        // What is inside of a section follows it.
        let later = std::mem::take(&mut walk.ahead);
        walk.section(&format!("`{path}`"), &path, schema);
        walk.ahead.extend(later);
    }
    walk.out
}

impl<'a> Walk<'a> {
    fn say(&mut self, text: &str) {
        self.out.push_str(text);
    }

    fn section(&mut self, title: &str, path: &str, schema: &'a Value) {
        self.say(&format!("\n## {title}\n"));
        if let Some(about) = schema["description"].as_str() {
            self.say(&format!("\n{}\n", flat(about)));
        }
        let kinds = list(schema, "oneOf")
            .iter()
            .filter(|variant| !variant["properties"]["kind"].is_null());
        let kinds: Vec<&Value> = kinds.collect();
        if kinds.is_empty() {
            self.table(path, schema);
        }
        for variant in kinds {
            let name = variant["properties"]["kind"]["const"].as_str().expect("a kind");
            let about = flat(variant["description"].as_str().unwrap_or_default());
            self.say(&format!("\n### {title} of kind `{name}`\n\n{about}\n"));
            self.table(path, variant);
        }
    }

    /// Keys of an object, and the words that they take.
    fn table(&mut self, path: &str, schema: &'a Value) {
        let mut rows = String::new();
        let mut words = String::new();
        let required: Vec<&str> = list(schema, "required")
            .iter()
            .filter_map(Value::as_str)
            .collect();
        let properties = schema["properties"].as_object().into_iter().flatten();
        for (key, property) in properties.filter(|(_, property)| property["const"].is_null()) {
            let inner = if path.is_empty() {
                key.clone()
            } else {
                format!("{path}.{key}")
            };
            let about = flat(property["description"].as_str().unwrap_or_default());
            let (spoken, listed) = self.value(&inner, property);
            if let Some(listed) = listed {
                let each = match property["type"] == "array" {
                    true => "Each of ",
                    false => "",
                };
                words.push_str(&format!("\n{each}`{key}` is one of\n\n{listed}"));
            }
            let about = about.replace('|', "\\|");
            match self.kind {
                Kind::Input => {
                    let default = match &property["default"] {
                        _ if required.contains(&key.as_str()) => "required".to_owned(),
                        Value::Null => String::new(),
                        Value::Object(_) => String::new(),
                        Value::Array(items) if items.is_empty() => "none".to_owned(),
                        Value::String(text) if text.is_empty() => String::new(),
                        value => format!("`{value}`"),
                    };
                    rows.push_str(&format!("| `{key}` | {spoken} | {default} | {about} |\n"));
                }
                Kind::Output => {
                    // What is left out where it is null is never null.
                    let spoken = match required.contains(&key.as_str()) {
                        true => spoken.as_str(),
                        false => spoken.trim_end_matches(", or null"),
                    };
                    let absent = match required.contains(&key.as_str()) {
                        true => "",
                        false => " (may be absent)",
                    };
                    rows.push_str(&format!("| `{key}` | {spoken} | {about}{absent} |\n"));
                }
            }
        }
        let head = match self.kind {
            Kind::Input => "\n| key | value | when left out | meaning |\n|---|---|---|---|\n",
            Kind::Output => "\n| key | value | meaning |\n|---|---|---|\n",
        };
        self.say(head);
        self.say(&rows);
        self.say(&words);
    }

    /// What a key's value is, and the words that it may be.
    fn value(&mut self, path: &str, schema: &'a Value) -> (String, Option<String>) {
        if let Some(real) = list(schema, "anyOf").iter().find(|one| one["type"] != "null") {
            let (spoken, words) = self.value(path, real);
            return (self.or_null(spoken), words);
        }
        if let Some(reference) = schema["$ref"].as_str() {
            let name = reference.rsplit('/').next().unwrap_or(reference);
            return self.defined(path, name);
        }
        let types: Vec<&str> = match &schema["type"] {
            Value::String(one) => vec![one],
            several => several
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str)
                .collect(),
        };
        let spoken = match types.first().copied().unwrap_or_default() {
            "integer" => format!("a whole number{}", range(schema)),
            "number" => format!("a number{}", range(schema)),
            "string" => "text".to_owned(),
            "boolean" => "`true` or `false`".to_owned(),
            "array" => {
                let (item, words) = self.value(&format!("{path}[]"), &schema["items"]);
                if words.is_some() {
                    return ("a list of words".to_owned(), words);
                }
                match schema["minItems"].as_u64() {
                    Some(count) if schema["maxItems"].as_u64() == Some(count) => match item.as_str() {
                        "text" => format!("{count} texts"),
                        _ => format!("{count} numbers"),
                    },
                    _ if item == "text" => "a list of texts".to_owned(),
                    _ => format!("a list of {}", item.trim_start_matches("an object: ")),
                }
            }
            "object" => "an object".to_owned(),
            other => panic!("{path}: a {other} is not told yet"),
        };
        let spoken = if types.contains(&"null") {
            self.or_null(spoken)
        } else {
            spoken
        };
        (spoken, None)
    }

    /// In a scene, null is as good as nothing.
    fn or_null(&self, spoken: String) -> String {
        match self.kind {
            Kind::Input => spoken,
            Kind::Output => format!("{spoken}, or null"),
        }
    }

    fn defined(&mut self, path: &str, name: &'a str) -> (String, Option<String>) {
        if name == "SceneFile" {
            return (format!("[a scene]({SCENE_PAGE})"), None);
        }
        let definition = &self.definitions[name];
        if definition["type"] == "array" {
            return ("a point".to_owned(), None);
        }
        let variants = list(definition, "oneOf");
        let tagged = variants
            .iter()
            .any(|variant| !variant["properties"]["kind"].is_null());
        if !variants.is_empty() && !tagged || !definition["enum"].is_null() {
            return match self.places.get(name) {
                Some(place) => (format!("a word, as `{place}`"), None),
                None => {
                    self.places.insert(name, path.to_owned());
                    ("a word".to_owned(), Some(words(definition)))
                }
            };
        }
        let place = self.places.get(name).cloned().unwrap_or_else(|| {
            self.ahead.push((path.to_owned(), definition));
            self.places.insert(name, path.to_owned());
            path.to_owned()
        });
        (
            format!("an object: [`{place}`](#{})", super::anchor(&place)),
            None,
        )
    }
}

/// The words of an enum, one a line.
fn words(schema: &Value) -> String {
    let mut lines = String::new();
    for variant in list(schema, "oneOf") {
        let about = flat(variant["description"].as_str().unwrap_or_default());
        let word = variant["const"].as_str().map(str::to_owned);
        let named = variant["properties"].as_object().into_iter().flatten().next();
        let word = word.or(named.map(|(key, _)| format!("{{\"{key}\": N}}")));
        lines.push_str(&format!("- `{}`: {about}\n", word.expect("a word")));
    }
    lines
}

fn range(schema: &Value) -> String {
    let bound = |name: &str| schema[name].as_f64().map(number);
    match (bound("minimum"), bound("maximum")) {
        (Some(low), Some(high)) => format!(", {low} to {high}"),
        (Some(low), None) if low != "0" => format!(", at least {low}"),
        _ => String::new(),
    }
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// Without the line breaks of a comment.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
