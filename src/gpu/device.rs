//! Choosing an adapter and opening its device.

use schemars::JsonSchema;
use serde::Serialize;

use super::fault::{Faults, made, quietly};
pub use super::limits::Limits;
use super::pass::Kernels;
use crate::error::{Error, Result};

/// Which adapter to use: the best one, one by its index in `sliceflow devices`, or one by part of its name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// `WGPU_ADAPTER_NAME` where it is set, otherwise discrete before integrated before software.
    #[default]
    Best,
    Index(usize),
    Name(String),
}

impl AdapterChoice {
    /// Reads what a user writes behind `--adapter`.
    pub fn parse(text: &str) -> Self {
        text.parse()
            .map_or_else(|_| Self::Name(text.to_owned()), Self::Index)
    }
}

/// An open device with what the rest of the program asks about it; clones share the device.
#[derive(Clone)]
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::AdapterInfo,
    pub limits: Limits,
    /// Whether passes can be timed.
    pub has_timestamps: bool,
    /// Whether shaders are compiled with bounds checks and bounded loops (tests) or without (release).
    pub checked_shaders: bool,
    pub(super) kernels: Kernels,
    faults: Faults,
}

/// Every adapter that the backends named by `WGPU_BACKEND` (all, when unset) offer.
pub fn adapters() -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle().with_env();
    // Validation layers are not ours to install, and their absence is no news to a user.
    descriptor.flags = wgpu::InstanceFlags::empty().with_env();
    let backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
    let instance = wgpu::Instance::new(descriptor);
    pollster::block_on(instance.enumerate_adapters(backends))
}

/// What names an adapter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Identity {
    /// The adapter's name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// Name of the driver.
    pub driver: String,
    /// Version of the driver.
    pub driver_info: String,
}

impl Identity {
    pub fn of(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::Other => "other",
        };
        Self {
            name: info.name.clone(),
            kind,
            backend: info.backend.to_string(),
            driver: info.driver.clone(),
            driver_info: info.driver_info.clone(),
        }
    }
}

/// One row of `sliceflow devices`.
#[derive(Debug, Clone, Serialize)]
pub struct Listed {
    pub index: usize,
    #[serde(flatten)]
    pub identity: Identity,
    #[serde(flatten)]
    pub limits: Limits,
    /// Whether passes can be timed.
    pub timestamps: bool,
}

/// What [`adapters`] are, for people to choose from.
///
/// # Errors
///
/// Where `SLICEFLOW_LIMITS` makes no sense.
pub fn list() -> Result<Vec<Listed>> {
    let listed = |(index, adapter): (usize, wgpu::Adapter)| {
        Ok(Listed {
            index,
            identity: Identity::of(&adapter.get_info()),
            limits: Limits::of(&adapter.limits()).lowered_by_environment()?,
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        })
    };
    adapters().into_iter().enumerate().map(listed).collect()
}

/// One line an adapter, as messages name them.
pub fn describe(info: &wgpu::AdapterInfo) -> String {
    let Identity {
        name,
        kind,
        backend,
        driver,
        driver_info,
    } = Identity::of(info);
    format!(
        "{name} ({kind}, {backend}, {})",
        format!("{driver} {driver_info}").trim()
    )
}

/// The error for a machine without a driver.
pub fn none_found() -> Error {
    Error::device(
        "no graphics adapter answers",
        "install a Vulkan driver; for software rendering on Debian or Ubuntu: \
         apt-get install libvulkan1 mesa-vulkan-drivers (./sliceflow does this for you). \
         If WGPU_BACKEND is set, check that it names a backend of this machine",
    )
}

fn choose(choice: &AdapterChoice) -> Result<wgpu::Adapter> {
    let mut found = adapters();
    if found.is_empty() {
        return Err(none_found());
    }
    let list = || {
        let lines: Vec<String> = found
            .iter()
            .enumerate()
            .map(|(i, adapter)| format!("{i}: {}", describe(&adapter.get_info())))
            .collect();
        format!("choose one of: {}", lines.join("; "))
    };
    let by_name = |name: &str| {
        let name = name.to_lowercase();
        let position = found
            .iter()
            .position(|a| a.get_info().name.to_lowercase().contains(&name));
        position.ok_or_else(|| Error::device(format!("no adapter is named `{name}`"), list()))
    };
    let index = match choice {
        AdapterChoice::Index(index) if *index < found.len() => *index,
        AdapterChoice::Index(index) => {
            return Err(Error::device(format!("there is no adapter {index}"), list()));
        }
        AdapterChoice::Name(name) => by_name(name)?,
        AdapterChoice::Best => match std::env::var("WGPU_ADAPTER_NAME") {
            Ok(name) => by_name(&name)?,
            Err(_) => {
                let rank = |adapter: &wgpu::Adapter| match adapter.get_info().device_type {
                    wgpu::DeviceType::DiscreteGpu => 0,
                    wgpu::DeviceType::IntegratedGpu => 1,
                    wgpu::DeviceType::VirtualGpu => 2,
                    wgpu::DeviceType::Other => 3,
                    wgpu::DeviceType::Cpu => 4,
                };
                (0..found.len()).min_by_key(|&i| rank(&found[i])).unwrap_or(0)
            }
        },
    };
    Ok(found.swap_remove(index))
}

impl Gpu {
    /// Opens a device with everything that its adapter allows.
    ///
    /// # Errors
    ///
    /// Where there is no such adapter, it cannot compute, it gives no device, or `SLICEFLOW_LIMITS` makes no sense.
    pub fn open(choice: &AdapterChoice, checked_shaders: bool) -> Result<Self> {
        Self::open_within(choice, checked_shaders, Limits::lowered_by_environment)
    }

    /// Opens a device with the limits that `lower` makes of its adapter's.
    ///
    /// # Errors
    ///
    /// Where there is no such adapter, it cannot compute, it gives no device, or `lower` fails.
    pub fn open_within(
        choice: &AdapterChoice,
        checked_shaders: bool,
        lower: impl FnOnce(Limits) -> Result<Limits>,
    ) -> Result<Self> {
        let adapter = choose(choice)?;
        let info = adapter.get_info();
        let another = "choose another adapter with --adapter; `sliceflow devices` lists them";
        let needed = wgpu::DownlevelFlags::COMPUTE_SHADERS | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
        if !adapter.get_downlevel_capabilities().flags.contains(needed) {
            return Err(Error::device(
                format!("{} cannot compute", describe(&info)),
                another,
            ));
        }
        let timestamps = wgpu::Features::TIMESTAMP_QUERY;
        let has_timestamps = adapter.features().contains(timestamps);
        let offered = adapter.limits();
        let limits = lower(Limits::of(&offered))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("sliceflow"),
            required_features: adapter.features() & timestamps,
            required_limits: limits.within(&offered),
            ..Default::default()
        }))
        .map_err(|error| Error::device(format!("{} gives no device: {error}", describe(&info)), another))?;
        Ok(Self {
            faults: Faults::watch(&device),
            kernels: Kernels::default(),
            device,
            queue,
            limits,
            adapter: info,
            has_timestamps,
            checked_shaders,
        })
    }

    /// Whether the adapter computes on the processor.
    pub fn is_software(&self) -> bool {
        self.adapter.device_type == wgpu::DeviceType::Cpu
    }

    /// Makes something on the device.
    ///
    /// # Errors
    ///
    /// Where memory is full, and where the device or the driver refuses it; the message calls it `what`.
    pub fn make<T>(&self, what: impl FnOnce() -> String, make: impl FnOnce(&wgpu::Device) -> T) -> Result<T> {
        made(&self.device, what, make)
    }

    /// Has the device do what was recorded.
    ///
    /// # Errors
    ///
    /// What went wrong on the device so far.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) -> Result<wgpu::SubmissionIndex> {
        let submission = self.queue.submit([encoder.finish()]);
        self.check()?;
        Ok(submission)
    }

    /// Waits until the device has done `submission`, or everything when it is `None`.
    ///
    /// # Errors
    ///
    /// What went wrong on the device so far.
    pub fn wait(&self, submission: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let wait = wgpu::PollType::Wait {
            submission_index: submission,
            timeout: None,
        };
        // wgpu panics where the driver loses the device while it is waited for.
        let waited = quietly(|| self.device.poll(wait));
        self.check()?;
        let why = match waited {
            Some(Ok(_)) => return Ok(()),
            Some(Err(why)) => why.to_string(),
            None => String::new(),
        };
        self.faults.keep_loss(why);
        self.check()
    }

    /// What went wrong on the device so far.
    fn check(&self) -> Result<()> {
        self.faults.check(|| describe(&self.adapter))
    }
}
