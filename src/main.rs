use std::io::Write as _;
use std::process::ExitCode;

use sliceflow::error::Error;
use sliceflow::output::text::printable;

fn main() -> ExitCode {
    quiet_display_layer();
    let Err(error) = sliceflow::cli::main() else {
        return ExitCode::SUCCESS;
    };
    let label = if matches!(error, Error::Interrupted { .. } | Error::Different) {
        ""
    } else {
        "error: "
    };
    // Where nobody reads standard error, the exit status still tells.
    let message = format!("{label}{error}");
    let _ = writeln!(std::io::stderr(), "{}", printable(&message));
    ExitCode::from(error.exit_code())
}

/// Mesa's device selection layer looks for a display, and complains on standard error where there is none. Sliceflow
/// has no use for one.
fn quiet_display_layer() {
    // SAFETY: the program has one thread yet.
    unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
}
