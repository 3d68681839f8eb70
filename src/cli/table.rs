//! Plain text tables.

/// How a column's cells stand.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Left,
    Right,
}

/// Rows of cells, the first one being the heads; two spaces between columns.
pub struct Table {
    align: Vec<Align>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new<const N: usize>(heads: [(&str, Align); N]) -> Self {
        Self::with_heads(heads.map(|(head, align)| (head.to_owned(), align)))
    }

    pub fn with_heads(heads: impl IntoIterator<Item = (String, Align)>) -> Self {
        let (heads, align) = heads.into_iter().unzip();
        Self {
            align,
            rows: vec![heads],
        }
    }

    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<_> = cells.into_iter().collect();
        debug_assert_eq!(cells.len(), self.align.len());
        self.rows.push(cells);
    }

    /// The same as Markdown.
    pub fn to_markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let align = self.align.iter().map(|align| match align {
            Align::Left => "---",
            Align::Right => "---:",
        });
        let (heads, rows) = self.rows.split_first().expect("a table has heads");
        let rows: String = rows.iter().map(|row| line(row)).collect();
        format!("{}|{}|\n{rows}", line(heads), align.collect::<Vec<_>>().join("|"))
    }

    /// Whether there is nothing below the heads.
    pub fn is_empty(&self) -> bool {
        self.rows.len() == 1
    }
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let width = |column: usize| {
            self.rows
                .iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<_> = (0..self.align.len()).map(width).collect();
        for row in &self.rows {
            let cells = row
                .iter()
                .zip(&widths)
                .zip(&self.align)
                .map(|((cell, &width), align)| match align {
                    Align::Left => format!("{cell:<width$}"),
                    Align::Right => format!("{cell:>width$}"),
                });
            writeln!(f, "{}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new([
            ("name", Align::Left),
            ("bytes", Align::Right),
            ("why", Align::Left),
        ]);
        table.row(["a", "7", "first"].map(str::to_owned));
        table.row(["longer", "123456", "second one"].map(str::to_owned));
        assert_eq!(
            table.to_string(),
            "name     bytes  why\n\
             a            7  first\n\
             longer  123456  second one\n"
        );
        assert_eq!(
            table.to_markdown(),
            "| name | bytes | why |\n|---|---:|---|\n| a | 7 | first |\n| longer | 123456 | second one |\n"
        );
    }
}
