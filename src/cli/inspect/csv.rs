//! A table of the JSON report as comma-separated values (RFC 4180, with a line break of one byte).

use serde_json::Value;

/// Rows of objects; a key of an object inside of a row gets a column of its own, `voxels_allocated.sliced-pool`.
pub fn table(rows: &Value) -> String {
    let rows: Vec<_> = rows.as_array().into_iter().flatten().map(flat).collect();
    let mut heads: Vec<&str> = Vec::new();
    for (key, _) in rows.iter().flatten() {
        if !heads.contains(&key.as_str()) {
            heads.push(key);
        }
    }
    let mut text = line(heads.iter().map(|head| quoted(head)));
    for row in &rows {
        let cell = |head: &&str| {
            let found = row.iter().find(|(key, _)| key == head);
            found.map_or_else(String::new, |(_, value)| cell(value))
        };
        text.push_str(&line(heads.iter().map(cell)));
    }
    text
}

fn flat(row: &Value) -> Vec<(String, &Value)> {
    let mut cells = Vec::new();
    for (key, value) in row.as_object().into_iter().flatten() {
        match value {
            Value::Object(inner) => {
                cells.extend(inner.iter().map(|(name, value)| (format!("{key}.{name}"), value)));
            }
            value => cells.push((key.clone(), value)),
        }
    }
    cells
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(",") + "\n"
}

/// Nothing where there is no value.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => quoted(text),
        other => other.to_string(),
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    #[test]
    fn objects_inside_become_columns_and_commas_are_quoted() {
        let rows = json!([
            { "name": "octree, leaves", "bytes": 12, "overflow": null, "in": { "a": 1, "b": 2 } },
            { "name": "say \"pool\"", "bytes": 0.5, "overflow": 3, "in": { "a": 3, "b": 4 } },
        ]);
        assert_eq!(
            super::table(&rows),
            "name,bytes,overflow,in.a,in.b\n\"octree, leaves\",12,,1,2\n\"say \"\"pool\"\"\",0.5,3,3,4\n"
        );
    }
}
