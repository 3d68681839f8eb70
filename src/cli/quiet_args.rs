//! The argument of every command that tells what it does.

use crate::output::progress::Style;
use crate::output::text::printable;

#[derive(clap::Args, Clone, Copy)]
pub struct QuietArgs {
    /// Shows warnings and errors only
    #[arg(short, long)]
    quiet: bool,
}

impl QuietArgs {
    /// The style to show progress in, where `otherwise` is what was asked for.
    pub fn style(self, otherwise: Style) -> Style {
        if self.quiet { Style::None } else { otherwise }
    }

    pub fn is_quiet(self) -> bool {
        self.quiet
    }

    /// Tells something on standard error, unless nobody wants to know.
    pub fn tell(self, text: &str) {
        if !self.quiet {
            eprintln!("{}", printable(text));
        }
    }
}
