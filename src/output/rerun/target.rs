//! Where a recording goes: a file or a viewer, which may have to be started first.

use std::net::{TcpStream, ToSocketAddrs as _};
use std::path::PathBuf;
use std::str::FromStr as _;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ::rerun::external::re_uri::ProxyUri;
use ::rerun::log::{ChunkBatcherConfig, LogMsg};
use ::rerun::sink::{GrpcSink, GrpcSinkConnectionState, LogSink, SinkFlushError};
use ::rerun::{RecordingStream, RecordingStreamBuilder};

use super::file::{FileEnd, ToFile};
use super::server::Server;
use super::{Target, server};
use crate::error::Error;
use crate::output::disk;

/// Viewers keep one arrangement for all recordings of an application.
pub const APPLICATION: &str = "sliceflow";
/// How long a viewer may take to answer.
const ANSWER: Duration = Duration::from_secs(5);
/// How long a viewer may take for what is still on its way when the run ends.
const LAST_WORDS: Duration = Duration::from_secs(20);
/// Rows of the same entity wait so long for company: few chunks make a small file.
const FILE_TICK: Duration = Duration::from_secs(2);

/// A stream into a target that answers.
pub struct Open {
    pub stream: RecordingStream,
    end: End,
    server: Option<Server>,
}

enum End {
    File(PathBuf, Arc<FileEnd>),
    Viewer(Arc<GrpcSink>),
}

/// Why a stream ended early.
#[derive(Debug)]
pub enum Trouble {
    /// The run cannot give what was asked for.
    Failed(Error),
    /// Nobody looks any more, and why; the run goes on.
    Lost(String),
}

impl Open {
    /// Opens a target; a viewer that does not answer is [`Trouble::Lost`]. `name` is the recording's.
    pub fn new(target: &Target, name: &str) -> std::result::Result<Self, Trouble> {
        let builder = RecordingStreamBuilder::new(APPLICATION).recording_name(name);
        let buffered = |builder: RecordingStreamBuilder| {
            let stream = builder.buffered().map_err(|error| {
                let what = format!("Rerun does not start: {error}");
                Trouble::Failed(Error::usage(what, "run without Rerun"))
            })?;
            stream.set_log_tick_enabled(false);
            stream.set_log_time_enabled(false);
            Ok(stream)
        };
        match target {
            Target::File(path) => {
                let file = Arc::new(FileEnd::create(path).map_err(Trouble::Failed)?);
                let few_chunks = ChunkBatcherConfig {
                    flush_tick: FILE_TICK,
                    ..ChunkBatcherConfig::DEFAULT
                };
                let stream = buffered(builder.batcher_config(few_chunks))?;
                stream.set_sink(Box::new(ToFile(file.clone())));
                let end = End::File(path.clone(), file);
                Ok(Self {
                    stream,
                    end,
                    server: None,
                })
            }
            Target::Viewer(address) => {
                let viewer = Arc::new(connect(address)?);
                let stream = buffered(builder.batcher_config(ChunkBatcherConfig::LOW_LATENCY))?;
                stream.set_sink(Box::new(ToViewer(viewer.clone())));
                let end = End::Viewer(viewer);
                Ok(Self {
                    stream,
                    end,
                    server: None,
                })
            }
            Target::Spawn => {
                server::spawn_viewer().map_err(Trouble::Failed)?;
                Self::new(&Target::local_viewer(), name)
            }
            Target::Serve => {
                let server = Server::start().map_err(Trouble::Failed)?;
                let open = Self::new(&Target::local_viewer(), name)?;
                Ok(Self {
                    server: Some(server),
                    ..open
                })
            }
        }
    }

    /// Whether the target still takes what is logged.
    pub fn check(&self) -> std::result::Result<(), Trouble> {
        match &self.end {
            End::File(path, file) => file.failure().map_or(Ok(()), |reason| {
                Err(Trouble::Failed(disk::failed(path, "write", reason)))
            }),
            End::Viewer(viewer) => match viewer.status() {
                GrpcSinkConnectionState::Disconnected(Err(reason)) => Err(Trouble::Lost(reason.to_string())),
                GrpcSinkConnectionState::Disconnected(Ok(())) => Err(Trouble::Lost("it was closed".into())),
                _ => Ok(()),
            },
        }
    }

    /// Hands everything over and ends the recording. A server comes back: whoever looks at it needs it still.
    pub fn finish(self) -> std::result::Result<Option<Server>, Trouble> {
        match &self.end {
            End::File(path, file) => {
                // Everything has to reach the encoder before the footer is written.
                let flushed = self.stream.flush_blocking();
                self.check()?;
                let failed = |reason: String| {
                    let reason = std::io::Error::other(reason);
                    Trouble::Failed(disk::failed(path, "write", reason))
                };
                flushed.map_err(|error| failed(error.to_string()))?;
                file.finish()
                    .map_err(|reason| Trouble::Failed(disk::failed(path, "write", reason)))?;
            }
            End::Viewer(_) => {
                let flushed = self.stream.flush_with_timeout(LAST_WORDS);
                self.check()?;
                flushed.map_err(|error| Trouble::Lost(error.to_string()))?;
            }
        }
        Ok(self.server)
    }
}

/// A viewer whose state can be asked for while a stream writes to it.
struct ToViewer(Arc<GrpcSink>);

impl LogSink for ToViewer {
    fn send(&self, message: LogMsg) {
        self.0.send(message);
    }

    fn flush_blocking(&self, timeout: Duration) -> std::result::Result<(), SinkFlushError> {
        self.0.flush_blocking(timeout)
    }
}

fn connect(address: &str) -> std::result::Result<GrpcSink, Trouble> {
    let lost = |reason: &dyn std::fmt::Display| Trouble::Lost(format!("{address} does not answer: {reason}"));
    let socket = address
        .to_socket_addrs()
        .map_err(|error| lost(&error))?
        .next()
        .ok_or_else(|| lost(&"it has no address"))?;
    // Rerun's client would try for ever.
    TcpStream::connect_timeout(&socket, ANSWER).map_err(|error| lost(&error))?;
    let uri = ProxyUri::from_str(&format!("rerun+http://{address}/proxy")).map_err(|error| lost(&error))?;
    let viewer = GrpcSink::new(uri);
    let patience = Instant::now();
    while matches!(viewer.status(), GrpcSinkConnectionState::Connecting { .. }) {
        if patience.elapsed() > ANSWER {
            return Err(lost(&"it is no Rerun viewer"));
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    Ok(viewer)
}
