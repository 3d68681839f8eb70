//! Names of neighbor searches: `ADDRESSING-STORAGE`, such as `sliced-pool`.

use serde::Serialize;
use serde_json::Value;

use crate::error::{Error, Result};
use crate::scene::Neighbors;

/// The scene keys that choose this grid. Words that no grid has are found when the scene is checked.
pub fn overrides(name: &str) -> Result<[String; 2]> {
    let (addressing, storage) = name.split_once('-').ok_or_else(|| {
        Error::usage(
            format!("`{name}` is no grid"),
            "write addressing and storage: --grid uniform-counting, --grid sliced-pool",
        )
    })?;
    Ok([
        format!("neighbors.addressing={addressing}"),
        format!("neighbors.storage={storage}"),
    ])
}

/// What `--grid` calls this choice.
pub fn name(neighbors: &Neighbors) -> String {
    format!("{}-{}", word(neighbors.addressing), word(neighbors.storage))
}

/// An enum's value as scene files write it.
fn word(value: impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(word)) => word,
        other => unreachable!("grids are chosen by words, not by {other:?}"),
    }
}
