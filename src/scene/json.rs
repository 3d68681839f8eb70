//! JSON text to a value: no key twice, comments from `//` to the end of a line, and errors that say where and what to do.

use std::borrow::Cow;
use std::fmt;

use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use crate::error::Problem;

/// Parses JSON text, which may hold comments; a key that occurs twice in an object is an error.
pub fn parse(text: &str) -> Result<Value, Problem> {
    let text = without_comments(text);
    serde_json::from_str::<Strict>(&text)
        .map(|strict| strict.0)
        .map_err(|error| explain(&text, &error))
}

/// The text with spaces in place of comments, so that everything else stays where it is.
fn without_comments(text: &str) -> Cow<'_, str> {
    if !text.contains("//") {
        return text.into();
    }
    let mut kept = String::with_capacity(text.len());
    let (mut in_text, mut is_escaped, mut in_comment) = (false, false, false);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        in_comment = c != '\n' && (in_comment || !in_text && c == '/' && rest.peek() == Some(&'/'));
        if in_comment {
            kept.extend(std::iter::repeat_n(' ', c.len_utf8()));
            continue;
        }
        // A line break ends a text too: the parser refuses it there.
        in_text = c != '\n' && in_text != (c == '"' && !is_escaped);
        is_escaped = in_text && c == '\\' && !is_escaped;
        kept.push(c);
    }
    kept.into()
}

struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(StrictVisitor).map(Strict)
    }
}

struct StrictVisitor;

impl<'de> Visitor<'de> for StrictVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }
    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let mut array = Vec::new();
        while let Some(Strict(element)) = elements.next_element()? {
            array.push(element);
        }
        Ok(array.into())
    }
    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format!("key `{key}` stands here twice")));
            }
            let Strict(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(object.into())
    }
}

/// What a syntax error most likely is, and its help.
fn explain(text: &str, error: &serde_json::Error) -> Problem {
    let place = format!("line {}, column {}", error.line(), error.column());
    let full = error.to_string();
    let what = full.split(" at line ").next().unwrap_or(&full);
    let word = word_at(text, error.line(), error.column());
    let bare = word.trim_start_matches(['-', '+']).to_lowercase();
    let (what, help) = if ["nan", "inf", "infinity"].contains(&bare.as_str()) {
        (
            format!("`{word}` is not a JSON number"),
            "JSON has no NaN and no Infinity; give a finite number",
        )
    } else if what.contains("out of range") {
        (
            format!("`{word}` is too large for a number"),
            "JSON has no Infinity; give a finite number, at most 1e308",
        )
    } else if word.starts_with('/') || word.starts_with('#') {
        (
            "a comment of another language".into(),
            "comments begin with // and end with the line",
        )
    } else {
        (what.to_string(), help_for(what))
    };
    Problem::new(place, what, help)
}

fn help_for(what: &str) -> &'static str {
    const HELP: &[(&str, &str)] = &[
        ("twice", "keep one of them"),
        ("trailing comma", "remove the comma before the closing bracket"),
        (
            "expected `,` or",
            "put a comma between entries, or close the bracket",
        ),
        ("expected `:`", "put a colon between key and value"),
        ("key must be a string", "put the key in double quotes"),
        ("EOF", "close every `{`, `[` and `\"` that is open"),
        ("trailing characters", "remove what follows the scene's last `}`"),
        ("invalid number", "write numbers as 1, -0.5 or 2.5e-3"),
        ("control character", "write a line break inside text as \\n"),
    ];
    HELP.iter().find(|(part, _)| what.contains(part)).map_or(
        "give a number, \"text\", true, false, [list] or {object}",
        |(_, help)| help,
    )
}

/// The word around a place (both counted from 1), for the message.
fn word_at(text: &str, line: usize, column: usize) -> &str {
    let line = text.lines().nth(line.saturating_sub(1)).unwrap_or("");
    let is_end = |c: char| c.is_whitespace() || ",:[]{}\"".contains(c);
    let mut at = column.saturating_sub(1).min(line.len());
    while !line.is_char_boundary(at) {
        at -= 1;
    }
    // The parser may point one past the word.
    if line[at..].starts_with(is_end) || at == line.len() {
        at = line[..at]
            .char_indices()
            .next_back()
            .map_or(0, |(before, _)| before);
    }
    let start = line[..at]
        .char_indices()
        .rfind(|(_, c)| is_end(*c))
        .map_or(0, |(end, c)| end + c.len_utf8());
    let length = line[start..].find(is_end).unwrap_or(line.len() - start);
    &line[start..start + length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_end_with_the_line_and_do_not_begin_in_text() {
        let text = r#"// first
{ "a": 1, // µ "b": 2
  "c": "http://x \"//", "d": [2] } // last"#;
        assert_eq!(
            parse(text).unwrap(),
            serde_json::json!({ "a": 1, "c": "http://x \"//", "d": [2] })
        );
        let wrong = parse("{ // 1\n  \"a\": nan }").unwrap_err();
        assert_eq!(wrong.path, "line 2, column 9");
        for other in ["{ /* a */ }", "{ # a\n }", "{ / }"] {
            let told = parse(other).unwrap_err();
            assert!(told.help.contains("//"), "{other}: {told}");
        }
    }
}
