//! Units of the Debian package: all are in it, and none is more open than that of the node, except where it says why.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}

const UNITS: [(&str, &str); 3] = [
    ("flexdrill.service", "run"),
    ("flexdrill-dashboard.service", "dashboard"),
    ("flexdrill-bridge.service", "bridge"),
];

#[test]
fn node_page_and_bridge_have_a_unit_that_the_package_installs() {
    let manifest = read("Cargo.toml");
    let environment = read("launch_scripts/debian/environment");
    let package = read("launch_scripts/package.sh");
    for (unit, command) in UNITS {
        let text = read(&format!("launch_scripts/debian/{unit}"));
        assert!(
            text.contains(&format!("\nExecStart=/usr/bin/flexdrill {command} ")),
            "{unit}"
        );
        assert!(
            text.contains("\nUser=flexdrill\n") && text.contains("\nWantedBy=multi-user.target\n"),
            "{unit}"
        );
        // cargo-deb finds the unit with the package's name by itself.
        let asset = format!("[\"launch_scripts/debian/{unit}\", \"usr/lib/systemd/system/\", \"644\"]");
        assert!(
            unit == "flexdrill.service" || manifest.contains(&asset),
            "{unit} is no asset"
        );
        assert!(
            package.contains(&format!("usr/lib/systemd/system/{unit}")),
            "{unit} is not checked"
        );
        let options = text
            .split(['$', '\n', ' '])
            .find(|word| word.starts_with("FLEXDRILL_") && word.ends_with("OPTIONS"));
        assert!(
            environment.contains(&format!("\n{}=", options.unwrap())),
            "{unit}: {options:?}"
        );
    }
}

#[test]
fn every_unit_has_the_restrictions_of_the_nodes() {
    let restricts = |line: &&str| {
        [
            "Protect",
            "Restrict",
            "NoNew",
            "Capability",
            "Ambient",
            "Private",
            "Lock",
            "Memory",
            "SystemCall",
            "Remove",
        ]
        .iter()
        .any(|begin| line.starts_with(begin))
            && !line.starts_with("MemoryMax")
    };
    let node = read("launch_scripts/debian/flexdrill.service");
    let wanted: Vec<&str> = node.lines().filter(restricts).collect();
    assert!(wanted.len() > 20, "{wanted:?}");
    for (unit, _) in UNITS {
        let text = read(&format!("launch_scripts/debian/{unit}"));
        for line in &wanted {
            // A bridge opens serial lines; DevicePolicy and DeviceAllow close the other devices.
            let is_serial =
                *line == "PrivateDevices=yes" && text.contains("\nDevicePolicy=closed\nDeviceAllow=char-ttyS rw");
            assert!(text.lines().any(|own| own == *line) || is_serial, "{unit} lacks {line}");
        }
    }
}
