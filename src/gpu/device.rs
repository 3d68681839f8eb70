//! Choosing an adapter and opening its device.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

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

/// Limits that a plan is made for, so that plans need no GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that one storage binding may have.
    pub binding: u64,
    /// Bytes that one buffer may have.
    pub buffer: u64,
    /// Workgroups along one dimension of a dispatch.
    pub groups: u32,
    /// Pixels along one side of a texture.
    pub texture: u32,
}

impl Limits {
    /// What WebGPU promises everywhere.
    pub const PROMISED: Self = Self {
        binding: 128 << 20,
        buffer: 256 << 20,
        groups: 65_535,
        texture: 8192,
    };
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
    lost: Arc<AtomicBool>,
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

/// What is told about an adapter.
#[derive(Debug, Clone, Serialize)]
pub struct Identity {
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    pub backend: String,
    pub driver: String,
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
    /// Bytes that one storage binding may have.
    pub binding_bytes: u64,
    /// Bytes that one buffer may have.
    pub buffer_bytes: u64,
    /// Whether passes can be timed.
    pub timestamps: bool,
}

/// What [`adapters`] are, for people to choose from.
pub fn list() -> Vec<Listed> {
    let listed = |(index, adapter): (usize, wgpu::Adapter)| {
        let limits = adapter.limits();
        Listed {
            index,
            identity: Identity::of(&adapter.get_info()),
            binding_bytes: limits.max_storage_buffer_binding_size,
            buffer_bytes: limits.max_buffer_size,
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        }
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
    pub fn open(choice: &AdapterChoice, checked_shaders: bool) -> Result<Self> {
        let adapter = choose(choice)?;
        let info = adapter.get_info();
        let timestamps = wgpu::Features::TIMESTAMP_QUERY;
        let has_timestamps = adapter.features().contains(timestamps);
        let limits = adapter.limits();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("sliceflow"),
            required_features: adapter.features() & timestamps,
            required_limits: limits.clone(),
            ..Default::default()
        }))
        .map_err(|error| {
            Error::device(
                format!("{} gives no device: {error}", describe(&info)),
                "choose another adapter with --adapter; `sliceflow devices` lists them",
            )
        })?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = lost.clone();
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::Relaxed));
        Ok(Self {
            device,
            queue,
            limits: Limits {
                binding: limits.max_storage_buffer_binding_size,
                buffer: limits.max_buffer_size,
                groups: limits.max_compute_workgroups_per_dimension,
                texture: limits.max_texture_dimension_2d,
            },
            adapter: info,
            has_timestamps,
            checked_shaders,
            lost,
        })
    }

    /// Whether the adapter computes on the processor.
    pub fn is_software(&self) -> bool {
        self.adapter.device_type == wgpu::DeviceType::Cpu
    }

    /// Waits until the device has done `submission`, or everything when it is `None`.
    pub fn wait(&self, submission: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let waited = self.device.poll(wgpu::PollType::Wait {
            submission_index: submission,
            timeout: None,
        });
        match waited {
            Ok(_) if !self.lost.load(Ordering::Relaxed) => Ok(()),
            _ => Err(Error::device(
                format!("the device was lost: {}", describe(&self.adapter)),
                "finished frames are on disk; run again, with a smaller scene if the device ran out of memory \
                 or out of its watchdog's time",
            )),
        }
    }
}
