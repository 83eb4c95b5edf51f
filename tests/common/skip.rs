//! What happens to a test that this machine cannot run.

use std::io::Write as _;

/// Reports on standard error that the calling test was skipped, and why; returns `None`. In CI, whose set-up provides
/// everything that can be provided, the test fails instead.
///
/// # Panics
/// When the environment variable CI is set, to anything but nothing, `0` or `false`.
pub fn skipped<T>(why: &str) -> Option<T> {
    let ci = std::env::var("CI").unwrap_or_default();
    assert!(
        ["", "0", "false"].contains(&ci.as_str()),
        "this test must not be skipped in CI: {why}"
    );
    unavailable(why)
}

/// As [`skipped`], for what no set-up can provide: a file that is not published, an idle processor. CI skips the test too.
pub fn unavailable<T>(why: &str) -> Option<T> {
    let name = std::thread::current().name().unwrap_or("a test").to_owned();
    // The test runner captures what the macros print and drops it when the test passes; this line has to be seen.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {name}: {why}");
    None
}
