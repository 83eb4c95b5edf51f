//! Bags of several parts, and compressed files.

use super::*;

/// One message at a second.
fn part(second: u64) -> Vec<u8> {
    let time = START + second * SECOND;
    file(
        &[chunk(
            time,
            time,
            &[float64(), channel(1, RPM), message(1, time, second as f64)],
        )],
        &[],
    )
}

fn metadata(folder: &Path, mode: &str, names: &[&str]) {
    let list: String = names.iter().map(|name| format!("  - {name}\n")).collect();
    let text = format!(
        "rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  compression_format: zstd\n  \
         compression_mode: {mode}\n  relative_file_paths:\n{list}"
    );
    std::fs::write(folder.join("metadata.yaml"), text).unwrap();
}

fn seconds(path: &Path) -> Vec<u64> {
    let (messages, errors) = read(path);
    assert!(errors.is_empty(), "{errors:?}");
    messages.into_iter().map(|(_, second, _)| second).collect()
}

#[test]
fn parts_that_the_metadata_does_not_list_are_read_or_named() {
    let folder = tempfile::tempdir().unwrap();
    for second in [0, 1, 2, 9, 10] {
        write(folder.path(), &format!("bag_{second}.mcap"), &part(second));
    }
    write(folder.path(), "other.mcap", &part(20));
    metadata(folder.path(), "\"\"", &["bag_0.mcap"]);
    // 9 and 10 are not the next ones, so they may be another recording's.
    assert_eq!(seconds(folder.path()), [0, 1, 2]);
    let bag = open(folder.path()).unwrap();
    says(
        bag.faults(),
        &[
            "bag_1.mcap is not listed in metadata.yaml and continues",
            "bag_2.mcap is not listed in metadata.yaml and continues",
            "bag_9.mcap is not listed in metadata.yaml and is NOT read",
            "other.mcap is not listed in metadata.yaml and is NOT read",
        ],
    );
    assert!(bag.faults().iter().all(|fault| !fault.loses()));
    let out = tempfile::tempdir().unwrap();
    let recovered = recover(folder.path(), &out.path().join("all")).unwrap();
    assert_eq!((recovered.recording.messages, recovered.faults.len()), (3, 5));
    // Listed alone, each is a bag.
    let alone = open(&folder.path().join("bag_9.mcap")).unwrap();
    assert!(alone.faults().is_empty());
}

#[test]
fn the_rest_is_recovered_where_a_listed_part_is_missing_or_no_bag() {
    let folder = tempfile::tempdir().unwrap();
    metadata(
        folder.path(),
        "\"\"",
        &["bag_0.mcap", "bag_1.mcap", "bag_2.mcap", "bag_3.mcap"],
    );
    let error = open(folder.path()).err().unwrap();
    says(&[error], &["4 files", "none is there", "bag_0.mcap"]);
    write(folder.path(), "bag_0.mcap", &part(0));
    write(folder.path(), "bag_2.mcap", b"");
    write(folder.path(), "bag_3.mcap", &part(3));
    assert_eq!(seconds(folder.path()), [0, 3]);
    let out = tempfile::tempdir().unwrap();
    let recovered = recover(folder.path(), &out.path().join("rest")).unwrap();
    assert_eq!(recovered.recording.messages, 2);
    assert!(recovered.faults.iter().all(PartFault::loses));
    says(
        &recovered.faults,
        &[
            "bag_1.mcap is listed in metadata.yaml and is missing",
            "copy it",
            "bag_2.mcap cannot be read",
        ],
    );
    let one = open(&folder.path().join("bag_3.mcap")).unwrap();
    says(one.faults(), &["one of 4 parts", "name the folder"]);
}

#[test]
fn compressed_files_are_read_alone_and_as_parts_of_a_bag() {
    let folder = tempfile::tempdir().unwrap();
    let packed = |second| zstd::encode_all(&part(second)[..], 3).unwrap();
    for second in 0..2 {
        write(folder.path(), &format!("bag_{second}.mcap.zstd"), &packed(second));
    }
    // rosbag2 lists the compressed names; one part was unpacked since.
    write(folder.path(), "bag_2.mcap", &part(2));
    metadata(
        folder.path(),
        "FILE",
        &["bag_0.mcap.zstd", "bag_1.mcap.zstd", "bag_2.mcap.zstd"],
    );
    assert_eq!(seconds(folder.path()), [0, 1, 2]);
    assert!(open(folder.path()).unwrap().faults().is_empty());
    assert_eq!(seconds(&folder.path().join("bag_1.mcap.zstd")), [1]);
    assert!(flexdrill_bag::is_bag(&folder.path().join("bag_1.mcap.zstd")).unwrap());
    // A log that is compressed is no bag, whatever its name is.
    let log = write(
        folder.path(),
        "log.zst",
        &zstd::encode_all(&b"t,rpm\n0,40\n"[..], 3).unwrap(),
    );
    assert!(!flexdrill_bag::is_bag(&log).unwrap());
    metadata(folder.path(), "MESSAGE", &["bag_2.mcap"]);
    says(
        &[open(folder.path()).err().unwrap()],
        &["zstd per MESSAGE", "ros2 bag convert"],
    );
    std::fs::remove_file(folder.path().join("metadata.yaml")).unwrap();
    assert_eq!(seconds(folder.path()), [0, 1, 2]);
}

#[test]
fn a_compressed_file_that_was_cut_gives_what_is_before_the_cut() {
    let folder = tempfile::tempdir().unwrap();
    let time = |second: u64| START + second * SECOND;
    let mut data = vec![chunk(START, START, &[float64(), channel(1, RPM)])];
    // Numbers that do not compress, so that the cut is within the content.
    let mut state = 1_u64;
    let noise = |state: &mut u64| {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        f64::from((*state >> 32) as u32)
    };
    for second in 0..40 {
        let messages: Vec<_> = (0..1000).map(|_| message(1, time(second), noise(&mut state))).collect();
        data.push(chunk(time(second), time(second), &messages));
    }
    let packed = zstd::encode_all(&file(&data, &[])[..], 3).unwrap();
    let path = write(folder.path(), "cut.mcap.zstd", &packed[..packed.len() / 2]);
    let (messages, errors) = read(&path);
    assert!(
        (5000..35_000).contains(&messages.len()),
        "{} {errors:?}",
        messages.len()
    );
    let bag = open(&path).unwrap();
    assert!(bag.faults()[0].loses());
    says(bag.faults(), &["cut.mcap.zstd is read up to byte", "damaged or cut"]);
    assert_eq!(bag.cuts().count(), 1);
}
