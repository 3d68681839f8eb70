//! The argument of every command that computes on a device.

use crate::gpu::AdapterChoice;

#[derive(clap::Args)]
pub struct DeviceArgs {
    /// Adapter, by index or part of its name (see `sliceflow devices`)
    #[arg(long, value_name = "NAME|INDEX")]
    adapter: Option<String>,
}

impl DeviceArgs {
    pub fn adapter(&self) -> AdapterChoice {
        self.adapter
            .as_deref()
            .map(AdapterChoice::parse)
            .unwrap_or_default()
    }
}
