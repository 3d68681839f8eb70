//! `sliceflow surface`

use std::path::PathBuf;
use std::time::Instant;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser as _};

use super::device_args::DeviceArgs;
use super::quiet_args::QuietArgs;
use crate::error::{Error, Result};
use crate::gpu::AdapterChoice;
use crate::output::Recorded;
use crate::output::surface::{
    MESH_FORMATS, MeshFormat, OnDevice, Sequence, SurfaceSettings, Walls, make_surfaces,
};
use crate::output::text::{bytes, count, seconds};
use crate::scene::Scene;
use crate::scene::model::{Addressing, SurfaceKernel};
use crate::surface::Figures;

/// Turns a run's particles into surfaces, one mesh per frame
///
/// Reads the particle files that `sliceflow run --particles` has written, and writes surface_000000.ply … beside them.
/// Made with splashsurf (Löschner et al. 2023): smoothed, closed, ended at walls. Lengths are in particle radii.
///
/// With --on-device the graphics adapter makes them instead: the implicit function of the particles (Zhu and Bridson 2005,
/// or with `--kernel anisotropic` Yu and Turk 2013) is stored in a grid whose memory follows what is near the surface, and
/// marching cubes make closed meshes of it, the same bytes every time.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Folder of a run
    run: PathBuf,
    /// Folder to write [default: the run's]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[arg(
        long,
        default_value = "ply",
        help = "Format of the meshes",
        value_parser = PossibleValuesParser::new(MESH_FORMATS.iter().map(|f| PossibleValue::new(f.name).help(f.about)))
            .map(format),
    )]
    format: &'static MeshFormat,
    /// Radius of a particle, metres [default: the run's]
    #[arg(long, value_name = "R", value_parser = positive)]
    radius: Option<f64>,
    /// Makes the surfaces on the graphics adapter
    #[arg(long, conflicts_with_all = ["smoothing_length", "threshold", "smoothing", "no_cleanup"])]
    on_device: bool,
    /// How --on-device stores voxels [default: bitmap]
    #[arg(
        long,
        value_name = "GRID",
        requires = "on_device",
        value_parser = PossibleValuesParser::new(["bitmap", "rows", "sliced"]),
    )]
    grid: Option<String>,
    /// Kernels of --on-device: as flat as what is around a particle, or the same in all directions [default: isotropic]
    #[arg(
        long,
        value_name = "KERNEL",
        requires = "on_device",
        value_parser = PossibleValuesParser::new(["anisotropic", "isotropic"]),
    )]
    kernel: Option<String>,
    #[command(flatten)]
    device: DeviceArgs,
    /// Smoothing length, radii; the kernel reaches twice as far
    #[arg(long, value_name = "L", default_value = "2", value_parser = positive)]
    smoothing_length: f64,
    /// Edge of the cubes that the surface is made from, radii; smaller is finer and slower [default: 0.75, with --on-device 1]
    #[arg(long, value_name = "L", value_parser = positive)]
    cube_size: Option<f64>,
    /// Density on the surface, as a share of the rest density
    #[arg(long, value_name = "SHARE", default_value = "0.55", value_parser = positive)]
    threshold: f64,
    /// Rounds of smoothing, from which splashes keep their shape; 0 shows every particle
    #[arg(long, value_name = "ROUNDS", default_value = "25", value_parser = clap::value_parser!(u32).range(..=1000))]
    smoothing: u32,
    /// Leaves thin triangles as marching cubes make them
    #[arg(long)]
    no_cleanup: bool,
    /// Lets the surface stand through walls and obstacles, as far as its particles' kernels reach
    #[arg(long)]
    no_clip: bool,
    /// Columns of the particles that the vertices of .ply and .glb files get [default: velocity, where there is one]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Leaves normals out
    #[arg(long)]
    no_normals: bool,
    /// Replaces surfaces that are there
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow run bunny_pour --particles ply --out out/bunny
  sliceflow surface out/bunny
  sliceflow surface out/bunny --out out/meshes --format obj --cube-size 0.5
  sliceflow surface out/bunny --format glb --columns velocity,pressure
  sliceflow surface out/bunny --on-device --out out/device";

pub fn main(args: &Args) -> Result<()> {
    let recorded = Sequence::open(&args.run)?;
    if recorded.dimensions == 2 {
        return Err(Error::usage(
            format!(
                "{} is a 2D run, whose particles have no surface in space",
                args.run.display()
            ),
            "run a scene with `dimensions` 3",
        ));
    }
    let frames = recorded.frames.len();
    if (frames as u64) < recorded.wanted {
        args.quiet.tell(&format!(
            "note: {frames} of {} frames have particle files; surfaces are made of those",
            recorded.wanted
        ));
    }
    let out = args.out.as_ref().unwrap_or(&args.run);
    let started = Instant::now();
    let settings = SurfaceSettings {
        radius: args.radius,
        smoothing_length: args.smoothing_length,
        cube_size: args.cube_size.unwrap_or(if args.on_device { 1.0 } else { 0.75 }),
        threshold: args.threshold,
        smoothing: args.smoothing,
        cleanup: !args.no_cleanup,
        normals: !args.no_normals,
        columns: args.columns.clone(),
        format: args.format,
        force: args.force,
        quiet: args.quiet.is_quiet(),
    };
    let scene = scene(args);
    let walls = scene.as_ref().map_or_else(Walls::default, Walls::of);
    let adapter = args.device.adapter();
    if adapter != AdapterChoice::Best && !args.on_device {
        return Err(Error::usage(
            "--adapter chooses where --on-device computes, and surfaces are made on the processor",
            "add --on-device, or leave --adapter out",
        ));
    }
    let device = match args.on_device {
        true => Some(OnDevice::open(&adapter, addressing(args), kernel(args))?),
        false => None,
    };
    let made = make_surfaces(&recorded, &walls, out, &settings, device.as_ref())?;
    if !made.empty.is_empty() {
        let frames: Vec<_> = made.empty.iter().map(u32::to_string).collect();
        eprintln!(
            "warning: no surface in frame {}: no particle there is dense enough for the threshold",
            frames.join(", ")
        );
    }
    args.quiet.tell(&format!(
        "done: {} surfaces in {}, {} triangles ({})",
        made.meshes,
        out.display(),
        count(made.triangles),
        seconds(started.elapsed().as_secs_f64())
    ));
    if let Some(device) = &device {
        args.quiet.tell(&cost(&device.figures(), frames as u64));
    }
    Ok(())
}

/// What meshes on the device have cost, per frame.
fn cost(sum: &Figures, frames: u64) -> String {
    let mean = |sum: u64| sum / frames.max(1);
    format!(
        "per frame: {} of {} voxels in memory, {} where the whole box would have {}; {} on the device, without the search",
        count(mean(sum.voxels)),
        count(mean(sum.box_voxels)),
        bytes(mean(sum.bytes)),
        bytes(mean(sum.box_bytes)),
        seconds(sum.seconds / frames.max(1) as f64)
    )
}

fn addressing(args: &Args) -> Addressing {
    match args.grid.as_deref() {
        Some("rows") => Addressing::Rows,
        Some("sliced") => Addressing::Sliced,
        _ => Addressing::Bitmap,
    }
}

fn kernel(args: &Args) -> SurfaceKernel {
    match args.kernel.as_deref() {
        Some("anisotropic") => SurfaceKernel::Anisotropic,
        _ => SurfaceKernel::Isotropic,
    }
}

/// The run's scene, for its walls.
fn scene(args: &Args) -> Option<Scene> {
    if args.no_clip {
        return None;
    }
    let scene = Recorded::read(&args.run).and_then(|recorded| recorded.configuration()?.scene(&[]));
    scene
        .inspect_err(|reason| {
            eprintln!(
                "warning: surfaces stand through walls, since the run's scene cannot be read: {reason}"
            );
        })
        .ok()
}

/// The row of a name that clap has found among them.
fn format(name: String) -> &'static MeshFormat {
    MESH_FORMATS
        .iter()
        .find(|format| format.name == name)
        .expect("one of the possible values")
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("give a number above zero".into()),
    }
}
