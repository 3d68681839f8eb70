//! A study's parts: each can be run alone, and each is on disk when the next one begins.

use std::path::PathBuf;

use super::bench::{Bench, first_line};
use super::page::Page;
use crate::error::{Error, Result};
use crate::output::interrupt;
use crate::scene::synonyms::nearest;

/// A part of a study, which has a heading of its own on the page. `S` is what parts share.
pub struct Part<S> {
    /// For `--case`.
    pub name: &'static str,
    pub run: fn(&mut Page, &Bench, &mut S) -> Result<()>,
}

/// The names of a study's parts.
pub fn names<S>(parts: &[Part<S>]) -> Vec<&'static str> {
    parts.iter().map(|part| part.name).collect()
}

/// The parts of these names in the study's order, all where none is named.
pub fn chosen<'a, S>(study: &str, parts: &'a [Part<S>], cases: &[String]) -> Result<Vec<&'a Part<S>>> {
    for case in cases {
        if parts.iter().all(|part| part.name != case) {
            return Err(unknown(study, case, &names(parts)));
        }
    }
    let wanted = |part: &&Part<S>| cases.is_empty() || cases.iter().any(|case| case == part.name);
    Ok(parts.iter().filter(wanted).collect())
}

/// The error for a case that a study has not.
pub fn unknown(study: &str, case: &str, known: &[&str]) -> Error {
    let near = nearest(case, known.iter().copied());
    let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
    Error::usage(
        format!("`study {study}` has no case `{case}`"),
        format!("{near}name one of {}", known.join(", ")),
    )
}

/// Runs parts in order. `end` adds what stands below all of them. A study that is interrupted, or that fails, keeps the
/// parts that were finished, and its page says which ones are missing.
pub fn run<S>(
    mut page: Page,
    bench: &Bench,
    shared: &mut S,
    parts: &[&Part<S>],
    end: fn(&mut Page, &S),
) -> Result<PathBuf> {
    let mut path = PathBuf::new();
    for (number, part) in parts.iter().enumerate() {
        let before = page.mark();
        let ran = (part.run)(&mut page, bench, shared).and_then(|()| bench.check());
        let is_last = number + 1 == parts.len();
        // A part that nobody told to stop is whole, and the next one does not begin.
        let finished = number + usize::from(ran.is_ok());
        let stopped = match ran {
            Ok(()) if interrupt::asked() && !is_last => Err(Error::interrupted("")),
            Err(error) => {
                page.back_to(before);
                Err(error)
            }
            Ok(()) => Ok(()),
        };
        if let Err(error) = stopped {
            let [done, missing] = [&parts[..finished], &parts[finished..]]
                .map(|parts| parts.iter().map(|part| part.name).collect::<Vec<_>>());
            return Err(keep(page, &done, &missing, error, |page| end(page, shared)));
        }
        let before = page.mark();
        end(&mut page, shared);
        path = page.save()?;
        page.back_to(before);
    }
    Ok(path)
}

/// The error of a study that ends before its first part does.
pub fn nothing_finished(error: Error) -> Error {
    match error {
        Error::Interrupted { .. } => Error::interrupted("nothing was finished"),
        other => other,
    }
}

/// Writes a page that ended early; gives the error that says so.
pub fn keep(
    mut page: Page,
    done: &[&str],
    missing: &[&str],
    error: Error,
    end: impl FnOnce(&mut Page),
) -> Error {
    if done.is_empty() {
        return nothing_finished(error);
    }
    end(&mut page);
    page.heading("Missing");
    page.paragraph(format!(
        "The study ended early ({}). These parts are missing: {}.",
        first_line(&error),
        missing.join(", ")
    ));
    page.value("missing", missing.to_vec());
    match (page.save(), error) {
        (Ok(path), Error::Interrupted { .. }) => Error::interrupted(format!(
            "finished: {}; missing: {}; the page is {}",
            done.join(", "),
            missing.join(", "),
            path.display()
        )),
        (Ok(_), error) => error,
        (Err(error), _) => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARTS: [Part<()>; 3] = [
        Part {
            name: "table_1",
            run: |_, _, ()| Ok(()),
        },
        Part {
            name: "table_2",
            run: |_, _, ()| Ok(()),
        },
        Part {
            name: "figure_5",
            run: |_, _, ()| Ok(()),
        },
    ];

    #[test]
    fn parts_are_chosen_by_name_in_the_studys_order() {
        let names = |cases: &[&str]| -> Result<Vec<&str>> {
            let cases: Vec<_> = cases.iter().map(|&case| case.to_owned()).collect();
            Ok(chosen("harada", &PARTS, &cases)?
                .iter()
                .map(|part| part.name)
                .collect())
        };
        assert_eq!(names(&[]).unwrap().len(), 3);
        assert_eq!(names(&["figure_5", "table_1"]).unwrap(), ["table_1", "figure_5"]);
        let told = names(&["tabel_1"]).unwrap_err().to_string();
        assert!(told.contains("`table_1`?") && told.contains("figure_5"), "{told}");
    }

    #[test]
    fn a_page_that_ended_early_keeps_what_was_finished() {
        let folder = tempfile::tempdir().unwrap();
        let page = || Page::create(folder.path(), "trial", "A trial", true).unwrap();
        let nothing = keep(page(), &[], &["a"], Error::interrupted(""), |_| {});
        assert!(nothing.to_string().contains("nothing was finished"));
        assert!(!folder.path().join("trial.md").exists());

        let mut begun = page();
        begun.paragraph("one");
        let mark = begun.mark();
        begun.paragraph("half");
        begun.value("half", 1);
        begun.back_to(mark);
        let told = keep(begun, &["a"], &["b", "c"], Error::interrupted(""), |page| {
            page.paragraph("the end")
        });
        assert_eq!(told.exit_code(), 130);
        assert!(told.to_string().contains("missing: b, c"), "{told}");
        let text = std::fs::read_to_string(folder.path().join("trial.md")).unwrap();
        assert!(
            text.contains("one") && !text.contains("half") && text.contains("the end"),
            "{text}"
        );
        let json = std::fs::read_to_string(folder.path().join("trial.json")).unwrap();
        assert!(json.contains("missing") && !json.contains("half"), "{json}");
    }
}
