//! A recording that was cut: by a lost tail, a killed process, a full disk. What was flushed can be read and recovered.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::bag_support::{PERIOD, START, check_prefix, message, record, recording, topics};
use flexdrill::bag::{self, BagError, Recorder};

/// Tells this test binary, started as a process of its own, where to record.
const CHILD_PATH: &str = "FLEXDRILL_TEST_CRASH_PATH";

#[test]
fn cut_anywhere_everything_before_the_last_whole_chunk_is_there() {
    let folder = tempfile::tempdir().unwrap();
    // Where the file stood after each flush, and how many messages it then held.
    let mut flushed = vec![(0, 0)];
    let path = folder.path().join("whole/run.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    for index in 0..900 {
        let (topic, log_time, bytes) = message(index);
        recorder.record(topic, log_time, &bytes).unwrap();
        if index % 100 == 99 {
            recorder.flush().unwrap();
            flushed.push((std::fs::metadata(&path).unwrap().len() as usize, index + 1));
        }
    }
    recorder.finish().unwrap();
    let whole = std::fs::read(&path).unwrap();
    let cut_path = folder.path().join("cut.mcap");
    // A stride that is prime to everything in the format; plus the places just around each flush.
    let places = (8..whole.len())
        .step_by(whole.len() / 150 + 1)
        .chain(
            flushed
                .iter()
                .flat_map(|(length, _)| [length.saturating_sub(1), *length, length + 1]),
        )
        .filter(|place| *place >= 8);
    for (number, place) in places.enumerate() {
        std::fs::write(&cut_path, &whole[..place]).unwrap();
        let bag = bag::open(&cut_path).unwrap();
        assert_eq!(bag.cuts().count(), 1, "cut at {place}");
        assert!(bag.cuts().all(|cut| cut.offset <= place as u64));
        let least = flushed
            .iter()
            .filter(|(length, _)| *length <= place)
            .map(|(_, count)| *count)
            .max();
        let count = check_prefix(bag);
        assert!(
            count >= least.unwrap(),
            "cut at {place}: {count} messages, {least:?} were flushed"
        );

        let output = folder.path().join(format!("recovered_{number}"));
        let recovered = bag::recover(&cut_path, &output).unwrap();
        assert_eq!(recovered.recording.messages, count as u64);
        assert_eq!(recovered.cuts.len(), 1);
        let bag = bag::open(&output).unwrap();
        assert_eq!(bag.cuts().count(), 0);
        assert_eq!(check_prefix(bag), count);
    }
}

/// The process that gets killed: records 50 instants per second of wall time and tells how far it has got.
#[test]
#[ignore = "started by the tests below as a process of its own"]
fn child_that_records() {
    let path = std::env::var(CHILD_PATH).unwrap();
    let mut recorder = Recorder::create(Path::new(&path), &topics()).unwrap();
    for index in 0..100_000 {
        let (topic, log_time, bytes) = message(index);
        recorder.record(topic, log_time, &bytes).unwrap();
        if index % 3 == 2 {
            println!("recorded {}", index + 1);
            std::thread::sleep(std::time::Duration::from_nanos(PERIOD as u64));
        }
    }
}

/// Kills a process that records after so long (s), and checks what it leaves.
fn kill_after(seconds: f64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "crash_file::child_that_records", "--ignored", "--nocapture"])
        .env(CHILD_PATH, &path)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // How much it had recorded when.
    let mut told = Vec::new();
    let mut began = None;
    for line in BufReader::new(child.stdout.take().unwrap()).lines() {
        if let Some(number) = line.unwrap().strip_prefix("recorded ") {
            let began = began.get_or_insert_with(Instant::now);
            told.push((began.elapsed().as_secs_f64(), number.parse::<usize>().unwrap()));
            if began.elapsed().as_secs_f64() >= seconds {
                break;
            }
        }
    }
    child.kill().unwrap();
    child.wait().unwrap();

    // Nobody takes it for a whole bag without messages.
    assert!(!folder.path().join("metadata.yaml").exists());
    let bag = bag::open(&path).unwrap();
    assert_eq!(bag.cuts().count(), 1);
    let count = check_prefix(bag);
    let at = told.last().unwrap().0;
    // Of the first moments, those before the last tenth of a second and what a busy machine adds.
    let loss = if at < 1.0 { 0.5 * at + 0.2 } else { 1.0 };
    let least = told
        .iter()
        .rfind(|(time, _)| *time <= at - loss)
        .map_or(0, |(_, count)| *count);
    assert!(count >= least, "killed after {at:.2} s: {count} messages of {least}");
    assert_eq!(check_prefix(bag::open(folder.path()).unwrap()), count);
    if count > 0 {
        let recovered = bag::recover(folder.path(), &folder.path().join("recovered")).unwrap();
        assert_eq!(recovered.recording.messages, count as u64);
    }
}

#[test]
fn a_killed_process_loses_at_most_its_last_second() {
    // Prime to any interval of the recorder.
    let times = (0..80_u32).map(|number| 0.1 + 0.037 * f64::from(number));
    let times: Vec<f64> = times.collect();
    for together in times.chunks(16) {
        std::thread::scope(|scope| {
            for seconds in together {
                scope.spawn(|| kill_after(*seconds));
            }
        });
    }
}

/// Records until the file may not grow any more, as on a full disk.
#[test]
#[ignore = "started by the test below as a process of its own"]
fn child_whose_disk_is_full() {
    let path = std::env::var(CHILD_PATH).unwrap();
    let mut recorder = Recorder::create(Path::new(&path), &topics()).unwrap();
    let limit = libc::rlimit {
        rlim_cur: 100_000,
        rlim_max: 100_000,
    };
    #[expect(unsafe_code, reason = "the limit of a file's size stands for a full disk")]
    // SAFETY: plain system calls on this process alone, which ends with this test.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
        assert_eq!(libc::setrlimit(libc::RLIMIT_FSIZE, &limit), 0);
    }
    let mut error = None;
    let mut count = 0;
    while error.is_none() {
        let (topic, log_time, bytes) = message(count);
        error = recorder.record(topic, log_time, &bytes).err();
        count += 1;
        assert!(count < 100_000, "the limit was never met");
    }
    let error = error.unwrap();
    assert!(matches!(error, BagError::Io { action: "write", .. }), "{error:?}");
    assert!(error.to_string().contains("run.mcap"), "{error}");
    let (topic, log_time, bytes) = message(count);
    let after = recorder.record(topic, log_time, &bytes).unwrap_err();
    assert!(matches!(after, BagError::Stopped { .. }), "{after:?}");
    assert!(recorder.finish().is_err());
}

#[test]
fn a_full_disk_is_an_error_and_keeps_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let output = Command::new(std::env::current_exe().unwrap())
        .args([
            "--exact",
            "crash_file::child_whose_disk_is_full",
            "--ignored",
            "--nocapture",
        ])
        .env(CHILD_PATH, &path)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bag = bag::open(&path).unwrap();
    let cut = bag.cuts().next().unwrap().clone();
    // The half-written chunk is gone, so that any reader comes to the end.
    assert_eq!(cut.offset, std::fs::metadata(&path).unwrap().len());
    let count = check_prefix(bag);
    assert!(count > 100, "{count}");
    let metadata = std::fs::read_to_string(folder.path().join("metadata.yaml")).unwrap();
    assert!(metadata.contains(&format!("message_count: {count}")), "{metadata}");
}

#[test]
fn recover_of_a_whole_bag_keeps_everything() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(folder.path(), "run.mcap", 300);
    let recovered = bag::recover(&path, &folder.path().join("again/run.mcap")).unwrap();
    assert!(recovered.cuts.is_empty() && recovered.damaged.is_empty());
    assert_eq!(recovered.recording.per_topic, [100, 100, 100, 0]);
    assert_eq!(recovered.topics, topics());
    assert_eq!(bag::open(&path).unwrap().bounds(), Some((START, START + 99 * PERIOD)));
}

#[test]
fn the_subcommand_recovers_and_says_what_was_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &topics()).unwrap();
    record(&mut recorder, 600);
    recorder.finish().unwrap();
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let run = |output: &str| {
        Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .arg("recover")
            .arg(&path)
            .arg("--out")
            .arg(folder.path().join(output))
            .output()
            .unwrap()
    };
    let output = run("recovered");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stderr).contains("within a record"));
    assert!(String::from_utf8_lossy(&output.stdout).contains("/rig_7/twin/bit_state"));
    assert!(check_prefix(bag::open(&folder.path().join("recovered")).unwrap()) >= 150);
    let again = run("recovered");
    assert_eq!(again.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&again.stderr).contains("exists already"));
}

/// Small chunks that unpack to far more than they are: a file of some ten kilobytes must not take a gigabyte.
#[test]
fn a_file_whose_chunks_would_fill_memory_is_refused_in_words() {
    const UNPACKED: usize = 4 << 20;
    let packed = zstd::bulk::compress(&vec![0; UNPACKED], 19).unwrap();
    let body = [
        &[0; 16][..],
        &(UNPACKED as u64).to_le_bytes(),
        // No checksum.
        &[0; 4],
        &4_u32.to_le_bytes(),
        b"zstd",
        &(packed.len() as u64).to_le_bytes(),
        &packed,
    ]
    .concat();
    let chunk = [
        &[mcap::records::op::CHUNK][..],
        &(body.len() as u64).to_le_bytes(),
        &body,
    ]
    .concat();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bomb.mcap");
    let file = |chunks: usize| {
        let bytes = [mcap::MAGIC, &chunk.repeat(chunks)].concat();
        std::fs::write(&path, &bytes).unwrap();
        bag::open(&path).map(|bag| bag.cuts().count())
    };
    // Two are small enough to be looked into.
    assert_eq!(file(2).unwrap(), 1);
    let error = file(250).unwrap_err().to_string();
    assert!(std::fs::metadata(&path).unwrap().len() < 500_000);
    for part in ["bomb.mcap", "byte", "decompress", "no recording compresses so well"] {
        assert!(error.contains(part), "'{part}' is not in: {error}");
    }
}
