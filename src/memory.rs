//! How much memory there is.

/// The memory that a solver may take if nobody says otherwise: three quarters of what the machine has,
/// where the system tells it (Linux), and no limit elsewhere. What else runs makes no difference, so that
/// results do not depend on it.
pub(crate) fn default_budget() -> usize {
    total().map_or(usize::MAX, |bytes| bytes / 4 * 3)
}

/// Bytes of memory of the machine.
fn total() -> Option<usize> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let mut lines = text.lines();
    let line = lines.find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: usize = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}
