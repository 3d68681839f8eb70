//! `sliceflow import`

use std::path::{Path, PathBuf};

use super::quiet_args::QuietArgs;
use super::scene_args::bytes;
use super::stdout;
use crate::error::{Error, Result};
use crate::output::text::count;
use crate::output::write_file;
use crate::scene::allowance::Allowance;
use crate::scene::import::import_within;

/// Makes a scene from a scene file of SPlisHSPlasH
///
/// Reads FluidBlocks, FluidModels, Emitters, RigidBodies (as obstacles that rest, or as the domain's box), Materials,
/// gravity, times, steps and camera. Fluid becomes a fluid of the same spacing, density and viscosity: of `wcsph` where its
/// solver is WCSPH, else of `dfsph`. What changes the physics and has no counterpart is a warning, first of all; every other
/// key that has no effect is listed.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// SPlisHSPlasH scene file (JSON)
    scene: PathBuf,
    /// Scene file to write; standard output when left out
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replaces that file where it is there
    #[arg(long, requires = "out")]
    force: bool,
    /// Changes a key of the new scene: fluid.viscosity=10 (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Refuses scenes with anything that changes the physics and has no counterpart
    #[arg(long)]
    strict: bool,
    /// Refuses scenes that need more memory for particles and meshes
    #[arg(long, value_name = "SIZE", default_value = "1GB", value_parser = bytes)]
    max_memory: u64,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow import DamBreakModel.json --out dam.json
  sliceflow run dam.json
  sliceflow import ViscousBunny.json --out bunny.json --set time.duration=2 --strict
  sliceflow import data/Scenes/DamBreakModel.json > dam.json";

pub fn main(args: &Args) -> Result<()> {
    let folder = args.out.as_deref().map(|out| match out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    });
    if let Some(out) = args.out.as_ref().filter(|out| out.exists() && !args.force) {
        return Err(Error::usage(
            format!("{} is there already", out.display()),
            "replace it with --force, or give --out another name",
        ));
    }
    let allowance = Allowance {
        memory: args.max_memory,
        ..Allowance::default()
    };
    let imported = import_within(&args.scene, folder, &args.set, &allowance)?;
    let (lost, unused): (Vec<_>, Vec<_>) = imported
        .ignored
        .iter()
        .partition(|ignored| ignored.changes_physics);
    if args.strict && !lost.is_empty() {
        let list: String = lost.iter().map(|lost| format!("\n  {lost}")).collect();
        return Err(Error::usage(
            format!(
                "{}: has no counterpart, and the physics change without it:{list}",
                args.scene.display()
            ),
            "take it out of the scene, or import without --strict",
        ));
    }
    for lost in lost {
        args.quiet.tell(&format!("warning: the physics change: {lost}"));
    }
    let own = Allowance {
        folders: Some(Vec::new()),
        ..allowance
    };
    let base = folder.unwrap_or(Path::new("."));
    for file in imported.scene.file.files() {
        let path = base.join(file);
        if !own.reads(&path, base) {
            let outside = path.parent().unwrap_or(base).display();
            args.quiet.tell(&format!(
                "note: the scene reads {file} outside of its own folder: run it with --allow-read {outside}"
            ));
        }
    }
    for note in &imported.notes {
        args.quiet.tell(&format!("note: {note}"));
    }
    for ignored in unused {
        args.quiet.tell(&format!("ignored: {ignored}"));
    }
    let text = format!("{:#}\n", imported.json);
    args.quiet.tell(&format!(
        "imported {} particles{} and {} obstacles{}",
        count(imported.scene.particles.len() as u64),
        match imported.scene.file.emitters.len() {
            0 => String::new(),
            emitters => format!(", {emitters} emitters"),
        },
        imported.scene.colliders.len(),
        args.out
            .as_ref()
            .map_or_else(String::new, |out| format!(" into {}", out.display()))
    ));
    match &args.out {
        Some(out) => write_file(out, text.as_bytes()),
        None => stdout::print_json(&imported.json),
    }
}
