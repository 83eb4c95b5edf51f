//! A recording of an earlier release: `tests/data/recording_0_1_0.mcap` was written by flexdrill 0.1.0 (`replay` of a log
//! of constant inputs, 4 s), whose messages end earlier and which knew two inputs.

use std::path::Path;
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::{AppliedInputs, BitState, ContactForces, JointDeflections, SessionInfo, Transfer};

/// What a recording shows of the drilling.
#[derive(Default)]
struct Read {
    inputs: Vec<AppliedInputs>,
    bit: Vec<BitState>,
    joints: Vec<JointDeflections>,
    contacts: usize,
    transfer: usize,
    session: SessionInfo,
}

fn read(path: &Path) -> Read {
    let mut found = Read::default();
    for message in bag::open(path).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/applied_inputs") {
            found.inputs.push(message.decode().unwrap());
        } else if message.topic.is("twin/bit_state") {
            found.bit.push(message.decode().unwrap());
        } else if message.topic.is("twin/joint_deflections") {
            found.joints.push(message.decode().unwrap());
        } else if message.topic.is("twin/contact_forces") {
            message.decode::<ContactForces>().unwrap();
            found.contacts += 1;
        } else if message.topic.is("twin/transfer") {
            message.decode::<Transfer>().unwrap();
            found.transfer += 1;
        } else if message.topic.is("twin/session") {
            found.session = message.decode().unwrap();
        }
    }
    found
}

fn flexdrill(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{said:?}");
    said.concat()
}

#[test]
fn regress_a_recording_of_an_earlier_release_is_replayed_and_reported() {
    let recording = crate::common::root().join("tests/data/recording_0_1_0.mcap");
    let before = read(&recording);
    assert_eq!(before.session.version, "0.1.0");
    // 5 and 2 messages per second over 4 s.
    let counts = (before.bit.len(), before.joints.len(), before.contacts);
    assert!(counts.0 >= 20 && counts.1 >= 20 && counts.2 >= 8, "{counts:?}");
    assert_eq!(before.transfer, 0, "0.1.0 had no such message");
    let folder = tempfile::tempdir().unwrap();
    let (again, pages) = (folder.path().join("again"), folder.path().join("pages"));
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let said = flexdrill(&["replay", &text(&recording), "--out", &text(&again)]);
    assert!(said.contains("not exact: recorded with flexdrill 0.1.0"), "{said}");
    let after = read(&again);
    assert_eq!(after.session.version, env!("CARGO_PKG_VERSION"));
    assert!(after.transfer > 0);
    // The inputs are those of the recording; the optional ones, which it did not have, are at rest.
    let last = after.inputs.last().unwrap();
    let recorded = before.inputs.last().unwrap();
    assert_eq!(
        (last.rotary_speed, last.weight_on_bit),
        (recorded.rotary_speed, recorded.weight_on_bit)
    );
    assert!((last.rotary_speed * 30.0 / std::f64::consts::PI - 40.0).abs() < 1e-6);
    assert_eq!((last.rate_of_penetration, last.standpipe_pressure), (0.0, 0.0));
    // The same tool: the torque of the rock follows from weight and speed alone once the bit turns, and the well's bend is
    // that of the joints on average. The solver of 0.1.0 was another, so that the motion's details differ.
    let torque = |read: &Read| read.bit.iter().map(|bit| bit.torque).fold(0.0, f64::max);
    let (old, new) = (torque(&before), torque(&after));
    assert!(
        old > 50.0 && (new / old - 1.0).abs() < 0.01,
        "{new} instead of {old} N m"
    );
    let bend = |read: &Read| {
        let late = &read.joints[10..];
        let all = late.iter().flat_map(|joints| &joints.bend_angle);
        all.clone().sum::<f64>() / all.count() as f64
    };
    let (old, new) = (bend(&before), bend(&after));
    assert!(
        old > 0.02 && (new / old - 1.0).abs() < 0.25,
        "{new} instead of {old} rad"
    );
    for bag in [&recording, &again] {
        flexdrill(&["report", &text(bag), "--out", &text(&pages)]);
        let page = std::fs::read_to_string(pages.join("report.html")).unwrap();
        assert!(page.ends_with("</html>") && !page.contains("NaN"));
        assert_eq!(page.contains("<figure id=\"transfer\">"), bag == &again);
        std::fs::remove_dir_all(&pages).unwrap();
    }
}
