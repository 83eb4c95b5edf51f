//! A figure is one row: the sources that name one, but its table, are counted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use flexdrill_outputs::figures::{BIT_STATE, TRANSFER};

/// Sources that compute the figures, which the table reads.
const COMPUTED_IN: [&str; 3] = ["flexdrill-base", "flexdrill-core", "flexdrill-motion"];
/// Fields with names that inputs, measurements, parts of the configuration or other messages have too.
const WORDS: [&str; 13] = [
    "bit_torque",
    "bit_weight",
    "depth_of_cut",
    "duration",
    "friction_power",
    "hook_load",
    "rate_of_penetration",
    "rotary_speed",
    "stick_slip_index",
    "surface_torque",
    "torque",
    "torque_efficiency",
    "weight_on_bit",
];
/// Sources that need chosen figures, and what for. A figure that is added is in none of them.
const USES: [(&str, &str); 10] = [
    (
        "crates/flexdrill-report/src/balances.rs",
        "a balance is a sum of certain figures",
    ),
    (
        "crates/flexdrill-report/src/weight.rs",
        "which friction takes the weight that does not arrive",
    ),
    ("crates/flexdrill-report/src/drive.rs", "curves of the bit"),
    ("crates/flexdrill-report/src/plots.rs", "curves of the bit"),
    (
        "crates/flexdrill-report/src/compare/figures.rs",
        "curves of the bit in two runs",
    ),
    (
        "crates/flexdrill-dashboard/src/history/mod.rs",
        "shocks in the strips of the rig page",
    ),
    (
        "crates/flexdrill-dashboard/web/src/views/transfer.ts",
        "when a figure that is zero is not shown",
    ),
    (
        "crates/flexdrill-messages/src/grown.rs",
        "the size of messages of older senders",
    ),
    ("src/health/motion.rs", "diagnostics"),
    (
        "src/cli/watch/texts.rs",
        "what drilling comes to, in one line of the terminal",
    ),
];
/// Most sources, but its table, that name a figure.
const MOST: usize = 4;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Product sources below `folder`, by path from the root: Rust, TypeScript and Python, without tests and examples.
fn sources(folder: &str, found: &mut Vec<String>) {
    let left_out = [
        "tests",
        "test",
        "examples",
        "notebooks",
        "dist",
        "node_modules",
        "rustdds",
    ];
    for entry in std::fs::read_dir(root().join(folder)).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{folder}/{name}");
        if entry.file_type().unwrap().is_dir() {
            if !left_out.contains(&name.as_str()) && !COMPUTED_IN.contains(&name.as_str()) {
                sources(&path, found);
            }
        } else if name.ends_with(".rs") || name.ends_with(".ts") || name.ends_with(".py") || name.ends_with(".pyi") {
            found.push(path);
        }
    }
}

/// Names in a source, without those of its tests at its end; `None` of a generated one and of the table.
fn names(path: &str) -> Option<BTreeSet<String>> {
    let text = std::fs::read_to_string(root().join(path)).unwrap();
    let first = text.lines().next().unwrap_or_default();
    let is_generated = first.contains("Generated from") || first.contains("Written by `cargo xtask");
    if is_generated || path.ends_with("figures/tables.rs") || path.ends_with("/tests.rs") {
        return None;
    }
    let product = text.split("#[cfg(test)]").next().unwrap_or_default();
    let words = product.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    Some(words.map(str::to_owned).collect())
}

#[test]
fn a_figure_is_named_by_its_row_alone() {
    let mut paths = Vec::new();
    sources("src", &mut paths);
    sources("crates", &mut paths);
    let sources: BTreeMap<&str, BTreeSet<String>> = paths
        .iter()
        .filter_map(|path| Some((path.as_str(), names(path)?)))
        .collect();
    assert!(sources.len() > 500, "{} sources", sources.len());
    let fields = BIT_STATE.iter().map(|figure| figure.field);
    let fields: Vec<&str> = fields.chain(TRANSFER.iter().map(|figure| figure.field)).collect();
    assert!(WORDS.iter().all(|word| fields.contains(word)), "a word is no figure");
    let mut used = BTreeSet::new();
    for field in fields.into_iter().filter(|field| !WORDS.contains(field)) {
        let places: Vec<&str> = sources
            .iter()
            .filter(|(_, names)| names.contains(field))
            .map(|(path, _)| *path)
            .collect();
        assert!(places.len() <= MOST, "{field}: {} sources: {places:?}", places.len());
        for place in places {
            assert!(
                USES.iter().any(|(path, _)| *path == place),
                "{place} names {field}: read the table of figures there, or say in USES what it needs this figure for"
            );
            used.insert(place);
        }
    }
    for (path, why) in USES {
        assert!(
            used.contains(path),
            "{path} names no figure ({why}): it needs no line in USES"
        );
    }
}
