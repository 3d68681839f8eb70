//! `sliceflow devices`

use serde_json::json;

use super::stdout;
use super::table::Align::{Left, Right};
use super::table::Table;
use crate::error::Result;
use crate::gpu::device;
use crate::output::text::{bytes, count};

/// Lists the adapters that can compute and draw
///
/// Storage buffers are those that one pass can bind. WGPU_BACKEND limits the list to a backend; WGPU_ADAPTER_NAME chooses an adapter where --adapter does not. Fails where
/// there is no adapter at all.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow devices
  sliceflow run green_cube --adapter 0
  WGPU_BACKEND=vulkan sliceflow devices --json";

pub fn main(args: &Args) -> Result<()> {
    let devices = device::list()?;
    if devices.is_empty() {
        return Err(device::none_found());
    }
    if args.json {
        return stdout::print_json(&json!(devices));
    }
    let mut table = Table::new([
        ("index", Right),
        ("name", Left),
        ("kind", Left),
        ("backend", Left),
        ("storage buffers", Right),
        ("one binding", Right),
        ("pass times", Left),
        ("driver", Left),
    ]);
    for device::Listed {
        index,
        identity,
        limits,
        timestamps,
        ..
    } in devices
    {
        table.row([
            index.to_string(),
            identity.name,
            identity.kind.to_owned(),
            identity.backend,
            count(limits.storage_buffers.into()),
            bytes(limits.binding),
            if timestamps { "yes" } else { "no" }.to_owned(),
            format!("{} {}", identity.driver, identity.driver_info),
        ]);
    }
    stdout::print(&table.to_string())
}
