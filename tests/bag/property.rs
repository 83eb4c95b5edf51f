//! Whatever the bytes are, reading a bag ends in messages and errors, never in a panic.

use std::path::Path;
use std::sync::OnceLock;

use crate::bag_support::recording;
use flexdrill::bag;
use proptest::prelude::*;

/// A whole recording's bytes, made once.
fn whole() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::read(recording(folder.path(), "run.mcap", 200)).unwrap()
    })
}

/// The same content without chunks, and with chunks that are not compressed or compressed otherwise.
fn variants() -> &'static [Vec<u8>] {
    static BYTES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let options = [
            mcap::WriteOptions::new().use_chunks(false),
            mcap::WriteOptions::new().compression(None).chunk_size(Some(2000)),
            mcap::WriteOptions::new()
                .compression(Some(mcap::Compression::Lz4))
                .chunk_size(Some(2000)),
        ];
        options.into_iter().map(rewritten).collect()
    })
}

fn rewritten(options: mcap::WriteOptions) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = options.create(std::io::Cursor::new(&mut bytes)).unwrap();
    for message in mcap::MessageStream::new(whole()).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    bytes
}

/// Reads everything; the number of messages, if it is a bag at all.
fn read(path: &Path) -> Option<usize> {
    let bag = bag::open(path).ok()?;
    // A bag never gives errors without end.
    Some(bag.take(10_000).filter(Result::is_ok).count())
}

#[test]
fn foreign_ways_of_writing_are_read_in_full() {
    let folder = tempfile::tempdir().unwrap();
    for (number, bytes) in variants().iter().enumerate() {
        let path = folder.path().join(format!("{number}.mcap"));
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(
            crate::bag_support::check_prefix(bag::open(&path).unwrap()),
            200,
            "variant {number}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn property_damaged_recordings_never_panic(
        variant in 0..4_usize,
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        cut in any::<prop::sample::Index>(),
        cut_at_all in any::<bool>(),
    ) {
        let mut bytes = if variant == 3 { whole().to_vec() } else { variants()[variant].clone() };
        for (place, value) in damage {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        if cut_at_all {
            bytes.truncate(cut.index(bytes.len()));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("damaged.mcap");
        std::fs::write(&path, &bytes).unwrap();
        if let Some(count) = read(&path) {
            prop_assert!(count <= 200);
            bag::recover(&path, &folder.path().join("recovered")).unwrap();
        }
    }

    #[test]
    fn property_random_bytes_never_panic(tail in proptest::collection::vec(any::<u8>(), 0..400)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("random.mcap");
        std::fs::write(&path, [&whole()[..8], &tail].concat()).unwrap();
        read(&path);
        std::fs::write(&path, [&b"SQLite format 3\0"[..], &tail].concat()).unwrap();
        read(&path);
        std::fs::write(&path, &tail).unwrap();
        prop_assert!(read(&path).is_none());
    }

    #[test]
    fn property_random_metadata_never_panics(text in "\\PC{0,200}") {
        let folder = tempfile::tempdir().unwrap();
        let document = format!("rosbag2_bagfile_information:\n  relative_file_paths: [x.mcap]\n  {text}");
        std::fs::write(folder.path().join("metadata.yaml"), document).unwrap();
        read(folder.path());
    }
}
