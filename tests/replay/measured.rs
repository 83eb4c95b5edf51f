//! What the rig measures besides its inputs, through a replay: of a field log, of the recording made of it, and of the bytes
//! of a WITS line.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use flexdrill::messages::{AppliedInputs, RigMeasured};
use flexdrill_bridge::Quantity;
use flexdrill_bridge::wits::capture::CaptureWriter;
use flexdrill_bridge::wits::{Mapping, RigFrames};
use flexdrill_core::inputs::MeasuredKind;

use crate::common::small_config;

/// 2023-11-14 22:13:20 UTC.
const START: i64 = 1_700_000_000_000_000_000;
const SECOND: i64 = 1_000_000_000;

/// Surface torque of a second (N m).
fn torque(second: i64) -> f64 {
    300.0 + second as f64
}

/// What the program says of a replay that succeeds.
fn replay(input: &Path, out: &Path, more: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(input)
        .arg("--out")
        .arg(out)
        .args(more)
        .output()
        .unwrap();
    let said = [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat();
    assert!(output.status.success(), "{said}");
    said
}

/// Bytes of a message with its time (ns).
type Timed = (i64, Vec<u8>);

/// The measured values of a bag as bytes and as messages, and the inputs that were applied.
fn recorded(bag: &Path) -> (Vec<Timed>, Vec<RigMeasured>, Vec<AppliedInputs>) {
    let (mut bytes, mut measured, mut applied) = (Vec::new(), Vec::new(), Vec::new());
    for message in flexdrill::bag::open(bag).unwrap().map(Result::unwrap) {
        if message.topic.is("rig/measured") {
            measured.push(message.decode().unwrap());
            bytes.push((message.log_time, message.data.clone()));
        } else if message.topic.is("twin/applied_inputs") {
            applied.push(message.decode().unwrap());
        }
    }
    (bytes, measured, applied)
}

#[test]
fn measured_values_of_a_log_are_in_the_recording_and_in_its_replay() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("t,rpm,wob,torque\n");
    for second in 0..4 {
        writeln!(text, "{second},40,5,{}", torque(second) / 1000.0).unwrap();
    }
    let log = folder.path().join("rig.csv");
    std::fs::write(&log, text).unwrap();
    let mapping = "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
                   weight_on_bit:\n    direct: {column: wob, unit: kN}\n  torque: {column: torque, unit: kN.m}\n";
    std::fs::write(folder.path().join("mapping.yaml"), mapping).unwrap();
    let [first, second, short] = ["first", "second", "short"].map(|name| folder.path().join(name));
    let config = small_config();
    let config = ["--config", config.to_str().unwrap()];
    replay(&log, &first, &config);
    let (bytes, measured, _) = recorded(&first);
    let values: Vec<_> = measured.iter().map(|message| message.surface_torque).collect();
    assert_eq!(values, [0, 1, 2, 3].map(torque));
    assert_eq!(
        bytes.iter().map(|(time, _)| *time).collect::<Vec<_>>(),
        [0, 1, 2, 3].map(|s| s * SECOND)
    );
    assert!(
        measured
            .iter()
            .all(|message| message.hook_load.is_nan() && message.quality == RigMeasured::GOOD)
    );
    // The recording of flexdrill: the same bytes at the same times.
    replay(&first, &second, &[]);
    assert_eq!(recorded(&second).0, bytes);
    // A shorter replay has no value from after its end.
    replay(&first, &short, &["--duration", "1.5"]);
    assert_eq!(recorded(&short).0, bytes[..2]);
}

/// A capture of three connections' worth of frames at 1 Hz; with times or as bytes alone.
fn capture(path: &Path, timed: bool) {
    let mut rig = RigFrames::new(&Mapping::default(), "A-7");
    let (mut bytes, mut writer) = (Vec::new(), timed.then(|| CaptureWriter::create(path).unwrap()));
    for second in 0..4 {
        let frame = rig.frame(START + second * SECOND, |quantity| match quantity {
            Quantity::RotarySpeed => Some(4.0 + 0.1 * second as f64),
            Quantity::WeightOnBit => Some(5e3),
            Quantity::Measured(MeasuredKind::SurfaceTorque) => Some(torque(second)),
            Quantity::Measured(_) | Quantity::Survey(_) => None,
        });
        let frame = frame.unwrap();
        match &mut writer {
            // Pieces end within a frame, as they do on a line, and arrive a quarter of a second late.
            Some(writer) => {
                let at = START + second * SECOND + SECOND / 4;
                let (begin, end) = frame.split_at(20);
                writer.write(at - 1000, 1, begin).unwrap();
                writer.write(at, 1, end).unwrap();
            }
            None => bytes.extend(frame),
        }
    }
    if !timed {
        std::fs::write(path, bytes).unwrap();
    }
}

#[test]
fn the_bytes_of_a_wits_line_are_replayed_as_they_came() {
    let folder = tempfile::tempdir().unwrap();
    let config = small_config();
    for timed in [true, false] {
        let name = if timed { "line.wits" } else { "bytes.txt" };
        let line = folder.path().join(name);
        capture(&line, timed);
        let out = folder.path().join(format!("{name} bag"));
        let said = replay(&line, &out, &["--wits", "--config", config.to_str().unwrap()]);
        assert!(
            said.contains("4 frames, 4 used with 12 values; 0 bytes in no frame"),
            "{said}"
        );
        let (bytes, measured, applied) = recorded(&out);
        let values: Vec<_> = measured.iter().map(|message| message.surface_torque).collect();
        assert_eq!(values, [0, 1, 2, 3].map(torque));
        let late = if timed { SECOND / 4 } else { 0 };
        let times: Vec<_> = bytes.iter().map(|(time, _)| *time).collect();
        assert_eq!(times, [0, 1, 2, 3].map(|second| START + second * SECOND + late));
        // Three digits after the point are on the line, in r/min.
        let newest = applied.last().unwrap();
        assert!((newest.rotary_speed - 4.3).abs() < 1e-3, "{newest:?}");
    }
    // A capture is known by its first line, and one that is cut is used up to there.
    let line = folder.path().join("line.wits");
    let whole = std::fs::read(&line).unwrap();
    let cut = folder.path().join("cut.wits");
    std::fs::write(&cut, &whole[..whole.len() - 10]).unwrap();
    let out = folder.path().join("cut bag");
    let said = replay(&cut, &out, &["--config", config.to_str().unwrap()]);
    assert!(
        said.contains("what is before it was read") && said.contains("3 used"),
        "{said}"
    );
    assert_eq!(recorded(&out).1.len(), 3);
}

#[test]
fn what_is_no_wits_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let config = small_config();
    let noise = folder.path().join("noise.txt");
    std::fs::write(&noise, "no frame at all\n").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(&noise)
        .args(["--wits", "--config"])
        .arg(&config)
        .arg("--out")
        .arg(folder.path().join("bag"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("no sample of rotary speed or weight on bit"), "{said}");
    assert!(
        said.contains("0 frames, 0 used") && said.contains("16 bytes in no frame"),
        "{said}"
    );
    assert!(!folder.path().join("bag").exists());
}
