//! A live recording is finished on SIGTERM, foreign programs read it, and its replay gives the same bytes.

mod repeated;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::common::{Network, Program};
use flexdrill::bag::{self, Recorder, Topic};
use flexdrill::messages::{AlarmEvent, AppliedInputs, Bands, BitState, TwinStatus, from_cdr};
use flexdrill_core::inputs::MeasuredKind;
use serde_json::{Value, json};

/// Messages of the topics that do not tell of wall-clock time or of the node itself, per topic in their order.
fn messages(path: &Path) -> BTreeMap<String, Vec<Vec<u8>>> {
    let mut found: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    let bag = bag::open(path).unwrap();
    for message in bag {
        let message = message.unwrap();
        let clocked = [
            "twin/status",
            "diagnostics",
            "twin/alarms",
            "twin/alarm_events",
            "rig/rotary_speed_rpm",
            "rig/weight_on_bit_kn",
            "rig/measured",
        ];
        if !clocked.iter().any(|name| message.topic.is(name)) {
            found.entry(message.topic.name.clone()).or_default().push(message.data);
        }
    }
    found
}

/// rosbags and mcap-ros2-support read all of it, with the hashes of our types, and find the same values.
fn foreign_programs_read(recording: &Path) {
    let folder = recording.parent().unwrap();
    if let Some(printed) = crate::common::python::run("bags.py", &["live", folder.to_str().unwrap()], "") {
        let found: BTreeMap<String, usize> =
            bag::open(recording)
                .unwrap()
                .fold(BTreeMap::new(), |mut found, message| {
                    *found.entry(message.unwrap().topic.name.clone()).or_default() += 1;
                    found
                });
        let total: usize = found.values().sum();
        assert_eq!(printed.trim(), format!("topics {} messages {total}", found.len()));
    }
}

/// The status tells where the time goes, once the model moves.
fn phases_are_told(recording: &Path) {
    let mut solve = 0.0_f64;
    for message in bag::open(recording).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/status") {
            let status: TwinStatus = message.decode().unwrap();
            assert_eq!(status.phase_name.len(), status.phase_time.len());
            assert_eq!(status.phase_name.last().map(String::as_str), Some("publish"));
            let index = status.phase_name.iter().position(|name| name == "solve").unwrap();
            solve = solve.max(status.phase_time[index]);
        }
    }
    assert!(solve > 0.0);
}

/// A bag as another recorder makes it that hears the latched topic and, from an instant on (ns), all others.
fn heard_from(live: &Path, instant: i64, out: &Path, heard: impl Fn(&str) -> bool) {
    let bag = bag::open(live).unwrap();
    let topics: Vec<Topic> = bag.topics().iter().map(|topic| (**topic).clone()).collect();
    let mut recorder = Recorder::create(out, &topics).unwrap();
    let mut missed = 0;
    for message in bag {
        let message = message.unwrap();
        let latched = message.topic.is("twin/session");
        if latched || message.log_time >= instant && heard(&message.topic.name) {
            let at = message.log_time.max(instant);
            recorder.record(message.topic_index, at, &message.data).unwrap();
        } else {
            missed += 1;
        }
    }
    assert!(missed > 0);
    recorder.finish().unwrap();
}

/// Whether a bag can be replayed, and what is said.
fn replayed(bag: &Path, out: &Path) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(bag)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8_lossy(&said).into_owned())
}

/// `ros2 bag record -a` begins while the twin runs: applied inputs are in it from a second later on at the latest.
fn others_bags_are_replayed(live: &Path, folder: &Path) {
    let (first, last) = bag::open(live).unwrap().bounds().unwrap();
    let middle = first + (last - first) / 2;
    let replay = |name: &str, heard: &dyn Fn(&str) -> bool| {
        let (late, out) = (folder.join(name), folder.join(format!("{name}_again")));
        heard_from(live, middle, &late, heard);
        let (good, said) = replayed(&late, &out);
        (good, said, out)
    };
    let stamps = |path: &Path| -> Vec<i64> {
        let bits = bag::open(path).unwrap().map(Result::unwrap);
        let bits = bits.filter(|message| message.topic.is("/rig_7/twin/bit_state"));
        bits.map(|message| message.decode::<BitState>().unwrap().header.stamp.to_nanoseconds())
            .collect()
    };

    let (good, said, out) = replay("late", &|_| true);
    assert!(good, "{said}");
    assert!(said.contains("not exact: the recording begins at step"), "{said}");
    // The instants are those of the run: from a second after the beginning on, each that was recorded is there.
    let again = stamps(&out);
    let recorded = stamps(live)
        .into_iter()
        .filter(|stamp| *stamp >= middle + 1_100_000_000);
    let common = recorded.clone().filter(|stamp| again.contains(stamp)).count();
    assert!(
        common * 2 > recorded.clone().count() && common > 20,
        "{common} of {}",
        recorded.count()
    );

    let (good, said, out) = replay("received", &|name| !name.ends_with("applied_inputs"));
    assert!(good, "{said}");
    assert!(said.contains("used as received"), "{said}");
    assert!(stamps_of_anything(&out) > 20, "{said}");

    // A damaged chunk in the middle, with what drove the model meanwhile.
    let mut bytes = std::fs::read(live).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let is_of = |channel: &u16| summary.channels[channel].topic.ends_with("applied_inputs");
    let chunk = &summary.chunk_indexes[2..]
        .iter()
        .find(|chunk| chunk.message_index_offsets.keys().any(is_of))
        .unwrap();
    bytes[(chunk.chunk_start_offset + chunk.chunk_length / 2) as usize] ^= 0xFF;
    let damaged = folder.join("damaged.mcap");
    std::fs::write(&damaged, &bytes).unwrap();
    let (good, said) = replayed(&damaged, &folder.join("damaged_again"));
    assert!(good, "{said}");
    assert!(said.contains("the recording is damaged: "), "{said}");
    assert!(said.contains("not exact: the recording has a gap"), "{said}");

    let (good, said, _) = replay("nothing", &|name| {
        !name.contains("/rig/") && !name.ends_with("applied_inputs")
    });
    assert!(!good && said.contains("does not record what drove the model"), "{said}");
}

fn stamps_of_anything(path: &Path) -> usize {
    let bag = bag::open(path).unwrap();
    bag.filter(|message| message.as_ref().unwrap().topic.is("twin/bit_state"))
        .count()
}

/// What a program says of its recording: messages in it, and not in it.
fn counts(said: &str) -> (u64, u64) {
    let number = |line: Option<&str>| {
        let words = line.unwrap_or("0").split(' ');
        words.filter_map(|word| word.parse().ok()).next().unwrap()
    };
    let line = |text: &str| said.lines().find(|line| line.contains(text));
    (number(line("recorded ")), number(line("missing in the recording")))
}

/// Messages in a bag, and whether all its files have an end.
fn whole(path: &Path) -> (u64, bool) {
    let bag = bag::open(path).unwrap();
    let whole = bag.cuts().count() == 0;
    (bag.map(Result::unwrap).count() as u64, whole)
}

#[test]
fn two_signals_close_together_are_one_request() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut twin = network.twin(&["--record", path.to_str().unwrap()]);
    twin.wait_for("model time runs");
    std::thread::sleep(Duration::from_secs(1));
    twin.signal("TERM");
    twin.signal("TERM");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0), "{}", twin.said());
    let (messages, lost) = counts(&twin.said());
    assert_eq!((messages, true), whole(&path));
    assert_eq!(lost, 0);
    assert!(path.join("metadata.yaml").is_file());
}

#[test]
fn a_killed_twin_leaves_its_first_moments_and_nothing_that_looks_whole() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut twin = network.twin(&["--record", path.to_str().unwrap()]);
    twin.wait_for("model time runs");
    // A tenth of a second for the first chunk, the rest for a busy machine.
    std::thread::sleep(Duration::from_millis(500));
    twin.signal("KILL");
    twin.end();
    assert!(!path.join("metadata.yaml").exists());
    let (messages, whole) = whole(&path);
    assert!(messages > 20 && !whole, "{messages}");
}

/// In a run in which nothing changes, over all the files of its recording.
fn applied_inputs_are_told_every_second(path: &Path) {
    let applied: Vec<AppliedInputs> = bag::open(path)
        .unwrap()
        .map(Result::unwrap)
        .filter(|message| message.topic.is("twin/applied_inputs"))
        .map(|message| message.decode().unwrap())
        .collect();
    // Of 8 s, less what a slow start takes.
    assert!(applied.len() >= 7, "{}", applied.len());
    for pair in applied.windows(2) {
        let steps = pair[1].step - pair[0].step + pair[1].skipped_steps - pair[0].skipped_steps;
        // Steps of 0.5 ms; sent with an output, of which there are 50 a second.
        assert!((1..=2040).contains(&steps), "{steps}");
        assert_eq!(pair[1].rotary_speed, pair[0].rotary_speed);
    }
    let last = applied.last().unwrap();
    assert!(!last.reset && last.step > 12_000, "{last:?}");
}

/// Recordings of some seconds in several files, which others read too.
#[test]
fn a_limit_of_the_file_size_splits_the_recording() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut command = network.command("prlimit");
    command.arg("--fsize=200000").arg(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .args(["run", "--duration", "8", "--config"])
        .arg(crate::common::small_config());
    command.arg("--record").arg(&path);
    let mut twin = Program::start(command);
    assert_eq!(twin.end(), Some(0), "{}", twin.said());
    let said = twin.said();
    assert!(path.join("run_1.mcap").is_file(), "{said}");
    assert!(!said.contains("stopped"), "{said}");
    let (messages, lost) = counts(&said);
    assert_eq!((messages, true), whole(&path), "{said}");
    assert_eq!(lost, 0, "{said}");
    applied_inputs_are_told_every_second(&path);
    if let Some(printed) = crate::common::python::run("bags.py", &["parts", path.to_str().unwrap()], "") {
        assert_eq!(printed.trim(), format!("messages {messages}"));
    }
}

/// A write beyond the limit sends a signal that ends a program that does not expect it.
#[test]
fn a_file_that_may_suddenly_not_grow_does_not_end_the_twin() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut twin = network.twin(&["--duration", "8", "--record", path.to_str().unwrap()]);
    twin.wait_for("model time runs");
    std::thread::sleep(Duration::from_secs(3));
    // Room for a chunk or so, and for the end of the file.
    let limit = std::fs::metadata(path.join("run_0.mcap")).unwrap().len() + 60_000;
    let limit = Command::new("prlimit")
        .args([&format!("--fsize={limit}"), "--pid", &twin.id().to_string()])
        .status()
        .unwrap();
    assert!(limit.success());
    assert_eq!(twin.end(), Some(0), "{}", twin.said());
    let said = twin.said();
    assert!(said.contains("has reached the largest size allowed"), "{said}");
    assert!(path.join("run_1.mcap").is_file(), "{said}");
    let (messages, lost) = counts(&said);
    assert_eq!((messages, true), whole(&path), "{said}");
    assert_eq!(lost, 0, "{said}");
}

/// A disk with room for three seconds, and again for more nine seconds after the start.
#[test]
fn a_full_disk_costs_what_could_not_be_written_and_says_so() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (disk, out) = (folder.path().join("disk"), folder.path().join("run"));
    std::fs::create_dir(&disk).unwrap();
    let script = "mount -t tmpfs -o size=2400k none \"$1\" || exit 90; head -c 2250000 /dev/zero > \"$1/filler\"; \
                  { sleep 9; rm \"$1/filler\"; } & \
                  \"$2\" run --config \"$3\" --duration 16 --record \"$1/run\"; code=$?; cp -r \"$1/run\" \"$4\"; exit $code";
    let mut command = network.command("unshare");
    command.args(["-m", "sh", "-c", script, "sh"]).arg(&disk);
    command
        .arg(env!("CARGO_BIN_EXE_flexdrill"))
        .arg(crate::common::small_config())
        .arg(&out);
    let mut twin = Program::start(command);
    let code = twin.end();
    let said = twin.said();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("free space"), "{said}");
    assert!(said.contains("the recording continues in"), "{said}");
    let (messages, lost) = counts(&said);
    assert!(lost > 0, "{said}");
    assert_eq!((messages, true), whole(&out), "{said}");
    let metadata = std::fs::read_to_string(out.join("metadata.yaml")).unwrap();
    assert!(
        metadata.contains(&format!("\n  message_count: {messages}\n")),
        "{metadata}"
    );
    assert!(
        metadata.contains(&format!("flexdrill_messages_lost: \"{lost}\"")),
        "{metadata}"
    );
    // The status that was recorded last agrees up to what came after it.
    let mut status = None;
    for message in bag::open(&out).unwrap().map(Result::unwrap) {
        if message.topic.is("twin/status") {
            status = Some(message.decode::<TwinStatus>().unwrap());
        }
    }
    let status = status.unwrap();
    assert_eq!(status.recording_state, TwinStatus::RECORDING_ON);
    assert_eq!(status.recording_drops, lost);
    assert!(status.recording_messages <= messages && status.recording_messages + 1000 > messages);
    // A replay says that the recording has a hole.
    let (good, told) = replayed(&out, &folder.path().join("again"));
    assert!(good, "{told}");
    assert!(told.contains("not exact: the recording has a gap"), "{told}");
}
