//! No peer can fill the log: every log line has the limit of `flexdrill_text::log_ending`, whose ending `{more}` stands in
//! its text, or is in the list of lines that no peer repeats.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Lines without a limit: file, a part of the text, and why no peer repeats it.
const ALLOWED: &[(&str, &str, &str)] = &[
    ("src/node/alarms.rs", "all alarms begin as normal", "once, at the start"),
    ("src/node/alarms.rs", "|error: StateError|", "once, at the start"),
    (
        "src/node/inputs.rs",
        "the model assumes",
        "once per input, at the start",
    ),
    (
        "src/node/host.rs",
        "it follows no further",
        "once: the following ends with it",
    ),
    ("src/node/prepare.rs", "live at ws://", "once, at the start"),
    (
        "src/node/prepare.rs",
        "the token is sent unencrypted",
        "configuration, once, at the start",
    ),
    ("src/node/prepare.rs", "model time runs", "once, at the start"),
    (
        "crates/flexdrill-session/src/ensemble/running.rs",
        "{why}",
        "once, at the start",
    ),
    (
        "crates/flexdrill-session/src/ensemble/running.rs",
        "plausible tools run with the twin",
        "once, at the start",
    ),
    ("src/node/running.rs", "the configured duration", "once, at the end"),
    ("src/node/running.rs", "the node ends without it", "once, at the end"),
    ("src/node/publish.rs", "did not reach the viewers", "once, at the end"),
    ("src/state_file.rs", "tracing::warn!(\"{error}\")", "once, at the start"),
    ("src/state_file.rs", "does not answer", "once, at the end"),
    ("src/node/surveys.rs", "", "once, at the start"),
    ("src/node/life.rs", "does not answer", "once, at the end"),
    ("src/cli/", "{note}", "notes on the environment, once, at the start"),
    ("src/cli/bridge/", "password", "configuration, once, at the start"),
    (
        "src/cli/bridge/keys.rs",
        "the terminal cannot be read",
        "once, at the start",
    ),
    (
        "src/bridge/wits.rs",
        "no source waits for a confirmation",
        "once per key that a person presses",
    ),
    (
        "src/cli/bridge/mqtt.rs",
        "Sparkplug session is not kept",
        "once, at the start",
    ),
    (
        "src/cli/bridge/mqtt.rs",
        "{error}",
        "a file of this machine, once, at the start",
    ),
    (
        "src/cli/replay/show.rs",
        "fault.to_string()",
        "files of a folder, once per bag",
    ),
    (
        "crates/flexdrill-dashboard/src/recorded.rs",
        "fault.to_string()",
        "files of a folder, once per bag",
    ),
    (
        "src/bridge/wits.rs",
        "the capture ends",
        "once: the capture ends with it",
    ),
    (
        "crates/flexdrill-bag/src/failover.rs",
        "the recording",
        "the disk's doing, with growing waits between attempts",
    ),
    (
        "crates/flexdrill-dashboard/src/recorded.rs",
        "read the whole bag",
        "once per bag",
    ),
    (
        "crates/flexdrill-live/src/server.rs",
        "can read the live data",
        "configuration, once, at the start",
    ),
    (
        "crates/flexdrill-live/src/server.rs",
        "the live server ended",
        "once, at the end",
    ),
    (
        "crates/flexdrill-live/src/hub.rs",
        "is not offered to viewers",
        "once per topic, at the start",
    ),
    (
        "crates/flexdrill-ros2/src/dds/port/child.rs",
        "tracing::error!(\"{text}\")",
        "limited in the DDS process",
    ),
    (
        "crates/flexdrill-ros2/src/dds/port/child.rs",
        "tracing::warn!(\"{text}\")",
        "limited in the DDS process",
    ),
    (
        "crates/flexdrill-ros2/src/dds/port/child.rs",
        "tracing::info!(\"{text}\")",
        "limited in the DDS process",
    ),
    (
        "crates/flexdrill-ros2/src/dds/port/keeper.rs",
        "DDS is restarted",
        "growing pauses between lives",
    ),
    (
        "crates/flexdrill-ros2/src/dds/side/graph.rs",
        "could not be announced",
        "limited in the DDS process",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The calls of the log's macros in a source, each as it stands there. Tests at the end of a file are left out.
fn calls(source: &str) -> Vec<&str> {
    let product = source.split("#[cfg(test)]").next().unwrap_or(source);
    let mut found = Vec::new();
    for (at, _) in product.match_indices("!(") {
        let begin = product[..at]
            .rfind(|c: char| !(c.is_alphanumeric() || c == ':' || c == '_'))
            .map_or(0, |at| at + 1);
        let name = &product[begin..at];
        let is_log = ["info", "warn", "error"]
            .iter()
            .any(|level| name == *level || name == format!("tracing::{level}") || name == format!("log::{level}"));
        // Up to the bracket that closes it. Brackets in texts come in pairs.
        let mut depth = 0;
        let end = product[at + 1..].char_indices().find(|(_, c)| {
            depth += match c {
                '(' => 1,
                ')' => -1,
                _ => 0,
            };
            depth == 0
        });
        if let Some((end, _)) = end.filter(|_| is_log) {
            found.push(&product[begin..at + end + 2]);
        }
    }
    found
}

#[test]
fn every_log_line_that_a_peer_can_cause_has_a_limit() {
    let mut paths = Vec::new();
    sources(&root().join("src"), &mut paths);
    for entry in std::fs::read_dir(root().join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        // RustDDS's own lines pass the limit of the DDS process.
        if folder.join("src").exists() && !folder.ends_with("rustdds") {
            sources(&folder.join("src"), &mut paths);
        }
    }
    let (mut unlimited, mut used) = (Vec::new(), BTreeSet::new());
    let mut lines = 0;
    for path in paths {
        let source = std::fs::read_to_string(&path).unwrap();
        let file = path.strip_prefix(root()).unwrap().display().to_string();
        let product = source.split("#[cfg(test)]").next().unwrap_or(&source).to_owned();
        for call in calls(&product) {
            lines += 1;
            if call.contains("{more}") {
                continue;
            }
            let at = product.find(call).unwrap_or(0);
            let begin = product[..at].rfind('\n').map_or(0, |at| at + 1);
            // With what stands before it in its line.
            let text = &product[begin..at + call.len()];
            match ALLOWED
                .iter()
                .position(|(place, part, _)| file.starts_with(place) && text.contains(part))
            {
                Some(index) => drop(used.insert(index)),
                None => unlimited.push(format!("{file}: {call}")),
            }
        }
    }
    assert!(lines > 60, "only {lines} log lines were found");
    assert!(
        unlimited.is_empty(),
        "log lines without a limit; write `if let Some(more) = log_ending(CAUSE)` and end the text with {{more}}:\n{}",
        unlimited.join("\n")
    );
    let unused: Vec<_> = (0..ALLOWED.len())
        .filter(|index| !used.contains(index))
        .map(|index| ALLOWED[index])
        .collect();
    assert!(unused.is_empty(), "allowed lines that are no longer there: {unused:?}");
}

#[test]
fn calls_are_found_whole() {
    let source = "fn f() { tracing::warn!(\"a {} ({b})\", g(1)); info!(\"c{more}\"); say!(\"d\"); }\n#[cfg(test)]\nmod t { error!(\"e\") }";
    assert_eq!(
        calls(source),
        ["tracing::warn!(\"a {} ({b})\", g(1))", "info!(\"c{more}\")"]
    );
}
