//! The map in `src/lib.rs` names what exists, imports go one way, and no file of tests is left out.

use std::path::Path;

#[test]
fn every_path_in_the_map_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = include_str!("../../src/lib.rs");
    let words = map
        .lines()
        .filter(|line| line.starts_with("//!"))
        .flat_map(|line| line.split(['`', ' ', ',']));
    let paths: Vec<&str> = words
        .filter(|word| word.contains('/') && word.starts_with(char::is_alphabetic))
        .collect();
    assert!(paths.len() > 12, "the map names its rooms: {paths:?}");
    for path in paths {
        let path = path.trim_end_matches(['.', ';', ':', ')']);
        assert!(
            root.join(path).exists(),
            "the map names `{path}`, which is not there"
        );
    }
}

/// Every Rust file below a folder.
fn files(folder: &Path, into: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, into);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn imports_point_one_way() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let map = include_str!("../../src/lib.rs");
    let room = |line: &str| {
        let path = line.strip_prefix("//! - `src/")?;
        path.split(['/', '.']).next().map(str::to_owned)
    };
    let rooms: Vec<String> = map.lines().filter_map(room).collect();
    assert_eq!(rooms.len(), 14, "{rooms:?}");
    let mut found = Vec::new();
    files(&source, &mut found);
    let mut wrong = Vec::new();
    for path in found {
        let inside = path.strip_prefix(&source).expect("inside").display().to_string();
        let Some(here) = rooms.iter().position(|room| inside.starts_with(room.as_str())) else {
            continue;
        };
        // Tests may look anywhere, and so may comments.
        if path.ends_with("tests.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("text");
        let is_inside = |rest: &str| rest.lines().nth(1).is_some_and(|line| line.ends_with('{'));
        let mut marks = text.match_indices("#[cfg(test)]").map(|(at, _)| at);
        let end = marks.find(|&at| is_inside(&text[at..])).unwrap_or(text.len());
        let code: String = text[..end]
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect();
        for room in &rooms[here + 1..] {
            if code.contains(&format!("crate::{room}::")) {
                wrong.push(format!("src/{inside} imports {}, which lies below it", room));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A file of `tests/library/` or `tests/program/` that no other declares would not run.
#[test]
fn every_file_of_tests_is_part_of_a_program() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    for room in ["library", "program"] {
        let mut found = Vec::new();
        files(&tests.join(room), &mut found);
        assert!(found.len() > 10, "{room}");
        for path in found
            .iter()
            .filter(|path| !path.ends_with(format!("{room}/main.rs")))
        {
            let (mut module, mut folder) = (path.file_stem(), path.parent().expect("a folder"));
            if path.ends_with("mod.rs") {
                (module, folder) = (folder.file_name(), folder.parent().expect("a folder"));
            }
            let root = ["main.rs", "mod.rs"]
                .map(|name| folder.join(name))
                .into_iter()
                .find(|root| root.exists());
            let text = std::fs::read_to_string(root.expect("a file of modules")).expect("text");
            let module = module.expect("a name").display();
            let declared = text.lines().any(|line| line == format!("mod {module};"));
            assert!(declared, "{} is declared nowhere", path.display());
        }
    }
}
