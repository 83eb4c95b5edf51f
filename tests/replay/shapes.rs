//! Bags of a rig that are wrong in one way each, through the program: it refuses them with what to do, or names what it
//! leaves out. `crates/flexdrill-bag/tests/shapes/main.rs` has the shapes of the files themselves.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use crate::common::program::Program;
use crate::common::small_config;

/// 2023-11-14 22:13:20 UTC.
const START: u64 = 1_700_000_000_000_000_000;
const SECOND: u64 = 1_000_000_000;
const RPM: &str = "/rig/rotary_speed_rpm";
const WEIGHT: &str = "/rig/weight_on_bit_kn";

/// A topic of a bag: name, type, encoding, bytes of its message.
type Topic = (&'static str, &'static str, &'static str, Vec<u8>);

fn float64(name: &'static str, value: f64) -> Topic {
    let data = [&[0, 1, 0, 0][..], &value.to_le_bytes()].concat();
    (name, "std_msgs/msg/Float64", "cdr", data)
}

/// A bag of another writer: the messages at the given seconds.
fn bag(path: &Path, seconds: &[u64], topics: &[Topic]) {
    let mut writer = mcap::Writer::new(std::fs::File::create(path).unwrap()).unwrap();
    let channels: Vec<u16> = topics
        .iter()
        .map(|(name, ros_type, encoding, _)| {
            let schema = match *ros_type {
                "" => 0,
                ros_type => writer.add_schema(ros_type, "ros2msg", b"float64 data\n").unwrap(),
            };
            writer.add_channel(schema, name, encoding, &BTreeMap::new()).unwrap()
        })
        .collect();
    for second in seconds {
        for (channel_id, (.., data)) in channels.iter().zip(topics) {
            let time = START + second * SECOND;
            let header = mcap::records::MessageHeader {
                channel_id: *channel_id,
                sequence: *second as u32,
                log_time: time,
                publish_time: time,
            };
            writer.write_to_known_channel(&header, data).unwrap();
        }
    }
    writer.finish().unwrap();
}

/// Exit code and all that the program says.
fn flexdrill(arguments: &[&str], paths: &[&Path]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    let output = command.args(arguments).args(paths).output().unwrap();
    let said = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    (output.status.code(), said.concat())
}

/// Replays a bag for half a second of model time.
fn replay(input: &Path, out: &Path) -> (Option<i32>, String) {
    let (config, out) = (small_config(), out.to_str().unwrap());
    let config = config.to_str().unwrap();
    flexdrill(
        &["replay", "--config", config, "--duration", "0.5", "--out", out],
        &[input],
    )
}

fn says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "'{part}' is not in:\n{said}");
    }
}

#[test]
fn an_input_as_another_type_or_encoding_is_refused_and_not_assumed() {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["bag.mcap", "out"].map(|name| folder.path().join(name));
    let float32 = [&[0, 1, 0, 0][..], &40_f32.to_le_bytes()].concat();
    for (wrong, parts) in [
        (
            (RPM, "std_msgs/msg/Float32", "cdr", float32),
            &[RPM, "std_msgs/msg/Float32", "expected std_msgs/msg/Float64", "convert"][..],
        ),
        ((RPM, "", "cdr", float64(RPM, 40.0).3), &[RPM, "no type", "no schema"]),
        (
            (RPM, "std_msgs/msg/Float64", "json", b"{\"data\":40}".to_vec()),
            &[RPM, "encoded as \"json\"", "cdr"],
        ),
        (
            (RPM, "std_msgs/msg/Float64", "ros1", 40_f64.to_le_bytes().to_vec()),
            &[RPM, "encoded as \"ros1\"", "rosbags-convert"],
        ),
    ] {
        bag(&path, &[0, 1], &[wrong, float64(WEIGHT, 10.0)]);
        let (code, said) = replay(&path, &out);
        assert_eq!(code, Some(1), "{said}");
        says(&said, parts);
        assert!(!out.exists());
    }
    // An optional input too: its assumed value would be taken for the rig's.
    let pressure = (
        "/rig/standpipe_pressure",
        "std_msgs/msg/Float32",
        "cdr",
        vec![0, 1, 0, 0, 0, 0, 0, 0],
    );
    bag(&path, &[0, 1], &[float64(RPM, 40.0), float64(WEIGHT, 10.0), pressure]);
    let (code, said) = replay(&path, &out);
    assert_eq!(code, Some(1), "{said}");
    says(&said, &["/rig/standpipe_pressure", "Float32"]);
}

#[test]
fn half_a_bag_is_never_replayed_silently() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let rig = place("rig");
    std::fs::create_dir(&rig).unwrap();
    let topics = [float64(RPM, 40.0), float64(WEIGHT, 10.0)];
    bag(&rig.join("rig_0.mcap"), &[0, 1], &topics);
    bag(&rig.join("rig_1.mcap"), &[2, 3], &topics);
    let list = |names: &[&str]| {
        let names: String = names.iter().map(|name| format!("  - {name}\n")).collect();
        let text = format!("rosbag2_bagfile_information:\n  relative_file_paths:\n{names}");
        std::fs::write(rig.join("metadata.yaml"), text).unwrap();
    };
    list(&["rig_0.mcap"]);
    let (code, said) = replay(&rig, &place("unlisted"));
    assert_eq!(code, Some(0), "{said}");
    says(&said, &["rig_1.mcap is not listed in metadata.yaml", "it is read too"]);

    list(&["rig_0.mcap", "rig_1.mcap", "rig_2.mcap"]);
    let (code, said) = replay(&rig, &place("missing"));
    assert_eq!(code, Some(1), "{said}");
    says(
        &said,
        &[
            "rig_2.mcap is listed in metadata.yaml and is missing",
            "flexdrill recover",
        ],
    );
    // What the message advises.
    let rest = place("rest");
    let (code, said) = flexdrill(&["recover", "--out", rest.to_str().unwrap()], &[&rig]);
    assert_eq!(code, Some(0), "{said}");
    says(
        &said,
        &["rig_2.mcap is listed in metadata.yaml and is missing", "8  messages in"],
    );
    let (code, said) = replay(&rest, &place("replayed"));
    assert_eq!(code, Some(0), "{said}");
}

/// rosbag2's compressed file, through every step of a replay.
#[test]
fn a_compressed_bag_is_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, packed] = ["rig.mcap", "rig.mcap.zstd"].map(|name| folder.path().join(name));
    bag(&plain, &[0, 1], &[float64(RPM, 40.0), float64(WEIGHT, 10.0)]);
    std::fs::write(
        &packed,
        zstd::encode_all(&std::fs::read(&plain).unwrap()[..], 3).unwrap(),
    )
    .unwrap();
    std::fs::remove_file(plain).unwrap();
    let (code, said) = replay(&packed, &folder.path().join("out"));
    assert_eq!(code, Some(0), "{said}");
}

/// The bag gets its end, and the exit code and the last line say that the replay is not whole.
#[test]
fn a_signal_ends_the_bag_of_a_replay_properly() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut input = root.join("config/field_logs/demo.csv");
    // First a log; then the recording that it has left, by its own inputs: thirty times as long as what is awaited of its
    // replay, which is not at its end by then on a machine that is busy.
    for (number, signal, least) in [(0, "TERM", 3_000_000), (1, "INT", 100_000)] {
        let out = folder.path().join(format!("run_{number}/run.mcap"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
        command.arg("replay").arg(&input).arg("--out").arg(&out);
        if number == 0 {
            command
                .arg("--mapping")
                .arg(root.join("config/field_logs/rig_1hz.yaml"))
                .arg("--config")
                .arg(root.join("config/coarse.yaml"))
                .args(["--from", "45"]);
        }
        let mut program = Program::start(command);
        let began = std::time::Instant::now();
        while std::fs::metadata(&out).map_or(0, |file| file.len()) < least {
            assert!(began.elapsed().as_secs() < 60, "{}", program.said());
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        program.signal(signal);
        assert_eq!(program.end(), Some(130), "{}", program.said());
        let said = program.said();
        says(
            &said,
            &[
                "a signal ended the replay after",
                "run.mcap is complete up to there",
                "wrote",
            ],
        );
        assert!(!said.contains("exact: the recording has everything"), "{said}");
        // The format's own library finds the index, and as many messages as it says.
        let bytes = std::fs::read(&out).unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        let messages = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).count() as u64;
        assert_eq!(summary.stats.unwrap().message_count, messages);
        // How many there are depends on the machine's speed.
        assert!(messages > 0 && !summary.chunk_indexes.is_empty(), "{messages}");
        let metadata = std::fs::read_to_string(out.with_file_name("metadata.yaml")).unwrap();
        says(&metadata, &[&format!("message_count: {messages}")]);
        input = out;
    }
}
