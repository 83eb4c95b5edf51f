//! A live recording on a disk that fails: at every single operation, for a while, or for ever. What was written stays
//! readable, what was lost is counted, and who hands over messages never waits.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::bag_support::faulty::{Counted, EIO, ENOSPC, Fault, Faulty};
use crate::bag_support::message;
use flexdrill::bag::{self, BagError, Disk, Gaps, Recording, RecordingThread, Storage};
use flexdrill::messages::topics::{self, TopicInfo};

/// Topics of the messages that `message` makes.
const TOPICS: [TopicInfo; 3] = [topics::ROTARY_SPEED_RPM, topics::BIT_STATE, topics::CONTACT_FORCES];

fn start(storage: impl Storage + 'static, path: &Path) -> Result<RecordingThread, BagError> {
    RecordingThread::start_on(Arc::new(storage), path, |topic| format!("/rig_7/{}", topic.name))
}

/// Hands over the messages `from..to`.
fn send(recording: &RecordingThread, from: usize, to: usize) {
    for index in from..to {
        let (topic, log_time, bytes) = message(index);
        recording.record(&TOPICS[topic], log_time, &bytes);
    }
}

/// The same at 600 messages a second, so that the disk is asked as often as in a run.
fn send_at_pace(recording: &RecordingThread, from: usize, to: usize) {
    for begin in (from..to).step_by(6) {
        send(recording, begin, to.min(begin + 6));
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Reads a bag, checks that each message is one of those that were sent, and in their order; how many, and how many the
/// bag itself says are missing among them.
fn read(path: &Path) -> (u64, u64) {
    let (mut count, mut gaps) = (0, Gaps::default());
    let mut last = None;
    for read in bag::open(path).unwrap() {
        let read = read.unwrap();
        gaps.observe(&read);
        // Each topic has every third message, numbered from 0.
        let topic = TOPICS.iter().position(|topic| read.topic.is(topic.name)).unwrap();
        let index = 3 * read.sequence.unwrap() as usize + topic;
        let (_, log_time, bytes) = message(index);
        assert!(read.data == bytes && read.log_time == log_time, "message {index}");
        assert!(last.is_none_or(|last| last < index), "{index} after {last:?}");
        last = Some(index);
        count += 1;
    }
    (count, gaps.found().iter().map(|gap| gap.messages).sum())
}

/// What a recording says of itself, whether it ended well or not: messages in it, lost, doubtful.
fn told(ended: &Result<Recording, BagError>) -> (u64, u64, u64) {
    match ended {
        Ok(recording) => (recording.messages, recording.lost, recording.doubtful),
        Err(BagError::Incomplete { messages, lost, .. }) => (*messages, *lost, 0),
        Err(error) => panic!("{error}"),
    }
}

/// The metadata, if there is one, says what is in the files.
fn check_metadata(folder: &Path, messages: u64, lost: u64) -> bool {
    let Ok(text) = std::fs::read_to_string(folder.join("metadata.yaml")) else {
        return false;
    };
    assert!(text.contains(&format!("\n  message_count: {messages}\n")), "{text}");
    assert!(text.contains(&format!("flexdrill_messages_lost: \"{lost}\"")), "{text}");
    true
}

/// One recording that meets a fault in its operation number `position`; false when it has not so many.
fn one_fault(fault: Fault, position: usize) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let disk = Faulty::new(Counted::All, fault);
    disk.fail_once_after(position);
    let recording = match start(disk.clone(), &path) {
        Ok(recording) => recording,
        Err(error) => {
            assert!(disk.fired() && error.to_string().contains("run_0.mcap"), "{error}");
            return true;
        }
    };
    // Two seconds of log time in two thirds of a second.
    let count = 402;
    send_at_pace(&recording, 0, count);
    let ended = recording.finish();
    let (messages, lost, doubtful) = told(&ended);
    let place = format!("{fault:?} at {position}: {ended:?}");
    assert_eq!(messages + lost, count as u64, "{place}");
    assert!(doubtful <= messages, "{place}");
    if messages > 0 {
        let (found, missing) = read(&path);
        assert_eq!(found, messages, "{place}");
        // What is lost at the very beginning or end is between no two messages.
        assert!(missing <= lost, "{place}: {missing} missing");
    }
    let described = check_metadata(&path, messages, lost);
    assert_eq!(described || messages == 0, ended.is_ok() || described, "{place}");
    if ended.is_ok() {
        assert!(described, "{place}");
    }
    match fault {
        Fault::Short | Fault::Slow(_) => assert_eq!((lost, doubtful), (0, 0), "{place}"),
        // One that failed once had worked before, or could not be tried again before a second had passed.
        _ => assert!(lost == 0 || position <= 6, "{place}"),
    }
    disk.fired()
}

#[test]
fn every_operation_may_fail_once() {
    for fault in [
        Fault::Refuse(ENOSPC),
        Fault::Refuse(EIO),
        Fault::Short,
        Fault::ShortThenRefuse(ENOSPC),
        Fault::Slow(40),
    ] {
        // A recording of these messages has about 20 operations; most of its time it waits.
        let fired: Vec<bool> = std::thread::scope(|scope| {
            let runs: Vec<_> = (0..48)
                .map(|position| scope.spawn(move || one_fault(fault, position)))
                .collect();
            runs.into_iter().map(|run| run.join().unwrap()).collect()
        });
        let positions = fired.iter().filter(|fired| **fired).count();
        assert!(positions >= 12, "{fault:?}: only {positions} operations");
        assert!(!fired[47], "{fault:?}: not all operations were tried");
    }
}

#[test]
fn a_disk_that_hangs_at_any_write_holds_nobody_up() {
    let mut position = 0;
    loop {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let disk = Faulty::new(Counted::All, Fault::Hang);
        let recording = start(disk.clone(), &path).unwrap();
        disk.fail_once_after(position);
        send_at_pace(&recording, 0, 120);
        // More than the queue takes: were one of these to wait, this test would not end.
        if disk.fired() {
            send(&recording, 120, 12_000);
            let drops = recording.health().drops();
            assert!((1..12_000).contains(&drops), "{drops}");
        }
        let fired = disk.fired();
        let began = Instant::now();
        let ended = recording.finish_within(Duration::from_millis(300));
        if !fired && ended.is_ok() {
            assert!(position >= 4, "only {position} operations");
            break;
        }
        // The bound, and what a busy machine adds.
        assert!(began.elapsed() < Duration::from_secs(5));
        let error = ended.unwrap_err();
        assert!(
            // A disk that hangs at the very end has all messages.
            matches!(&error, BagError::Hung { messages, .. } if *messages > 0 || !fired),
            "{error}"
        );
        let text = error.to_string();
        assert!(
            text.contains("does not respond") && text.contains("run_0.mcap"),
            "{text}"
        );
        // Nothing takes it for a whole recording, and what is in the file can be read.
        assert!(!path.join("metadata.yaml").exists());
        let (found, missing) = read(&path);
        assert!(found <= 12_000 && missing == 0, "{found}, {missing}");
        disk.heal();
        position += 1;
    }
}

#[test]
fn a_disk_that_hangs_at_the_start_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let disk = Faulty::new(Counted::All, Fault::Hang);
    disk.fail_once_after(0);
    let began = Instant::now();
    let error = start(disk.clone(), &folder.path().join("run")).err().unwrap();
    assert!(
        error.to_string().contains("could not be created within 10 s"),
        "{error}"
    );
    // The bound, and what a busy machine adds.
    assert!(began.elapsed() < Duration::from_secs(15));
    disk.heal();
}

#[test]
fn after_a_full_disk_it_goes_on_in_another_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let disk = Faulty::new(Counted::Writes, Fault::Refuse(ENOSPC));
    let recording = start(disk.clone(), &path).unwrap();
    send_at_pace(&recording, 0, 300);
    disk.fail();
    send_at_pace(&recording, 300, 900);
    assert!(recording.health().failed());
    let error = recording.health().error().unwrap();
    assert!(error.contains("free space"), "{error}");
    let (written, drops) = (recording.health().messages(), recording.health().drops());
    assert!(written <= 300 && drops > 300, "{written} written, {drops} lost");
    // What is told to be in the file is in it.
    assert_eq!(read(&path).0, written);
    disk.heal();
    // A file is tried again after 1 s and, should that have been too early, 2 s later.
    let deadline = Instant::now() + Duration::from_secs(12);
    let mut sent = 900;
    while recording.health().failed() {
        assert!(Instant::now() < deadline);
        send_at_pace(&recording, sent, sent + 30);
        sent += 30;
    }
    assert!(recording.health().notice().unwrap().contains("free space"));
    assert!(recording.health().path().ends_with("run_1.mcap"));
    send_at_pace(&recording, sent, sent + 300);
    sent += 300;
    let recording = recording.finish().unwrap();
    assert_eq!(recording.files, 2);
    assert_eq!(recording.messages + recording.lost, sent as u64);
    let (found, missing) = read(&path);
    assert_eq!((found, missing), (recording.messages, recording.lost));
    assert!(check_metadata(&path, found, missing));
    let metadata = std::fs::read_to_string(path.join("metadata.yaml")).unwrap();
    for part in ["- \"run_0.mcap\"", "- \"run_1.mcap\"", "- path: \"run_1.mcap\""] {
        assert!(metadata.contains(part), "{metadata}");
    }
    // Each file can be used alone, by its index.
    for file in ["run_0.mcap", "run_1.mcap"] {
        let bytes = std::fs::read(path.join(file)).unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        let statistics = summary.stats.as_ref().unwrap();
        let indexed: usize = summary
            .chunk_indexes
            .iter()
            .map(|chunk| summary.stream_chunk(&bytes, chunk).unwrap().map(Result::unwrap).count())
            .sum();
        assert_eq!(statistics.message_count, indexed as u64, "{file}");
        assert_eq!(mcap::MessageStream::new(&bytes).unwrap().count(), indexed);
        assert_eq!(statistics.chunk_count as usize, summary.chunk_indexes.len());
        assert_eq!(statistics.channel_count as usize, summary.channels.len());
        assert_eq!(usize::from(statistics.schema_count), summary.schemas.len());
        let alone = bag::open(&path.join(file)).unwrap();
        assert_eq!(alone.message_count(), Some(indexed as u64));
        let (first, last) = alone.bounds().unwrap();
        assert_eq!(
            (first as u64, last as u64),
            (statistics.message_start_time, statistics.message_end_time)
        );
    }
    // A copy by `recover` says what is missing too.
    let recovered = bag::recover(&path, &folder.path().join("copy")).unwrap();
    assert_eq!(recovered.gaps.len(), 3);
    assert_eq!(read(&folder.path().join("copy")), (found, missing));
}

#[test]
fn a_disk_that_stays_full_is_told_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let disk = Faulty::new(Counted::Writes, Fault::Refuse(ENOSPC));
    let recording = start(disk.clone(), &path).unwrap();
    send_at_pace(&recording, 0, 300);
    disk.fail();
    send_at_pace(&recording, 300, 600);
    let ended = recording.finish();
    let (messages, lost, _) = told(&ended);
    assert_eq!(messages + lost, 600);
    assert!((1..=300).contains(&messages), "{messages}");
    let error = ended.unwrap_err().to_string();
    for part in [
        "not complete",
        "free space",
        &format!("{messages} messages"),
        &format!("{lost} are lost"),
    ] {
        assert!(error.contains(part), "{error}");
    }
    assert_eq!(read(&path).0, messages);
    assert!(check_metadata(&path, messages, lost));
    assert!(!path.join("run_1.mcap").exists());
}

#[test]
fn a_refused_sync_is_not_believed_afterwards() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let disk = Faulty::new(Counted::Syncs, Fault::Refuse(EIO));
    let recording = start(disk.clone(), &path).unwrap();
    // Some good times, then a bad one.
    send_at_pace(&recording, 0, 300);
    let before = disk.count();
    assert!(before >= 1);
    disk.fail_once_after(0);
    let mut sent = 300;
    while !disk.fired() {
        send_at_pace(&recording, sent, sent + 6);
        sent += 6;
    }
    send_at_pace(&recording, sent, sent + 300);
    sent += 300;
    let notice = recording.health().notice().unwrap();
    assert!(
        notice.contains("cannot sync") && notice.contains("may be lost"),
        "{notice}"
    );
    let drops = recording.health().drops();
    let recording = recording.finish().unwrap();
    // All of it went into the files, but the disk has refused some of it once.
    assert_eq!(
        (recording.files, recording.messages, recording.lost),
        (2, sent as u64, 0)
    );
    assert!(recording.doubtful > 0 && recording.doubtful == drops, "{recording:?}");
    assert_eq!(read(&path), (sent as u64, 0));
}

#[test]
fn a_folder_that_is_moved_or_removed_is_noticed() {
    for removed in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let recording = start(Disk, &path).unwrap();
        send_at_pace(&recording, 0, 300);
        assert_eq!(recording.health().notice(), None);
        let moved = folder.path().join("moved");
        if removed {
            std::fs::remove_dir_all(&path).unwrap();
        } else {
            std::fs::rename(&path, &moved).unwrap();
        }
        let began = Instant::now();
        let mut sent = 300;
        while recording.health().notice().is_none() {
            assert!(began.elapsed() < Duration::from_secs(2), "not noticed");
            send_at_pace(&recording, sent, sent + 6);
            sent += 6;
        }
        let notice = recording.health().notice().unwrap();
        assert!(notice.contains("removed, moved or replaced"), "{notice}");
        send_at_pace(&recording, sent, sent + 60);
        sent += 60;
        let recording = recording.finish().unwrap();
        assert_eq!(recording.path, path.join("run_1.mcap"));
        assert_eq!(recording.messages + recording.lost, sent as u64);
        let (found, missing) = read(&path);
        assert_eq!((found, missing), (recording.messages, 0));
        if !removed {
            // What was written until then is whole where it went.
            let (there, _) = read(&moved);
            assert_eq!(there, recording.lost);
            assert_eq!(bag::open(&moved).unwrap().cuts().count(), 0);
        }
    }
}

#[test]
fn a_file_that_is_replaced_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let recording = start(Disk, &path).unwrap();
    send_at_pace(&recording, 0, 120);
    std::fs::remove_file(&path).unwrap();
    std::fs::write(&path, "something else").unwrap();
    std::thread::sleep(Duration::from_secs(2));
    assert!(recording.health().notice().is_some());
    send(&recording, 120, 240);
    let recording = recording.finish().unwrap();
    assert_eq!(recording.path, folder.path().join("run_1.mcap"));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "something else");
}

/// The mount point of a disk that was taken out is a folder of another one, which is not to be filled.
#[test]
fn nothing_is_written_to_another_disk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let disk = Faulty::new(Counted::All, Fault::Short);
    let recording = start(disk.clone(), &path).unwrap();
    send_at_pace(&recording, 0, 300);
    std::fs::remove_dir_all(&path).unwrap();
    disk.swap();
    send_at_pace(&recording, 300, 1500);
    let error = recording.health().error().unwrap();
    assert!(error.contains("on another disk"), "{error}");
    let ended = recording.finish();
    assert!(ended.unwrap_err().to_string().contains("on another disk"));
    assert!(!path.exists());
}

#[test]
fn the_first_messages_are_on_the_disk_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let recording = start(Disk, &path).unwrap();
    let began = Instant::now();
    send(&recording, 0, 3);
    while recording.health().messages() < 3 {
        std::thread::sleep(Duration::from_millis(5));
        // A tenth of a second, and what a busy machine adds.
        assert!(began.elapsed() < Duration::from_millis(600));
    }
    // As it would be found after a kill: not ended, and with nothing that says it is.
    assert_eq!(read(&path), (3, 0));
    assert_eq!(bag::open(&path).unwrap().cuts().count(), 1);
    assert!(!folder.path().join("metadata.yaml").exists());
    recording.finish().unwrap();
}

/// The index of a file's chunks is in memory until the file ends: two chunks a second must not add up for ever.
#[test]
fn after_six_hours_it_goes_on_in_another_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let recording = start(Disk, &path).unwrap();
    let count = 43_210_usize;
    for index in 0..count {
        let (_, log_time, bytes) = message(0);
        // A chunk for each.
        let log_time = log_time + index as i64 * 500_000_000;
        recording.record(&topics::ROTARY_SPEED_RPM, log_time, &bytes);
        let began = Instant::now();
        while index % 4000 == 3999 && (recording.health().messages() as usize) < index - 2 {
            assert!(
                began.elapsed() < Duration::from_secs(60),
                "{}",
                recording.health().messages()
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    let ended = recording.finish();
    assert_eq!(told(&ended), (count as u64, 0, 0));
    let files = ["run_0.mcap", "run_1.mcap"].map(|name| bag::open(&path.join(name)).unwrap().count());
    assert_eq!(files, [43_200, 10]);
    let times: Vec<i64> = bag::open(&path).unwrap().map(|read| read.unwrap().log_time).collect();
    assert!(times.len() == count && times.windows(2).all(|pair| pair[1] - pair[0] == 500_000_000));
}

/// What was lost on its way to the recorder shows like what the recorder lost.
#[test]
fn messages_that_did_not_reach_it_are_counted_and_missing_by_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let recording = start(Disk, &path).unwrap();
    send(&recording, 0, 30);
    recording.lose(&topics::BIT_STATE, 7);
    assert_eq!(recording.health().drops(), 7);
    send(&recording, 30, 60);
    assert_eq!(told(&recording.finish()), (60, 7, 0));
    let mut gaps = Gaps::default();
    bag::open(&path).unwrap().for_each(|read| gaps.observe(&read.unwrap()));
    let found = gaps.found();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].topic.is("twin/bit_state") && found[0].messages == 7,
        "{found:?}"
    );
}
