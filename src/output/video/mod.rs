//! A video of a run: each picture goes to an encoder as it is drawn, in order. The name's ending chooses the encoder.

mod apng;
mod ffmpeg;
mod gif;
mod small;

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use image::RgbaImage;

use super::manifest::Files;
use super::png::compose;
use super::workers::Workers;
use super::{Sink, disk};
use crate::error::{Error, Result};
use crate::files;
use crate::render::{Overlay, over_white};
use crate::scene::Scene;
use crate::simulation::frame::Frame;

/// Frames a second that a viewer shows well. Others play at the default, told.
const PLAYABLE: std::ops::RangeInclusive<f64> = 5.0..=60.0;
const DEFAULT_RATE: f64 = 30.0;

/// Takes pictures in order.
trait Encoder: Send {
    /// `index` counts the pictures from 0.
    fn picture(&mut self, index: u32, picture: &RgbaImage) -> Result<()>;

    /// Ends the file. Not called after a failure.
    fn finish(self: Box<Self>) -> Result<()>;
}

/// What an encoder starts with.
struct Start<'a> {
    /// Where to write; renamed when it is whole.
    path: &'a Path,
    size: [u32; 2],
    /// Pictures a second of playing.
    rate: f64,
    /// Pictures that are to come.
    frames: u32,
}

/// A kind of video. To add one: a row of [`KINDS`].
#[derive(Debug)]
pub struct Kind {
    /// The ending of the file's name.
    pub extension: &'static str,
    about: &'static str,
    /// Finds out before the run whether the encoder is there.
    check: fn() -> Result<()>,
    start: fn(&Start) -> Result<Box<dyn Encoder>>,
    /// Whether only some frames, smaller, are kept.
    is_small: bool,
    /// Bytes on disk per pixel of every frame, a guess.
    bytes_per_pixel: f64,
}

pub const KINDS: &[Kind] = &[
    Kind {
        extension: "mp4",
        about: "H.264",
        check: ffmpeg::check,
        start: |start| ffmpeg::start(start, ffmpeg::MP4),
        is_small: false,
        bytes_per_pixel: 0.1,
    },
    Kind {
        extension: "webm",
        about: "VP9",
        check: ffmpeg::check,
        start: |start| ffmpeg::start(start, ffmpeg::WEBM),
        is_small: false,
        bytes_per_pixel: 0.1,
    },
    Kind {
        extension: "gif",
        about: "animated GIF",
        check: || Ok(()),
        start: gif::start,
        is_small: true,
        bytes_per_pixel: 0.03,
    },
    Kind {
        extension: "png",
        about: "animated PNG",
        check: || Ok(()),
        start: apng::start,
        is_small: true,
        bytes_per_pixel: 0.2,
    },
];

/// Which video a run writes.
#[derive(Debug, Clone)]
pub struct VideoOutput {
    path: PathBuf,
    kind: &'static Kind,
}

impl VideoOutput {
    pub fn new(path: &Path) -> Result<Self> {
        let extension = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let kind = KINDS.iter().find(|kind| kind.extension == extension);
        let Some(kind) = kind else {
            let endings: Vec<_> = KINDS.iter().map(|kind| format!(".{}", kind.extension)).collect();
            return Err(Error::usage(
                format!("{} is not the name of a video", path.display()),
                format!("end it with one of {}", endings.join(", ")),
            ));
        };
        Ok(Self {
            path: path.to_owned(),
            kind,
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The video of a run that goes on with frame `first`: what is there cannot be appended to.
    pub fn part_from(&self, first: u32, folder_of: impl Fn(&Path) -> PathBuf) -> Self {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let stem = match first {
            0 => stem.into_owned(),
            _ => format!("{stem}_from_{first}"),
        };
        let name = format!("{stem}.{}", self.kind.extension);
        Self {
            path: folder_of(&self.path).join(name),
            kind: self.kind,
        }
    }

    /// Whether it can be made, before anything is computed.
    pub fn check(&self, force: bool) -> Result<()> {
        if self.path.exists() && !force {
            return Err(Error::usage(
                format!("{} is there already", self.path.display()),
                "replace it with --force, or give --video another name",
            ));
        }
        (self.kind.check)()
    }

    /// The name until the video is whole. It keeps the ending, which ffmpeg goes by.
    fn partial(&self) -> PathBuf {
        self.path.with_extension(format!("part.{}", self.kind.extension))
    }

    /// What to know about it.
    pub fn note(&self, scene: &Scene) -> Option<String> {
        let mut parts = Vec::new();
        let rate = rate(scene.time.fps);
        if rate != scene.time.fps {
            parts.push(format!(
                "plays {rate} frames per second, {:.3} times as fast as the scene",
                rate / scene.time.fps
            ));
        }
        if self.kind.is_small {
            parts.extend(small::Small::new(scene.render.size, rate, scene.time.frames).told());
        }
        (!parts.is_empty()).then(|| format!("{}: {}", self.path.display(), parts.join("; ")))
    }

    pub fn bytes(&self, scene: &Scene) -> f64 {
        let pixels: f64 = scene.render.size.map(f64::from).iter().product();
        self.kind.bytes_per_pixel * pixels * f64::from(scene.time.frames)
    }

    /// For the manifest.
    pub fn files(&self) -> Files {
        Files {
            name: self.path.display().to_string(),
            about: format!("{} of the frames", self.kind.about),
        }
    }
}

fn rate(fps: f64) -> f64 {
    if PLAYABLE.contains(&fps) {
        fps
    } else {
        DEFAULT_RATE
    }
}

/// Composes and encodes on a thread of its own.
pub struct Video {
    output: VideoOutput,
    overlay: Arc<Overlay>,
    rate: f64,
    frames: u32,
    /// Pictures that were taken so far.
    taken: u32,
    /// Where frames are beside the video, so that the run may go on without it.
    pictures: Option<PathBuf>,
    /// One thread, so that pictures stay in order.
    workers: Workers,
    encoder: Arc<Mutex<Option<Box<dyn Encoder>>>>,
    /// Keeps other runs away from the half-written file; `None` once that is gone.
    claim: Option<File>,
    /// What ended the video before the run.
    failure: Option<Error>,
    told: bool,
}

impl Video {
    /// `pictures` is the folder of the run's PNGs, where it has them.
    ///
    /// # Errors
    ///
    /// Where another run is making the same video.
    pub fn new(output: VideoOutput, scene: &Scene, pictures: Option<&Path>) -> Result<Self> {
        if let Some(folder) = output
            .path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
        {
            std::fs::create_dir_all(folder).map_err(|reason| disk::failed(folder, "create", reason))?;
        }
        let overlay = Arc::new(Overlay::new(scene, scene.render.view)?);
        let claim = Some(claim(&output)?);
        Ok(Self {
            overlay,
            claim,
            rate: rate(scene.time.fps),
            frames: scene.time.frames,
            taken: 0,
            pictures: pictures.map(Path::to_owned),
            workers: Workers::new(1),
            encoder: Arc::default(),
            failure: None,
            told: false,
            output,
        })
    }

    fn partial(&self) -> PathBuf {
        self.output.partial()
    }

    /// Half a video only takes room; what went wrong is told elsewhere.
    fn discard(&mut self) {
        if self.claim.take().is_some() {
            let _ = files::remove(&self.partial());
        }
    }

    /// Says that the run's frames are there all the same, and how to make a video of them.
    fn with_way_out(&self, error: Error) -> Error {
        let Some(folder) = &self.pictures else {
            return error;
        };
        let help = format!(
            "the frames are there all the same: ffmpeg -framerate {} -i {} -pix_fmt yuv420p {}",
            self.rate,
            folder.join("frame_%06d.png").display(),
            self.output.path.display()
        );
        Error::file(&self.output.path, "make the video", error, help)
    }

    fn fail(&mut self, error: Error) -> Result<()> {
        self.discard();
        let error = self.with_way_out(error);
        if self.pictures.is_none() {
            return Err(error);
        }
        self.failure = Some(error);
        Ok(())
    }
}

impl Sink for Video {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        if self.failure.is_some() {
            return Ok(());
        }
        let (frame, overlay, encoder) = (frame.clone(), self.overlay.clone(), self.encoder.clone());
        let (start, path) = (self.output.kind.start, self.partial());
        let (rate, frames, index) = (self.rate, self.frames, self.taken);
        self.taken += 1;
        let queued = self.workers.submit(move || {
            let Some(mut picture) = compose(&frame, &overlay)? else {
                return Ok(());
            };
            over_white(&mut picture);
            let mut encoder = encoder.lock().unwrap_or_else(PoisonError::into_inner);
            if encoder.is_none() {
                *encoder = Some(start(&Start {
                    path: &path,
                    size: picture.dimensions().into(),
                    rate,
                    frames,
                })?);
            }
            encoder
                .as_mut()
                .map_or(Ok(()), |encoder| encoder.picture(index, &picture))
        });
        queued.or_else(|error| self.fail(error))
    }

    fn warnings(&mut self) -> Vec<String> {
        let failure = self.failure.as_ref().filter(|_| !self.told);
        self.told |= failure.is_some();
        failure.map(ToString::to_string).into_iter().collect()
    }

    fn finish(&mut self) -> Result<()> {
        let written = self.workers.finish();
        let encoder = self.encoder.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        let is_made = encoder.is_some();
        let finished = written.and_then(|()| encoder.map_or(Ok(()), Encoder::finish));
        match finished {
            Ok(()) if is_made => {
                std::fs::rename(self.partial(), &self.output.path)
                    .map_err(|reason| disk::failed(&self.output.path, "write", reason))?;
                self.claim = None;
                Ok(())
            }
            Ok(()) => {
                self.discard();
                Ok(())
            }
            Err(error) => {
                self.discard();
                Err(self.with_way_out(error))
            }
        }
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        self.discard();
    }
}

/// Creates the half-written file and locks it, where the system can.
fn claim(output: &VideoOutput) -> Result<File> {
    let path = output.partial();
    let busy = || {
        Error::usage(
            format!("another run is making {}", output.path.display()),
            "wait for it or stop it, or give --video another name",
        )
    };
    let is_locked = |file: &File| matches!(file.try_lock(), Err(TryLockError::WouldBlock));
    // One that a killed run has left is locked by nobody.
    if files::open(&path).is_ok_and(|file| is_locked(&file)) {
        return Err(busy());
    }
    let file = files::create(&path).map_err(|reason| disk::failed(&path, "create", reason))?;
    match is_locked(&file) {
        true => Err(busy()),
        false => Ok(file),
    }
}

/// The half-written file, which is there already in a run, to encode into.
fn create(path: &Path) -> Result<std::io::BufWriter<File>> {
    let file = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .open(path);
    let file = file.map_err(|reason| disk::failed(path, "create", reason))?;
    Ok(std::io::BufWriter::new(file))
}

#[cfg(test)]
mod tests;
