//! What is known about drivers.

/// Mesa's first version whose software driver reads storage buffers fast: 22.3 and before go through the stack for each
/// component of each lane.
const FAST_MESA: u32 = 25;

/// A warning, where the adapter's driver is known to be slow and a faster one exists.
pub fn slow(adapter: &wgpu::AdapterInfo) -> Option<String> {
    let version = mesa_version(&adapter.driver, &adapter.driver_info)?;
    let major: u32 = version.split('.').next()?.parse().ok()?;
    (major < FAST_MESA).then(|| {
        format!(
            "the software driver of Mesa {version} computes 2 to 4 times slower than that of Mesa {FAST_MESA}; \
             start ./sliceflow, which fetches a newer one beside the system's where the distribution has one, or \
             install Mesa {FAST_MESA}"
        )
    })
}

/// The version of Mesa's software driver; `None` of any other driver.
fn mesa_version<'a>(driver: &str, driver_info: &'a str) -> Option<&'a str> {
    let version = driver_info
        .strip_prefix("Mesa ")
        .filter(|_| driver == "llvmpipe")?;
    version.split([' ', '-']).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_mesa() {
        for (driver, info, expected) in [
            ("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)", Some("22.3.6")),
            ("llvmpipe", "Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", Some("25.0.7")),
            ("llvmpipe", "Mesa 26.0.0-devel (git-1234567890)", Some("26.0.0")),
            ("radv", "Mesa 22.3.6", None),
            ("SwiftShader driver", "SwiftShader driver-5.0.0", None),
            ("NVIDIA", "570.86.15", None),
        ] {
            assert_eq!(mesa_version(driver, info), expected, "{info}");
        }
    }

    #[test]
    fn old_software_drivers_are_slow() {
        let adapter = |driver: &str, info: &str| {
            let mut adapter = wgpu::AdapterInfo::new(wgpu::DeviceType::Cpu, wgpu::Backend::Vulkan);
            (adapter.driver, adapter.driver_info) = (driver.into(), info.into());
            adapter
        };
        let warning = slow(&adapter("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)")).unwrap();
        assert!(
            warning.contains("22.3.6") && warning.contains("./sliceflow"),
            "{warning}"
        );
        for (driver, info) in [
            ("llvmpipe", "Mesa 25.0.0"),
            ("llvmpipe", "LLVM"),
            ("llvmpipe", "Mesa ?"),
            ("radv", "Mesa 20"),
        ] {
            assert_eq!(slow(&adapter(driver, info)), None, "{info}");
        }
    }
}
