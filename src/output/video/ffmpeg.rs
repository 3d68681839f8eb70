//! Videos by the `ffmpeg` program: raw pictures go to its standard input.

use std::io::{ErrorKind, Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use image::RgbaImage;

use super::{Encoder, Start};
use crate::error::{Error, Result};

/// Visually lossless, and played by what there is: 4:2:0, whole file ready to stream.
pub const MP4: &[&str] = &[
    "-c:v",
    "libx264",
    "-preset",
    "medium",
    "-crf",
    "18",
    "-movflags",
    "+faststart",
];
pub const WEBM: &[&str] = &[
    "-c:v",
    "libvpx-vp9",
    "-crf",
    "24",
    "-b:v",
    "0",
    "-row-mt",
    "1",
    "-cpu-used",
    "4",
];

/// Even sides, as 4:2:0 needs, and colors by BT.709, told to the player.
const FILTER: &str = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
const COLORS: &[&str] = &[
    "-colorspace",
    "bt709",
    "-color_primaries",
    "bt709",
    "-color_trc",
    "bt709",
];

/// Lines of its last words that are told.
const LAST_WORDS: usize = 8;

const INSTALL: &str = "install it (apt-get install ffmpeg, brew install ffmpeg, https://ffmpeg.org), or end the name with \
                       .gif or .png, which need no program";

pub fn check() -> Result<()> {
    let asked = Command::new("ffmpeg")
        .arg("-version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match asked {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Error::usage(
            format!("`ffmpeg -version` ends with {status}"),
            INSTALL,
        )),
        Err(reason) if reason.kind() == ErrorKind::NotFound => Err(Error::usage(
            "videos of this kind are made by the program ffmpeg, which is not in PATH",
            INSTALL,
        )),
        Err(reason) => Err(Error::usage(format!("ffmpeg does not start: {reason}"), INSTALL)),
    }
}

pub fn start(start: &Start, codec: &[&str]) -> Result<Box<dyn Encoder>> {
    let [width, height] = start.size;
    let mut command = Command::new("ffmpeg");
    command
        .args([
            "-hide_banner",
            "-loglevel",
            "error",
            "-nostdin",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgba",
        ])
        .args([
            "-video_size",
            &format!("{width}x{height}"),
            "-framerate",
            &start.rate.to_string(),
            "-i",
            "pipe:0",
        ])
        .args(["-vf", FILTER])
        .args(codec)
        .args(COLORS)
        .arg(start.path)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    // Ctrl-C is for the run, which then ends the video properly.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command
        .spawn()
        .map_err(|reason| Error::usage(format!("ffmpeg does not start: {reason}"), INSTALL))?;
    let mut errors = child.stderr.take().expect("it is piped");
    let words = std::thread::spawn(move || {
        let mut words = Vec::new();
        // What cannot be read is missing from the message, no more.
        let _ = errors.read_to_end(&mut words);
        String::from_utf8_lossy(&words).into_owned()
    });
    Ok(Box::new(Ffmpeg {
        child,
        words: Some(words),
        path: start.path.to_owned(),
    }))
}

struct Ffmpeg {
    child: Child,
    /// Collects what it says.
    words: Option<JoinHandle<String>>,
    path: PathBuf,
}

impl Ffmpeg {
    /// Waits for its end; the error has its last words.
    fn end(&mut self) -> Result<()> {
        drop(self.child.stdin.take());
        let status = self.child.wait();
        let words = self
            .words
            .take()
            .and_then(|words| words.join().ok())
            .unwrap_or_default();
        let reason = match status {
            Ok(status) if status.success() => return Ok(()),
            Ok(status) => format!("ffmpeg ended with {status}"),
            Err(reason) => format!("ffmpeg is lost: {reason}"),
        };
        let lines: Vec<_> = words.lines().filter(|line| !line.trim().is_empty()).collect();
        let last = lines[lines.len().saturating_sub(LAST_WORDS)..].join("\n    ");
        let said = if last.is_empty() {
            ", without a word".to_owned()
        } else {
            format!("; its last words:\n    {last}")
        };
        Err(Error::file(
            &self.path,
            "encode",
            reason + &said,
            "check that this ffmpeg has the encoder, and that the disk has room",
        ))
    }
}

impl Encoder for Ffmpeg {
    fn picture(&mut self, _index: u32, picture: &RgbaImage) -> Result<()> {
        let sent = self
            .child
            .stdin
            .as_mut()
            .map_or(Ok(()), |input| input.write_all(picture));
        // A broken pipe: it has ended, and says why.
        sent.or_else(|reason| {
            self.end()?;
            Err(Error::file(
                &self.path,
                "encode",
                reason,
                "ffmpeg ended before the run",
            ))
        })
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        self.end()
    }
}

impl Drop for Ffmpeg {
    /// After a failure elsewhere nobody waits for it.
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}
