//! How much memory there is.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};

use crate::Error;

/// Addresses that threads reserve to allocate from, and a program itself, without taking memory \[bytes\]: measured
/// with two threads and rounded up.
const RESERVED: usize = 256 << 20;

/// Bytes that a path may hold, and those that it holds whatever the number of nodes in contact, in proportion to
/// the grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Memory {
    pub(crate) budget: usize,
    pub(crate) fixed: usize,
}

impl Memory {
    /// The memory budget of updater and iterations.
    pub(crate) fn left(&self) -> usize {
        self.budget.saturating_sub(self.fixed)
    }

    /// `Ok` if `needed` bytes beside the fixed ones are within the budget; `fit` nodes in contact are.
    pub(crate) fn check(&self, needed: usize, fit: usize) -> Result<(), Error> {
        let needed = needed.saturating_add(self.fixed);
        if needed <= self.budget {
            return Ok(());
        }
        Err(Error::MemoryBudget { needed, budget: self.budget, nodes_that_fit: fit })
    }

    /// An error of the updater, which knows only of what is left to it, in terms of the whole.
    pub(crate) fn in_all(&self, error: Error) -> Error {
        match error {
            Error::MemoryBudget { needed, nodes_that_fit, .. } => Error::MemoryBudget {
                needed: needed.saturating_add(self.fixed),
                budget: self.budget,
                nodes_that_fit,
            },
            other => other,
        }
    }
}

/// The memory that a solver may take if nobody says otherwise: three quarters of what the process may use, where the
/// system tells it (Linux), and no limit elsewhere. That is the least of the memory of the machine, the limits of its
/// control groups (containers, batch systems) and the limit of its address space (`ulimit -v`). What else runs makes no
/// difference, so that results do not depend on it.
pub fn default_budget() -> usize {
    let of_machine = read_to_string("/proc/meminfo").ok().and_then(|text| total(&text));
    let of_groups = read_to_string("/proc/self/cgroup").ok();
    let of_groups = of_groups.and_then(|text| of_groups_in(Path::new("/sys/fs/cgroup"), &text));
    let of_addresses = read_to_string("/proc/self/limits").ok();
    let of_addresses = of_addresses.and_then(|text| address_space(&text));
    let least = [of_machine, of_groups, of_addresses].into_iter().flatten().min();
    least.map_or(usize::MAX, |bytes| bytes / 4 * 3)
}

/// Bytes of memory of the machine, from `/proc/meminfo`.
fn total(text: &str) -> Option<usize> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: usize = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

/// Bytes of the address space less those that are only reserved, from `/proc/self/limits`; `None` without a limit.
fn address_space(text: &str) -> Option<usize> {
    let line = text.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let bytes: usize = line.split_whitespace().next()?.parse().ok()?;
    Some(bytes.saturating_sub(RESERVED))
}

/// The least limit of the control groups that `/proc/self/cgroup` names, and of those around them, below the folder
/// where the system shows them. A container shows its own group as the root.
fn of_groups_in(root: &Path, text: &str) -> Option<usize> {
    let limits = text.lines().flat_map(|line| {
        let mut parts = line.splitn(3, ':');
        let (Some(_), Some(controllers), Some(path)) = (parts.next(), parts.next(), parts.next())
        else {
            return Vec::new();
        };
        // The second version has one hierarchy without a name, and the first one of its own for memory.
        let (root, file) = match controllers {
            "" => (root.to_path_buf(), "memory.max"),
            _ => (root.join("memory"), "memory.limit_in_bytes"),
        };
        let is_of_memory = controllers.is_empty() || controllers.split(',').any(|c| c == "memory");
        let group = root.join(path.trim_start_matches('/'));
        let around = group.ancestors().take_while(|folder| folder.starts_with(&root));
        let files = around.map(|folder| folder.join(file)).filter(|_| is_of_memory);
        files.collect::<Vec<PathBuf>>()
    });
    // Without a limit the second version says `max`, and the first a number beyond all memory.
    limits.filter_map(|file| read_to_string(file).ok()?.trim().parse().ok()).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_from_what_the_system_says() {
        assert_eq!(total("MemFree: 1 kB\nMemTotal:       24576 kB\n"), Some(24576 << 10));
        assert_eq!(total("MemTotal: many kB"), None);
        let limits = |value: &str| {
            format!(
                "Limit  Soft Limit  Hard Limit  Units\nMax address space  {value}  unlimited  bytes\n"
            )
        };
        assert_eq!(address_space(&limits("3072000000")), Some(3_072_000_000 - RESERVED));
        assert_eq!(address_space(&limits("1000")), Some(0));
        assert_eq!(address_space(&limits("unlimited")), None);
        assert_eq!(address_space(""), None);
    }

    /// The group itself has no limit, and the one around it has; in a container only the root is there.
    #[test]
    fn the_tightest_group_counts() -> std::io::Result<()> {
        let root = std::env::temp_dir().join(format!("asperity-groups-{}", std::process::id()));
        let write = |file: &str, text: &str| {
            let file = root.join(file);
            file.parent().map_or(Ok(()), std::fs::create_dir_all)?;
            std::fs::write(file, text)
        };
        assert_eq!(of_groups_in(&root, "0::/job/step"), None);
        write("job/step/memory.max", "max\n")?;
        assert_eq!(of_groups_in(&root, "0::/job/step"), None);
        write("job/memory.max", "5000000\n")?;
        assert_eq!(of_groups_in(&root, "0::/job/step"), Some(5_000_000));
        write("memory.max", "4000000\n")?;
        assert_eq!(of_groups_in(&root, "0::/job/step"), Some(4_000_000));
        assert_eq!(of_groups_in(&root, "0::/elsewhere\n"), Some(4_000_000));
        write("memory/old/memory.limit_in_bytes", "3000000\n")?;
        let old = "5:cpu,cpuacct:/old\n4:memory,hugetlb:/old\n";
        assert_eq!(of_groups_in(&root, old), Some(3_000_000));
        assert_eq!(of_groups_in(&root, "5:cpu,cpuacct:/old\nno line of a group\n"), None);
        std::fs::remove_dir_all(&root)
    }
}
