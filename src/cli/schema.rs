//! `sliceflow schema`

use super::stdout;
use crate::error::{Error, Result};
use crate::output;
use crate::scene::keys::{self, Key};
use crate::scene::{load, synonyms};

/// Prints the JSON schema of scene files, or explains one of their keys
///
/// With KEY it says what the key means, its unit, which values it takes, and what holds where it is left out. With --of it
/// does the same for what a run writes about itself.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A key with its path (fluid.viscosity, bodies[0].shape), or the last part of one (viscosity)
    key: Option<String>,
    /// Whose keys
    #[arg(long, value_enum, value_name = "FILE", default_value = "scene")]
    of: Of,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Of {
    /// Scene files
    Scene,
    /// A line of stats.jsonl
    Stats,
    /// run.json
    Run,
    /// post_mortem/report.json
    PostMortem,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow schema fluid.viscosity
  sliceflow schema bodies.shape
  sliceflow schema render.camera
  sliceflow schema --of stats density_error_mean
  sliceflow schema > scene.schema.json     then, in a scene: \"$schema\": \"scene.schema.json\"";

/// Columns of text in a terminal.
const WIDTH: usize = 100;

pub fn main(args: &Args) -> Result<()> {
    let schema = match args.of {
        Of::Scene => load::schema(),
        Of::Stats => output::statistics_schema(),
        Of::Run => output::manifest_schema(),
        Of::PostMortem => output::post_mortem_schema(),
    };
    let Some(typed) = &args.key else {
        return stdout::print_json(&schema);
    };
    let keys = keys::all(&schema);
    let found = find(typed, &keys);
    if found.is_empty() {
        return Err(unknown(typed, args.of, &keys));
    }
    let texts: Vec<_> = found.into_iter().map(|key| explain(key, args.of)).collect();
    stdout::print(&texts.join("\n"))
}

/// The keys with this path; where there is none, those whose path ends so.
fn find<'a>(typed: &str, keys: &'a [Key]) -> Vec<&'a Key> {
    let wanted = without_brackets(typed);
    let whole = keys.iter().filter(|key| key.plain_path() == wanted);
    let whole: Vec<_> = whole.collect();
    if !whole.is_empty() {
        return whole;
    }
    let ending = format!(".{wanted}");
    keys.iter()
        .filter(|key| key.plain_path().ends_with(&ending))
        .collect()
}

/// `bodies[0].shape` is `bodies.shape`, and so is `bodies[].shape`.
fn without_brackets(path: &str) -> String {
    let mut plain = String::new();
    let mut is_inside = false;
    for c in path.trim().chars() {
        match c {
            '[' => is_inside = true,
            ']' => is_inside = false,
            c if !is_inside => plain.push(c),
            _ => {}
        }
    }
    plain
}

fn explain(key: &Key, of: Of) -> String {
    let presence = match of {
        Of::Scene => &key.presence,
        _ if key.is_required => "always there",
        _ => "not always there",
    };
    let kinds = match &key.of_kinds[..] {
        [] => String::new(),
        kinds => format!(" (of kind {})", kinds.join(", ")),
    };
    let mut text = format!("{}{kinds}: {}; {presence}\n", key.path, key.value);
    for about in &key.about {
        text.push_str(&paragraph("  ", about));
    }
    let names = key.choices.iter().map(|(name, _)| name.chars().count());
    let width = names.max().unwrap_or(0);
    for (name, about) in &key.choices {
        text.push_str(&paragraph(&format!("    {name:<width$}  "), about));
    }
    text
}

/// Lines of a paragraph behind `head`, all indented alike.
fn paragraph(head: &str, text: &str) -> String {
    let indent = head.chars().count();
    let mut lines = vec![head.to_owned()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        let is_first = line.chars().count() == indent;
        if !is_first && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            if !is_first {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
        .iter()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

/// What was asked for may be another program's name of a key, one of the words that a key takes, or a typing mistake.
fn unknown(typed: &str, of: Of, keys: &[Key]) -> Error {
    let wanted = without_brackets(typed);
    let last = wanted.rsplit('.').next().unwrap_or(&wanted);
    let mut near: Vec<String> = match of {
        Of::Scene => synonyms::keys_for(last)
            .iter()
            .map(|&key| key.to_owned())
            .collect(),
        _ => Vec::new(),
    };
    let whose = match of {
        Of::Scene => "scenes",
        Of::Stats => "stats.jsonl",
        Of::Run => "run.json",
        Of::PostMortem => "post_mortem/report.json",
    };
    let what = format!("no key of {whose} is called `{typed}`");
    if near.is_empty()
        && let Some((word, takers)) = word(last, keys)
    {
        return Error::usage(what, format!("`{word}` is a value of {}", quoted(&takers)));
    }
    if near.is_empty()
        && let Some(name) = synonyms::nearest(last, keys.iter().map(Key::name))
    {
        near.extend(keys.iter().filter(|key| key.name() == name).map(Key::plain_path));
    }
    near.dedup();
    near.truncate(5);
    let help = match &near[..] {
        [] => {
            let top = keys.iter().filter(|key| !key.path.contains('.'));
            let top: Vec<_> = top.map(|key| key.name()).collect();
            format!("the outermost keys are {}", top.join(", "))
        }
        near => format!("did you mean {}?", quoted(near)),
    };
    Error::usage(what, help)
}

/// The word of scenes that `typed` is or means, and the keys that take it.
fn word<'a>(typed: &'a str, keys: &[Key]) -> Option<(&'a str, Vec<String>)> {
    let words = [typed]
        .into_iter()
        .chain(synonyms::words_for(typed).iter().copied());
    let takers = |word: &str| -> Vec<String> {
        // `bodies.shape` has the words of its `kind`.
        let takes = |key: &&Key| key.name() != "kind" && key.choices.iter().any(|(known, _)| known == word);
        keys.iter().filter(takes).map(Key::plain_path).collect()
    };
    let all = words.map(|word| (word, takers(word)));
    all.into_iter().find(|(_, takers)| !takers.is_empty())
}

/// `` `a`, `b` or `c` ``
fn quoted(words: &[String]) -> String {
    let quoted: Vec<_> = words.iter().map(|word| format!("`{word}`")).collect();
    match &quoted[..] {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        all => all.join(""),
    }
}
