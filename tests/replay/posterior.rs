//! A run whose plausible tools come from a calibration's sample: its replay has the same bands, and is refused with another
//! sample or without one.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use flexdrill::bag;
use flexdrill_config::Config;
use flexdrill_uncertainty::posterior::{Provenance, to_csv};

const KEY: &str = "contact.outer.friction_tangential";

fn flexdrill(arguments: &[&Path]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap()
}

fn succeeds(arguments: &[&Path]) -> String {
    let output = flexdrill(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn fails(arguments: &[&Path]) -> String {
    let output = flexdrill(arguments);
    assert!(!output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A sample of the friction about `middle` for a configuration.
fn write_sample(path: &Path, config: &Path, middle: f64) {
    let config = Config::load(config).unwrap();
    let provenance = Provenance {
        tool: config.tool_hash([KEY]),
        configuration: config.hash(),
        sha256: "ab".repeat(32),
        rows: [1, 100],
        ..Provenance::default()
    };
    let rows: Vec<[f64; 1]> = (0..30).map(|row| [middle + 1e-3 * (f64::from(row) - 14.5)]).collect();
    let rows = rows.iter().map(|row| (1.0, row.as_slice()));
    std::fs::write(path, to_csv(&provenance, &[KEY], rows)).unwrap();
}

/// Time and bytes of each message with bands.
fn bands(bag_of: &Path) -> Vec<(i64, Vec<u8>)> {
    let messages = bag::open(bag_of).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.topic.is("twin/bands"))
        .map(|message| (message.log_time, message.data.to_vec()))
        .collect()
}

#[test]
fn a_run_with_a_sample_replays_with_that_sample_alone() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    let (config, log, mapping) = (at("tool.yaml"), at("log.csv"), at("mapping.yaml"));
    let mut text = std::fs::read_to_string(crate::common::small_config()).unwrap();
    text += &format!(
        "uncertainty:\n  keys:\n    - {{key: {KEY}, distribution: {{log_normal: {{low: 0.2, high: 0.4}}}}, source: a \
         test}}\nensemble: {{members: 8, from: {{posterior: sample.csv}}}}\n"
    );
    std::fs::write(&config, text).unwrap();
    write_sample(&at("sample.csv"), &config, 0.3);
    let rows = (0..5).map(|second| format!("{second},40,5\n"));
    let rows: String = std::iter::once("time_s,rpm,wob\n".to_owned()).chain(rows).collect();
    std::fs::write(&log, rows).unwrap();
    std::fs::write(
        &mapping,
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n",
    )
    .unwrap();
    let [replay, with_config, with_mapping, to, with_sample] =
        ["replay", "--config", "--mapping", "--out", "--posterior"].map(Path::new);
    std::fs::create_dir(at("recorded")).unwrap();
    let run = at("recorded/run");
    succeeds(&[replay, &log, with_mapping, &mapping, with_config, &config, to, &run]);
    let drawn = bands(&run);
    assert!(drawn.len() >= 2, "{} messages", drawn.len());

    // The recording has the name of the sample, which is not next to it, and its SHA-256.
    let words = fails(&[replay, &run, to, &at("without")]);
    assert!(words.contains("sample.csv") && words.contains("--posterior"), "{words}");
    assert!(!at("without").exists(), "a refused replay leaves a bag");
    let said = succeeds(&[replay, &run, with_sample, &at("sample.csv"), to, &at("again")]);
    assert!(!said.contains("not exact"), "{said}");
    assert!(bands(&at("again")) == drawn, "other bands");

    // Values a thousandth apart are another sample.
    write_sample(&at("other.csv"), &config, 0.301);
    let words = fails(&[replay, &run, with_sample, &at("other.csv"), to, &at("other")]);
    assert!(words.contains("other.csv") && words.contains("SHA-256"), "{words}");
}
