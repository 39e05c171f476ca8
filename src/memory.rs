//! How much memory there is.

/// Bytes that are held at most unless another budget is given: three quarters of the machine's memory,
/// and no limit where the system does not say how much that is.
pub(crate) fn default_budget() -> usize {
    stated("MemTotal:").map_or(usize::MAX, |total| total / 4 * 3)
}

/// Bytes of memory that are free now, where the system says so (Linux).
pub(crate) fn available() -> Option<usize> {
    stated("MemAvailable:")
}

/// Bytes that Linux states under a name.
fn stated(name: &str) -> Option<usize> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let mut lines = text.lines();
    let line = lines.find_map(|line| line.strip_prefix(name))?;
    let kibibytes: usize = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}
