//! Arguments, messages, exit status, files.

#![cfg(all(feature = "plots", feature = "surface", feature = "video"))]

mod arguments;
mod inspect;
mod plans;
mod runs;

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::command::{failure, output, sliceflow};

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&output(args)).unwrap()
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// A checkpoint at the end of a run and none before, however long it takes.
const ONE_CHECKPOINT: [&str; 2] = ["--checkpoint-every", "1000000"];

/// A short run: three small frames of 2,000 discs.
fn short_run<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec![
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "3",
        "--fps",
        "1000",
        "--size",
        "160x120",
    ];
    args.extend(ONE_CHECKPOINT);
    args.extend(more);
    args
}

/// Every file of a run but the manifest (which has times of day), by name.
fn files(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let mut found = std::collections::BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        for entry in std::fs::read_dir(inside).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("run.json") {
                let name = path.strip_prefix(folder).expect("inside").display().to_string();
                found.insert(name, std::fs::read(path).expect("a file"));
            }
        }
    }
    found
}
