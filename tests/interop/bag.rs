//! Our bags read by foreign programs, and theirs by us: the Python packages rosbags and mcap-ros2-support.

use crate::bag_support::{PERIOD, START, recording};
use flexdrill::bag;
use flexdrill::messages::std_msgs::Float64;
use flexdrill::messages::{BitState, Message};

#[test]
fn interop_foreign_programs_read_our_recording() {
    let folder = tempfile::tempdir().unwrap();
    recording(folder.path(), "run", 1500);
    let bag = folder.path().join("run");
    if let Some(printed) = crate::common::python::run("bags.py", &["check", bag.to_str().unwrap()], "") {
        assert_eq!(printed.trim(), "messages 1500");
    }
}

#[test]
fn interop_foreign_programs_read_what_we_recover() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 1500);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() * 2 / 3]).unwrap();
    let output = folder.path().join("recovered");
    let recovered = bag::recover(&path, &output).unwrap();
    if let Some(printed) = crate::common::python::run("bags.py", &["check", output.to_str().unwrap()], "") {
        assert_eq!(printed.trim(), format!("messages {}", recovered.recording.messages));
    }
}

/// A recording whose process was killed has no metadata, which others ask for: better than one that says nothing is there.
#[test]
fn interop_foreign_programs_refuse_a_killed_recording() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("run");
    let mut recorder = bag::Recorder::create(&bag, &crate::bag_support::topics()).unwrap();
    crate::bag_support::record(&mut recorder, 300);
    recorder.flush().unwrap();
    // As a kill does: nothing more is written.
    std::mem::forget(recorder);
    if let Some(printed) = crate::common::python::run("bags.py", &["killed", bag.to_str().unwrap()], "") {
        assert!(printed.contains("refused") && printed.contains("metadata"), "{printed}");
    }
    assert_eq!(crate::bag_support::check_prefix(bag::open(&bag).unwrap()), 300);
}

#[test]
fn interop_we_read_foreign_recordings() {
    let folder = tempfile::tempdir().unwrap();
    let Some(printed) = crate::common::python::run("bags.py", &["write", folder.path().to_str().unwrap()], "") else {
        return;
    };
    assert_eq!(printed.trim(), format!("hash {}", BitState::RIHS01));
    flexdrill_sqlite::read_sqlite();
    for (path, file) in [("mcap", "mcap.mcap"), ("sqlite", "sqlite.db3")] {
        // The folder and the file in it.
        for path in [folder.path().join(path), folder.path().join(path).join(file)] {
            let bag = bag::open(&path).unwrap();
            assert_eq!(bag.message_count(), Some(1400));
            assert_eq!(bag.bounds(), Some((START, START + 699 * PERIOD + PERIOD / 2)));
            let topic = bag.topic("twin/bit_state").unwrap();
            assert_eq!(topic.name, "/rig_7/twin/bit_state");
            assert!(topic.schema.contains("MSG: std_msgs/"), "{}", topic.schema);
            let mut count = 0;
            for message in bag {
                let message = message.unwrap();
                let index = count / 2;
                if count % 2 == 0 {
                    assert_eq!(message.log_time, START + index * PERIOD);
                    assert_eq!(message.decode::<Float64>().unwrap().data, index as f64);
                } else {
                    assert_eq!(message.log_time, START + index * PERIOD + PERIOD / 2);
                    let state: BitState = message.decode().unwrap();
                    assert_eq!((state.torque, state.lateral_acceleration), (index as f64, 0.3));
                    assert_eq!(state.header.stamp.to_nanoseconds(), START + index * PERIOD);
                }
                count += 1;
            }
            assert_eq!(count, 1400);
            // A bag in SQLite becomes one in MCAP.
            let output = folder.path().join(format!("copy_{}_{}", file, path.is_dir()));
            assert_eq!(bag::recover(&path, &output).unwrap().recording.messages, 1400);
            assert_eq!(
                bag::open(&output).unwrap().filter(|message| message.is_ok()).count(),
                1400
            );
        }
    }
}
