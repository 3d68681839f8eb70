//! Names of neighbor searches: `ADDRESSING-STORAGE`, such as `sliced-pool`.

use serde::Serialize;
use serde_json::Value;

use crate::error::{Error, Result};
use crate::neighbors::{ADDRESSINGS, STORAGES};
use crate::scene::Neighbors;

/// What `--grid` is, with the words that it takes.
pub fn help() -> String {
    let addressings: Vec<&str> = ADDRESSINGS.iter().map(|row| row.name).collect();
    let storages: Vec<&str> = STORAGES.iter().map(|row| row.name).collect();
    format!(
        "Neighbor search, ADDRESSING-STORAGE: {} with {}, such as sliced-counting",
        addressings.join("|"),
        storages.join("|")
    )
}

fn split(name: &str) -> Result<(&str, &str)> {
    name.split_once('-').ok_or_else(|| {
        Error::usage(
            format!("`{name}` is not a grid"),
            "write addressing and storage: --grid uniform-counting, --grid sliced-pool",
        )
    })
}

/// The search that a grid's name stands for, where no scene file chooses one.
pub fn neighbors(name: &str) -> Result<Neighbors> {
    let (addressing, storage) = split(name)?;
    let unknown = |word: &str, what: &str, known: &mut dyn Iterator<Item = &'static str>| {
        Error::usage(
            format!("no {what} is called `{word}`"),
            format!("there is {}", known.collect::<Vec<_>>().join(", ")),
        )
    };
    let addressing = ADDRESSINGS
        .iter()
        .find(|row| row.name == addressing)
        .ok_or_else(|| {
            unknown(
                addressing,
                "addressing",
                &mut ADDRESSINGS.iter().map(|row| row.name),
            )
        })?;
    let storage = STORAGES
        .iter()
        .find(|row| row.name == storage)
        .ok_or_else(|| unknown(storage, "storage", &mut STORAGES.iter().map(|row| row.name)))?;
    Ok(Neighbors {
        addressing: addressing.kind,
        storage: storage.kind,
        ..Neighbors::default()
    })
}

/// The scene keys that choose this grid. Words that no grid has are found when the scene is checked.
pub fn overrides(name: &str) -> Result<[String; 2]> {
    let (addressing, storage) = split(name)?;
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
