//! Ctrl-C (and SIGTERM): the first asks a run to end after the frames under way, the second ends the program. Signals
//! are the program's, so a library without the cargo feature `cli` leaves them alone.

#[cfg(feature = "cli")]
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Starts to listen; a program that cannot keeps the system's own behavior.
#[cfg(feature = "cli")]
pub fn listen() {
    static LISTENING: OnceLock<()> = OnceLock::new();
    LISTENING.get_or_init(|| {
        let _ = ctrlc::set_handler(|| {
            if ASKED.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        });
    });
}

#[cfg(not(feature = "cli"))]
pub fn listen() {}

/// Waits until somebody asks.
pub fn wait() {
    while !asked() {
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Whether the run should end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
