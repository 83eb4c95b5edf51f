//! What is recorded is read back: bytes, times, order, topics; and what cannot be done is refused with its reason.

use crate::bag_support::{PERIOD, START, check_prefix, message, record, recording, topics};
use flexdrill::bag::{self, BagError, Recorder, Topic};
use flexdrill::messages::std_msgs::Float64;
use flexdrill::messages::{BitState, to_cdr, topics as table};

#[test]
fn a_file_is_read_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 1000);
    assert_eq!(path, folder.path().join("run.mcap"));
    let bag = bag::open(&path).unwrap();
    assert_eq!(bag.message_count(), Some(1000));
    assert_eq!(bag.bounds(), Some((START, START + 333 * PERIOD)));
    assert_eq!(bag.cuts().count(), 0);
    let read: Vec<Topic> = bag.topics().iter().map(|topic| (**topic).clone()).collect();
    assert_eq!(read, topics());
    assert_eq!(check_prefix(bag), 1000);

    let metadata = std::fs::read_to_string(folder.path().join("metadata.yaml")).unwrap();
    assert!(metadata.contains("message_count: 1000"), "{metadata}");
    // The folder is a bag too.
    assert_eq!(check_prefix(bag::open(folder.path()).unwrap()), 1000);
}

#[test]
fn a_path_without_mcap_becomes_a_folder_as_rosbag2_makes_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "deep/night_run", 30);
    assert_eq!(path, folder.path().join("deep/night_run/night_run_0.mcap"));
    assert_eq!(
        check_prefix(bag::open(&folder.path().join("deep/night_run")).unwrap()),
        30
    );
}

#[test]
fn the_same_messages_give_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let first = std::fs::read(recording(folder.path(), "a/run.mcap", 2000)).unwrap();
    let second = std::fs::read(recording(folder.path(), "b/run.mcap", 2000)).unwrap();
    assert!(first == second);
}

#[test]
fn nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    recording(folder.path(), "run.mcap", 3);
    let refuse = |name: &str| Recorder::create(&folder.path().join(name), &topics()).err().unwrap();
    assert!(matches!(refuse("run.mcap"), BagError::Exists { .. }));
    let error = refuse("other.mcap");
    assert!(matches!(error, BagError::OtherMetadata { .. }));
    assert!(error.to_string().contains("empty folder"), "{error}");
    assert!(!folder.path().join("other.mcap").exists());
    recording(folder.path(), "other", 3);
    assert!(matches!(refuse("other"), BagError::Exists { .. }));
}

#[test]
fn a_path_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let blocking = folder.path().join("file");
    std::fs::write(&blocking, "").unwrap();
    let error = Recorder::create(&blocking.join("run.mcap"), &topics()).err().unwrap();
    assert!(error.to_string().contains("file"), "{error}");
    let error = bag::open(&folder.path().join("missing.mcap")).err().unwrap();
    assert!(error.to_string().contains("missing.mcap"), "{error}");
    let error = bag::open(&blocking).err().unwrap();
    assert!(matches!(error, BagError::NotABag { .. }));
    let empty = folder.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    assert!(matches!(bag::open(&empty).err().unwrap(), BagError::NotABag { .. }));
}

#[test]
fn messages_come_in_time_order_and_equal_times_in_the_order_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mixed.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    let bytes = |value: f64| to_cdr(&Float64 { data: value }).unwrap();
    // Late messages, further back than a chunk is long.
    let times = [0, 500, 3000, 2000, 100, 3000, 1500, 9000, 100];
    for (index, milliseconds) in times.iter().enumerate() {
        recorder
            .record(0, START + milliseconds * 1_000_000, &bytes(index as f64))
            .unwrap();
    }
    recorder.finish().unwrap();
    let order: Vec<f64> = bag::open(&path)
        .unwrap()
        .map(|message| message.unwrap().decode::<Float64>().unwrap().data)
        .collect();
    assert_eq!(order, [0.0, 4.0, 8.0, 1.0, 6.0, 3.0, 2.0, 5.0, 7.0]);
}

#[test]
fn topics_are_found_in_any_namespace() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.mcap");
    let names = [
        "/rig_7/twin/bit_state",
        "/rig_8/twin/bit_state",
        "/rig_8/rig/rotary_speed_rpm",
    ];
    let all = names.map(|name| Topic::new(name, &table::BIT_STATE.kind, table::BIT_STATE.qos));
    let mut recorder = Recorder::create(&path, &all).unwrap();
    let bytes = to_cdr(&BitState::default()).unwrap();
    for topic in 0..3 {
        recorder.record(topic, START, &bytes).unwrap();
    }
    recorder.finish().unwrap();
    let mut bag = bag::open(&path).unwrap();
    assert_eq!(bag.topic("rig/rotary_speed_rpm").unwrap().name, names[2]);
    assert_eq!(bag.topic("/rig_7/twin/bit_state").unwrap().name, names[0]);
    assert!(
        bag.topic("twin/bit_state")
            .unwrap_err()
            .to_string()
            .contains("/rig_8/twin/bit_state")
    );
    assert!(matches!(bag.topic("state").unwrap_err(), BagError::NoTopic { .. }));
    bag.select(|topic| topic.is("rig/rotary_speed_rpm"));
    let messages: Vec<_> = bag.map(Result::unwrap).collect();
    assert_eq!(messages.len(), 1);
    assert_eq!(messages[0].topic.name, names[2]);
    assert!(matches!(
        messages[0].decode::<Float64>().unwrap_err(),
        BagError::WrongType { .. }
    ));
}

#[test]
fn an_unannounced_topic_is_refused_and_the_recording_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    assert!(matches!(
        recorder.record(9, START, &[]).unwrap_err(),
        BagError::NoSuchIndex { .. }
    ));
    record(&mut recorder, 9);
    assert_eq!(recorder.finish().unwrap().per_topic, [3, 3, 3, 0]);
}

#[test]
fn a_recording_without_messages_is_a_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 0);
    let bag = bag::open(&path).unwrap();
    assert_eq!(bag.topics().len(), 4);
    assert_eq!((bag.message_count(), bag.bounds()), (Some(0), None));
    assert_eq!(bag.count(), 0);
}

#[test]
fn a_dropped_recorder_leaves_a_whole_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    record(&mut recorder, 7);
    drop(recorder);
    let bag = bag::open(&path).unwrap();
    assert_eq!(bag.cuts().count(), 0);
    assert_eq!(check_prefix(bag), 7);
}

#[test]
fn one_damaged_chunk_costs_only_its_own_messages() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 1500);
    let mut bytes = std::fs::read(&path).unwrap();
    // Well inside one of the chunks.
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let chunk = &summary.chunk_indexes[9];
    let middle = (chunk.chunk_start_offset + chunk.chunk_length / 2) as usize;
    bytes[middle] ^= 0xFF;
    let damaged = folder.path().join("damaged.mcap");
    std::fs::write(&damaged, &bytes).unwrap();
    let (mut good, mut errors) = (0, Vec::new());
    for item in bag::open(&damaged).unwrap() {
        match item {
            Ok(_) => good += 1,
            Err(error) => errors.push(error),
        }
    }
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(matches!(errors[0], BagError::Damaged { .. }));
    assert!((1200..1500).contains(&good), "{good}");

    let recovered = bag::recover(&damaged, &folder.path().join("recovered")).unwrap();
    assert_eq!(recovered.recording.messages, good);
    assert_eq!(recovered.damaged.len(), 1);
}

#[test]
fn a_message_larger_than_a_chunk_passes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    let large: Vec<u8> = (0..5_000_000_u32).map(|value| (value % 251) as u8).collect();
    recorder.record(0, START, &large).unwrap();
    recorder.record(0, START + 1, &message(0).2).unwrap();
    recorder.finish().unwrap();
    let read: Vec<_> = bag::open(&path).unwrap().map(Result::unwrap).collect();
    assert!(read[0].data == large && read.len() == 2);
}

/// Where a bag is sought, it goes on as if it had been read until there: forward, back, in whole files and in cut ones.
#[test]
fn a_bag_goes_on_from_any_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 3000);
    let whole = std::fs::read(&path).unwrap();
    let cut = folder.path().join("cut.mcap");
    std::fs::write(&cut, &whole[..whole.len() * 2 / 3]).unwrap();
    for path in [path, cut] {
        let all: Vec<_> = bag::open(&path).unwrap().map(Result::unwrap).collect();
        assert!(all.len() > 1000);
        let mut bag = bag::open(&path).unwrap();
        let last = all[all.len() - 1].log_time;
        for time in [
            START + 301 * PERIOD,
            START,
            last,
            START + 7 * PERIOD + 1,
            i64::MIN,
            last + 1,
        ] {
            bag.seek(time);
            let wanted: Vec<_> = all
                .iter()
                .filter(|message| message.log_time >= time)
                .take(100)
                .collect();
            let found: Vec<_> = bag.by_ref().take(wanted.len()).map(Result::unwrap).collect();
            assert!(found.iter().eq(wanted.iter().copied()), "from {time}");
            if wanted.len() < 100 {
                assert!(bag.next().is_none());
            }
        }
    }
}
