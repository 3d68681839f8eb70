use std::io::Write as _;
use std::process::ExitCode;

use sliceflow::error::Error;

fn main() -> ExitCode {
    let Err(error) = sliceflow::cli::main() else {
        return ExitCode::SUCCESS;
    };
    let label = if matches!(error, Error::Interrupted { .. }) {
        ""
    } else {
        "error: "
    };
    // Where nobody reads standard error, the exit status still tells.
    let _ = writeln!(std::io::stderr(), "{label}{error}");
    ExitCode::from(error.exit_code())
}
