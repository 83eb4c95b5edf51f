//! A recording with known content, for the tests of bags.

#![allow(dead_code, reason = "each test file uses some of it")]
#![allow(clippy::unwrap_used, reason = "a helper of tests fails by panicking")]

pub mod faulty;
pub mod witness;

use std::path::{Path, PathBuf};

use flexdrill::bag::{Bag, Recorder, Topic};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::{Float64, Header};
use flexdrill::messages::{BitState, ContactForces, to_cdr, topics};

/// Log time of the first message (ns).
pub const START: i64 = 1_700_000_000_000_000_000;
/// Between two instants at which messages are recorded (ns): 50 Hz.
pub const PERIOD: i64 = 20_000_000;

/// An input, a small output, a large output and one that stays empty, in a namespace.
pub fn topics() -> Vec<Topic> {
    [
        topics::ROTARY_SPEED_RPM,
        topics::BIT_STATE,
        topics::CONTACT_FORCES,
        topics::WHIRL_WARNINGS,
    ]
    .map(|topic| Topic::new(format!("/rig_7/{}", topic.name), &topic.kind, topic.qos))
    .to_vec()
}

/// Topic, log time and bytes of the message number `index`.
pub fn message(index: usize) -> (usize, i64, Vec<u8>) {
    let log_time = START + (index / 3) as i64 * PERIOD;
    let value = index as f64;
    let header = Header {
        stamp: Time::from_nanoseconds(log_time),
        frame_id: "flexible_tool".to_owned(),
    };
    let bytes = match index % 3 {
        0 => to_cdr(&Float64 { data: value }),
        1 => to_cdr(&BitState {
            header,
            torque: value,
            rotary_speed: 4.2,
            ..BitState::default()
        }),
        _ => to_cdr(&ContactForces {
            header,
            max_pipe_guide_force: value,
            state: vec![ContactForces::INNER; 40],
            pipe_guide_normal: (0..40).map(|station| (value * 0.37 + station as f64).sin()).collect(),
            ..ContactForces::default()
        }),
    };
    (index % 3, log_time, bytes.unwrap())
}

/// Records messages `0..count`.
pub fn record(recorder: &mut Recorder, count: usize) {
    for index in 0..count {
        let (topic, log_time, bytes) = message(index);
        recorder.record(topic, log_time, &bytes).unwrap();
    }
}

/// A finished recording of `count` messages.
pub fn recording(folder: &Path, name: &str, count: usize) -> PathBuf {
    let mut recorder = Recorder::create(&folder.join(name), &topics()).unwrap();
    record(&mut recorder, count);
    recorder.finish().unwrap().path
}

/// Reads the bag and checks that it holds the messages `0..n` in order, without gaps. Returns n.
pub fn check_prefix(bag: Bag) -> usize {
    let mut count = 0;
    for read in bag {
        let read = read.unwrap();
        let (topic, log_time, bytes) = message(count);
        assert_eq!(read.topic.name, topics()[topic].name, "message {count}");
        assert_eq!(
            (read.log_time, read.publish_time),
            (log_time, log_time),
            "message {count}"
        );
        assert!(read.data == bytes, "message {count} has other bytes");
        count += 1;
    }
    count
}
