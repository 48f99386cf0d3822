//! How much memory reading may take.

/// What is assumed of a machine that does not tell how much memory it has, in bytes.
const UNKNOWN: u64 = 8 << 30;

/// Half of the machine's memory, in bytes: what reading a file may take where nothing else is said.
#[must_use]
pub fn half_of_machine() -> u64 {
    let info = rustix::system::sysinfo();
    let unit = u64::from(info.mem_unit.max(1));
    let total = info.totalram.saturating_mul(unit);
    if total == 0 { UNKNOWN / 2 } else { total / 2 }
}

#[cfg(test)]
mod tests {
    #[test]
    fn half_a_machine_is_within_reason() {
        assert!((1 << 26..1 << 50).contains(&super::half_of_machine()));
    }
}
