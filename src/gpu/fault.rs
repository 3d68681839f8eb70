//! What goes wrong on the device behind the host's back: wgpu reports it out of band, and the next wait or submission
//! makes it an error.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::{Arc, Once, OnceLock};

use crate::error::{Error, Result};

/// The first thing that went wrong of each kind; clones share it.
#[derive(Clone, Default)]
pub(super) struct Faults(Arc<First>);

#[derive(Default)]
struct First {
    /// That the device is lost, and why.
    loss: OnceLock<String>,
    error: OnceLock<(Kind, String)>,
}

#[derive(Clone, Copy)]
enum Kind {
    Memory,
    Other,
}

impl Faults {
    /// Has the device report here instead of ending the program.
    pub fn watch(device: &wgpu::Device) -> Self {
        let faults = Self::default();
        let first = faults.clone();
        device.on_uncaptured_error(Arc::new(move |error| first.keep(&error)));
        let first = faults.clone();
        device.set_device_lost_callback(move |_, why| first.keep_loss(why));
        faults
    }

    pub fn keep_loss(&self, why: String) {
        let _ = self.0.loss.set(why);
    }

    fn keep(&self, error: &wgpu::Error) {
        let kind = match error {
            wgpu::Error::OutOfMemory { .. } => Kind::Memory,
            wgpu::Error::Validation { .. } | wgpu::Error::Internal { .. } => Kind::Other,
        };
        let _ = self.0.error.set((kind, told(error)));
    }

    /// What went wrong so far, on the adapter with this description.
    ///
    /// # Errors
    ///
    /// A lost device, memory that ran out, or a command that the device refused.
    pub fn check(&self, adapter: impl FnOnce() -> String) -> Result<()> {
        let First { loss, error } = &*self.0;
        if loss.get().is_none() && error.get().is_none() {
            return Ok(());
        }
        let adapter = adapter();
        if let Some(why) = loss.get() {
            let why = match why.trim() {
                "" => String::new(),
                why => format!(", {why}"),
            };
            return Err(Error::device(
                format!("the device was lost: {adapter}{why}"),
                "finished frames are on disk; run again, with a smaller scene if the device ran out of memory or out of \
                 its watchdog's time",
            ));
        }
        match error.get() {
            None => Ok(()),
            Some((Kind::Memory, what)) => Err(Error::device(
                format!("the memory of {adapter} is full: {what}"),
                MORE_MEMORY,
            )),
            Some((Kind::Other, what)) => Err(Error::device(
                format!("{adapter} refused a command: {what}"),
                DEFECT,
            )),
        }
    }
}

const MORE_MEMORY: &str = "finished frames are on disk; take fewer particles or smaller pictures, leave neighbor lists out \
                           (--set neighbors.skin=0), or choose another adapter with --adapter";
const DEFECT: &str = "finished frames are on disk; this is a defect of Sliceflow or of the driver: please report it, and try \
                      another driver or adapter";

/// Makes something on the device. What wgpu reports about it is an error that says what was made: `what`.
///
/// # Errors
///
/// Where memory is full, and where the device or the driver refuses what is made.
pub(super) fn made<T>(
    device: &wgpu::Device,
    what: impl FnOnce() -> String,
    make: impl FnOnce(&wgpu::Device) -> T,
) -> Result<T> {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let scopes = [Internal, OutOfMemory, Validation].map(|filter| device.push_error_scope(filter));
    let thing = make(device);
    let mut first = None;
    for scope in scopes.into_iter().rev() {
        first = first.or(pollster::block_on(scope.pop()));
    }
    match first {
        None => Ok(thing),
        Some(error @ wgpu::Error::OutOfMemory { .. }) => Err(Error::device(
            format!(
                "{} does not fit into the device's memory: {}",
                what(),
                told(&error)
            ),
            MORE_MEMORY,
        )),
        Some(error) => Err(Error::device(
            format!("the device refuses {}: {}", what(), told(&error)),
            DEFECT,
        )),
    }
}

/// An error and its causes in one line.
fn told(error: &wgpu::Error) -> String {
    let mut causes = Vec::new();
    let mut cause = std::error::Error::source(error);
    while let Some(inner) = cause {
        causes.push(inner.to_string().split_whitespace().collect::<Vec<_>>().join(" "));
        cause = inner.source();
    }
    causes.dedup();
    causes.join(": ")
}

thread_local! {
    static IS_QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Does what may panic inside wgpu, without a message; `None` where it did.
pub(super) fn quietly<T>(work: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_QUIET.get() {
                usual(panic);
            }
        }));
    });
    IS_QUIET.set(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    IS_QUIET.set(false);
    done.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &'static str) -> wgpu::Error {
        wgpu::Error::Validation {
            source: text.into(),
            description: "long".into(),
        }
    }

    #[test]
    fn the_first_error_is_kept_and_a_loss_says_more() {
        let faults = Faults::default();
        assert!(faults.check(|| "it".into()).is_ok());
        faults.keep(&error("one\n  two"));
        faults.keep(&error("three"));
        let text = faults.check(|| "it".into()).unwrap_err().to_string();
        assert!(text.starts_with("it refused a command: one two\n"), "{text}");
        faults.keep_loss("hung".into());
        let text = faults.check(|| "it".into()).unwrap_err().to_string();
        assert!(text.starts_with("the device was lost: it, hung\n"), "{text}");
    }

    #[test]
    fn full_memory_is_no_defect() {
        let faults = Faults::default();
        faults.keep(&wgpu::Error::OutOfMemory {
            source: "no more".into(),
        });
        let text = faults.check(|| "it".into()).unwrap_err().to_string();
        assert!(text.contains("the memory of it is full: no more"), "{text}");
        assert!(text.contains("fewer particles"), "{text}");
    }

    #[test]
    fn a_panic_of_others_is_nothing() {
        assert_eq!(quietly(|| 3), Some(3));
        assert_eq!(quietly(|| -> u32 { panic!("inside wgpu") }), None);
    }
}
