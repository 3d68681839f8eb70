//! A recording on disk.

use std::fs::File;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::Encoder;
use ::rerun::external::re_log_encoding::rrd::{EncodeError, EncodingOptions};
use ::rerun::log::LogMsg;
use ::rerun::sink::{LogSink, SinkFlushError};

use crate::error::Result;
use crate::output::disk;

/// The encoder of a file. Rerun's own file sink keeps the reason of a failed write to itself.
pub struct FileEnd {
    encoder: Mutex<Option<Encoder<File>>>,
    failure: Mutex<Option<std::io::Error>>,
}

impl FileEnd {
    pub fn create(path: &Path) -> Result<Self> {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|reason| disk::failed(folder, "create", reason))?;
        }
        let file = crate::files::create(path).map_err(|reason| disk::failed(path, "create", reason))?;
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)
            .map_err(|error| disk::failed(path, "write", reason(error)))?;
        Ok(Self {
            encoder: Mutex::new(Some(encoder)),
            failure: Mutex::new(None),
        })
    }

    /// Why writing stopped; told once.
    pub fn failure(&self) -> Option<std::io::Error> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn append(&self, message: &LogMsg) {
        let mut encoder = self.encoder.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Err(error)) = encoder.as_mut().map(|encoder| encoder.append(message)) {
            // Its destructor would try to write the footer behind half a message.
            let _ = encoder.take().map(Encoder::into_inner);
            let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(reason(error));
        }
    }

    /// Writes the footer.
    pub fn finish(&self) -> std::io::Result<()> {
        let encoder = self.encoder.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(mut encoder) = encoder else { return Ok(()) };
        encoder.finish().map_err(reason)?;
        encoder.into_inner().map_err(reason)?.sync_all()
    }
}

fn reason(error: EncodeError) -> std::io::Error {
    match error {
        EncodeError::Write(reason) => reason,
        other => std::io::Error::other(other.to_string()),
    }
}

/// A stream's way into the file.
pub struct ToFile(pub Arc<FileEnd>);

impl LogSink for ToFile {
    fn send(&self, message: LogMsg) {
        self.0.append(&message);
    }

    fn flush_blocking(&self, _timeout: Duration) -> std::result::Result<(), SinkFlushError> {
        Ok(())
    }
}
