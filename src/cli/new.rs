//! `sliceflow new`

use std::path::{Path, PathBuf};

use super::stdout;
use crate::error::{Error, Result};
use crate::output::write_file;
use crate::scene::{Dimensions, library, start};

/// Writes a scene file to begin with
///
/// The file is small and has comments: from `//` to the end of the line. It is a fluid in 2D unless the options below
/// say otherwise. A name without an ending becomes NAME.json; a file that is there already stays.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Name of the scene, or path of the file to write
    name: PathBuf,
    /// What the particles are
    #[arg(long, value_enum, default_value = "fluid", conflicts_with = "from")]
    kind: Kind,
    /// 2 or 3
    #[arg(
        long,
        value_name = "N",
        default_value_t = 2,
        value_parser = clap::value_parser!(u8).range(2..=3),
        conflicts_with = "from",
    )]
    dimensions: u8,
    /// Begins with a scene that ships instead (see `sliceflow scenes`); meshes that it reads are written beside it
    #[arg(long, value_name = "SCENE")]
    from: Option<String>,
    /// Replaces the file where it is there
    #[arg(long)]
    force: bool,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Kind {
    Fluid,
    Grains,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow new my_dam                          then: sliceflow run my_dam.json
  sliceflow new my_heap --kind grains --dimensions 3
  sliceflow new scenes/my_bunny.json --from bunny_pour";

pub fn main(args: &Args) -> Result<()> {
    let mut path = args.name.clone();
    if path.extension().is_none() {
        path.set_extension("json");
    }
    let files = match &args.from {
        Some(name) => shipped(name, &path)?,
        None => {
            let kind = match args.kind {
                Kind::Fluid => start::Kind::Fluid,
                Kind::Grains => start::Kind::Grains,
            };
            let dimensions = match args.dimensions {
                2 => Dimensions::Two,
                _ => Dimensions::Three,
            };
            vec![(path.clone(), start::text(kind, dimensions).as_bytes().to_vec())]
        }
    };
    let differs = |(path, bytes): &&(PathBuf, Vec<u8>)| {
        path.exists() && (path == &files[0].0 || std::fs::read(path).ok().as_ref() != Some(bytes))
    };
    if let Some((there, _)) = files.iter().find(differs).filter(|_| !args.force) {
        return Err(Error::usage(
            format!("{} is there already", there.display()),
            "replace it with --force, or give another name",
        ));
    }
    for (path, bytes) in &files {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|reason| {
                Error::file(folder, "create", reason, "choose a folder that you may write")
            })?;
        }
        write_file(path, bytes)?;
    }
    for (path, _) in &files {
        stdout::print(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

/// A scene that ships and the meshes that it reads, which stand beside it.
fn shipped(name: &str, path: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let text = library::find(name).ok_or_else(|| library::unknown(name))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    // The new scene is called after its own file.
    let mut text = text.replacen(&format!("  \"name\": \"{name}\",\n"), "", 1);
    let mut files = Vec::new();
    for mesh in library::meshes_of(&text) {
        text = text.replace(&mesh.written, mesh.name);
        files.push((folder.join(mesh.name), mesh.bytes.to_vec()));
    }
    files.insert(0, (path.to_owned(), text.into_bytes()));
    Ok(files)
}
