//! Every key of scene files, as the schema has them: its path, what it may be, and what it means.

use serde_json::Value;

/// A key of scene files.
#[derive(Debug, Clone, Copy)]
struct Place<'a> {
    /// The property's own part of the schema, before references are followed.
    schema: &'a Value,
    is_required: bool,
    /// The `kind` of the object that has this key, where kinds have keys of their own.
    of_kind: Option<&'a str>,
    /// Where the key is `kind` itself: the object, with all of its variants.
    variants: Option<&'a Value>,
}

/// A key with everything that the schema says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// `bodies[].shape.radius`
    pub path: String,
    /// The kinds of the object that have this key, where not all have it.
    pub of_kinds: Vec<String>,
    /// What the key means, with its unit; a paragraph each.
    pub about: Vec<String>,
    /// `a number from 0 to 10`
    pub value: String,
    pub is_required: bool,
    /// `0.5 when left out`
    pub presence: String,
    /// Words that the value may be, or keys of the object, each with what it means.
    pub choices: Vec<(String, String)>,
}

impl Key {
    /// The path without brackets: `bodies.shape.radius`.
    pub fn plain_path(&self) -> String {
        self.path.replace("[]", "")
    }

    /// The last part of the path.
    pub fn name(&self) -> &str {
        self.path
            .rsplit('.')
            .next()
            .unwrap_or_default()
            .trim_end_matches("[]")
    }
}

/// Every key of the schema, the outer ones before those inside of them. Keys that several kinds of an object share are
/// listed once where they mean the same.
pub fn all(schema: &Value) -> Vec<Key> {
    let walk = Walk {
        definitions: &schema["$defs"],
    };
    let mut keys: Vec<Key> = Vec::new();
    walk.visit_inside("", schema, &mut |path, place| {
        let key = walk.key(path, place);
        let same = |other: &&mut Key| {
            other.path == key.path
                && (&other.about, &other.value, &other.presence) == (&key.about, &key.value, &key.presence)
        };
        match keys.iter_mut().find(same) {
            Some(known) => known.of_kinds.extend(key.of_kinds),
            None => keys.push(key),
        }
    });
    keys
}

struct Walk<'a> {
    definitions: &'a Value,
}

impl<'a> Walk<'a> {
    /// What a part of the schema refers to; of an optional part what it is when it is there.
    fn resolve(&self, mut schema: &'a Value) -> &'a Value {
        loop {
            if let Some(reference) = schema["$ref"].as_str() {
                let name = reference.rsplit('/').next().unwrap_or(reference);
                schema = &self.definitions[name];
            } else if let Some(real) = list(schema, "anyOf").iter().find(|part| part["type"] != "null") {
                schema = real;
            } else {
                return schema;
            }
        }
    }

    /// Calls `each` with all keys inside of a value.
    fn visit_inside(&self, path: &str, schema: &'a Value, each: &mut impl FnMut(&str, Place<'a>)) {
        let real = self.resolve(schema);
        if let Some(items) = real.get("items").filter(|items| items.is_object()) {
            self.visit_inside(&format!("{path}[]"), items, each);
            return;
        }
        let variants = list(real, "oneOf")
            .iter()
            .filter(|variant| tag(variant).is_some());
        for (number, variant) in variants.enumerate() {
            self.visit_properties(path, variant, (number == 0).then_some(real), each);
        }
        self.visit_properties(path, real, None, each);
    }

    /// `kind` is the same key in all variants; it is listed with the first, which has all of them as `variants`.
    fn visit_properties(
        &self,
        path: &str,
        object: &'a Value,
        variants: Option<&'a Value>,
        each: &mut impl FnMut(&str, Place<'a>),
    ) {
        for (name, schema) in object["properties"].as_object().into_iter().flatten() {
            let is_tag = schema["const"].is_string();
            if is_tag && variants.is_none() {
                continue;
            }
            let inner = if path.is_empty() {
                name.clone()
            } else {
                format!("{path}.{name}")
            };
            let place = Place {
                schema,
                is_required: list(object, "required").iter().any(|key| key == name.as_str()),
                of_kind: if is_tag { None } else { tag(object) },
                variants: variants.filter(|_| is_tag),
            };
            each(&inner, place);
            if !is_tag {
                self.visit_inside(&inner, schema, each);
            }
        }
    }

    fn key(&self, path: &str, place: Place<'a>) -> Key {
        let Place {
            schema,
            is_required,
            of_kind,
            variants,
        } = place;
        let real = self.resolve(schema);
        // The property's own words say what its type's would; what a list holds comes on top.
        let own = [schema, real]
            .into_iter()
            .find_map(|part| part["description"].as_str());
        let element = self.element(real);
        let of_element = element["description"]
            .as_str()
            .filter(|_| !std::ptr::eq(element, real));
        let mut about: Vec<String> = own
            .into_iter()
            .chain(of_element)
            .map(|text| text.replace('\n', " "))
            .collect();
        about.dedup();
        Key {
            path: path.to_owned(),
            of_kinds: of_kind.map(str::to_owned).into_iter().collect(),
            about,
            value: match variants {
                Some(_) => "a word".to_owned(),
                None => self.value(real),
            },
            is_required,
            presence: match (default(&schema["default"]), is_required) {
                (Some(default), _) => format!("{default} when left out"),
                (None, true) => "must be given".to_owned(),
                (None, false) => "may be left out".to_owned(),
            },
            choices: self.choices(variants.unwrap_or(real)),
        }
    }

    /// What a list holds; the value itself where it is none.
    fn element(&self, real: &'a Value) -> &'a Value {
        match real.get("items").filter(|items| items.is_object()) {
            Some(items) => self.resolve(items),
            None => real,
        }
    }

    /// In words, with the range.
    fn value(&self, real: &'a Value) -> String {
        if real.get("items").is_some() {
            let each = self.resolve(&real["items"]);
            let length = match (real["minItems"].as_u64(), real["maxItems"].as_u64()) {
                (Some(least), Some(most)) if least == most => format!("{least} "),
                (Some(least), Some(most)) => format!("{least} or {most} "),
                _ => String::new(),
            };
            let what = match each["type"].as_str() {
                Some("number") => "numbers",
                Some("integer") => "whole numbers",
                Some("string") => "texts",
                _ => "objects",
            };
            return format!("a list of {length}{what}");
        }
        if !words(real).is_empty() {
            return "a word".to_owned();
        }
        if list(real, "oneOf").iter().any(|variant| tag(variant).is_some()) {
            return "an object, whose `kind` says which keys it has".to_owned();
        }
        let types = [&real["type"]].into_iter().chain(list(real, "type"));
        let name = types.filter_map(Value::as_str).find(|name| *name != "null");
        let what = match name {
            Some("number") => "a number",
            Some("integer") => "a whole number",
            Some("string") => "a text",
            Some("boolean") => "true or false",
            _ => "an object",
        };
        let bound = |name: &str| real[name].as_f64().map(super::text::number);
        let range = match (bound("minimum"), bound("maximum")) {
            (Some(low), Some(high)) => format!(" from {low} to {high}"),
            (Some(low), None) => format!(", at least {low}"),
            (None, Some(high)) => format!(", at most {high}"),
            (None, None) => String::new(),
        };
        format!("{what}{range}")
    }

    /// Words, kinds or keys to choose from, each with its first sentence.
    fn choices(&self, real: &'a Value) -> Vec<(String, String)> {
        let inner = self.element(real);
        let sentence = |schema: &'a Value| {
            let own = schema["description"].as_str();
            let text = own.or_else(|| self.resolve(schema)["description"].as_str());
            first_sentence(&text.unwrap_or_default().replace('\n', " "))
        };
        let variants = list(inner, "oneOf");
        let kinds = variants
            .iter()
            .filter_map(|variant| Some((tag(variant)?, variant)));
        let kinds: Vec<_> = kinds
            .map(|(kind, variant)| {
                let keys = variant["properties"].as_object().into_iter().flatten();
                let keys = keys.map(|(name, _)| name.as_str()).filter(|name| *name != "kind");
                let keys = keys.collect::<Vec<_>>().join(", ");
                let about = match sentence(variant) {
                    about if about.is_empty() => format!("with {keys}"),
                    about => format!("with {keys}: {about}"),
                };
                (kind.to_owned(), about)
            })
            .collect();
        if !kinds.is_empty() {
            return kinds;
        }
        let words = words(inner);
        if !words.is_empty() {
            return words
                .into_iter()
                .map(|(word, schema)| (word.to_owned(), schema.map(sentence).unwrap_or_default()))
                .collect();
        }
        let properties = inner["properties"].as_object().into_iter().flatten();
        properties
            .map(|(name, schema)| (name.clone(), sentence(schema)))
            .collect()
    }
}

/// In words; `None` where it says nothing.
fn default(value: &Value) -> Option<String> {
    match value {
        Value::Null | Value::Object(_) => None,
        Value::String(text) => Some(text.clone()).filter(|text| !text.is_empty()),
        Value::Number(number) => number.as_f64().map(super::text::number),
        Value::Array(list) => {
            let each: Option<Vec<_>> = list.iter().map(default).collect();
            each.filter(|each| !each.is_empty())
                .map(|each| format!("[{}]", each.join(", ")))
        }
        Value::Bool(_) => Some(value.to_string()),
    }
}

fn list<'a>(schema: &'a Value, name: &str) -> &'a [Value] {
    schema[name].as_array().map_or(&[], Vec::as_slice)
}

/// The `kind` of a tagged variant.
fn tag(variant: &Value) -> Option<&str> {
    variant["properties"]["kind"]["const"].as_str()
}

/// The words of an enum, each with the part of the schema that describes it.
fn words(schema: &Value) -> Vec<(&str, Option<&Value>)> {
    let listed = list(schema, "enum").iter().filter_map(Value::as_str);
    let listed = listed.map(|word| (word, None));
    let nested = list(schema, "oneOf").iter().flat_map(|part| {
        let single = part["const"].as_str().map(|word| (word, Some(part)));
        single.into_iter().chain(words(part))
    });
    listed.chain(nested).collect()
}

fn first_sentence(text: &str) -> String {
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    text[..end].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::schema;

    fn key(path: &str) -> Vec<Key> {
        all(&schema())
            .into_iter()
            .filter(|key| key.path == path)
            .collect()
    }

    #[test]
    fn every_key_of_the_schema_is_there_once() {
        let keys = all(&schema());
        assert!(keys.len() > 140, "{}", keys.len());
        for path in [
            "domain.sides.y_max",
            "fluid.materials[].density",
            "bodies[].shape.placement.translate",
            "colliders[].path[].offset",
            "events[].move.during",
            "render.camera.field_of_view",
        ] {
            assert_eq!(key(path).len(), 1, "{path}");
        }
        let again = keys.iter().enumerate().find(|(at, one)| {
            let same =
                |other: &Key| other.path == one.path && other.value == one.value && other.about == one.about;
            keys[..*at].iter().any(same)
        });
        assert_eq!(again, None);
    }

    #[test]
    fn numbers_have_their_range_and_default() {
        let [gap] = &key("bodies[].jitter")[..] else {
            panic!()
        };
        assert_eq!(gap.value, "a number from 0 to 0.5");
        assert_eq!(gap.presence, "0 when left out");
        let [spring] = &key("grains.spring")[..] else {
            panic!()
        };
        assert!(spring.about[0].contains("N/m"), "{spring:?}");
        let [spacing] = &key("fluid.spacing")[..] else {
            panic!()
        };
        assert_eq!(spacing.presence, "must be given");
    }

    #[test]
    fn kinds_words_and_keys_are_choices() {
        let names = |path: &str| -> Vec<String> {
            let [one] = &key(path)[..] else { panic!("{path}") };
            one.choices.iter().map(|(name, _)| name.clone()).collect()
        };
        assert!(names("bodies[].shape").contains(&"cylinder".to_owned()));
        assert_eq!(names("bodies[].shape.kind"), names("bodies[].shape"));
        assert_eq!(names("grains.dashpot"), ["full", "normal"]);
        let [gravity] = &key("gravity")[..] else { panic!() };
        assert_eq!(gravity.value, "a list of 2 or 3 numbers");
        assert_eq!(gravity.presence, "[0, -9.81, 0] when left out");
        assert!(names("emitters").contains(&"velocity".to_owned()));
        // Spheres and cylinders of bodies have a radius with the same range.
        let [radius] = &key("bodies[].shape.radius")[..] else {
            panic!()
        };
        assert_eq!(radius.of_kinds, ["sphere", "cylinder"]);
    }
}
