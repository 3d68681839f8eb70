//! The README and the guide say what is true: commands parse, scenes are valid, links lead somewhere, messages and examples
//! are those of the code, and the pages of keys are as the code makes them.
//!
//! Pages of keys are made anew by `UPDATE_GUIDE=1 cargo test --release --test guide`.

#![cfg(all(feature = "cli", feature = "study", feature = "surface", feature = "video"))]

#[path = "guide/keys.rs"]
mod keys;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sliceflow::gpu::device::Limits;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::load;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn guide() -> PathBuf {
    root().join("assets/guide/src")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|reason| panic!("{}: {reason}", path.display()))
}

/// The guide's pages by name.
fn pages() -> Vec<(String, String)> {
    let mut pages = Vec::new();
    for entry in std::fs::read_dir(guide()).expect("the guide") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "md") {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            pages.push((name, read(&path)));
        }
    }
    pages.sort();
    pages
}

/// The README and the guide's pages: path and text.
fn texts() -> Vec<(PathBuf, String)> {
    let mut texts = vec![(root().join("README.md"), read(&root().join("README.md")))];
    texts.extend(pages().into_iter().map(|(name, text)| (guide().join(name), text)));
    texts
}

/// Blocks between fences with this word behind the first.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let starts = text
        .split(fence.as_str())
        .skip(1)
        .filter_map(|rest| rest.split("\n```").next());
    starts.collect()
}

/// What stands between fences is no prose.
fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

#[test]
fn the_summary_lists_every_page_once() {
    let summary = read(&guide().join("SUMMARY.md"));
    let listed: Vec<&str> = links(&summary);
    let there: BTreeSet<String> = pages().into_iter().map(|(name, _)| name).collect();
    let expected: BTreeSet<&str> = there
        .iter()
        .map(String::as_str)
        .filter(|name| *name != "SUMMARY.md")
        .collect();
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), expected);
    assert_eq!(listed.len(), expected.len(), "a page is listed twice");
}

/// Targets of the links and pictures in a text.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1);
    targets.filter_map(|rest| rest.split(')').next()).collect()
}

/// A heading as links name it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut count = 0;
    let mut wrong = Vec::new();
    for (page, text) in texts() {
        let text = prose(&text);
        for link in links(&text).into_iter().filter(|link| !link.starts_with("http")) {
            count += 1;
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => page.clone(),
                _ => page.parent().expect("a folder").join(file),
            };
            let is_in_guide = target
                .canonicalize()
                .is_ok_and(|path| path.starts_with(guide().canonicalize().expect("the guide")));
            let at = page.strip_prefix(root()).expect("inside").display();
            if !target.exists() {
                wrong.push(format!("{at} links to `{link}`, which is not there"));
            } else if page.starts_with(guide()) && !is_in_guide {
                wrong.push(format!("{at} links to `{link}`, which mdBook would not find"));
            } else if !place.is_empty() {
                let text = read(&target);
                let headings = text.lines().filter(|line| line.starts_with('#'));
                if !headings
                    .into_iter()
                    .any(|line| anchor(line.trim_start_matches('#')) == place)
                {
                    wrong.push(format!("{at} links to `{link}`, and there is no such heading"));
                }
            }
        }
    }
    assert!(count > 30, "only {count} links were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_picture_is_shown_somewhere() {
    let shown: String = texts().into_iter().map(|(_, text)| text).collect();
    for entry in std::fs::read_dir(guide().join("gallery")).expect("pictures") {
        let name = entry
            .expect("an entry")
            .file_name()
            .to_string_lossy()
            .into_owned();
        assert!(
            shown.contains(&format!("gallery/{name})")),
            "{name} is shown nowhere"
        );
    }
}

/// The commands of a line as a shell splits them, each into its words.
fn commands(line: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars().chain([' ']) {
        match (quote, c) {
            (Some(end), c) if c == end => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, '&' | '|' | '>' | ';') => {
                commands.last_mut().expect("one").extend(word.take());
                // What a redirection names is no word of a command.
                commands.push(if c == '>' {
                    vec!["(file)".into()]
                } else {
                    Vec::new()
                });
            }
            (None, c) if c.is_whitespace() => commands.last_mut().expect("one").extend(word.take()),
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    commands
}

/// Every command of Sliceflow in the README and the guide: where it stands, and its words.
fn sliceflow_commands() -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (page, text) in texts() {
        let page = page.strip_prefix(root()).expect("inside").display().to_string();
        for line in blocks(&text, "sh").into_iter().flat_map(str::lines) {
            for words in commands(line) {
                // Variables may be set before a command.
                let mut words: Vec<String> = words
                    .into_iter()
                    .skip_while(|word| word.contains('=') && !word.starts_with('-'))
                    .collect();
                if words.first().is_some_and(|first| first.ends_with("sliceflow")) {
                    words[0] = "sliceflow".into();
                    found.push((format!("{page}: {line}"), words));
                }
            }
        }
    }
    found
}

#[test]
fn lines_are_split_as_a_shell_does() {
    assert_eq!(
        commands("A=1 ./x run 'a b=[0, 1]' > f && y \"c\"  # comment"),
        [
            vec!["A=1", "./x", "run", "a b=[0, 1]"],
            vec!["(file)", "f"],
            vec![],
            vec!["y", "c"]
        ]
    );
}

#[test]
fn every_command_is_understood() {
    let found = sliceflow_commands();
    assert!(found.len() > 60, "only {} commands were found", found.len());
    let mut wrong = Vec::new();
    for (place, words) in &found {
        // The launcher's own: the first picture, and the tests.
        if words.len() == 1 || words[1] == "test" {
            continue;
        }
        match sliceflow::cli::command().try_get_matches_from(words) {
            Ok(_) => {}
            Err(error) if !error.use_stderr() => {}
            Err(error) => wrong.push(format!("{place}\n{error}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Runs of scenes that ship are valid, with what is changed in them.
#[test]
fn every_run_of_a_shipped_scene_is_valid() {
    let mut checked = 0;
    for (place, words) in sliceflow_commands() {
        if words.len() < 3 || !["run", "plan", "inspect"].contains(&words[1].as_str()) {
            continue;
        }
        let Ok(matches) = sliceflow::cli::command().try_get_matches_from(&words) else {
            continue;
        };
        let (_, given) = matches.subcommand().expect("a command");
        let scene: &PathBuf = given.get_one("scene").expect("a scene");
        if scene.extension().is_some() {
            continue;
        }
        let set: Vec<String> = given.get_many("set").into_iter().flatten().cloned().collect();
        load::load(scene, &set).unwrap_or_else(|error| panic!("{place}\n{error}"));
        checked += 1;
    }
    assert!(checked > 10, "only {checked} runs were found");
}

#[test]
fn every_scene_in_the_guide_has_a_plan() {
    let mut scenes = 0;
    for (page, text) in texts() {
        for block in blocks(&text, "json")
            .into_iter()
            .filter(|block| block.contains("\"domain\""))
        {
            let place = format!("{}:\n{block}\n", page.display());
            let scene =
                load::parse(block, "scene.json", root(), &[]).unwrap_or_else(|e| panic!("{place}{e}"));
            let wanted = Wanted {
                statistics: true,
                view: Some(scene.render.view),
                sensors: true,
                ..Wanted::default()
            };
            Plan::new(&scene, &Limits::PROMISED, &wanted).unwrap_or_else(|e| panic!("{place}{e}"));
            scenes += 1;
        }
    }
    assert!(scenes >= 7, "the guide has {scenes} scenes");
}

#[test]
fn every_message_is_one_of_the_program() {
    let mut source = String::new();
    collect(&root().join("src"), &mut source);
    let page = read(&guide().join("messages.md"));
    let mut count = 0;
    for heading in page.lines().filter_map(|line| line.strip_prefix("### ")) {
        let single = heading.starts_with("``").then_some(heading.trim_matches('`'));
        let parts: Vec<&str> = match single {
            Some(whole) => vec![whole],
            None => heading.split('`').skip(1).step_by(2).collect(),
        };
        assert!(!parts.is_empty(), "{heading} quotes no message");
        for part in parts {
            count += 1;
            assert!(source.contains(part), "no message of the program says `{part}`");
        }
    }
    assert!(count > 25, "{count} messages");
}

/// The text of all Rust files, with lines that go on joined as the compiler joins them.
fn collect(folder: &Path, into: &mut String) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, into);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = read(&path);
            for line in text.lines() {
                match line.strip_suffix('\\') {
                    Some(begun) => {
                        into.push_str(if into.ends_with('\n') {
                            begun
                        } else {
                            begun.trim_start()
                        });
                    }
                    None if into.ends_with('\n') || into.is_empty() => {
                        into.push_str(line);
                        into.push('\n');
                    }
                    None => {
                        into.push_str(line.trim_start());
                        into.push('\n');
                    }
                }
            }
        }
    }
}

#[test]
fn the_library_page_shows_the_example() {
    let page = read(&guide().join("library.md"));
    let example = read(&root().join("examples/heap.rs"));
    assert_eq!(blocks(&page, "rust"), [example.trim_end()]);
}

#[test]
fn pages_of_keys_are_as_the_code_makes_them() {
    for (name, made) in keys::pages() {
        let path = guide().join(name);
        if std::env::var_os("UPDATE_GUIDE").is_some() {
            std::fs::write(&path, &made).expect("the guide can be written");
        }
        assert!(
            std::fs::read_to_string(&path).is_ok_and(|there| there == made),
            "{name} is older than the code: UPDATE_GUIDE=1 cargo test --release --test guide"
        );
    }
}

#[test]
fn every_key_has_a_description() {
    let missing = keys::without_description();
    assert!(
        missing.is_empty(),
        "without a description: {}",
        missing.join(", ")
    );
}

#[test]
fn the_page_of_guards_has_every_guard() {
    let page = read(&guide().join("guards.md"));
    let rows: Vec<String> = sliceflow::guards::GUARDS
        .iter()
        .map(|row| format!("| `{}` | {} | {} |", row.word, row.finds, row.looks_at))
        .collect();
    let there: Vec<&str> = page
        .lines()
        .filter(|line| line.starts_with("| `") && line.matches('|').count() == 4)
        .take(rows.len())
        .collect();
    assert_eq!(there, rows);
}
