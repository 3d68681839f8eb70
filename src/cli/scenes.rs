//! `sliceflow scenes`

use serde_json::{Value, json};

use super::stdout;
use super::table::Align::Left;
use super::table::Table;
use crate::error::Result;
use crate::output::text::count;
use crate::scene::color_maps::COLOR_MAPS;
use crate::scene::column::{COLUMNS, Column, VECTORS};
use crate::scene::library;

/// Lists the scenes that ship, or prints one of them; lists columns or color maps
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Prints this scene's file (JSON)
    #[arg(value_name = "NAME", conflicts_with_all = ["columns", "color_maps"])]
    name: Option<String>,
    /// Lists columns: values of particles that can be drawn (render.color.by) or written (--columns)
    #[arg(long, conflicts_with = "color_maps")]
    columns: bool,
    /// Lists color maps (render.color.map)
    #[arg(long)]
    color_maps: bool,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow scenes
  sliceflow scenes dam_break_2d > my_dam.json
  sliceflow scenes --columns
  sliceflow scenes --color-maps --json";

pub fn main(args: &Args) -> Result<()> {
    if let Some(name) = &args.name {
        print_scene(name)
    } else if args.columns {
        columns(args.json)
    } else if args.color_maps {
        color_maps(args.json)
    } else {
        scenes(args.json)
    }
}

/// The text as it ships, to the letter.
fn print_scene(name: &str) -> Result<()> {
    let text = library::find(name).ok_or_else(|| library::unknown(name))?;
    for mesh in library::meshes_of(text) {
        eprintln!(
            "note: the scene reads {}; `sliceflow new NAME --from {name}` writes both",
            mesh.written
        );
    }
    stdout::print(text)
}

fn scenes(as_json: bool) -> Result<()> {
    let entries = library::entries()?;
    if as_json {
        let entry = |entry: &library::Entry| {
            json!({
                "name": entry.name,
                "particles": entry.particles,
                "description": entry.description,
                "source": entry.source,
            })
        };
        return stdout::print_json(&entries.iter().map(entry).collect::<Value>());
    }
    let texts = entries.iter().map(|entry| {
        format!(
            "{} ({} particles)\n    {}\n    Source: {}\n",
            entry.name,
            count(entry.particles.into()),
            entry.description,
            entry.source
        )
    });
    stdout::print(&texts.collect::<Vec<_>>().join("\n"))
}

fn columns(as_json: bool) -> Result<()> {
    let columns = VECTORS.iter().chain(COLUMNS.iter());
    if as_json {
        let one = |column: &Column| {
            json!({
                "name": column.name,
                "unit": column.unit,
                "about": column.about,
                "can_be_drawn": !VECTORS.contains(column),
            })
        };
        return stdout::print_json(&columns.map(one).collect::<Value>());
    }
    let mut table = Table::new([("column", Left), ("unit", Left), ("use", Left), ("what", Left)]);
    for column in columns {
        let used = if VECTORS.contains(column) {
            "files"
        } else {
            "files, color"
        };
        table.row([column.name, column.unit, used, column.about].map(str::to_owned));
    }
    stdout::print(&table.to_string())
}

fn color_maps(as_json: bool) -> Result<()> {
    if as_json {
        let maps = COLOR_MAPS
            .iter()
            .map(|map| json!({ "name": map.name, "about": map.about }));
        return stdout::print_json(&maps.collect::<Value>());
    }
    let mut table = Table::new([("color map", Left), ("what", Left)]);
    for map in COLOR_MAPS {
        table.row([map.name, map.about].map(str::to_owned));
    }
    stdout::print(&table.to_string())
}
