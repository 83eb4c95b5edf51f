//! Bags that are wrong in one way each: what is read of them, and what is said. The files are made of bytes by the
//! specification of MCAP, and the `mcap` crate judges them where it can.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod parts;

use std::path::{Path, PathBuf};

use flexdrill_bag::{BagError, PartFault, open, recover};
use flexdrill_messages::std_msgs::Float64;
use mcap::records::op;

/// Log time of the first message (ns).
const START: u64 = 1_700_000_000_000_000_000;
const SECOND: u64 = 1_000_000_000;
const RPM: &str = "/rig/rotary_speed_rpm";
const WEIGHT: &str = "/rig/weight_on_bit_kn";
const FLOAT64: &str = "std_msgs/msg/Float64";

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

fn record(opcode: u8, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat()
}

fn schema(id: u16, name: &str, definition: &str) -> Vec<u8> {
    let body = [&id.to_le_bytes()[..], &text(name), &text("ros2msg"), &text(definition)].concat();
    record(op::SCHEMA, &body)
}

fn channel_as(id: u16, schema: u16, topic: &str, encoding: &str) -> Vec<u8> {
    let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
    record(
        op::CHANNEL,
        &[&ids[..], &text(topic), &text(encoding), &[0; 4]].concat(),
    )
}

fn channel(id: u16, topic: &str) -> Vec<u8> {
    channel_as(id, 1, topic, "cdr")
}

/// A `std_msgs/msg/Float64` in CDR.
fn message(channel: u16, time: u64, value: f64) -> Vec<u8> {
    let cdr = [&[0, 1, 0, 0][..], &value.to_le_bytes()].concat();
    message_of(channel, time, &cdr)
}

fn message_of(channel: u16, time: u64, data: &[u8]) -> Vec<u8> {
    let head = [
        &channel.to_le_bytes()[..],
        &0_u32.to_le_bytes(),
        &time.to_le_bytes(),
        &time.to_le_bytes(),
    ];
    record(op::MESSAGE, &[&head.concat()[..], data].concat())
}

fn chunk(start: u64, end: u64, records: &[Vec<u8>]) -> Vec<u8> {
    let records = records.concat();
    let packed = zstd::encode_all(&records[..], 1).unwrap();
    let body = [
        &start.to_le_bytes()[..],
        &end.to_le_bytes(),
        &(records.len() as u64).to_le_bytes(),
        &crc32fast::hash(&records).to_le_bytes(),
        &text("zstd"),
        &(packed.len() as u64).to_le_bytes(),
        &packed,
    ];
    record(op::CHUNK, &body.concat())
}

/// A file with these records and an end; `summary` are records between them.
fn file(data: &[Vec<u8>], summary: &[Vec<u8>]) -> Vec<u8> {
    let header = record(op::HEADER, &[text("ros2"), text("made by hand")].concat());
    let before = [mcap::MAGIC, &header, &data.concat(), &record(op::DATA_END, &[0; 4])].concat();
    let summary = summary.concat();
    let begin = if summary.is_empty() { 0 } else { before.len() as u64 };
    let footer = record(op::FOOTER, &[&begin.to_le_bytes()[..], &[0; 12]].concat());
    [&before[..], &summary, &footer, mcap::MAGIC].concat()
}

fn float64() -> Vec<u8> {
    schema(1, FLOAT64, "float64 data\n")
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// Topic, seconds since the start and value of every message; every error.
fn read(path: &Path) -> (Vec<(String, u64, f64)>, Vec<String>) {
    let (mut messages, mut errors) = (Vec::new(), Vec::new());
    for item in open(path).unwrap() {
        match item {
            Ok(message) => messages.push((
                message.topic.name.clone(),
                (message.log_time as u64 - START) / SECOND,
                message.decode::<Float64>().unwrap().data,
            )),
            Err(error) => errors.push(error.to_string()),
        }
    }
    (messages, errors)
}

fn says(errors: &[impl ToString], parts: &[&str]) {
    let all = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    for part in parts {
        assert!(all.contains(part), "'{part}' is not in:\n{all}");
    }
}

/// Four chunks of a second; the third gives channel 1 to the weight. Loose records and chunks, with and without a summary.
fn two_topics(chunked: bool, summary: &[Vec<u8>]) -> Vec<u8> {
    let at = |second: u64| START + second * SECOND;
    let parts = [
        vec![float64(), channel(1, RPM), message(1, at(0), 120.0)],
        vec![message(1, at(1), 121.0)],
        vec![message(1, at(2), 122.0), channel(1, WEIGHT), message(1, at(3), 25.0)],
        vec![message(1, at(4), 26.0)],
    ];
    let times = [(0, 0), (1, 1), (2, 3), (4, 4)];
    let data = parts.into_iter().zip(times).map(|(records, (from, to))| {
        if chunked {
            chunk(at(from), at(to), &records)
        } else {
            records.concat()
        }
    });
    file(&data.collect::<Vec<_>>(), summary)
}

#[test]
fn a_weight_is_never_read_as_a_speed_where_a_channel_changes_its_topic() {
    let folder = tempfile::tempdir().unwrap();
    let summaries = [
        vec![],
        vec![float64(), channel(1, RPM)],
        // What a writer keeps that forgets the first topic.
        vec![float64(), channel(1, WEIGHT)],
    ];
    for chunked in [true, false] {
        for summary in &summaries {
            let bytes = two_topics(chunked, summary);
            // The format's own library refuses the file.
            let foreign = mcap::MessageStream::new(&bytes).unwrap().find_map(Result::err);
            assert!(
                matches!(foreign, Some(mcap::McapError::ConflictingChannels(_))),
                "{foreign:?}"
            );
            let path = write(folder.path(), "two_topics.mcap", &bytes);
            let (messages, errors) = read(&path);
            let expected: Vec<_> = (0..3).map(|at| (RPM.to_owned(), at, 120.0 + at as f64)).collect();
            assert_eq!(messages, expected, "{errors:?}");
            says(
                &errors,
                &[
                    "channel 1 is",
                    RPM,
                    WEIGHT,
                    "from byte",
                    "one topic",
                    "left out",
                    "two_topics.mcap",
                ],
            );
            // Forward to the end, without what lies between.
            let mut bag = open(&path).unwrap();
            bag.seek((START + 4 * SECOND) as i64);
            let sought: Vec<_> = bag.filter_map(Result::ok).collect();
            assert!(sought.is_empty(), "{sought:?}");
            let out = folder.path().join("recovered");
            let recovered = recover(&path, &out).unwrap();
            assert_eq!(recovered.recording.messages, 3);
            says(&recovered.damaged, &["channel 1 is", WEIGHT]);
            std::fs::remove_dir_all(out).unwrap();
        }
    }
}

/// The type decides how bytes are read as much as the topic does.
#[test]
fn a_channel_that_changes_its_type_is_named_too() {
    let folder = tempfile::tempdir().unwrap();
    let float32 = || schema(1, "std_msgs/msg/Float32", "float32 data\n");
    let data = [
        chunk(START, START, &[float64(), channel(1, RPM), message(1, START, 120.0)]),
        chunk(
            START + SECOND,
            START + SECOND,
            &[
                float32(),
                channel(1, RPM),
                message_of(1, START + SECOND, &[0, 1, 0, 0, 0, 0, 0x80, 0x3f]),
            ],
        ),
    ];
    let path = write(folder.path(), "types.mcap", &file(&data, &[]));
    let (messages, errors) = read(&path);
    assert_eq!(messages, [(RPM.to_owned(), 0, 120.0)]);
    says(&errors, &[FLOAT64, "std_msgs/msg/Float32"]);
}

#[test]
fn a_topic_of_another_type_encoding_or_none_is_named_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let at = |channel: u16, data: &[u8]| message_of(channel, START, data);
    let mut number = vec![0, 1, 0, 0];
    number.extend_from_slice(&40.0_f32.to_le_bytes());
    let data = [
        float64(),
        schema(2, "std_msgs/msg/Float32", "float32 data\n"),
        channel_as(1, 2, "/float32", "cdr"),
        channel_as(2, 0, "/untyped", "cdr"),
        channel_as(3, 1, "/json", "json"),
        channel_as(4, 1, "/ros1", "ros1"),
        at(1, &number),
        at(2, &[&[0, 1, 0, 0][..], &40.0_f64.to_le_bytes()].concat()),
        at(3, b"{\"data\": 40.0}"),
        // Eight bytes whose first four are a CDR header: 40.0 ends in zeros.
        at(4, &40.0_f64.to_le_bytes()),
    ];
    let path = write(folder.path(), "types.mcap", &file(&data, &[]));
    let mut errors = Vec::new();
    for message in open(&path).unwrap() {
        errors.push(message.unwrap().decode::<Float64>().unwrap_err());
    }
    let bag = open(&path).unwrap();
    for (name, parts) in [
        (
            "/float32",
            &[
                "/float32 has the type std_msgs/msg/Float32, expected std_msgs/msg/Float64",
                "convert",
            ][..],
        ),
        (
            "/untyped",
            &["/untyped has no type", "no schema", "message definitions"],
        ),
        (
            "/json",
            &["/json is encoded as \"json\"", "expected \"cdr\"", "ros2 bag record"],
        ),
        ("/ros1", &["/ros1 is encoded as \"ros1\"", "rosbags-convert"]),
    ] {
        says(&errors, parts);
        says(&[bag.topic_of_type(name, FLOAT64).unwrap_err()], parts);
    }
    let ros1 = write(folder.path(), "old.bag", b"#ROSBAG V2.0\nE\0\0\0");
    says(&[open(&ros1).err().unwrap()], &["old.bag", "ROS 1", "rosbags-convert"]);
}

/// Of two topics with one name the one with the type is found, and of two descriptions of one topic either.
#[test]
fn a_topic_is_found_by_name_and_type() {
    let folder = tempfile::tempdir().unwrap();
    let more = [&5_u32.to_le_bytes()[..], &[1, 0, 0, 0, b'a'], &[0; 4]].concat();
    let mut with_metadata = channel(3, RPM);
    with_metadata.truncate(with_metadata.len() - 4);
    with_metadata.extend([&(more.len() as u32 - 4).to_le_bytes()[..], &more[4..]].concat());
    let length = (with_metadata.len() - 9) as u64;
    with_metadata[1..9].copy_from_slice(&length.to_le_bytes());
    let data = [
        float64(),
        schema(2, "std_msgs/msg/Float32", "float32 data\n"),
        channel_as(1, 2, RPM, "cdr"),
        channel(2, RPM),
        with_metadata,
        message(2, START, 120.0),
    ];
    let path = write(folder.path(), "names.mcap", &file(&data, &[]));
    let bag = open(&path).unwrap();
    assert!(matches!(bag.topic(RPM), Err(BagError::AmbiguousTopic { .. })));
    assert_eq!(
        bag.topic_of_type("rig/rotary_speed_rpm", FLOAT64).unwrap().ros_type,
        FLOAT64
    );
    assert!(matches!(
        bag.topic_of_type("/other", FLOAT64),
        Err(BagError::NoTopic { .. })
    ));
}

#[test]
fn log_times_that_no_clock_has_are_left_out_and_not_put_at_one_instant() {
    let folder = tempfile::tempdir().unwrap();
    let beyond = 1_u64 << 63;
    let records = [
        float64(),
        channel(1, RPM),
        message(1, START, 120.0),
        message(1, beyond, 121.0),
        message(1, beyond + SECOND, 122.0),
        message(1, u64::MAX, 123.0),
        message(1, START + SECOND, 124.0),
    ];
    for data in [vec![chunk(START, u64::MAX, &records)], records.to_vec()] {
        let path = write(folder.path(), "times.mcap", &file(&data, &[]));
        let (messages, errors) = read(&path);
        assert_eq!(messages, [(RPM.to_owned(), 0, 120.0), (RPM.to_owned(), 1, 124.0)]);
        says(
            &errors,
            &[
                RPM,
                "3 in number",
                "9223372036854775808 ns",
                "2262",
                "times.mcap",
                "byte",
            ],
        );
        let (start, end) = open(&path).unwrap().bounds().unwrap();
        assert!(start == START as i64 && end < i64::MAX, "{start} {end}");
    }
}

/// Ten chunks of one message each; channel and schema are in the first.
fn ten() -> (Vec<Vec<u8>>, Vec<u8>) {
    let data: Vec<_> = (0..10_u64)
        .map(|second| {
            let time = START + second * SECOND;
            let mut records = vec![message(1, time, second as f64)];
            if second == 0 {
                records.splice(0..0, [float64(), channel(1, RPM)]);
            }
            chunk(time, time, &records)
        })
        .collect();
    let bytes = file(&data, &[float64(), channel(1, RPM)]);
    (data, bytes)
}

#[test]
fn recovery_continues_behind_a_chunk_whose_head_or_length_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let (data, whole) = ten();
    let head = whole.len() - file(&[], &[float64(), channel(1, RPM)]).len();
    assert_eq!(head, data.iter().map(Vec::len).sum::<usize>());
    let first = file(&[], &[]).len() - mcap::MAGIC.len() - 29 - 13;
    let begin = |chunk: usize| first + data[..chunk].iter().map(Vec::len).sum::<usize>();
    assert_eq!(whole[begin(4)], op::CHUNK);
    // The offset in a chunk, the bytes there, and whether its message is lost too.
    let damages: [(usize, &[u8], bool); 8] = [
        (0, &[0; 40], true),
        (0, &[0xA7; 60], true),
        // The length: beyond the file, into the next chunk, too short.
        (1, &[0xFF; 8], false),
        (1, &[0xB0, 0, 0, 0, 0, 0, 0, 0], false),
        (1, &[50, 0, 0, 0, 0, 0, 0, 0], false),
        // The size of the compressed records in the chunk's head.
        (45, &[0xFF; 4], true),
        // The name of the compression, and the records.
        (41, b"????", true),
        (56, &[0x55; 8], true),
    ];
    for number in [0, 4, 9] {
        for (offset, with, lost) in damages {
            let mut bytes = whole.clone();
            let from = begin(number) + offset;
            bytes[from..from + with.len()].copy_from_slice(with);
            let path = write(folder.path(), "damaged.mcap", &bytes);
            let (messages, errors) = read(&path);
            let (cuts, what) = (open(&path).unwrap().cuts().count(), (number, offset));
            let seconds: Vec<_> = messages.iter().map(|(_, second, _)| *second).collect();
            let expected: Vec<_> = (0..10).filter(|second| !lost || *second != number as u64).collect();
            assert_eq!(seconds, expected, "{what:?} {errors:?}");
            assert!(messages.iter().all(|(_, second, value)| *second as f64 == *value));
            assert!(!errors.is_empty() || cuts == 1, "{what:?}");
            let out = folder.path().join("recovered");
            let recovered = recover(&path, &out).unwrap();
            assert_eq!(recovered.recording.messages as usize, expected.len());
            // The format's own library reads what was recovered.
            let bytes = std::fs::read(&recovered.recording.path).unwrap();
            assert_eq!(
                mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).count(),
                expected.len()
            );
            std::fs::remove_dir_all(out).unwrap();
        }
    }
}

#[test]
fn what_follows_behind_an_end_is_read_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let one = |topic: &str, second: u64| {
        let time = START + second * SECOND;
        [float64(), channel(1, topic), message(1, time, second as f64)]
    };
    // Both files have a channel 1, so that the second topic is left out.
    for (topic, count) in [(RPM, 2), (WEIGHT, 1)] {
        let bytes = [file(&one(RPM, 0), &[]), file(&one(topic, 1), &[])].concat();
        let path = write(folder.path(), "joined.mcap", &bytes);
        let (messages, errors) = read(&path);
        assert_eq!(messages.len(), count, "{errors:?}");
        assert!(messages.iter().all(|(topic, ..)| topic == RPM));
        says(&errors, &["continues behind its end", "joined.mcap"]);
    }
}

/// Whatever bytes are damaged, a message that is read has its own value and time, and is read once.
#[test]
fn a_thousand_damaged_files_invent_no_value() {
    let folder = tempfile::tempdir().unwrap();
    let (_, whole) = ten();
    let mut state = 7_u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut most_lost = 0;
    for case in 0..1000 {
        let mut bytes = whole.clone();
        for _ in 0..=random(4) {
            let (from, length) = (8 + random(bytes.len() - 8), 1 + random(12));
            let with = random(256) as u8;
            let to = bytes.len().min(from + length);
            bytes[from..to].fill(with);
        }
        let path = write(folder.path(), "damaged.mcap", &bytes);
        let mut seen = Vec::new();
        for message in open(&path).unwrap().filter_map(Result::ok) {
            if message.topic.name != RPM || message.topic.check(FLOAT64).is_err() {
                continue;
            }
            let second = (message.log_time as u64 - START) / SECOND;
            assert_eq!(message.decode::<Float64>().unwrap().data, second as f64, "case {case}");
            assert!(!seen.contains(&second), "case {case}: {second} twice");
            seen.push(second);
        }
        most_lost = most_lost.max(10 - seen.len());
        if case % 50 == 0 {
            recover(&path, &folder.path().join(format!("recovered_{case}"))).unwrap();
        }
    }
    println!("at most {most_lost} of 10 chunks are lost");
}
