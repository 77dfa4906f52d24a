// SPDX-License-Identifier: BSD-3-Clause
//! Memory that is still to be had, found before a large piece of it is taken.
//!
//! An allocation that fails ends a Rust program at once, so the large ones are judged first: by
//! the limit of the process, by that of its control group and by what the machine has free.

use std::fmt;
use std::fs;

use super::allocator;

/// Left over for everything that is not looked for: buffers, stacks of threads, the writer.
const RESERVE: u64 = 48 << 20;

/// Addresses that the heaps of two threads (the writer, the first of a pool) set aside unused.
const HEAPS: u64 = 128 << 20;

/// Addresses of one thread: its stack and heap.
const THREAD: u64 = 72 << 20;

/// A job that needs more memory than there is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shortage {
    job: String,
    /// Bytes, where they are known beforehand.
    needed: Option<u64>,
    free: Option<u64>,
}

impl Shortage {
    /// An allocation that failed.
    pub fn met(job: String) -> Self {
        Self { job, needed: None, free: free() }
    }
}

impl fmt::Display for Shortage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mega = |bytes: u64| bytes.div_ceil(1 << 20);
        write!(f, "not enough memory for {}: ", self.job)?;
        if let Some(needed) = self.needed {
            write!(f, "it takes about {} MB, ", mega(needed.saturating_add(RESERVE)))?;
        }
        if let Some(free) = self.free {
            write!(f, "{} MB are free; ", mega(free))?;
        }
        f.write_str("use a coarser mesh or a larger machine")
    }
}

/// Refuses to go on where an allocation has failed and memory is still short.
///
/// # Errors
///
/// If the reserve of the allocator is gone.
pub fn require_reserve() -> Result<(), Shortage> {
    if allocator::keep_reserve() { Ok(()) } else { Err(Shortage::met("this job".into())) }
}

/// Refuses a job of so many bytes if they, and a reserve, are not to be had.
///
/// Where the system does not say what is free (anything but Linux) every job is let through.
pub fn require(bytes: usize, job: impl FnOnce() -> String) -> Result<(), Shortage> {
    let needed = bytes as u64;
    require_reserve()?;
    match free() {
        Some(free) if needed.saturating_add(RESERVE) > free => {
            Err(Shortage { job: job(), needed: Some(needed), free: Some(free) })
        }
        _ => Ok(()),
    }
}

/// Bytes that this process may still take, if the system tells.
pub fn free() -> Option<u64> {
    [of_process(), of_group(), of_machine()].into_iter().flatten().min()
}

/// Whether so many threads can set their addresses aside; their memory is taken only where used.
pub fn has_room_for(threads: usize) -> bool {
    of_process().is_none_or(|free| free >= RESERVE + THREAD * threads as u64)
}

/// Up to the limit of the address space (`ulimit -v`).
fn of_process() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find(|l| l.starts_with("Max address space"))?;
    let limit: u64 = line.split_whitespace().nth(3)?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some(limit.saturating_sub(kilobytes(&status, "VmSize:")? + HEAPS))
}

/// Free or soon given back on the whole machine, with what can be swapped out.
fn of_machine() -> Option<u64> {
    let info = fs::read_to_string("/proc/meminfo").ok()?;
    Some(kilobytes(&info, "MemAvailable:")? + kilobytes(&info, "SwapFree:").unwrap_or(0))
}

/// Up to the limit of the control group, of either version and any level above.
fn of_group() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    let mut least = None;
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?);
        let (root, limit, used) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max", "memory.current"),
            "memory" => ("/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes"),
            _ => continue,
        };
        for group in std::path::Path::new(path).ancestors() {
            let folder = format!("{root}{}", group.display());
            let read = |name: &str| fs::read_to_string(format!("{folder}/{name}")).ok();
            let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
            let (Some(limit), Some(used)) = (number(limit), number(used)) else { continue };
            // Pages of files are given back before a process is refused.
            let stat = read("memory.stat").unwrap_or_default();
            let pages = cached(&stat, "total_").or_else(|| cached(&stat, "")).unwrap_or(0);
            let left = limit.saturating_sub(used.saturating_sub(pages));
            least = Some(least.map_or(left, |l: u64| l.min(left)));
        }
    }
    least
}

/// Bytes of files that a control group holds in memory, of the lines with a prefix.
fn cached(stat: &str, prefix: &str) -> Option<u64> {
    let value = |name: &str| {
        let mut words = stat.lines().map(|l| l.split(' '));
        words.find_map(|mut w| (w.next()? == format!("{prefix}{name}")).then(|| w.next())?)
    };
    let bytes = |name: &str| value(name)?.parse::<u64>().ok();
    Some(bytes("inactive_file")? + bytes("active_file")?)
}

/// Value of a line `name   number kB`, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find(|l| l.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|k| k << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_let_through_and_everything_refused() {
        assert_eq!(require(0, String::new), Ok(()));
        let refused = require(usize::MAX, || "a test".into());
        if free().is_some() {
            let text = refused.unwrap_err().to_string();
            assert!(text.starts_with("not enough memory for a test: it takes about"), "{text}");
        }
    }

    #[test]
    fn a_large_block_shows_in_what_is_left() {
        assert_eq!(kilobytes("VmSize:\t  12 kB\n", "VmSize:"), Some(12 << 10));
        assert_eq!(kilobytes("VmSize:\t  12 kB\n", "VmPeak:"), None);
    }

    #[test]
    fn pages_of_files_are_free() {
        let stat = "cache 9\ninactive_file 3\nactive_file 4\ntotal_inactive_file 30\n\
                    total_active_file 40\n";
        assert_eq!(cached(stat, "total_"), Some(70));
        assert_eq!(cached(stat, ""), Some(7));
        assert_eq!(cached("anon 5\n", ""), None);
    }
}
