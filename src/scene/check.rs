//! Walks a scene file's JSON against the schema of [`super::model::SceneFile`] and collects every mistake.
//!
//! The schema is the only list of keys, types, ranges and words: what is added to the model is checked here.

use serde_json::{Map, Value};

use super::keys;
use super::synonyms::{Meant, meant, meant_word};
use super::text::{list, number};
use crate::error::Problem;

/// Every way in which `value` does not follow `schema`.
pub fn check(value: &Value, schema: &Value) -> Vec<Problem> {
    let mut walk = Walk {
        schema,
        definitions: &schema["$defs"],
        problems: Vec::new(),
    };
    walk.visit("", value, schema, None);
    walk.problems
}

struct Walk<'a> {
    /// Of the whole scene.
    schema: &'a Value,
    definitions: &'a Value,
    problems: Vec<Problem>,
}

impl<'a> Walk<'a> {
    /// `about` is the nearest description outside, which is nearer to the reader's key than the type's own.
    fn visit(&mut self, path: &str, value: &Value, schema: &'a Value, about: Option<&'a str>) {
        let about = about.or(schema["description"].as_str());
        if let Some(reference) = schema["$ref"].as_str() {
            let name = reference.rsplit('/').next().unwrap_or(reference);
            self.visit(path, value, &self.definitions[name], about);
            return;
        }
        for part in alternatives(schema, "allOf") {
            self.visit(path, value, part, about);
        }
        let options = alternatives(schema, "anyOf");
        if !options.is_empty() {
            if let (false, Some(real)) = (value.is_null(), options.iter().find(|o| o["type"] != "null")) {
                self.visit(path, value, real, about);
            }
            return;
        }
        let variants = alternatives(schema, "oneOf");
        if variants.iter().any(|variant| tag(variant).is_some()) {
            self.visit_tagged(path, value, variants);
            return;
        }
        let words = words(schema);
        if !words.is_empty() {
            self.visit_word(path, value, &words);
            return;
        }
        if !self.has_type(path, value, schema, about) {
            return;
        }
        match value {
            Value::Object(object) => self.visit_object(path, object, schema),
            Value::Array(array) => self.visit_array(path, array, schema, about),
            Value::Number(_) => self.visit_number(path, value, schema, about),
            _ => {}
        }
    }

    fn has_type(&mut self, path: &str, value: &Value, schema: &Value, about: Option<&str>) -> bool {
        let types: Vec<&str> = match &schema["type"] {
            Value::String(one) => vec![one],
            Value::Array(several) => several.iter().filter_map(Value::as_str).collect(),
            _ => return true,
        };
        let fits = types.iter().any(|name| match *name {
            "integer" => value.is_u64() || value.is_i64(),
            "number" => value.is_number(),
            "null" => value.is_null(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "array" => value.is_array(),
            "object" => value.is_object(),
            _ => true,
        });
        if !fits {
            let wanted = types
                .iter()
                .find(|name| **name != "null")
                .map_or("null", |name| spoken(name));
            let what = format!("expected {wanted}, found {}", found(value));
            self.problems.push(Problem::new(
                path,
                what,
                with_about(&format!("give {wanted}"), about),
            ));
        }
        fits
    }

    fn visit_object(&mut self, path: &str, object: &Map<String, Value>, schema: &'a Value) {
        let Some(properties) = schema["properties"].as_object() else {
            return;
        };
        let known = properties.keys().map(String::as_str);
        let mut replaced = Vec::new();
        for (key, value) in object {
            let place = join(path, key);
            match properties.get(key) {
                Some(property) => self.visit(&place, value, property, None),
                None if schema["additionalProperties"] == false => {
                    let all = keys::all(self.schema);
                    let all: Vec<String> = all.iter().map(keys::Key::plain_path).collect();
                    // Keys of an element of a list have nothing to do with those of other objects.
                    let meant = meant(key, known.clone(), &all, !path.contains('['));
                    let help = match &meant {
                        Some(meant) => meant.question(key),
                        None => format!("keys here: {}", list(known.clone())),
                    };
                    if let Some(Meant::Here(near)) = meant {
                        replaced.push(near);
                    }
                    self.problems.push(Problem::new(place, "unknown key", help));
                }
                None => {}
            }
        }
        for key in alternatives(schema, "required").iter().filter_map(Value::as_str) {
            // A misspelled key has been reported as such.
            if !object.contains_key(key) && !replaced.contains(&key) {
                let help = with_about("add it", self.about(&properties[key]));
                self.problems.push(Problem::new(join(path, key), "missing", help));
            }
        }
    }

    fn visit_array(&mut self, path: &str, array: &[Value], schema: &'a Value, about: Option<&'a str>) {
        let least = schema["minItems"].as_u64().unwrap_or(0);
        let most = schema["maxItems"].as_u64().unwrap_or(u64::MAX);
        let count = array.len() as u64;
        if count < least || count > most {
            let wanted = match (least, most) {
                (a, b) if a == b => format!("{a}"),
                (a, u64::MAX) => format!("at least {a}"),
                (a, b) => format!("{a} to {b}"),
            };
            let help = with_about(&format!("give {wanted} entries"), about);
            self.problems.push(Problem::new(
                path,
                format!("a list of {count}, expected {wanted} entries"),
                help,
            ));
        }
        let fixed = alternatives(schema, "prefixItems");
        for (i, element) in array.iter().enumerate() {
            let rule = fixed.get(i).unwrap_or(&schema["items"]);
            // An element's own description says more than the list's; a number has none.
            self.visit(&format!("{path}[{i}]"), element, rule, None);
        }
    }

    fn visit_number(&mut self, path: &str, value: &Value, schema: &Value, about: Option<&str>) {
        let Some(x) = value.as_f64() else {
            return;
        };
        let bound = |name: &str| schema[name].as_f64();
        let outside = bound("minimum").is_some_and(|low| x < low)
            || bound("maximum").is_some_and(|high| x > high)
            || bound("exclusiveMinimum").is_some_and(|low| x <= low)
            || bound("exclusiveMaximum").is_some_and(|high| x >= high);
        if !outside {
            return;
        }
        let limits = [
            ("at least", "minimum"),
            ("more than", "exclusiveMinimum"),
            ("at most", "maximum"),
            ("less than", "exclusiveMaximum"),
        ];
        let range: Vec<_> = limits
            .iter()
            .filter_map(|(says, name)| Some(format!("{says} {}", number(bound(name)?))))
            .collect();
        let help = with_about(&format!("give {}", range.join(" and ")), about);
        self.problems
            .push(Problem::new(path, format!("{value} is out of range"), help));
    }

    fn visit_word(&mut self, path: &str, value: &Value, words: &[&str]) {
        match value.as_str() {
            Some(word) if words.contains(&word) => {}
            Some(word) => {
                let all = list(words.iter().copied());
                let help = match meant_word(word, words.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`? one of {all}"),
                    None => format!("one of {all}"),
                };
                self.problems
                    .push(Problem::new(path, format!("unknown word \"{word}\""), help));
            }
            None => {
                let what = format!("expected a word, found {}", found(value));
                let help = format!("one of {}", list(words.iter().copied()));
                self.problems.push(Problem::new(path, what, help));
            }
        }
    }

    /// An object whose `kind` says which keys it has.
    fn visit_tagged(&mut self, path: &str, value: &Value, variants: &'a [Value]) {
        let kinds: Vec<&str> = variants.iter().filter_map(tag).collect();
        let Some(object) = value.as_object() else {
            let what = format!("expected an object, found {}", found(value));
            let help = format!("give an object with `kind`: one of {}", list(kinds));
            self.problems.push(Problem::new(path, what, help));
            return;
        };
        let place = join(path, "kind");
        let Some(kind) = object.get("kind") else {
            let help = format!("add it: one of {}", list(kinds));
            self.problems.push(Problem::new(place, "missing", help));
            return;
        };
        match variants.iter().find(|variant| tag(variant) == kind.as_str()) {
            Some(variant) if kind.is_string() => self.visit_object(path, object, variant),
            _ => self.visit_word(&place, kind, &kinds),
        }
    }

    /// A property's description, or that of the type it refers to.
    fn about(&self, property: &'a Value) -> Option<&'a str> {
        let name = property["$ref"]
            .as_str()
            .and_then(|reference| reference.rsplit('/').next());
        let own = property["description"].as_str();
        own.or(name.and_then(|name| self.definitions[name]["description"].as_str()))
    }
}

fn alternatives<'a>(schema: &'a Value, name: &str) -> &'a [Value] {
    schema[name].as_array().map_or(&[], Vec::as_slice)
}

/// The `kind` of a tagged variant.
fn tag(variant: &Value) -> Option<&str> {
    variant["properties"]["kind"]["const"].as_str()
}

/// The words of an enum, however the schema spells it.
fn words(schema: &Value) -> Vec<&str> {
    let own = schema["const"].as_str().into_iter();
    let listed = alternatives(schema, "enum").iter().filter_map(Value::as_str);
    let nested = alternatives(schema, "oneOf").iter().flat_map(words);
    own.chain(listed).chain(nested).collect()
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_string()
    } else {
        format!("{path}.{key}")
    }
}

/// "give a number: Metres per second"
fn with_about(help: &str, about: Option<&str>) -> String {
    match about {
        Some(about) => format!("{help}: {}", about.trim_end_matches('.')),
        None => help.to_string(),
    }
}

fn spoken(type_name: &str) -> &'static str {
    match type_name {
        "integer" => "a whole number",
        "number" => "a number",
        "string" => "text in quotes",
        "boolean" => "true or false",
        "array" => "a list [...]",
        "object" => "an object {...}",
        _ => "null",
    }
}

fn found(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Array(_) => "a list".into(),
        Value::Object(_) => "an object".into(),
        Value::String(text) => format!("text \"{text}\""),
        plain => plain.to_string(),
    }
}
