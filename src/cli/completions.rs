//! `sliceflow completions`

use clap_complete::Shell;

use super::stdout;
use crate::error::Result;

/// Prints what lets a shell complete commands and options
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow completions bash > ~/.local/share/bash-completion/completions/sliceflow
  sliceflow completions zsh > ~/.zfunc/_sliceflow     where `fpath` has ~/.zfunc
  sliceflow completions fish > ~/.config/fish/completions/sliceflow.fish";

/// `program` is the whole command line.
pub fn main(args: &Args, mut program: clap::Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "sliceflow", &mut script);
    stdout::print(&String::from_utf8_lossy(&script))
}
