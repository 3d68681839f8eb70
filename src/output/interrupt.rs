//! Ctrl-C (and SIGTERM): the first asks a run to end after the frames under way, the second ends the program.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Starts to listen; a program that cannot keeps the system's own behavior.
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
