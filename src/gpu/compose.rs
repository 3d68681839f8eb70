//! Puts shader modules together from files, with a true place for every line.
//!
//! Directives, each alone on its line:
//! - `#import common/vector` takes in `shaders/common/vector.wgsl` once; `#import <addressing>` takes the file that
//!   the plan chose for that role, so that physics never names a grid;
//! - `#if flag`, `#if !flag`, `#else`, `#end` keep lines only where the plan set the flag; a plan decides about each flag
//!   that its shaders depend on, and about none that no shader knows;
//! - `#flag name` sets a flag for this composition, for what the file imports below;
//! - `#each list`, `#end` repeat the lines between them for each file of a list that the plan made. There `#import <list>`
//!   takes that file, and `{list}` and `{List}` stand for its name, `surface_tension` and `SurfaceTension`.
//!   `#each list {list}_pair` leaves out files without a function of that name, `#each list {List}` those without a
//!   struct of that name;
//! - constants that the plan set stand in front as `const NAME = value;`; a plan may also write whole modules, such as
//!   those of the particles' fields, which are imported as files are.
//!
//! The libraries that do this (naga_oil, wesl) rename what they import; here a buffer has one name everywhere, and
//! the reflection in [`super::reflect`] depends on that.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;

use include_dir::{Dir, include_dir};

use super::parts::dispatch_module;
use crate::error::{Error, Result};

static SHADERS: Dir = include_dir!("$CARGO_MANIFEST_DIR/shaders");

/// Threads of a workgroup in passes over particles and voxels.
pub const GROUP_SIZE: u32 = 64;
/// Threads of a workgroup that computes prefix sums, and items of each.
pub const SCAN_THREADS: u32 = 256;
pub const SCAN_ITEMS: u32 = 8;

/// What a plan chose: which lines and files a shader is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    pub flags: BTreeSet<String>,
    /// Flags that the plan decided not to set.
    unset: BTreeSet<String>,
    /// WGSL constants of type u32.
    pub constants: BTreeMap<&'static str, u32>,
    /// Role → file without its ending: `addressing` → `cells/sliced`.
    pub roles: BTreeMap<&'static str, String>,
    /// Modules that the host writes, path → text: `fields/place`.
    pub modules: BTreeMap<String, String>,
    /// List → files without their ending, in order: `force` → `physics/fluid/forces/pressure_symmetric`, ….
    pub lists: BTreeMap<&'static str, Vec<String>>,
}

impl Default for Variant {
    fn default() -> Self {
        let sizes = [
            ("GROUP_SIZE", GROUP_SIZE),
            ("SCAN_THREADS", SCAN_THREADS),
            ("SCAN_ITEMS", SCAN_ITEMS),
        ];
        Self {
            flags: BTreeSet::new(),
            unset: BTreeSet::new(),
            constants: sizes.into(),
            roles: BTreeMap::new(),
            modules: [("host/dispatch".to_owned(), dispatch_module())].into(),
            lists: BTreeMap::new(),
        }
    }
}

impl Variant {
    /// Decides about a flag; what is once set stays so.
    pub fn flag(&mut self, name: &str, on: bool) -> &mut Self {
        let decided = if on { &mut self.flags } else { &mut self.unset };
        decided.insert(name.to_owned());
        self
    }

    /// Decides that these flags are not set.
    pub fn without(&mut self, names: &[&str]) -> &mut Self {
        self.unset.extend(names.iter().map(|&name| name.to_owned()));
        self
    }

    /// Whether a flag is set; `None` where nobody decided.
    fn decided(&self, name: &str) -> Option<bool> {
        let is_set = self.flags.contains(name);
        (is_set || self.unset.contains(name) || own_flags().contains(name)).then_some(is_set)
    }

    pub fn constant(&mut self, name: &'static str, value: u32) -> &mut Self {
        self.constants.insert(name, value);
        self
    }

    pub fn role(&mut self, name: &'static str, file: impl Into<String>) -> &mut Self {
        self.roles.insert(name, file.into());
        self
    }

    pub fn list(&mut self, name: &'static str, files: Vec<String>) -> &mut Self {
        self.lists.insert(name, files);
        self
    }
}

/// One module's text, and for each of its lines the file and line that the author wrote.
#[derive(Debug, Clone)]
pub struct Composed {
    pub path: String,
    pub text: String,
    /// Flags that it depends on, and whether they were set.
    pub flags: BTreeSet<(String, bool)>,
    places: Vec<(String, usize)>,
}

impl Composed {
    /// `file:line` of a line of `text`, counted from one.
    pub fn place(&self, line: usize) -> String {
        match self.places.get(line.saturating_sub(1)) {
            Some((file, line)) => format!("shaders/{file}:{line}"),
            None => format!("shaders/{}", self.path),
        }
    }
}

/// Every shader file, by path below `shaders/`, without its ending.
pub fn files() -> Vec<String> {
    fn walk(dir: &Dir, into: &mut Vec<String>) {
        for file in dir.files() {
            if let Some(path) = file.path().to_str().and_then(|p| p.strip_suffix(".wgsl")) {
                into.push(path.to_owned());
            }
        }
        for dir in dir.dirs() {
            walk(dir, into);
        }
    }
    let mut found = Vec::new();
    walk(&SHADERS, &mut found);
    found.sort();
    found
}

/// The text of a shader file, from the folder that `SLICEFLOW_SHADERS` names while one works on shaders.
fn source(file: &str) -> Option<Cow<'static, str>> {
    match std::env::var_os("SLICEFLOW_SHADERS") {
        Some(folder) => std::fs::read_to_string(Path::new(&folder).join(file))
            .ok()
            .map(Cow::from),
        None => SHADERS.get_file(file)?.contents_utf8().map(Cow::from),
    }
}

/// Second words of all lines of shaders that begin with a directive.
fn words_of(directive: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for path in files() {
        let text = source(&format!("{path}.wgsl")).unwrap_or_default();
        let lines = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix(directive));
        found.extend(lines.map(|word| word.trim().trim_start_matches('!').to_owned()));
    }
    found
}

/// Flags that files set for what they import.
fn own_flags() -> &'static BTreeSet<String> {
    static FLAGS: LazyLock<BTreeSet<String>> = LazyLock::new(|| words_of("#flag "));
    &FLAGS
}

/// Flags that some shader depends on.
pub fn known_flags() -> &'static BTreeSet<String> {
    static FLAGS: LazyLock<BTreeSet<String>> = LazyLock::new(|| words_of("#if "));
    &FLAGS
}

/// Composes `shaders/{path}.wgsl`.
pub fn compose(path: &str, variant: &Variant) -> Result<Composed> {
    let mut composed = Composed {
        path: format!("{path}.wgsl"),
        text: String::new(),
        flags: BTreeSet::new(),
        places: Vec::new(),
    };
    for (name, value) in &variant.constants {
        composed.push(&format!("const {name}: u32 = {value}u;"), "(plan)", 0);
    }
    if let Some(unknown) = variant
        .flags
        .union(&variant.unset)
        .find(|flag| !known_flags().contains(*flag))
    {
        return Err(Error::Shader {
            message: format!("no shader knows the flag `{unknown}` of the plan"),
        });
    }
    let mut seen = BTreeSet::new();
    composed.import(path, &mut variant.clone(), &mut seen, "(plan)")?;
    Ok(composed)
}

impl Composed {
    fn push(&mut self, line: &str, file: &str, number: usize) {
        self.text.push_str(line);
        self.text.push('\n');
        self.places.push((file.to_owned(), number));
    }

    fn import(
        &mut self,
        path: &str,
        variant: &mut Variant,
        seen: &mut BTreeSet<String>,
        from: &str,
    ) -> Result<()> {
        if !seen.insert(path.to_owned()) {
            return Ok(());
        }
        let source = source_of(path, variant, from)?;
        let lines: Vec<_> = source.lines().map(Cow::from).enumerate().collect();
        self.lines(&format!("{path}.wgsl"), &lines, variant, seen)
    }

    /// Lines of a file, each with its number from zero on.
    fn lines(
        &mut self,
        file: &str,
        lines: &[(usize, Cow<str>)],
        variant: &mut Variant,
        seen: &mut BTreeSet<String>,
    ) -> Result<()> {
        // One entry for each open `#if`: whether its lines are kept.
        let mut open: Vec<bool> = Vec::new();
        let mut next = 0;
        while let Some((index, line)) = lines.get(next) {
            next += 1;
            let number = index + 1;
            let place = format!("shaders/{file}:{number}");
            let words: Vec<&str> = line.split_whitespace().take(4).collect();
            let keep = open.iter().all(|&kept| kept);
            let most = match words.first() {
                Some(&"#each") => 3,
                Some(&("#if" | "#flag" | "#import")) => 2,
                Some(&("#else" | "#end")) => 1,
                _ => usize::MAX,
            };
            if let Some(more) = words.get(most) {
                return Err(fail(format!(
                    "{place}: `{more}` is too much: `{}` takes {} words",
                    words[0],
                    most - 1
                )));
            }
            match words[..] {
                ["#if", flag] => {
                    let (flag, wanted) = match flag.strip_prefix('!') {
                        Some(flag) => (flag, false),
                        None => (flag, true),
                    };
                    if keep {
                        let is_set = variant.decided(flag).ok_or_else(|| {
                            fail(format!(
                                "{place}: the plan does not decide about the flag `{flag}`"
                            ))
                        })?;
                        self.flags.insert((flag.to_owned(), is_set));
                        open.push(is_set == wanted);
                    } else {
                        open.push(false);
                    }
                }
                ["#flag", flag] if keep => {
                    variant.flag(flag, true);
                }
                ["#else"] => match open.last_mut() {
                    Some(kept) => *kept = !*kept,
                    None => return Err(fail(format!("{place}: #else without #if"))),
                },
                ["#end"] => {
                    open.pop()
                        .ok_or_else(|| fail(format!("{place}: #end without #if or #each")))?;
                }
                ["#import", what] => {
                    if !keep {
                        continue;
                    }
                    let role = what.strip_prefix('<').and_then(|w| w.strip_suffix('>'));
                    let target = match role {
                        Some(role) => variant.roles.get(role).cloned().ok_or_else(|| {
                            fail(format!("{place}: the plan gives no file for the role <{role}>"))
                        })?,
                        None => what.to_owned(),
                    };
                    self.import(&target, variant, seen, &place)?;
                }
                ["#each", list, ..] => {
                    let end = end_of_block(&lines[next..])
                        .ok_or_else(|| fail(format!("{place}: an #each has no #end")))?;
                    let block = &lines[next..next + end];
                    next += end + 1;
                    if keep {
                        self.each(file, &place, (list, words.get(2).copied()), block, variant, seen)?;
                    }
                }
                [word, ..] if word.starts_with('#') => {
                    return Err(fail(format!("{place}: `{line}` is no directive")));
                }
                _ if keep => self.push(line, file, number),
                _ => {}
            }
        }
        if open.is_empty() {
            Ok(())
        } else {
            Err(fail(format!("shaders/{file}: an #if has no #end")))
        }
    }

    /// A block of lines for each file of a list that has what is asked for.
    fn each(
        &mut self,
        file: &str,
        place: &str,
        (list, asked): (&str, Option<&str>),
        block: &[(usize, Cow<str>)],
        variant: &mut Variant,
        seen: &mut BTreeSet<String>,
    ) -> Result<()> {
        let Some((&list, items)) = variant.lists.get_key_value(list) else {
            return Err(fail(format!("{place}: the plan gives no list `{list}`")));
        };
        for item in items.clone() {
            let name = item.rsplit('/').next().unwrap_or_default();
            let named = |text: &str| {
                text.replace(&format!("{{{list}}}"), name)
                    .replace(&format!("{{{}}}", camel_case(list)), &camel_case(name))
            };
            if let Some(asked) = asked.map(named) {
                let source = source_of(&item, variant, place)?;
                if ![format!("fn {asked}("), format!("struct {asked} ")]
                    .iter()
                    .any(|declaration| source.contains(declaration))
                {
                    continue;
                }
            }
            let lines: Vec<_> = block
                .iter()
                .map(|(index, line)| (*index, Cow::from(named(line))))
                .collect();
            variant.role(list, item);
            self.lines(file, &lines, variant, seen)?;
        }
        variant.roles.remove(list);
        Ok(())
    }
}

fn fail(message: String) -> Error {
    Error::Shader { message }
}

/// The text of a file or of a module that the plan wrote.
fn source_of(path: &str, variant: &Variant, from: &str) -> Result<Cow<'static, str>> {
    if let Some(text) = variant.modules.get(path) {
        return Ok(Cow::from(text.clone()));
    }
    let file = format!("{path}.wgsl");
    source(&file).ok_or_else(|| fail(format!("{from}: there is no shaders/{file}")))
}

/// Where the `#end` of a block is, whose first line is the first of these.
fn end_of_block(lines: &[(usize, Cow<str>)]) -> Option<usize> {
    let mut depth = 0;
    lines.iter().position(|(_, line)| {
        match line.split_whitespace().next() {
            Some("#if" | "#each") => depth += 1,
            Some("#end") => depth -= 1,
            _ => {}
        }
        depth < 0
    })
}

/// `surface_tension` as `SurfaceTension`.
fn camel_case(name: &str) -> String {
    let words = name.split('_').map(|word| {
        let mut letters = word.chars();
        let first = letters.next().map(|letter| letter.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    });
    words.collect()
}

/// A module of this text alone.
#[cfg(test)]
pub(super) fn of_text(text: &str) -> Composed {
    let mut composed = Composed {
        path: "test.wgsl".into(),
        text: String::new(),
        places: Vec::new(),
        flags: BTreeSet::new(),
    };
    for (index, line) in text.lines().enumerate() {
        composed.push(line, "test.wgsl", index + 1);
    }
    composed
}
