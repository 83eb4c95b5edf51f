//! The history: one frame per second, bounded, with its gaps.

use super::columns::MOST_BYTES;
use super::*;
use flexdrill_messages::SessionInfo;
use serde_json::Value;

fn session() -> Session {
    let configuration = include_str!("../../../../tests/data/small.yaml").to_owned();
    Session::new(&SessionInfo {
        configuration,
        ..SessionInfo::default()
    })
    .unwrap()
}

fn bit(speed: f64) -> BitState {
    BitState {
        rotary_speed: speed,
        torque: 10.0 * speed,
        ..BitState::default()
    }
}

fn begun() -> History {
    let mut history = History::new(1);
    begin(&mut history);
    history
}

fn begin(history: &mut History) {
    let whirl = WhirlState {
        kind: vec![2, 0],
        whirl_ratio: vec![-1.5, f64::NAN],
        ..WhirlState::default()
    };
    history.whirl(0, &whirl, &session());
}

/// Head and frames of what the page gets.
fn parts(history: &History) -> (Value, Vec<Vec<f32>>) {
    let bytes = history.to_bytes().unwrap();
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    assert_eq!((4 + length) % 8, 0);
    let head: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let numbers: Vec<f32> = bytes[4 + length..]
        .as_chunks::<4>()
        .0
        .iter()
        .map(|four| f32::from_le_bytes(*four))
        .collect();
    let stride = head["stride"].as_u64().unwrap() as usize;
    assert_eq!(numbers.len(), stride * head["count"].as_u64().unwrap() as usize);
    (head, numbers.chunks(stride).map(<[f32]>::to_vec).collect())
}

fn column(head: &Value, name: &str) -> std::ops::Range<usize> {
    let columns = head["columns"].as_array().unwrap();
    let found = columns.iter().find(|column| column["name"] == name).unwrap();
    let of = |key: &str| found[key].as_u64().unwrap() as usize;
    of("offset")..of("offset") + of("length")
}

#[test]
fn a_second_is_reduced_to_least_mean_and_largest() {
    let mut history = History::new(1);
    // Latched, it comes before all else.
    let severity = WhirlWarning::CRITICAL;
    history.warning(
        0,
        &WhirlWarning {
            severity,
            ..WhirlWarning::default()
        },
    );
    begin(&mut history);
    for (time, speed) in [(100, 3.0), (500, 1.0), (900, 5.0), (1_100, 7.0)] {
        history.bit(time * 1_000_000, &bit(speed));
    }
    let (head, frames) = parts(&history);
    assert_eq!(frames.len(), 2);
    let value = |frame: usize, name: &str| frames[frame][column(&head, name).start];
    assert_eq!(
        (
            value(0, "bit_speed_min"),
            value(0, "bit_speed_mean"),
            value(0, "bit_speed_max")
        ),
        (1.0, 3.0, 5.0)
    );
    assert_eq!((value(1, "time"), value(1, "bit_torque_max")), (1.0, 70.0));
    assert_eq!(frames[0][column(&head, "whirl_ratio").start], -1.5);
    assert!(frames[0][column(&head, "whirl_ratio")][1].is_nan());
    // A level holds until another one arrives.
    assert_eq!((value(0, "warning_severity"), value(1, "warning_severity")), (3.0, 3.0));
    // What was not heard is not made up.
    assert!(value(0, "state").is_nan() && frames[0][column(&head, "pipe_y")].iter().all(|y| y.is_nan()));
}

#[test]
fn it_spans_at_most_an_hour_and_keeps_gaps() {
    let mut history = begun();
    for second in 0..5000_i64 {
        if !(4000..4100).contains(&second) {
            history.bit(second * SECOND, &bit(second as f64));
        }
    }
    let (head, frames) = parts(&history);
    // The open one is on top.
    assert_eq!(frames.len(), CAPACITY + 1);
    assert_eq!(head["base_ns"], (1299 * SECOND).to_string());
    let steps = frames.windows(2).filter(|pair| pair[1][0] - pair[0][0] != 1.0).count();
    assert_eq!(steps, 1);
    // Late by less than another run would be: not taken; another run: the hour begins anew.
    history.bit(4998 * SECOND, &bit(0.0));
    assert_eq!(parts(&history).1.len(), CAPACITY + 1);
    history.bit(10 * SECOND, &bit(0.0));
    assert_eq!(parts(&history).1.len(), 1);
}

#[test]
fn an_hour_of_the_default_tool_has_the_memory_that_is_documented() {
    let layout = Layout::new(32, 166, 64);
    let bytes = layout.stride * 4 * layout.capacity();
    assert!((22_000_000..24_000_000).contains(&bytes), "{bytes}");
    let longest = Layout::new(2000, 100_000, 200_000);
    assert!(longest.stride * 4 * longest.capacity() <= MOST_BYTES);
}

#[test]
fn a_message_that_is_not_of_this_tool_takes_no_memory() {
    let mut history = History::new(1);
    let kind = vec![0; 1_000_000];
    history.whirl(
        0,
        &WhirlState {
            kind,
            ..WhirlState::default()
        },
        &session(),
    );
    assert!(history.to_bytes().is_none());
}

/// A page that is opened after the twin has ended draws the tool from this.
#[test]
fn the_head_lists_the_watched_stations() {
    let mut history = History::new(1);
    let whirl = |depth: f64| WhirlState {
        kind: vec![0, 0],
        body: vec![0, 1],
        measured_depth: vec![0.5, depth],
        ..WhirlState::default()
    };
    for depth in [0.75, 1.25] {
        history.whirl(0, &whirl(depth), &session());
    }
    let (head, _) = parts(&history);
    assert_eq!(head["watched_body"], serde_json::json!([0, 1]));
    // A later run watches as many stations, at other depths.
    assert_eq!(head["watched_depth"], serde_json::json!([0.5, 1.25]));
}
