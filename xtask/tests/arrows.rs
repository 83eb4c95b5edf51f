//! Crates that wrap a foreign library are the only ones that depend on it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::{Path, PathBuf};

/// A foreign crate, and the crate of the workspace that may use it.
const OWNERS: [(&str, &str); 13] = [
    ("rustdds", "flexdrill-ros2"),
    ("ros2-client", "flexdrill-ros2"),
    ("foxglove", "flexdrill-live"),
    ("tokio-tungstenite", "flexdrill-live"),
    ("mcap", "flexdrill-bag"),
    ("rusqlite", "flexdrill-bag"),
    ("csv-core", "flexdrill-field-log"),
    ("serial2-tokio", "flexdrill-bridge"),
    ("rumqttc", "flexdrill-bridge"),
    ("async-opcua", "flexdrill-bridge"),
    ("maud", "flexdrill-report"),
    ("numpy", "flexdrill-python"),
    ("pyo3", "flexdrill-python"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Name and manifest of every crate of the workspace.
fn manifests() -> Vec<(String, String)> {
    let crates = std::fs::read_dir(root().join("crates")).unwrap();
    let mut folders: Vec<PathBuf> = crates.map(|entry| entry.unwrap().path()).collect();
    folders.extend([root(), root().join("xtask")]);
    folders
        .iter()
        .filter_map(|folder| std::fs::read_to_string(folder.join("Cargo.toml")).ok())
        .map(|text| {
            let name = text.lines().find_map(|line| line.strip_prefix("name = "));
            (name.unwrap().trim_matches('"').to_owned(), text)
        })
        .collect()
}

/// The crates that a manifest lists under its `[dependencies]`, those for tests left out.
fn dependencies(manifest: &str) -> Vec<&str> {
    let mut section = "";
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line;
        } else if section == "[dependencies]"
            && let Some((name, _)) = line.split_once(['=', '.'])
        {
            found.push(name.trim());
        }
    }
    found
}

#[test]
fn a_foreign_library_has_one_user() {
    let manifests = manifests();
    assert!(manifests.len() > 10, "{} crates", manifests.len());
    for (library, owner) in OWNERS {
        let users: Vec<&str> = manifests
            .iter()
            .filter(|(_, manifest)| dependencies(manifest).contains(&library))
            .map(|(name, _)| name.as_str())
            .collect();
        assert!(
            users.iter().all(|user| *user == owner),
            "only {owner} may depend on {library}, not {users:?}"
        );
    }
    // The check reads manifests as they are written.
    let ros2 = manifests.iter().find(|(name, _)| name == "flexdrill-ros2");
    assert!(dependencies(&ros2.unwrap().1).contains(&"rustdds"));
}

#[test]
fn no_crate_uses_the_product_or_the_workshop() {
    for (name, manifest) in manifests() {
        for above in ["flexdrill", "xtask"] {
            assert!(!dependencies(&manifest).contains(&above), "{name} depends on {above}");
        }
    }
}
