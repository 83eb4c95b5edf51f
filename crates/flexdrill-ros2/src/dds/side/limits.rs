//! How much memory the DDS process may take. What the network makes it store is bounded by nothing else.

use rustix::process::{Resource, Rlimit, Signal, setrlimit};

/// Most memory (bytes): a request for more fails, which ends the process.
///
/// One packet may claim a sample of 4 GiB, which the library asks for at once. A tool of 200 stations with a reader that
/// stalls needs 120 MB.
pub(super) const MOST_MEMORY: u64 = 512 << 20;
/// Resident memory (bytes) at which it begins afresh, in order.
const ENOUGH: u64 = 320 << 20;

/// Sets the limits of this process; where the system refuses, the node's own watch still holds.
pub(super) fn set() {
    let most = Rlimit {
        current: Some(MOST_MEMORY),
        maximum: Some(MOST_MEMORY),
    };
    let none = Rlimit {
        current: Some(0),
        maximum: Some(0),
    };
    let _ = setrlimit(Resource::Data, most);
    // It ends by design where memory does; a core file of that tells nothing and fills the disk.
    let _ = setrlimit(Resource::Core, none);
    // Without the node there is nothing to do.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::set_parent_process_death_signal(Some(Signal::KILL));
}

/// Resident memory of this process (bytes); 0 where it cannot be read.
pub(super) fn resident() -> u64 {
    let pages = std::fs::read_to_string("/proc/self/statm")
        .ok()
        .and_then(|text| text.split_whitespace().nth(1)?.parse::<u64>().ok());
    pages.unwrap_or(0) * rustix::param::page_size() as u64
}

/// # Errors
/// When it is time to begin afresh.
pub(super) fn judge(resident: u64) -> Result<(), String> {
    if resident <= ENOUGH {
        return Ok(());
    }
    Err(format!(
        "it holds {} MB, more than {} MB; packets of unknown senders pile up, or readers do not take",
        resident >> 20,
        ENOUGH >> 20
    ))
}
