//! A bar on the terminal for work that has an end. Without the cargo feature `cli`, a library's, it shows nothing.

#[cfg(feature = "cli")]
use indicatif::{ProgressBar, ProgressStyle};

/// Hidden where standard error is no terminal.
#[derive(Clone)]
pub struct Bar {
    #[cfg(feature = "cli")]
    shown: ProgressBar,
}

#[cfg(feature = "cli")]
impl Bar {
    /// `template` is indicatif's.
    pub fn new(template: &str, total: u32) -> Self {
        let style = ProgressStyle::with_template(template)
            .expect("templates stand in the program")
            .progress_chars("━╸ ");
        Self {
            shown: ProgressBar::new(u64::from(total)).with_style(style),
        }
    }

    pub fn set(&self, done: u32) {
        self.shown.set_position(u64::from(done));
    }

    #[cfg(feature = "surface")]
    pub fn advance(&self) {
        self.shown.inc(1);
    }

    pub fn message(&self, text: String) {
        self.shown.set_message(text);
    }

    /// Takes the bar away while `write` writes.
    pub fn suspend(&self, write: impl FnOnce()) {
        self.shown.suspend(write);
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.shown.finish_and_clear();
    }
}

#[cfg(not(feature = "cli"))]
impl Bar {
    pub fn new(_template: &str, _total: u32) -> Self {
        Self {}
    }

    pub fn set(&self, _done: u32) {}

    #[cfg(feature = "surface")]
    pub fn advance(&self) {}

    pub fn message(&self, _text: String) {}

    pub fn suspend(&self, write: impl FnOnce()) {
        write();
    }

    pub fn clear(&self) {}
}
