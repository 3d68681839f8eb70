//! How much memory the program takes.

/// The most that was resident at once since the program began, in bytes. Only Linux says it without further libraries.
pub fn peak_resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn the_peak_sees_what_was_taken_and_given_back() {
        let before = peak_resident_bytes().unwrap();
        let taken = before as usize + (1 << 20);
        assert_eq!(
            vec![1u8; taken]
                .iter()
                .map(|&byte| usize::from(byte))
                .sum::<usize>(),
            taken
        );
        assert!(peak_resident_bytes().unwrap() >= taken as u64);
    }
}
