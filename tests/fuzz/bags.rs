//! Bags: MCAP files, the records within their chunks, SQLite files, metadata.yaml.

use std::path::Path;

use flexdrill::bag::{self, BagMessage};
use flexdrill::messages::{AppliedInputs, BitState, ContactForces, SessionInfo, TwinStatus};
use rusqlite::Connection;

use crate::bag_support::{message, recording, topics};
use crate::engine::Target;
use crate::{folder, says_why};

/// Messages of a file of at most 64 kB; a chunk may unpack to more.
const MANY: usize = 200_000;

/// What can be read, in the order that it comes; none when it is no bag.
fn read(path: &Path) -> Option<Vec<BagMessage>> {
    let mut bag = match bag::open(path) {
        Ok(bag) => bag,
        Err(error) => {
            says_why(&error);
            return None;
        }
    };
    let _ = (bag.message_count(), bag.bounds(), bag.cuts().count());
    let mut messages = Vec::new();
    for (count, item) in bag.by_ref().enumerate() {
        assert!(count < MANY, "no end");
        match item {
            Ok(message) => messages.push(message),
            Err(error) => {
                says_why(&error);
            }
        }
    }
    for message in messages.iter().take(20) {
        let _ = message.decode::<BitState>();
        let _ = message.decode::<ContactForces>();
        let _ = message.decode::<TwinStatus>();
        let _ = message.decode::<AppliedInputs>();
        let _ = message.decode::<SessionInfo>();
    }
    Some(messages)
}

/// Reads a bag and recovers it: the recovered one has the same messages.
fn read_and_recover(path: &Path) -> bool {
    let Some(found) = read(path) else { return false };
    let output = path.with_file_name("recovered");
    let _ = std::fs::remove_dir_all(&output);
    let recovered = match bag::recover(path, &output) {
        Ok(recovered) => recovered,
        // Topics that differ in nothing that MCAP can say, or a name that no file can hold.
        Err(error) => return says_why(&error),
    };
    let again = read(&output).unwrap();
    let lost = found
        .iter()
        .filter(|message| message.topic_index >= recovered.topics.len());
    assert_eq!(again.len() + lost.count(), found.len(), "messages of the recovered bag");
    let bytes = |messages: &[BagMessage]| {
        let mut bytes: Vec<_> = messages
            .iter()
            .filter(|message| message.topic_index < recovered.topics.len())
            // MCAP knows no time before 1970.
            .map(|message| (message.log_time.max(0), message.data.clone()))
            .collect();
        bytes.sort();
        bytes
    };
    assert!(bytes(&again) == bytes(&found), "the recovered bag has other bytes");
    true
}

fn whole() -> Vec<u8> {
    let folder = folder();
    std::fs::read(recording(folder.path(), "run.mcap", 30)).unwrap()
}

fn rewritten(options: mcap::WriteOptions) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = options.create(std::io::Cursor::new(&mut bytes)).unwrap();
    for message in mcap::MessageStream::new(&whole()).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    bytes
}

#[test]
fn mcap_file() {
    let folder = folder();
    let path = folder.path().join("bag.mcap");
    let plain = || {
        mcap::WriteOptions::new()
            .calculate_chunk_crcs(false)
            .chunk_size(Some(2000))
    };
    let (all, loose) = (whole(), rewritten(plain().use_chunks(false)));
    Target {
        name: "mcap_file",
        seeds: vec![
            all[..all.len() * 2 / 3].to_vec(),
            all,
            loose,
            rewritten(plain().compression(None)),
            rewritten(plain().compression(Some(mcap::Compression::Zstd))),
            rewritten(plain().compression(Some(mcap::Compression::Lz4))),
        ],
        words: &[
            "\u{89}MCAP0\r\n",
            "zstd",
            "lz4",
            "offered_qos_profiles",
            "- depth: 1\n",
            "\0\0\0\0\0\0\0\0",
        ],
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            read_and_recover(&path)
        },
    }
    .fuzz();
}

/// Files that are compressed as a whole: of one frame or several, whole or cut.
#[test]
fn packed_file() {
    let folder = folder();
    let path = folder.path().join("bag.mcap.zstd");
    let all = whole();
    let pack = |content: &[u8]| zstd::encode_all(content, 1).unwrap();
    // A frame of so few bytes is one block, of which nothing can be unpacked once it is cut: frames before it remain.
    let frames: Vec<Vec<u8>> = all.chunks(500).map(pack).collect();
    let several = frames.concat();
    Target {
        name: "packed_file",
        seeds: vec![several[..several.len() * 2 / 3].to_vec(), several, pack(&all)],
        words: &["\u{89}MCAP0\r\n", "SQLite format 3\0", "zstd", "\0\0\0\0"],
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            read_and_recover(&path)
        },
    }
    .fuzz();
}

/// The records of a chunk, in a file of that one chunk: compressed as the first byte says, cut or whole.
fn in_a_chunk(kind: u8, records: &[u8]) -> Vec<u8> {
    let (name, packed) = match kind % 3 {
        0 => ("", records.to_vec()),
        1 => ("zstd", zstd::encode_all(records, 1).unwrap()),
        _ => {
            let mut encoder = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
            std::io::Write::write_all(&mut encoder, records).unwrap();
            ("lz4", encoder.finish().0)
        }
    };
    let body = [
        &[0; 16][..],
        &(records.len() as u64).to_le_bytes(),
        &crc32fast::hash(records).to_le_bytes(),
        &(name.len() as u32).to_le_bytes(),
        name.as_bytes(),
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
    let kept = if kind & 0x80 == 0 {
        chunk.len()
    } else {
        chunk.len() * 3 / 4
    };
    [mcap::MAGIC, &chunk[..kept]].concat()
}

#[test]
fn mcap_chunk() {
    let folder = folder();
    let path = folder.path().join("bag.mcap");
    let loose = rewritten(mcap::WriteOptions::new().use_chunks(false));
    // Without the magic: schemas, channels and messages, then the file's end.
    let records = &loose[mcap::MAGIC.len()..];
    let seeds = [0, 1, 2, 0x80, 0x81, 0x82].map(|kind| [&[kind][..], &records[..3000.min(records.len())]].concat());
    Target {
        name: "mcap_chunk",
        seeds: seeds.to_vec(),
        words: &[
            "\u{3}",
            "\u{4}",
            "\u{5}",
            "offered_qos_profiles",
            "- depth: 1\n",
            "[[[[[[[[",
            "&a [*a]",
            "topic_type_hash",
        ],
        run: &mut |bytes| {
            let (kind, records) = bytes.split_first().unwrap_or((&0, bytes));
            std::fs::write(&path, in_a_chunk(*kind, records)).unwrap();
            read_and_recover(&path)
        },
    }
    .fuzz();
}

/// A small database as rosbag2 writes it.
fn database(path: &Path, definitions: bool) -> Vec<u8> {
    let _ = std::fs::remove_file(path);
    let connection = Connection::open(path).unwrap();
    let more = if definitions {
        ", offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL"
    } else {
        ""
    };
    connection
        .execute_batch(&format!(
            "PRAGMA page_size = 512;
             CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                serialization_format TEXT NOT NULL{more});
             CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                data BLOB NOT NULL);
             CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
        ))
        .unwrap();
    if definitions {
        connection
            .execute_batch(
                "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT, encoding TEXT,
                    encoded_message_definition TEXT, type_description_hash TEXT);
                 INSERT INTO message_definitions VALUES (1, 'std_msgs/msg/Float64', 'ros2msg', 'float64 data', '');",
            )
            .unwrap();
    }
    for (id, topic) in topics().iter().enumerate() {
        let more = if definitions {
            ", '- depth: 1\n  reliability: 1\n  durability: 2\n', ''"
        } else {
            ""
        };
        connection
            .execute(
                &format!("INSERT INTO topics VALUES (?1, ?2, ?3, 'cdr'{more})"),
                (id as i64, &topic.name, &topic.ros_type),
            )
            .unwrap();
    }
    for index in 0..12 {
        let (topic, time, data) = message(index);
        connection
            .execute(
                "INSERT INTO messages VALUES (?1, ?2, ?3, ?4)",
                (index as i64, topic as i64, time, &data[..data.len().min(300)]),
            )
            .unwrap();
    }
    connection.close().unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn sqlite_file() {
    let folder = folder();
    let path = folder.path().join("bag.db3");
    let seeds = [true, false].map(|definitions| database(&path, definitions));
    flexdrill_sqlite::read_sqlite();
    Target {
        name: "sqlite_file",
        seeds: seeds.to_vec(),
        words: &[
            "CREATE VIEW",
            "messages",
            "topics",
            "WITHOUT ROWID",
            " GENERATED ALWAYS AS (zeroblob(1e9))",
            "\u{d}\0\0\0",
        ],
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            read_and_recover(&path)
        },
    }
    .fuzz();
}

/// Tables whose rows are computed rather than stored: without end, or larger than the file.
#[test]
fn sqlite_files_that_compute_their_rows_cost_what_their_size_costs() {
    flexdrill_sqlite::read_sqlite();
    let folder = folder();
    let path = folder.path().join("bag.db3");
    let endless = "CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)
                   SELECT x AS id, 1 AS topic_id, x AS timestamp, zeroblob(100) AS data FROM n;";
    let large = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,
                 data BLOB GENERATED ALWAYS AS (zeroblob(900000000)) VIRTUAL);
                 INSERT INTO messages(id, topic_id, timestamp) VALUES (1, 1, 1);";
    for (schema, told) in [(endless, "table `messages`"), (large, "too big")] {
        database(&path, true);
        let connection = Connection::open(&path).unwrap();
        connection
            .execute_batch(&format!("DROP TABLE messages; {schema}"))
            .unwrap();
        connection.close().unwrap();
        let began = std::time::Instant::now();
        let error = match bag::open(&path) {
            Ok(mut bag) => bag.find_map(Result::err).unwrap(),
            Err(error) => error,
        };
        let error = error.to_string();
        assert!(error.contains(told), "{error}");
        assert!(began.elapsed().as_secs() < 5, "{error}: after {:?}", began.elapsed());
    }
}

#[test]
fn metadata() {
    let folder = folder();
    let name = "run.mcap";
    recording(folder.path(), name, 6);
    let path = folder.path().join("metadata.yaml");
    let written = std::fs::read(&path).unwrap();
    let old = "rosbag2_bagfile_information:\n  compression_mode: NONE\n  relative_file_paths:\n  - bag/run.mcap\n";
    let none = "rosbag2_bagfile_information: {relative_file_paths: []}\n";
    Target {
        name: "metadata",
        seeds: vec![written, old.into(), none.into()],
        words: &[
            "relative_file_paths:",
            "- run.mcap\n",
            "- ..\n",
            "- \"\"\n",
            "compression_mode: FILE\n",
            "- run.mcap.zstd\n",
            "- run_1.mcap\n",
            "&a ",
            "*a",
            "[",
            "{",
            "~",
            "../",
            "rosbag2_bagfile_information:\n",
            "\u{feff}",
            "- .\n",
        ],
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            read(folder.path()).is_some()
        },
    }
    .fuzz();
}
