//! A study's page: one Markdown file with its pictures beside it, and one JSON file with the same figures.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use crate::error::{Error, Result};
use crate::output::text::{bytes, count};
use crate::output::write_file;

/// A page under way; on disk when it is saved. Pictures are on disk when they are added.
pub struct Page {
    folder: PathBuf,
    name: &'static str,
    text: String,
    data: Map<String, Value>,
    /// Pictures that are on disk.
    pictures: BTreeSet<String>,
}

/// A place on a page to come back to.
#[derive(Debug, Clone, Copy)]
pub struct Mark {
    text: usize,
    values: usize,
}

/// One cell of a table: what the page shows and what the JSON says.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    Text(String),
    Number {
        value: f64,
        shown: String,
    },
    /// Not there: a dash, `null`.
    Nothing,
}

impl Cell {
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub fn count(value: u64) -> Self {
        Self::Number {
            value: value as f64,
            shown: count(value),
        }
    }

    pub fn bytes(value: u64) -> Self {
        Self::Number {
            value: value as f64,
            shown: bytes(value),
        }
    }

    /// With three significant digits.
    pub fn number(value: f64) -> Self {
        let shown = shown(value);
        match value.is_finite() {
            true => Self::Number { value, shown },
            false => Self::Nothing,
        }
    }

    /// With `number`'s digits; nothing where there is no value.
    pub fn maybe(value: Option<f64>) -> Self {
        value.map_or(Self::Nothing, Self::number)
    }

    fn markdown(&self) -> String {
        match self {
            Self::Text(text) => text.replace('|', "\\|").replace('\n', " "),
            Self::Number { shown, .. } => shown.clone(),
            Self::Nothing => "–".into(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Text(text) => text.as_str().into(),
            Self::Number { value, .. } => (*value).into(),
            Self::Nothing => Value::Null,
        }
    }
}

/// Three significant digits, large numbers whole.
pub fn shown(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { "–".into() };
    }
    let decimals = (2 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// Rows of cells under heads.
#[derive(Debug, Clone, Default)]
pub struct Table {
    heads: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    pub fn new<S: Into<String>>(heads: impl IntoIterator<Item = S>) -> Self {
        Self {
            heads: heads.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
        }
    }

    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        let cells: Vec<_> = cells.into_iter().collect();
        assert_eq!(
            cells.len(),
            self.heads.len(),
            "a cell for each of {:?}",
            self.heads
        );
        self.rows.push(cells);
    }

    fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        // Columns that hold a number anywhere stand on the right.
        let rules: Vec<String> = (0..self.heads.len())
            .map(|column| {
                let numbers = self
                    .rows
                    .iter()
                    .any(|row| matches!(row[column], Cell::Number { .. }));
                if numbers { "--:" } else { "---" }.to_owned()
            })
            .collect();
        let mut text = line(&self.heads) + &line(&rules);
        for row in &self.rows {
            text += &line(&row.iter().map(Cell::markdown).collect::<Vec<_>>());
        }
        text
    }

    /// A list of objects, one per row.
    fn json(&self) -> Value {
        let object = |row: &Vec<Cell>| -> Value {
            let cells = row.iter().map(Cell::json);
            Value::Object(self.heads.iter().cloned().zip(cells).collect())
        };
        self.rows.iter().map(object).collect()
    }
}

impl Page {
    /// Creates the folder; refuses one that holds this study already, unless it may be replaced.
    pub fn create(folder: &Path, name: &'static str, title: &str, replace: bool) -> Result<Self> {
        std::fs::create_dir_all(folder).map_err(|reason| {
            Error::file(
                folder,
                "create",
                reason,
                "choose a folder that you may write, with --out",
            )
        })?;
        let page = Self {
            folder: folder.to_owned(),
            name,
            text: format!("# {title}\n"),
            data: Map::new(),
            pictures: BTreeSet::new(),
        };
        if !replace && page.path("md").exists() {
            return Err(Error::usage(
                format!("{} exists already", page.path("md").display()),
                "replace the study with --force, or choose another folder with --out",
            ));
        }
        Ok(page)
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}.{ending}", self.name))
    }

    pub fn heading(&mut self, text: &str) {
        let _ = write!(self.text, "\n## {text}\n");
    }

    pub fn paragraph(&mut self, text: impl AsRef<str>) {
        let _ = write!(self.text, "\n{}\n", text.as_ref());
    }

    /// A table, and its rows under `key` in the JSON.
    pub fn table(&mut self, key: &str, table: &Table) {
        let _ = write!(self.text, "\n{}", table.markdown());
        self.value(key, table.json());
    }

    /// Figures that no table shows.
    pub fn value(&mut self, key: &str, value: impl Into<Value>) {
        let before = self.data.insert(key.to_owned(), value.into());
        assert!(before.is_none(), "`{key}` is in the JSON twice");
    }

    /// A picture, which `save` writes unless it is there since an earlier call.
    pub fn picture(
        &mut self,
        file: &str,
        caption: &str,
        save: impl FnOnce(&Path) -> Result<()>,
    ) -> Result<()> {
        if self.pictures.insert(file.to_owned()) {
            save(&self.folder.join(file))?;
        }
        let _ = write!(self.text, "\n![{caption}]({file})\n\n*{caption}*\n");
        Ok(())
    }

    /// Where the page ends now.
    pub fn mark(&self) -> Mark {
        Mark {
            text: self.text.len(),
            values: self.data.len(),
        }
    }

    /// Takes back what was added since; pictures stay on disk.
    pub fn back_to(&mut self, mark: Mark) {
        self.text.truncate(mark.text);
        self.data = std::mem::take(&mut self.data)
            .into_iter()
            .take(mark.values)
            .collect();
    }

    /// Writes page and JSON; gives the page's path.
    pub fn save(&self) -> Result<PathBuf> {
        let path = self.path("md");
        let mut json = serde_json::to_vec_pretty(&self.data).expect("keys are text");
        json.push(b'\n');
        write_file(&self.path("json"), &json)?;
        write_file(&path, self.text.as_bytes())?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_and_its_json_say_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let mut page = Page::create(folder.path(), "trial", "A trial", false).unwrap();
        let mut table = Table::new(["grid", "ms", "bytes", "note"]);
        table.row([
            Cell::text("sliced|pool"),
            Cell::number(12.3456),
            Cell::bytes(1 << 20),
            Cell::Nothing,
        ]);
        page.heading("Times");
        page.table("times", &table);
        page.picture("a.png", "A picture", |path| write_file(path, b"png"))
            .unwrap();
        let path = page.save().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("| sliced\\|pool | 12.3 | 1 MiB | – |"), "{text}");
        assert!(text.contains("| --- | --: | --: | --- |"), "{text}");
        assert!(text.contains("![A picture](a.png)"), "{text}");
        let json = std::fs::read_to_string(folder.path().join("trial.json")).unwrap();
        let json: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["times"][0]["ms"], 12.3456);
        assert_eq!(json["times"][0]["bytes"], 1_048_576.0);
        assert_eq!(json["times"][0]["note"], Value::Null);
    }

    #[test]
    fn a_study_is_not_replaced_unasked() {
        let folder = tempfile::tempdir().unwrap();
        let create = |replace| Page::create(folder.path(), "trial", "A trial", replace);
        create(false).unwrap().save().unwrap();
        let refused = create(false).map(|_| ()).unwrap_err();
        assert_eq!(refused.exit_code(), 2);
        assert!(refused.to_string().contains("--force"), "{refused}");
        create(true).unwrap();
    }

    #[test]
    fn numbers_have_three_digits() {
        let texts = [0.0, 0.039_44, 0.0619, 1.0, 12.345, 123.4, 98_765.0].map(shown);
        assert_eq!(texts, ["0", "0.0394", "0.0619", "1.00", "12.3", "123", "98765"]);
    }
}
