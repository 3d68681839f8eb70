//! `sliceflow schema`

use super::stdout;
use crate::error::Result;
use crate::scene::load;

/// Prints the JSON schema of scene files
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {}

const EXAMPLES: &str = "\
Examples:
  sliceflow schema > scene.schema.json     then, in a scene: \"$schema\": \"scene.schema.json\"";

pub fn main(_: &Args) -> Result<()> {
    stdout::print_json(&load::schema())
}
