//! What an adapter allows, what a pass takes of it, and the refusal where that is too much.

use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};

/// Limits that a plan is made for, so that plans need no GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Limits {
    /// Storage buffers that one stage of a pass or a draw binds.
    pub storage_buffers: u32,
    /// Uniform buffers that one stage binds.
    pub uniform_buffers: u32,
    /// Textures that one stage samples.
    pub textures: u32,
    /// Samplers that one stage binds.
    pub samplers: u32,
    /// Resources of all kinds that one pass or draw binds.
    pub bindings: u32,
    /// Bytes that one storage binding may have.
    #[serde(rename = "binding_bytes")]
    pub binding: u64,
    /// Bytes that one uniform binding may have.
    #[serde(rename = "uniform_bytes")]
    pub uniform: u64,
    /// Bytes that one buffer may have.
    #[serde(rename = "buffer_bytes")]
    pub buffer: u64,
    /// Threads of one workgroup.
    pub threads: u32,
    /// Bytes that the threads of one workgroup share.
    pub group_bytes: u32,
    /// Workgroups along one dimension of a dispatch.
    pub groups: u32,
    /// Pixels along one side of a texture.
    #[serde(rename = "texture_pixels")]
    pub texture: u32,
}

/// What a pass or a draw takes of an adapter's limits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Demand {
    /// Storage buffers that one stage binds at most.
    pub storage_buffers: u32,
    /// Uniform buffers that one stage binds at most.
    pub uniform_buffers: u32,
    /// Textures that one stage samples at most.
    pub textures: u32,
    /// Samplers that one stage binds at most.
    pub samplers: u32,
    /// Resources of all kinds that it binds.
    pub bindings: u32,
    /// Threads of one workgroup; 0 for draws.
    pub threads: u32,
    /// Bytes that the threads of one workgroup share.
    pub group_bytes: u32,
}

impl Demand {
    /// The larger of both, limit by limit.
    pub fn or_more(&self, other: &Self) -> Self {
        Self {
            storage_buffers: self.storage_buffers.max(other.storage_buffers),
            uniform_buffers: self.uniform_buffers.max(other.uniform_buffers),
            textures: self.textures.max(other.textures),
            samplers: self.samplers.max(other.samplers),
            bindings: self.bindings.max(other.bindings),
            threads: self.threads.max(other.threads),
            group_bytes: self.group_bytes.max(other.group_bytes),
        }
    }
}

/// The environment variable that lowers limits.
const VARIABLE: &str = "SLICEFLOW_LIMITS";

impl Limits {
    /// What WebGPU promises everywhere; it promises 8 storage buffers, and passes of some scenes that do not ship bind more.
    pub const PROMISED: Self = Self {
        storage_buffers: 32,
        uniform_buffers: 12,
        textures: 16,
        samplers: 16,
        bindings: 1000,
        binding: 128 << 20,
        uniform: 64 << 10,
        buffer: 256 << 20,
        threads: 256,
        group_bytes: 16 << 10,
        groups: 65_535,
        texture: 8192,
    };

    /// Those of an adapter.
    pub fn of(limits: &wgpu::Limits) -> Self {
        Self {
            storage_buffers: limits.max_storage_buffers_per_shader_stage,
            uniform_buffers: limits.max_uniform_buffers_per_shader_stage,
            textures: limits.max_sampled_textures_per_shader_stage,
            samplers: limits.max_samplers_per_shader_stage,
            bindings: limits.max_bindings_per_bind_group,
            binding: limits.max_storage_buffer_binding_size,
            uniform: limits.max_uniform_buffer_binding_size,
            buffer: limits.max_buffer_size,
            threads: limits
                .max_compute_invocations_per_workgroup
                .min(limits.max_compute_workgroup_size_x),
            group_bytes: limits.max_compute_workgroup_storage_size,
            groups: limits.max_compute_workgroups_per_dimension,
            texture: limits.max_texture_dimension_2d,
        }
    }

    /// An adapter's limits with these in their place, so that the device itself refuses what is above them.
    pub fn within(&self, adapter: &wgpu::Limits) -> wgpu::Limits {
        wgpu::Limits {
            max_storage_buffers_per_shader_stage: self.storage_buffers,
            max_uniform_buffers_per_shader_stage: self.uniform_buffers,
            max_sampled_textures_per_shader_stage: self.textures,
            max_samplers_per_shader_stage: self.samplers,
            max_bindings_per_bind_group: self.bindings,
            max_storage_buffer_binding_size: self.binding,
            max_uniform_buffer_binding_size: self.uniform,
            max_buffer_size: self.buffer,
            max_compute_invocations_per_workgroup: self.threads,
            max_compute_workgroup_size_x: self.threads,
            max_compute_workgroup_storage_size: self.group_bytes,
            max_compute_workgroups_per_dimension: self.groups,
            max_texture_dimension_2d: self.texture,
            ..adapter.clone()
        }
    }

    /// The same limits, lowered by what the environment variable `SLICEFLOW_LIMITS` says. It is for developers, who
    /// see with it what users of lesser adapters see: `SLICEFLOW_LIMITS=storage_buffers=8,binding=1MiB`.
    pub fn lowered_by_environment(self) -> Result<Self> {
        match std::env::var(VARIABLE) {
            Ok(text) => self.lowered(&text),
            Err(_) => Ok(self),
        }
    }

    /// The same limits, each no higher than `text` says: `NAME=NUMBER`, with commas between; bytes may have the unit
    /// KiB, MiB or GiB.
    ///
    /// # Errors
    ///
    /// Where `text` is of another form, or names no limit.
    pub fn lowered(mut self, text: &str) -> Result<Self> {
        for one in text.split(',').map(str::trim).filter(|one| !one.is_empty()) {
            let (name, value) = one.split_once('=').unwrap_or((one, ""));
            let mut named = self.named();
            let names: Vec<_> = named.iter().map(|(known, _)| *known).collect();
            let found = named.iter_mut().find(|(known, _)| *known == name.trim());
            match (found, number(value.trim())) {
                (Some((_, Number::Count(limit))), Some(most)) => {
                    **limit = u64::from(**limit).min(most) as u32;
                }
                (Some((_, Number::Bytes(limit))), Some(most)) => **limit = (**limit).min(most),
                _ => {
                    return Err(Error::usage(
                        format!("{VARIABLE} has `{one}`, which lowers no limit"),
                        format!(
                            "write NAME=NUMBER with commas between, such as storage_buffers=8,binding=1MiB; the names are {}",
                            names.join(", ")
                        ),
                    ));
                }
            }
        }
        Ok(self)
    }

    fn named(&mut self) -> [(&'static str, Number<'_>); 12] {
        use Number::{Bytes, Count};
        [
            ("storage_buffers", Count(&mut self.storage_buffers)),
            ("uniform_buffers", Count(&mut self.uniform_buffers)),
            ("textures", Count(&mut self.textures)),
            ("samplers", Count(&mut self.samplers)),
            ("bindings", Count(&mut self.bindings)),
            ("binding", Bytes(&mut self.binding)),
            ("uniform", Bytes(&mut self.uniform)),
            ("buffer", Bytes(&mut self.buffer)),
            ("threads", Count(&mut self.threads)),
            ("group_bytes", Count(&mut self.group_bytes)),
            ("groups", Count(&mut self.groups)),
            ("texture", Count(&mut self.texture)),
        ]
    }

    /// Bytes of the largest storage buffer.
    pub fn largest(&self) -> u64 {
        self.binding.min(self.buffer)
    }

    /// Refuses the first pass or draw that takes more than there is; of several that bind too much, the one that binds
    /// most.
    pub fn check<'a>(&self, demands: impl Iterator<Item = (&'a str, Demand)> + Clone) -> Result<()> {
        /// What is limited, in words with the number in between, and how much of it a demand takes.
        type Row = (&'static str, &'static str, fn(&Demand) -> u32, u32);
        let rows: [Row; 7] = [
            (
                "binds",
                "storage buffers",
                |d| d.storage_buffers,
                self.storage_buffers,
            ),
            (
                "binds",
                "uniform buffers",
                |d| d.uniform_buffers,
                self.uniform_buffers,
            ),
            ("samples", "textures", |d| d.textures, self.textures),
            ("binds", "samplers", |d| d.samplers, self.samplers),
            ("binds", "resources", |d| d.bindings, self.bindings),
            ("runs", "threads in a workgroup", |d| d.threads, self.threads),
            (
                "shares",
                "bytes in a workgroup",
                |d| d.group_bytes,
                self.group_bytes,
            ),
        ];
        for (verb, what, of, limit) in rows {
            let most = demands.clone().max_by_key(|(_, demand)| of(demand));
            if let Some((label, demand)) = most.filter(|(_, demand)| of(demand) > limit) {
                return Err(Error::Limit {
                    what: format!("pass `{label}` {verb} {} {what}; this adapter allows {limit}", of(&demand)),
                    help: "choose another adapter with --adapter; `sliceflow devices` lists them and what they allow"
                        .into(),
                });
            }
        }
        Ok(())
    }
}

/// A limit to be lowered.
enum Number<'a> {
    Count(&'a mut u32),
    Bytes(&'a mut u64),
}

/// `8`, `64KiB`, `1 MiB`, `2GiB`
fn number(text: &str) -> Option<u64> {
    let units = [("KiB", 10), ("MiB", 20), ("GiB", 30)];
    let (digits, shift) = units
        .iter()
        .find_map(|&(unit, shift)| Some((text.strip_suffix(unit)?, shift)))
        .unwrap_or((text, 0));
    digits.trim().parse::<u64>().ok()?.checked_mul(1 << shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_lowered_and_never_raised() {
        let lowered = Limits::PROMISED
            .lowered(" storage_buffers=4, binding=1 MiB,buffer=999GiB, threads=64,")
            .unwrap();
        let expected = Limits {
            storage_buffers: 4,
            binding: 1 << 20,
            threads: 64,
            ..Limits::PROMISED
        };
        assert_eq!(lowered, expected);
        for wrong in [
            "storage=4",
            "storage_buffers",
            "storage_buffers=-1",
            "binding=1MB",
            "=3",
        ] {
            let error = Limits::PROMISED.lowered(wrong).unwrap_err().to_string();
            assert!(error.contains(wrong) && error.contains("group_bytes"), "{error}");
        }
    }

    #[test]
    fn lowered_limits_reach_the_device() {
        let adapter = wgpu::Limits::default();
        let mut lowered = Limits::of(&adapter);
        for (_, number) in lowered.named() {
            match number {
                Number::Count(limit) => *limit -= 1,
                Number::Bytes(limit) => *limit -= 1,
            }
        }
        assert_eq!(Limits::of(&lowered.within(&adapter)), lowered);
    }

    #[test]
    fn the_pass_that_takes_most_is_refused() {
        let taking = |storage_buffers, threads| Demand {
            storage_buffers,
            threads,
            ..Default::default()
        };
        let passes = [
            ("few", taking(3, 64)),
            ("more", taking(9, 64)),
            ("most", taking(11, 64)),
        ];
        let limits = Limits {
            storage_buffers: 8,
            ..Limits::PROMISED
        };
        let text = limits.check(passes.into_iter()).unwrap_err().to_string();
        assert!(
            text.starts_with("pass `most` binds 11 storage buffers; this adapter allows 8"),
            "{text}"
        );
        assert!(limits.check([("fits", taking(8, 256))].into_iter()).is_ok());
        let error = limits.check([("wide", taking(1, 257))].into_iter()).unwrap_err();
        assert!(
            error.to_string().contains("257 threads in a workgroup"),
            "{error}"
        );
    }
}
