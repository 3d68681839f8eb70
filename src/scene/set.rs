//! `--set path=value`: changes a scene file's JSON before it is checked.

use serde_json::{Map, Value};

use super::json;
use crate::error::Problem;

/// All texts in the values of overrides.
pub fn words(overrides: &[String]) -> impl Iterator<Item = String> {
    let values = overrides.iter().filter_map(|one| one.split_once('='));
    let mut open: Vec<Value> = values.map(|(_, text)| value(text)).collect();
    std::iter::from_fn(move || {
        loop {
            match open.pop()? {
                Value::String(word) => return Some(word),
                Value::Array(values) => open.extend(values),
                Value::Object(values) => open.extend(values.into_iter().map(|(_, value)| value)),
                _ => {}
            }
        }
    })
}

/// JSON, or text where it is none.
fn value(text: &str) -> Value {
    json::parse(text).unwrap_or_else(|_| Value::String(text.trim().to_string()))
}

/// Applies one override such as `grains.radius=0.01` or `bodies[0].velocity=[0,1,0]`.
///
/// The value is JSON, or text when it is not JSON, so words need no quotes. Objects on the way are created; list
/// elements are not.
pub fn apply(scene: &mut Value, assignment: &str) -> Result<(), Problem> {
    let place = || format!("--set {assignment}");
    let fail = |what: String, help: String| Problem::new(place(), what, help);
    let Some((path, text)) = assignment.split_once('=') else {
        return Err(fail(
            "no `=`".into(),
            "write it as path=value: grains.radius=0.01".into(),
        ));
    };
    let steps = steps(path.trim()).ok_or_else(|| {
        fail(
            format!("`{path}` is not a path"),
            "write keys with dots and list places in brackets: bodies[0].shape.radius".into(),
        )
    })?;
    let value = value(text);
    let mut here = scene;
    let mut walked = String::new();
    for step in steps {
        here = match step {
            Step::Key(key) => {
                if here.is_null() {
                    *here = Value::Object(Map::new());
                }
                let kind = kind(here);
                let object = here.as_object_mut().ok_or_else(|| {
                    let help = format!("`{walked}` holds {kind}; set it whole, or correct the path");
                    fail(format!("`{walked}` has no key `{key}`"), help)
                })?;
                if !walked.is_empty() {
                    walked.push('.');
                }
                walked.push_str(&key);
                object.entry(key).or_insert(Value::Null)
            }
            Step::Element(index) => {
                let kind = kind(here);
                let count = here.as_array().map_or(0, Vec::len);
                let help = match count {
                    0 => format!("`{walked}` holds {kind}; set it whole: {walked}=[...]"),
                    _ => format!(
                        "`{walked}` has {count}, counted from 0: the last is {walked}[{}]",
                        count - 1
                    ),
                };
                let missing = format!("there is no `{walked}[{index}]`");
                walked.push_str(&format!("[{index}]"));
                here.get_mut(index).ok_or_else(|| fail(missing, help))?
            }
        };
    }
    *here = value;
    Ok(())
}

enum Step {
    Key(String),
    Element(usize),
}

/// `a.b[1].c` → a, b, 1, c; none when it is not a path.
fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (key, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        if key.is_empty() || key.contains(']') {
            return None;
        }
        steps.push(Step::Key(key.to_string()));
        while !rest.is_empty() {
            let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
            steps.push(Step::Element(index.parse().ok()?));
            rest = after;
        }
    }
    Some(steps)
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "nothing yet",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}
