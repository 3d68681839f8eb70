//! `sliceflow gallery`

mod page;
mod scenes;

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::quiet_args::QuietArgs;
use super::scene_args::size;
use crate::error::{Error, Result};
use crate::files;
use crate::output::interrupt;
use crate::output::text::quoted;
use page::Shown;
use scenes::{ENTRIES, Entry};

/// Makes pictures of eight scenes, and a page that shows them with their commands
///
/// Each scene is simulated up to the moment that shows it best (`run`), and that frame is drawn (`render`); the page has both
/// commands, so each picture can be made alone. What is there already stays as it is and is not made again: a gallery that was
/// stopped goes on where it was.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Makes this picture only (repeatable)
    #[arg(long, value_name = "NAME", value_parser = ENTRIES.map(|entry| entry.name))]
    only: Vec<String>,
    /// Size of pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1920x1080")]
    size: [u32; 2],
    /// Shows this frame of each scene [default: the one that suits it]
    #[arg(long, value_name = "N")]
    frame: Option<u32>,
    /// Folder to write
    #[arg(short, long, value_name = "DIR", default_value = "out/gallery")]
    out: PathBuf,
    /// Makes pictures again that are there
    #[arg(long)]
    force: bool,
    /// Adapter, by index or part of its name (see `sliceflow devices`)
    #[arg(long, value_name = "NAME|INDEX")]
    adapter: Option<String>,
    #[command(flatten)]
    quiet: QuietArgs,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow gallery
  sliceflow gallery --only drum --only hopper --size 1280x720
  sliceflow gallery --out out/gallery_4k --size 3840x2160";

pub fn main(args: &Args) -> Result<()> {
    let asked = |entry: &&Entry| args.only.is_empty() || args.only.iter().any(|name| name == entry.name);
    let program = std::env::current_exe().map_err(|reason| {
        Error::usage(
            format!("the program does not find itself: {reason}"),
            "call it by its whole path",
        )
    })?;
    // The command that is under way says what it waits for.
    interrupt::listen(|| {});
    let mut shown = Vec::new();
    for entry in ENTRIES.iter() {
        let picture = Picture::new(args, entry);
        if asked(&entry) {
            picture.make(args, &program)?;
        }
        // Pictures that were made before are shown too.
        shown.extend(picture.shown());
    }
    std::fs::create_dir_all(&args.out)
        .map_err(|reason| Error::file(&args.out, "create", reason, "choose another folder with --out"))?;
    let index = args.out.join("index.html");
    page::write(&index, &shown)?;
    args.quiet
        .tell(&format!("done: {} pictures in {}", shown.len(), index.display()));
    Ok(())
}

/// A picture, and the commands that make it.
struct Picture<'a> {
    entry: &'a Entry,
    /// Folders of the simulation and of the drawing.
    run: PathBuf,
    drawing: PathBuf,
    simulate: Vec<String>,
    draw: Vec<String>,
}

impl<'a> Picture<'a> {
    fn new(args: &Args, entry: &'a Entry) -> Self {
        let frame = args.frame.unwrap_or(entry.frame);
        let run = args.out.join(entry.name);
        let drawing = args.out.join(format!("{}_picture", entry.name));
        let (run_text, drawing_text) = (run.display().to_string(), drawing.display().to_string());
        let frames = (frame + 1).to_string();
        let mut simulate = words(&[
            "run",
            entry.scene,
            "--frames",
            &frames,
            "--no-pictures",
            "--out",
            &run_text,
        ]);
        for set in entry.set {
            simulate.extend(words(&["--set", set]));
        }
        let [width, height] = args.size;
        let size = format!("{width}x{height}");
        let frame_text = frame.to_string();
        let draw = [
            "render",
            &run_text,
            "--frames",
            &frame_text,
            "--size",
            &size,
            "--no-overlay",
            "--out",
            &drawing_text,
        ];
        let mut draw = words(&draw);
        for command in [&mut simulate, &mut draw] {
            if let Some(adapter) = &args.adapter {
                command.extend(words(&["--adapter", adapter]));
            }
        }
        Self {
            entry,
            run,
            drawing,
            simulate,
            draw,
        }
    }

    /// Does what is still to be done.
    fn make(&self, args: &Args, program: &Path) -> Result<()> {
        let (run, drawing) = (recorded(&self.run), recorded(&self.drawing));
        let mut again = false;
        match &run {
            Some(record) if !args.force && is_finished(record) && was_called(record, &self.simulate) => {}
            Some(record) if !args.force && was_called(record, &self.simulate) => {
                self.call(
                    args,
                    program,
                    &words(&["resume", &self.run.display().to_string()]),
                )?;
            }
            Some(_) if !args.force => return Err(refused(&self.run)),
            other => {
                again = true;
                let force = other.is_some().then(|| "--force".to_owned());
                let command: Vec<String> = self.simulate.iter().cloned().chain(force).collect();
                self.call(args, program, &command)?;
            }
        }
        match &drawing {
            Some(record) if !again && is_finished(record) && was_called(record, &self.draw) => {
                args.quiet.tell(&format!("{}: is there", self.entry.name));
                return Ok(());
            }
            // A drawing that was stopped is of the gallery, and is made anew.
            Some(record) if !args.force && (is_finished(record) || !was_called(record, &self.draw)) => {
                return Err(refused(&self.drawing));
            }
            _ => {}
        }
        let force = drawing.is_some().then(|| "--force".to_owned());
        let command: Vec<String> = self.draw.iter().cloned().chain(force).collect();
        self.call(args, program, &command)
    }

    /// Runs one of the program's own commands, which tells how it goes.
    fn call(&self, args: &Args, program: &Path, command: &[String]) -> Result<()> {
        if interrupt::asked() {
            return Err(Error::interrupted("the same command goes on"));
        }
        args.quiet
            .tell(&format!("{}: {}", self.entry.name, shell(command)));
        let quiet = args.quiet.is_quiet().then_some("--quiet");
        let status = Command::new(program).args(command).args(quiet).status();
        let status = status
            .map_err(|reason| Error::file(program, "start", reason, "see that the program may be started"))?;
        match status.code() {
            Some(0) => Ok(()),
            Some(130) => Err(Error::interrupted("the same command goes on")),
            _ => Err(Error::usage(
                format!("`{}` ended with {status}", shell(command)),
                "its own message stands above",
            )),
        }
    }

    /// The picture, where it is there.
    fn shown(&self) -> Option<Shown<'a>> {
        let drawing = recorded(&self.drawing)?;
        let run = recorded(&self.run).unwrap_or_default();
        let frame = drawing["last_frame"].as_u64()?;
        let file = format!("frame_{frame:06}.png");
        (is_finished(&drawing) && self.drawing.join(&file).exists()).then(|| Shown {
            entry: self.entry,
            // Those that made it, which this call's may not be.
            commands: [&run, &drawing]
                .map(|record| shell(called(record).unwrap_or_default()))
                .to_vec(),
            picture: format!("{}_picture/{file}", self.entry.name),
            run,
            drawing,
        })
    }
}

fn refused(folder: &Path) -> Error {
    Error::usage(
        format!("{} was made with other arguments", folder.display()),
        "make it anew with --force, or choose another folder with --out",
    )
}

/// The record that a run has left in its folder.
fn recorded(folder: &Path) -> Option<Value> {
    let text = files::read(&folder.join("run.json")).ok()?;
    serde_json::from_slice(&text).ok()
}

fn is_finished(record: &Value) -> bool {
    record["status"] == "finished"
}

/// The command of a record, without options that change no file.
fn called(record: &Value) -> Option<Vec<&str>> {
    let arguments = record["configuration"]["arguments"]
        .as_array()
        .or_else(|| record["command_line"].as_array())?;
    let words = arguments.iter().skip(1).filter_map(Value::as_str);
    Some(
        words
            .filter(|&word| word != "--force" && word != "--quiet")
            .collect(),
    )
}

fn was_called(record: &Value, command: &[String]) -> bool {
    called(record).is_some_and(|words| words.into_iter().eq(command))
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

/// A command as a shell takes it.
fn shell<W: AsRef<str>>(command: impl IntoIterator<Item = W>) -> String {
    let words = command.into_iter().map(|word| quoted(Path::new(word.as_ref())));
    std::iter::once("sliceflow".to_owned())
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}
