//! `flexdrill sensitivity` on a short tool: table, picture and words agree, the number of threads does not matter, and
//! `flexdrill check` shows what was computed.

use std::path::{Path, PathBuf};
use std::process::Output;

use flexdrill_uncertainty::Effects;

use crate::program::{flexdrill, text};

const PRIORS: &str = "
uncertainty:
  keys:
    - key: tool.bit.friction_factor
      form: factor
      distribution: {log_normal: {low: 0.8, high: 1.25}}
      source: a bit on a bench
    - key: contact.inner.stiffness
      form: factor
      distribution: {log_normal: {low: 0.5, high: 2}}
      source: assumption
  sensors:
    weight_indicator: {factor_error: 0.05}
";

/// A short tool with priors, in a folder.
fn configuration(folder: &Path) -> PathBuf {
    let tool = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/reach.yaml");
    let path = folder.join("tool.yaml");
    std::fs::write(&path, std::fs::read_to_string(tool).unwrap() + PRIORS).unwrap();
    path
}

fn sensitivity(config: &Path, more: &[&str]) -> Output {
    let fixed = ["sensitivity", config.to_str().unwrap(), "--wob=2"];
    flexdrill(&[&fixed, more].concat())
}

#[test]
fn table_picture_and_words_agree_and_check_shows_them() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path());
    let check = || text(&flexdrill(&["check", config.to_str().unwrap()]).stdout);
    let before = check();
    for part in [
        "tool.bit.friction_factor: 0.188 to 0.29375 (log_normal, a factor of 0.8 to 1.25; configured 0.235)",
        "source: a bit on a bench",
        "sensor weight_indicator: factor within 5 %",
        "`flexdrill sensitivity",
    ] {
        assert!(before.contains(part), "{part}: {before}");
    }
    let one = sensitivity(&config, &["--seconds=4"]);
    assert!(one.status.success(), "{}", text(&one.stderr));
    let default = folder.path().join("tool_sensitivity");
    let other = folder.path().join("other");
    let two = sensitivity(
        &config,
        &["--seconds=4", "--jobs=2", "--resume", "--out", other.to_str().unwrap()],
    );
    assert!(two.status.success(), "{}", text(&two.stderr));
    // The same command continues with what is there.
    let again = sensitivity(&config, &["--seconds=4", "--resume", "--out", other.to_str().unwrap()]);
    assert!(again.status.success(), "{}", text(&again.stderr));
    for name in ["sensitivity.csv", "sensitivity.svg", "sensitivity.json"] {
        let [a, b] = [&default, &other].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(!a.is_empty() && a == b, "{name}");
    }
    // Three runs that ought to be equal, two per key, two of the factor of the weight.
    assert_eq!(std::fs::read_dir(other.join("points")).unwrap().count(), 9);
    let effects = Effects::load(&default).unwrap().unwrap();
    assert_eq!(
        effects.keys(),
        [
            "tool.bit.friction_factor",
            "contact.inner.stiffness",
            "uncertainty.sensors.weight_indicator.factor"
        ]
    );
    // Eq. 1: the torque is proportional to the factor and to the weight, which has its value at the bit here.
    let torque = effects.outputs[0].nominal.unwrap();
    let changes = effects.changes("tool.bit.friction_factor", 0).map(Option::unwrap);
    for (change, factor) in changes.into_iter().zip([0.8, 1.25]) {
        assert!((change / torque - (factor - 1.0)).abs() < 0.02, "{change} of {torque}");
    }
    let changes = effects
        .changes("uncertainty.sensors.weight_indicator.factor", 1)
        .map(Option::unwrap);
    for (change, factor) in changes.into_iter().zip([0.95, 1.05]) {
        assert!((change - 2.0 * (1.0 / factor - 1.0)).abs() < 0.01, "{change}");
    }
    // This tool has no rock that answers an advance.
    assert_eq!(effects.outputs[6].nominal, None);
    let mut table = csv::Reader::from_path(default.join("sensitivity.csv")).unwrap();
    assert_eq!(table.records().map(Result::unwrap).count(), 6 * 7);
    let svg = std::fs::read_to_string(default.join("sensitivity.svg")).unwrap();
    for part in ["<svg", "bit_torque", "tool.bit.friction_factor", "at 95 %", "</svg>"] {
        assert!(svg.contains(part), "{part}");
    }
    let after = check();
    let words = effects.largest_in_words("tool.bit.friction_factor");
    assert!(words.starts_with("bit_torque -"), "{words}");
    assert!(
        text(&one.stdout).contains(&words) && after.contains(&words),
        "{words}: {after}"
    );
    assert!(after.contains("Effects at 40 r/min and 2 kN"), "{after}");
    // Of another configuration they are not shown, and a file that is none is named.
    let changed = std::fs::read_to_string(&config)
        .unwrap()
        .replace("limit_deg: 6.0", "limit_deg: 6.5");
    std::fs::write(&config, changed).unwrap();
    assert!(check().contains("is the effect of another configuration"));
    std::fs::write(default.join("sensitivity.json"), "{").unwrap();
    assert!(check().contains("no table of `flexdrill sensitivity`"));
}

#[test]
fn what_cannot_be_computed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path());
    for (arguments, expected) in [
        (&["--rpm=4000"][..], "within inputs.rotary_speed, 0 to 120 r/min"),
        (&["--jobs=0"], "1..=256"),
        (&["--seconds=nan"], "from 0.001"),
    ] {
        let output = sensitivity(&config, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
    }
    let output = flexdrill(&["sensitivity", "coarse"]);
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    assert!(said.contains("uncertainty.keys is empty"), "{said}");
}
