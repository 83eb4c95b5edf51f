//! The memory limit of the DDS process. The library itself does not limit what packets make it store.

use rustix::process::{Resource, Rlimit, Signal, setrlimit};

/// Most memory (bytes). A larger allocation fails, which ends the process.
///
/// One packet can announce a sample of 4 GiB, which the library allocates at once. A tool of 200 stations with a stalled
/// reader needs 120 MB.
pub(super) const MOST_MEMORY: u64 = 512 << 20;
/// Resident memory (bytes) at which the process ends in order, to be restarted.
const RESTART_AT: u64 = 320 << 20;

/// Sets the limits of this process. Where the system refuses them, the supervision by the node remains.
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
    // The process ends by design at the limit; a core file of that would fill the disk for nothing.
    let _ = setrlimit(Resource::Core, none);
    // The process must not outlive the node.
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
/// When the process must be restarted.
pub(super) fn judge(resident: u64) -> Result<(), String> {
    if resident <= RESTART_AT {
        return Ok(());
    }
    Err(format!(
        "it uses {} MB, more than {} MB; packets of unknown senders accumulate, or readers do not acknowledge samples",
        resident >> 20,
        RESTART_AT >> 20
    ))
}
