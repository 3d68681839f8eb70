//! Data on standard output.

use std::io::{ErrorKind, Write as _, stdout};
use std::path::Path;

use serde_json::Value;

use crate::error::{Error, Result};
use crate::output::text::printable;

/// Prints text without control characters. A reader that has seen enough (`| head`) is no error.
pub fn print(text: &str) -> Result<()> {
    let mut out = stdout().lock();
    match out
        .write_all(printable(text).as_bytes())
        .and_then(|()| out.flush())
    {
        Err(reason) if reason.kind() != ErrorKind::BrokenPipe => {
            let place = Path::new("standard output");
            Err(Error::file(
                place,
                "write",
                reason,
                "check where it is redirected to",
            ))
        }
        _ => Ok(()),
    }
}

/// Prints JSON for people to read and programs to parse.
pub fn print_json(value: &Value) -> Result<()> {
    let mut text = format!("{value:#}\n");
    // JSON itself escapes those below U+0020 alone.
    for control in '\u{7f}'..='\u{9f}' {
        text = text.replace(control, &format!("\\u{:04x}", u32::from(control)));
    }
    print(&text)
}
