//! Ctrl-C (and SIGTERM): the first asks a command to end, and says at once what it still waits for; the second ends the
//! program. Signals are the program's, so a library without the cargo feature `cli` leaves them alone.

#[cfg(feature = "cli")]
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
#[cfg(feature = "cli")]
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

static ASKED: AtomicBool = AtomicBool::new(false);
static HEEDED: AtomicBool = AtomicBool::new(false);
#[cfg(feature = "cli")]
static ANSWER: Mutex<Option<Box<dyn Fn() + Send>>> = Mutex::new(None);

/// What is told of the second Ctrl-C.
pub const AGAIN: &str = "Ctrl-C again ends at once";

/// Starts to listen; a program that cannot keeps the system's own behavior. `answer` tells what happens when the first
/// Ctrl-C comes, and takes the place of an earlier one; it is called on a thread of its own.
#[cfg(feature = "cli")]
pub fn listen(answer: impl Fn() + Send + 'static) {
    *ANSWER.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(answer));
    static LISTENING: OnceLock<()> = OnceLock::new();
    LISTENING.get_or_init(|| {
        let _ = ctrlc::set_handler(|| {
            if ASKED.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
            if let Some(answer) = &*ANSWER.lock().unwrap_or_else(PoisonError::into_inner) {
                answer();
            }
        });
    });
}

#[cfg(not(feature = "cli"))]
pub fn listen(_answer: impl Fn() + Send + 'static) {}

/// Waits until somebody asks.
pub fn wait() {
    while !asked() {
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Whether the command should end.
pub fn asked() -> bool {
    let asked = ASKED.load(Ordering::Relaxed);
    if asked {
        HEEDED.store(true, Ordering::Relaxed);
    }
    asked
}

/// Whether somebody has been told to end, so that work may have been left undone.
pub fn heeded() -> bool {
    HEEDED.load(Ordering::Relaxed)
}
