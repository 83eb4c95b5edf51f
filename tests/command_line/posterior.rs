//! `flexdrill check` of a configuration whose plausible tools come from a calibration's sample: what it says of the sample,
//! and what it refuses.

use std::path::Path;
use std::process::Command;

use flexdrill_config::Config;
use flexdrill_uncertainty::posterior::{Provenance, to_csv};

const KEY: &str = "contact.outer.friction_tangential";

/// A tool whose plausible tools are drawn from `sample.csv` next to it.
fn configuration(folder: &Path, more: &str) -> std::path::PathBuf {
    let mut text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/small.yaml")).unwrap();
    text += &format!(
        "uncertainty:\n  keys:\n    - {{key: {KEY}, distribution: {{log_normal: {{low: 0.2, high: 0.4}}}}, source: a \
         test}}\nensemble: {{members: 8, from: {{posterior: sample.csv}}{more}}}\n"
    );
    let path = folder.join("tool.yaml");
    std::fs::write(&path, text).unwrap();
    path
}

/// Thirty members about `middle`, 1e-3 apart.
fn write_sample(config: &Path, middle: f64, change: impl FnOnce(&mut Provenance)) {
    let known = Config::load(config).unwrap();
    let mut provenance = Provenance {
        version: "1.2.3".into(),
        tool: known.tool_hash([KEY]),
        configuration: known.hash(),
        log: "rig of May.csv".into(),
        sha256: "ab".repeat(32),
        rows: [3, 900],
        ..Provenance::default()
    };
    change(&mut provenance);
    let rows: Vec<[f64; 1]> = (0..30).map(|row| [middle + 1e-3 * (f64::from(row) - 14.5)]).collect();
    let rows = rows.iter().map(|row| (1.0, row.as_slice()));
    std::fs::write(config.with_file_name("sample.csv"), to_csv(&provenance, &[KEY], rows)).unwrap();
}

/// Exit code, and what is said where it succeeds or fails.
fn check(config: &Path) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("check")
        .arg(config)
        .output()
        .unwrap();
    let said = if output.status.success() {
        output.stdout
    } else {
        output.stderr
    };
    (output.status.code(), String::from_utf8_lossy(&said).into_owned())
}

#[test]
fn check_says_what_plausible_tools_are_drawn_from() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), "");
    write_sample(&config, 0.3, |_| ());
    let (code, said) = check(&config);
    assert_eq!(code, Some(0), "{said}");
    for words in [
        "sample.csv: 30 members, 30 alike by their weights, fitted to rows 3 to 900 of rig of May.csv by flexdrill 1.2.3",
        KEY,
    ] {
        assert!(said.contains(words), "{said}");
    }
    // Without the sample the same file says nothing of one.
    let text = std::fs::read_to_string(&config).unwrap();
    std::fs::write(&config, text.replace(", from: {posterior: sample.csv}", "")).unwrap();
    let (code, said) = check(&config);
    assert!(code == Some(0) && !said.contains("sample.csv"), "{said}");
}

#[test]
fn check_refuses_the_sample_that_a_node_would_refuse() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), "");
    let refused = |words: &str| {
        let (code, said) = check(&config);
        assert!(
            code == Some(1) && said.contains(words) && said.contains("sample.csv"),
            "{said}"
        );
    };
    refused("cannot be read");
    write_sample(&config, 0.3, |from| from.tool = "cd".repeat(32));
    refused("a posterior of another tool or hole");
    write_sample(&config, 0.3, |from| from.objections = vec!["another rock".into()]);
    refused("this calibration is not to be used: another rock");
    // Negative friction, beyond the limits of the key.
    write_sample(&config, 0.0, |_| ());
    refused(KEY);
    std::fs::write(config.with_file_name("sample.csv"), b"\xff\xfe").unwrap();
    refused("no posterior of `flexdrill calibrate`");
    // Another file than the one that a recording names.
    write_sample(&config, 0.3, |_| ());
    let named = configuration(folder.path(), &format!(", posterior_sha256: '{}'", "0".repeat(64)));
    let (code, said) = check(&named);
    assert!(code == Some(1) && said.contains("ensemble.posterior_sha256"), "{said}");
}
