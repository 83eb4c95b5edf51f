//! Every configuration file that is shipped loads, and reads back from what it writes.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::{Path, PathBuf};

use flexdrill_config::Config;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::SimulationSettings;
use flexdrill_core::units::rpm_to_rad_per_s;

fn shipped() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let mut files: Vec<PathBuf> = [root.clone(), root.join("verify")]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
        .collect();
    files.sort();
    assert!(files.len() >= 2, "no configuration files found in {}", root.display());
    files
}

#[test]
fn all_load_and_round_trip() {
    for path in shipped() {
        let config = Config::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let text = config.to_yaml().unwrap();
        let again = Config::from_text("written", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(config, again, "{}", path.display());
        assert_eq!(config.hash(), again.hash());
        assert_eq!(config.hash().len(), 64);
    }
}

/// The default file writes out the schema's defaults: a file that gives only what is required must mean the same.
#[test]
fn default_file_is_the_schemas_defaults() {
    let minimal = "
run: {title: \"The paper's case\"}
well:
  sections: [{arc: {radius: 3.2, build_angle_deg: 90}}]
  hole_diameter: 0.118
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
";
    let minimal = Config::from_text("minimal", minimal).unwrap();
    let file = Config::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/default.yaml")).unwrap();
    // What the paper leaves open is no default: a file of a tool of which nothing is said draws nothing.
    assert!(file.uncertainty.is_some());
    assert_eq!(minimal, file.without_uncertainty());
    // The paper's guide has no stress in the arc, and would yield on its way there.
    let warnings = file.warnings();
    assert!(
        warnings.len() == 1 && warnings[0].starts_with("tool.guide: "),
        "{warnings:?}"
    );
}

/// The core has the same numbers in code, for users without YAML.
#[test]
fn default_file_is_what_the_core_calls_the_papers_case() {
    let file = Config::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/default.yaml")).unwrap();
    assert_eq!(file.tool(), ToolDescription::paper());
    assert_eq!(file.simulation(), SimulationSettings::default());
}

#[test]
fn a_speed_that_is_measured_downhole_is_followed_faster() {
    let config = Config::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/default.yaml")).unwrap();
    let slew = |config: &Config| config.simulation().rotary_speed_slew;
    assert_eq!(slew(&config), rpm_to_rad_per_s(20.0));
    let downhole = config.with_value("inputs.rotary_speed.measured", "downhole").unwrap();
    assert_eq!(slew(&downhole), rpm_to_rad_per_s(200.0));
    let error = config.with_value("inputs.rotary_speed.measured", "bit").unwrap_err();
    assert!(error.to_string().contains("inputs.rotary_speed.measured"), "{error}");
}

/// Every number of the sections that describe tool and simulation reaches the mechanics: no field is forgotten where
/// the schema is translated, which the compiler does not check for structures that may grow.
#[test]
fn every_number_reaches_the_mechanics() {
    fn numbers(value: &serde_json::Value, path: String, into: &mut Vec<(String, f64)>) {
        match value {
            serde_json::Value::Object(map) => {
                for (key, value) in map {
                    numbers(value, format!("{path}.{key}"), into);
                }
            }
            serde_json::Value::Number(number) => into.push((path, number.as_f64().unwrap())),
            _ => {}
        }
    }
    let config = Config::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/default.yaml")).unwrap();
    let described = |config: &Config| (config.tool(), config.simulation(), config.unknowns());
    let before = described(&config);
    let tree = config.to_tree();
    let (mut changed, mut refused) = (0, Vec::new());
    for section in [
        "well",
        "tool",
        "contact",
        "environment",
        "solver",
        "whirl",
        "stick_slip",
        "shock",
        "joint_load",
        "chaotic_whirl",
        "transfer",
    ] {
        let mut keys = Vec::new();
        numbers(&tree[section], section.to_owned(), &mut keys);
        for (key, value) in keys {
            let is_count = !tree.pointer(&format!("/{}", key.replace('.', "/"))).unwrap().is_f64();
            // Small changes, up or down, that the bounds of most keys allow.
            let candidates = [1.01 * value + 1e-4, 0.99 * value - 1e-4].map(serde_json::Value::from);
            let counts = [value as i64 + 1, value as i64 - 1].map(serde_json::Value::from);
            let candidates = if is_count { counts } else { candidates };
            let Some(other) = candidates
                .into_iter()
                .find_map(|value| config.with_value(&key, value).ok())
            else {
                refused.push(key);
                continue;
            };
            assert_ne!(described(&other), before, "{key} has no effect on tool or simulation");
            changed += 1;
        }
    }
    assert!(changed > 60, "{changed}");
    // Only with a free curvature and a guide that is held against turning, with a slotted guide, and with `scheme: newmark`.
    assert_eq!(
        refused,
        [
            "tool.guide.free_curvature_phase_deg",
            "tool.guide.spine_offset",
            "tool.guide.spine_toolface_deg",
            "solver.gamma"
        ]
    );
}

/// The YAML files of the repository and the YAML in its documents, each with its name.
fn yaml_texts() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = |folder: &str, extension: &str| {
        let entries = std::fs::read_dir(root.join(folder)).unwrap();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|found| found == extension));
        files.sort();
        files
    };
    let read = |path: &PathBuf| (path.display().to_string(), std::fs::read_to_string(path).unwrap());
    let folders = [
        "config",
        "config/verify",
        "config/field_logs",
        "docs/examples",
        "tests/data",
    ];
    let mut texts: Vec<_> = folders
        .iter()
        .flat_map(|folder| files(folder, "yaml"))
        .map(|path| read(&path))
        .collect();
    assert!(texts.len() > 50, "{} files", texts.len());
    let pages = ["", "docs", "docs/effects", "docs/decisions"]
        .iter()
        .flat_map(|folder| files(folder, "md"));
    let before = texts.len();
    for (name, page) in pages.map(|path| read(&path)) {
        for block in page.split("```yaml\n").skip(1) {
            texts.push((name.clone(), block.split("```").next().unwrap().to_owned()));
        }
    }
    assert!(texts.len() > before + 5, "{} blocks", texts.len() - before);
    texts
}

/// The plain values of a text, without comments.
fn plain_values(text: &str) -> impl Iterator<Item = &str> {
    text.lines().flat_map(|line| {
        let code = line.split(" #").next().unwrap_or(line);
        let code = if code.trim_start().starts_with('#') { "" } else { code };
        let items = code.split(['[', ']', '{', '}', ',']).flat_map(|item| item.split(": "));
        items.map(|item| item.trim().trim_start_matches("- ").trim())
    })
}

/// Whether YAML 1.1 reads a decimal number, as PyYAML 6 does: an exponent needs a point before it and a sign
/// (<https://yaml.org/type/float.html>, <https://yaml.org/type/int.html>).
fn is_number_of_yaml_1_1(text: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let (number, exponent) = text
        .split_once(['e', 'E'])
        .map_or((text, None), |(number, exponent)| (number, Some(exponent)));
    let number = number.strip_prefix(['-', '+']).unwrap_or(number);
    match (number.split_once('.'), exponent) {
        (None, exponent) => digits(number) && exponent.is_none(),
        (Some((whole, fraction)), exponent) => {
            let exponent = exponent.is_none_or(|exponent| exponent.strip_prefix(['-', '+']).is_some_and(digits));
            (digits(whole) || whole.is_empty() && digits(fraction))
                && (fraction.is_empty() || digits(fraction))
                && exponent
        }
    }
}

/// Programs in Python read the files too: with PyYAML `206e9` is a text, and `206.0e+9` a number.
#[test]
fn numbers_are_numbers_for_readers_of_yaml_1_1_too() {
    // As PyYAML 6.0.3 reads them.
    for text in ["206.0e+9", "1.0e-4", "-0.5", "12", "-3", "1.", ".5", "5.e+3"] {
        assert!(is_number_of_yaml_1_1(text), "{text}");
    }
    for text in ["206e9", "206.0e9", "206e+9", "1e-4", "1.0e", "."] {
        assert!(!is_number_of_yaml_1_1(text), "{text}");
    }
    let texts = yaml_texts();
    let mut numbers = 0;
    for (name, text) in &texts {
        for value in plain_values(text).filter(|value| value.parse::<f64>().is_ok_and(f64::is_finite)) {
            assert!(
                is_number_of_yaml_1_1(value),
                "{name}: PyYAML reads {value} as a text; write it as in 206.0e+9"
            );
            numbers += 1;
        }
    }
    assert!(numbers > 1000, "{numbers} numbers in {} texts", texts.len());
}
