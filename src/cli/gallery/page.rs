//! The page that shows the gallery.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::scenes::Entry;
use crate::error::{Error, Result};
use crate::files;
use crate::output::write_file;

/// How a page of the gallery begins.
const MARK: &str = "<!-- sliceflow gallery -->";

/// A picture that is there, and how it was made.
pub struct Shown<'a> {
    pub entry: &'a Entry,
    /// As a shell takes them.
    pub commands: Vec<String>,
    /// From the page's folder.
    pub picture: String,
    /// `run.json` of the simulation and of the drawing.
    pub run: Value,
    pub drawing: Value,
}

/// Writes the page; refuses to replace a file that is none.
pub fn write(path: &Path, shown: &[Shown]) -> Result<()> {
    if path.exists() {
        let text = files::read(path).unwrap_or_default();
        if !text.starts_with(MARK.as_bytes()) {
            return Err(Error::usage(
                format!("{} is no page of the gallery", path.display()),
                "move it away, or choose another folder with --out",
            ));
        }
    }
    write_file(path, page(shown).as_bytes())
}

fn page(shown: &[Shown]) -> String {
    let mut text = format!(
        "{MARK}\n<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Sliceflow: gallery</title>\n<style>\n\
         body {{ font-family: sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; }}\n\
         img {{ max-width: 100%; max-height: 45rem; }}\n\
         pre {{ background: #f2f2f2; padding: 0.7rem; overflow-x: auto; }}\n\
         table {{ border-spacing: 1rem 0.2rem; margin-left: -1rem; }}\nth {{ text-align: left; }}\n</style>\n\
         <h1>Gallery</h1>\n"
    );
    for one in shown {
        let name = escaped(one.entry.name);
        let _ = write!(
            text,
            "<h2 id=\"{name}\">{name}</h2>\n<p>{}</p>\n<img src=\"{}\" alt=\"{}\">\n<pre>{}</pre>\n<table>\n",
            escaped(one.entry.about),
            escaped(&one.picture),
            escaped(one.entry.about),
            escaped(&one.commands.join("\n")),
        );
        for (title, value) in rows(one) {
            let _ = writeln!(text, "<tr><th>{title}<td>{}", escaped(&value));
        }
        text.push_str("</table>\n");
    }
    text
}

fn rows(shown: &Shown) -> Vec<(&'static str, String)> {
    let (run, drawing) = (&shown.run, &shown.drawing);
    let text = |value: &Value| value.as_str().unwrap_or("?").to_owned();
    let number = |value: &Value| value.as_f64().unwrap_or_default();
    let scene = &run["scene"];
    let solver = match &scene["fluid"] {
        Value::Object(fluid) => format!("fluid, {}", text(&fluid["solver"])),
        _ => format!("grains, {}", text(&scene["grains"]["law"])),
    };
    vec![
        ("Solver", solver),
        ("Particles", format!("{}", number(&run["particles"]))),
        (
            "Shown",
            format!(
                "frame {}, after {:.2} s",
                number(&run["last_frame"]),
                number(&run["last_frame"]) / number(&run["fps"])
            ),
        ),
        ("Simulated in", format!("{:.0} s", number(&run["wall_s"]))),
        ("Drawn in", format!("{:.1} s", number(&drawing["wall_s"]))),
        ("Adapter", text(&run["adapter"]["name"])),
    ]
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_other_pages_stay() {
        assert_eq!(escaped(r#"a<b> & "c""#), "a&lt;b&gt; &amp; &quot;c&quot;");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("index.html");
        write(&path, &[]).unwrap();
        write(&path, &[]).unwrap();
        std::fs::write(&path, "mine").unwrap();
        assert!(
            write(&path, &[])
                .unwrap_err()
                .to_string()
                .contains("no page of the gallery")
        );
        assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    }
}
