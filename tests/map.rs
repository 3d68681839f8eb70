//! The map in `src/lib.rs` and what the README names exist.

use std::path::Path;

#[test]
fn every_path_in_the_map_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = include_str!("../src/lib.rs");
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

#[test]
fn every_link_in_the_readme_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = include_str!("../README.md");
    let links: Vec<&str> = readme
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .collect();
    assert!(!links.is_empty());
    for link in links
        .iter()
        .filter(|link| !link.starts_with("http") && !link.starts_with('#'))
    {
        assert!(
            root.join(link).exists(),
            "the README links to `{link}`, which is not there"
        );
    }
}
