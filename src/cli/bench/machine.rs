//! Where and when something was measured.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// One sentence: processor, system, date, version, commit.
pub(super) fn describe() -> String {
    let processors = match std::thread::available_parallelism().map_or(0, usize::from) {
        1 => "1 processor".to_owned(),
        many => format!("{many} processors"),
    };
    let commit = commit().map_or_else(String::new, |commit| format!(", commit {commit}"));
    format!(
        "{}, {processors} for this program, {}; {}; flexdrill {}{commit}.",
        processor().unwrap_or_else(|| "unknown processor".to_owned()),
        system().unwrap_or_else(|| std::env::consts::OS.to_owned()),
        date(SystemTime::now()),
        env!("CARGO_PKG_VERSION"),
    )
}

/// A value of this process's status, as the kernel counts it (kB).
pub(super) fn status_kb(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(key))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

fn processor() -> Option<String> {
    let info = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let value = |key: &str| {
        let line = info.lines().find(|line| line.starts_with(key))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let widest = ["avx512f", "avx2"]
        .into_iter()
        .find(|flag| info.contains(flag))
        .map_or_else(String::new, |flag| format!(", {flag}"));
    Some(format!(
        "{} (family {}, model {}{widest})",
        value("model name")?,
        value("cpu family")?,
        value("model\t")?
    ))
}

fn system() -> Option<String> {
    let release = std::fs::read_to_string("/proc/sys/kernel/osrelease").ok()?;
    Some(format!("Linux {}", release.trim()))
}

/// Of the working folder, with a mark if it has changes.
fn commit() -> Option<String> {
    let output = Command::new("git")
        .args(["describe", "--always", "--dirty"])
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
}

/// Day and minute, UTC.
fn date(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (mut day, mut year) = (seconds / 86_400, 1970);
    let leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    while day >= 365 + u64::from(leap(year)) {
        day -= 365 + u64::from(leap(year));
        year += 1;
    }
    let mut month = 1;
    for length in [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if day < length {
            break;
        }
        day -= length;
        month += 1;
    }
    format!(
        "{year}-{month:02}-{:02} {:02}:{:02} UTC",
        day + 1,
        seconds / 3600 % 24,
        seconds / 60 % 60
    )
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let at = |seconds| date(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01 00:00 UTC");
        // `date -u -d @...` of coreutils.
        assert_eq!(at(951_782_400), "2000-02-29 00:00 UTC");
        assert_eq!(at(1_735_689_599), "2024-12-31 23:59 UTC");
        assert_eq!(at(1_735_689_600), "2025-01-01 00:00 UTC");
    }
}
