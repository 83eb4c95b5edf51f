//! Where and when something was measured.

use std::process::Command;

/// One sentence: processor, system, date, version, commit.
pub fn describe() -> String {
    let processors = match std::thread::available_parallelism().map_or(0, usize::from) {
        1 => "1 processor".to_owned(),
        many => format!("{many} processors"),
    };
    let commit = commit().map_or_else(String::new, |commit| format!(", commit {commit}"));
    format!(
        "{}, {processors} for this program, {}; {}; flexdrill {}{commit}.",
        processor().unwrap_or_else(|| "unknown processor".to_owned()),
        system().unwrap_or_else(|| std::env::consts::OS.to_owned()),
        jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M UTC"),
        env!("CARGO_PKG_VERSION"),
    )
}

/// A value of this process's status, as the kernel counts it (kB).
pub fn status_kb(key: &str) -> Option<u64> {
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
