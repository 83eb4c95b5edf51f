//! `flexdrill rig LOG --guess`: the mapping is shown and written, and nothing runs on it without `--yes`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};

use crate::program::unwrapped;

/// Writes a log of ten minutes: weight and rotation come and go, and the hook carries what the bit does not.
fn log(folder: &Path, header: &str) {
    let mut text = format!("{header}\n");
    for second in 0..600 {
        let time = f64::from(second);
        let weight = if (second / 100) % 2 == 1 {
            8.0 + 2.0 * (time / 17.0).sin()
        } else {
            0.0
        };
        let speed = if second > 50 {
            40.0 + 3.0 * (time / 23.0).sin()
        } else {
            0.0
        };
        writeln!(text, "{second},{speed:.1},{weight:.2},{:.2}", 200.0 - weight).unwrap();
    }
    std::fs::write(folder.join("log.csv"), text).unwrap();
}

/// Runs the command in a folder; what it plays is written to whoever connects, a thousand times faster than the rig.
fn rig(folder: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["rig", "log.csv", "--wits", "127.0.0.1:0", "--rate", "1000"])
        .args(more)
        .current_dir(folder)
        .output()
        .unwrap()
}

const NAMED: &str = "Time (s),Rotary Speed (rpm),WOB (kN),Hookload (kN)";

#[test]
fn a_guess_is_shown_and_written_and_runs_with_yes_only() {
    let folder = tempfile::tempdir().unwrap();
    log(folder.path(), NAMED);
    let output = rig(folder.path(), &["--guess"]);
    let said = unwrapped(&output.stdout);
    assert!(output.status.success(), "{said}{}", unwrapped(&output.stderr));
    for words in [
        "Rotary Speed (rpm) rotary_speed 0 r/min",
        "WOB (kN) weight_on_bit 0 kN",
        "mirrors hook_load",
        "log.yaml has this mapping",
        "nothing was run; compare each line with the rig's display",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    assert!(!said.contains("playing"), "{said}");
    // Asked again, the file is left as it is, and --yes runs on it: the log was made with 40 + 3 r/min and 8 + 2 kN at most.
    let site = folder.path().join("log.yaml");
    let written = std::fs::read_to_string(&site).unwrap();
    let output = rig(folder.path(), &["--guess", "--yes"]);
    let (said, log) = (unwrapped(&output.stdout), unwrapped(&output.stderr));
    assert!(output.status.success(), "{said}{log}");
    for words in [
        "log.yaml exists and is left as it is",
        "playing log.csv (1200 samples of inputs",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    for words in [
        "rotary_speed 600 samples, 0.0 to 43.0 r/min",
        "weight_on_bit 600 samples, 0.0 to 10.0 kN",
    ] {
        assert!(log.contains(words), "{words}\n{log}");
    }
    assert_eq!(std::fs::read_to_string(&site).unwrap(), written);
    // A person's corrections are neither written over nor passed over.
    let corrected = written.replace("unit: kN}", "unit: kdaN}");
    assert_ne!(corrected, written);
    std::fs::write(&site, &corrected).unwrap();
    let output = rig(folder.path(), &["--guess", "--yes"]);
    let log = unwrapped(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{log}");
    assert!(
        log.contains("run with --mapping log.yaml, or name another file with --guess-file"),
        "{log}"
    );
    assert_eq!(std::fs::read_to_string(&site).unwrap(), corrected);
    assert!(rig(folder.path(), &["--guess"]).status.success());
    assert_eq!(std::fs::read_to_string(&site).unwrap(), corrected);
}

#[test]
fn the_guess_has_the_file_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    log(folder.path(), NAMED);
    let output = rig(folder.path(), &["--guess", "--yes", "--guess-file", "site.yaml"]);
    let said = unwrapped(&output.stdout);
    assert!(output.status.success(), "{said}{}", unwrapped(&output.stderr));
    assert!(
        said.contains("site.yaml has this mapping") && said.contains("playing log.csv"),
        "{said}"
    );
    assert!(folder.path().join("site.yaml").exists() && !folder.path().join("log.yaml").exists());
    // A place that cannot be written runs nothing.
    let output = rig(folder.path(), &["--guess", "--yes", "--guess-file", "no/site.yaml"]);
    let log = unwrapped(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{log}");
    assert!(log.contains("--guess-file no/site.yaml"), "{log}");
    assert!(!unwrapped(&output.stdout).contains("playing"));
}

#[test]
fn a_log_that_does_not_show_an_input_runs_nothing_with_yes_either() {
    let folder = tempfile::tempdir().unwrap();
    // The third column is pump strokes here, and the log has no weight.
    log(
        folder.path(),
        "Time (s),Rotary Speed (rpm),Pump Strokes (1/min),Hookload (kN)",
    );
    for more in [&["--guess"][..], &["--guess", "--yes"]] {
        let output = rig(folder.path(), more);
        let said = unwrapped(&output.stdout) + &unwrapped(&output.stderr);
        assert_eq!(output.status.success(), more.len() == 1, "{said}");
        assert!(said.contains("the log does not show weight_on_bit"), "{said}");
        assert!(!said.contains("playing"), "{said}");
    }
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    log(folder.path(), NAMED);
    for (more, words) in [
        (&["--yes"][..], "--guess"),
        (&["--guess-file", "site.yaml"], "--guess"),
        (&["--guess", "--mapping", "site.yaml"], "cannot be used with '--mapping"),
    ] {
        let output = rig(folder.path(), more);
        let log = unwrapped(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {log}");
        assert!(log.contains(words), "{more:?}: {log}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
