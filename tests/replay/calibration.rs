//! `flexdrill calibrate` up to the runs of the twin: which parts of a log are used, and what is refused with which reason.
//! The fit is tested in `crates/flexdrill-calibration/tests`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};

use flexdrill::bag::{Recorder, Topic};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{RigInputs, RigMeasured, to_cdr, topics};

fn calibrate(log: &Path, more: &[&str]) -> (Option<i32>, String, String) {
    let folder = log.parent().unwrap();
    let config = crate::common::root().join("config/rig.yaml");
    let output: Output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("calibrate")
        .arg(log)
        .arg("--config")
        .arg(config)
        .arg("--out")
        .arg(folder.join("out"))
        .args(more)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

/// Torque with ripple, so that no sensor counts as frozen.
fn torque(second: u32) -> f64 {
    let steady = if second < 100 { 20.0 } else { 300.0 };
    steady + (f64::from(second) * 2.4).sin()
}

/// A log at 1 Hz: 100 s off bottom, if asked for, then 200 s of drilling.
fn write_log(folder: &Path, off_bottom: bool, measured: bool) -> std::path::PathBuf {
    let mut text = String::from("t,rpm,wob,torque\n");
    for second in if off_bottom { 0 } else { 100 }..300_u32 {
        let weight = if second < 100 { 0.0 } else { 12.0 };
        writeln!(text, "{second},40,{weight},{}", torque(second) / 1000.0).unwrap();
    }
    let log = folder.join("rig.csv");
    std::fs::write(&log, text).unwrap();
    let columns = "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
                   weight_on_bit:\n    direct: {column: wob, unit: kN}\n";
    let torque = if measured {
        "  torque: {column: torque, unit: kN.m}\n"
    } else {
        ""
    };
    std::fs::write(folder.join("mapping.yaml"), format!("{columns}{torque}")).unwrap();
    log
}

#[test]
fn the_steady_parts_of_a_log_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let log = write_log(folder.path(), true, true);
    let (code, said, told) = calibrate(&log, &["--windows"]);
    assert_eq!(code, Some(0), "{told}");
    // 15 s of settling at the begin and after the change; the rest is a window off bottom and two of drilling.
    assert!(
        said.contains("270 of 300 samples are in steady windows: 1 off bottom, 2 drilling"),
        "{said}"
    );
    assert!(said.contains("left out: 30 samples, settling after a change"), "{said}");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_log_without_a_time_off_bottom_is_refused_for_torque() {
    let folder = tempfile::tempdir().unwrap();
    let log = write_log(folder.path(), false, true);
    let (code, said, told) = calibrate(&log, &[]);
    assert_eq!(code, Some(1), "{said}");
    for text in [&said, &told] {
        assert!(
            text.contains("no steady time off bottom with rotation, so the tare of the surface torque is not known"),
            "{text}"
        );
    }
    assert!(told.contains("there is nothing to fit"), "{told}");
    assert!(!folder.path().join("out").exists(), "the twin did not run");
}

#[test]
fn a_log_without_measured_values_says_which_columns_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    let log = write_log(folder.path(), true, false);
    let (code, _, told) = calibrate(&log, &["--windows"]);
    assert_eq!(code, Some(1));
    assert!(
        told.contains("no measured torque") && told.contains("columns.measured"),
        "{told}"
    );
}

#[test]
fn a_bag_with_what_the_rig_measured_is_a_log() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rig/rig.mcap");
    let known = [&topics::RIG_INPUTS, &topics::RIG_MEASURED];
    let all = known.map(|topic| Topic::new(format!("/{}", topic.name), &topic.kind, topic.qos));
    let mut recorder = Recorder::create(&path, &all).unwrap();
    for second in 0..300_u32 {
        let at = 1_700_000_000_000_000_000 + i64::from(second) * 1_000_000_000;
        let header = Header {
            stamp: Time::from_nanoseconds(at),
            ..Header::default()
        };
        // The rig's speed and weight are missing for a while: older than 5 s they are not known.
        if !(200..220).contains(&second) {
            let inputs = RigInputs {
                header: header.clone(),
                rotary_speed_rpm: 40.0,
                weight_on_bit_kn: if second < 100 { 0.0 } else { 12.0 },
                ..RigInputs::default()
            };
            recorder.record(0, at, &to_cdr(&inputs).unwrap()).unwrap();
        }
        let measured = RigMeasured {
            header,
            surface_torque: torque(second),
            hook_load: f64::NAN,
            downhole_torque: f64::NAN,
            downhole_weight_on_bit: f64::NAN,
            ..RigMeasured::default()
        };
        recorder.record(1, at, &to_cdr(&measured).unwrap()).unwrap();
    }
    recorder.finish().unwrap();
    let (code, said, told) = calibrate(&path, &["--windows"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(said.contains("1 off bottom, 2 drilling"), "{said}");
    assert!(
        said.contains("left out: 15 samples, speed or weight is missing"),
        "{said}"
    );
    let (code, _, told) = calibrate(&path, &["--windows", "--from", "3"]);
    assert_eq!(code, Some(2), "{told}");
}

/// A calibration that is refused leaves the sample of an earlier one as it was: nothing is written before all is known.
#[test]
fn a_calibration_that_is_refused_leaves_an_earlier_sample() {
    let folder = tempfile::tempdir().unwrap();
    let log = write_log(folder.path(), true, true);
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("points.csv"), "points of another configuration\n").unwrap();
    std::fs::write(out.join("posterior.csv"), "an earlier sample").unwrap();
    let (code, said, told) = calibrate(&log, &[]);
    assert_eq!(code, Some(1), "{said}");
    assert!(told.contains("points.csv"), "{told}");
    let mut left: Vec<_> = std::fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    left.sort();
    assert_eq!(left, ["points.csv", "posterior.csv"]);
    let sample = std::fs::read_to_string(out.join("posterior.csv")).unwrap();
    assert_eq!(sample, "an earlier sample");
}
