//! rosbag2's `metadata.yaml`, version 9: written at the end of a recording, read to find a bag's files.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::parts::PACKED;
use crate::storage::Storage;
use crate::tally::Tally;
use crate::{BagError, Topic, qos};

/// A file of a recording, as its metadata lists it.
#[derive(Debug, Clone)]
pub(crate) struct FileEntry {
    /// Name, without folder.
    pub name: String,
    /// Its content.
    pub tally: Tally,
}

/// The YAML under `rosbag2_bagfile_information` for these files; `custom` are rosbag2's free pairs of key and value.
pub(crate) fn body(topics: &[Topic], files: &[FileEntry], custom: &[(&str, String)]) -> String {
    // rosbag2 sums over all files in the head and lists each file's own counts below.
    let mut all = Tally::new(topics.len());
    for file in files {
        all.add(&file.tally);
    }
    // YAML needs `[]` for an empty list: a key without a value would be null.
    let none = |empty: bool| if empty { " []" } else { "" };
    let mut text = format!(
        "version: 9\nstorage_identifier: mcap\n{}topics_with_message_count:{}\n",
        times(&all),
        none(topics.is_empty())
    );
    // The keys stand in the order that rosbag2 writes, with its quotes: names of topics may hold any character.
    for (topic, count) in topics.iter().zip(&all.per_topic) {
        let _ = write!(
            text,
            concat!(
                "- topic_metadata:\n    name: {}\n    type: {}\n    serialization_format: {}\n",
                "    offered_qos_profiles:{}    type_description_hash: {}\n  message_count: {}\n",
            ),
            quoted(&topic.name),
            quoted(&topic.ros_type),
            quoted(&topic.encoding),
            nested(&qos::to_yaml(&topic.qos), "      "),
            quoted(&topic.type_hash),
            count,
        );
    }
    let _ = writeln!(
        text,
        "compression_format: \"\"\ncompression_mode: \"\"\nrelative_file_paths:{}",
        none(files.is_empty())
    );
    // rosbag2 writes both lists, the names alone and the files with their counts.
    for file in files {
        let _ = writeln!(text, "- {}", quoted(&file.name));
    }
    let _ = writeln!(text, "files:{}", none(files.is_empty()));
    for file in files {
        let times = nested(&times(&file.tally), "  ");
        let _ = write!(text, "- path: {}{times}", quoted(&file.name));
    }
    // `~` is what rosbag2 writes without custom data.
    if custom.is_empty() {
        text.push_str("custom_data: ~\n");
    } else {
        text.push_str("custom_data:\n");
    }
    for (key, value) in custom {
        let _ = writeln!(text, "  {key}: {}", quoted(value));
    }
    // The distribution whose rosbag2 writes version 9.
    text.push_str("ros_distro: jazzy\n");
    text
}

/// Duration, start and number of messages.
fn times(tally: &Tally) -> String {
    let (start, end) = tally.bounds.unwrap_or((0, 0));
    format!(
        concat!(
            "duration:\n  nanoseconds: {}\nstarting_time:\n  nanoseconds_since_epoch: {}\n",
            "message_count: {}\n"
        ),
        end.saturating_sub(start),
        start,
        tally.messages()
    )
}

/// Writes the file at the end of a recording. Until then there is none, so that readers do not take an interrupted
/// recording for an empty one.
///
/// # Errors
/// When it cannot be written, or the folder has another bag's.
pub(crate) fn write(storage: &dyn Storage, path: &Path, body: &str) -> Result<(), BagError> {
    let text = format!("rosbag2_bagfile_information:{}", nested(body, "  "));
    storage.put(path, &text).map_err(|source| match source.kind() {
        ErrorKind::AlreadyExists => BagError::OtherMetadata { path: path.to_owned() },
        _ => BagError::io("write", path)(source),
    })
}

/// A double-quoted YAML scalar. YAML has JSON's escapes; characters that YAML calls unprintable, or reads as the end of
/// a line, are escaped in addition.
fn quoted(text: &str) -> String {
    let mut quoted = String::new();
    for character in serde_json::Value::from(text).to_string().chars() {
        match character {
            ' '..='~'
            | '\u{a0}'..='\u{2027}'
            | '\u{202a}'..='\u{d7ff}'
            | '\u{e000}'..='\u{fefe}'
            | '\u{ff00}'..='\u{fffd}'
            | '\u{10000}'.. => quoted.push(character),
            other => {
                let _ = write!(quoted, "\\u{:04x}", u32::from(other));
            }
        }
    }
    quoted
}

/// A value under a key: a block begins on the next line, indented; a flow sequence follows on the key's line.
fn nested(block: &str, indent: &str) -> String {
    if block.starts_with('[') {
        return format!(" {block}");
    }
    let mut text = String::from("\n");
    for line in block.lines() {
        let _ = writeln!(text, "{indent}{line}");
    }
    text
}

#[derive(Deserialize)]
struct Document {
    rosbag2_bagfile_information: Information,
}

#[derive(Deserialize)]
struct Information {
    #[serde(default)]
    compression_format: Option<String>,
    #[serde(default)]
    compression_mode: Option<String>,
    relative_file_paths: Vec<String>,
}

/// The files of the bag in `folder`, as its metadata.yaml lists them, each once.
///
/// # Errors
/// When the metadata cannot be read, or the bag has rosbag2's compression of single messages.
pub(crate) fn files(folder: &Path, metadata: &Path) -> Result<Vec<PathBuf>, BagError> {
    let text = std::fs::read_to_string(metadata).map_err(BagError::io("read", metadata))?;
    let document: Document = serde_saphyr::from_str(&text).map_err(|error| BagError::Metadata {
        path: metadata.to_owned(),
        problem: format!(
            "not a rosbag2 metadata file: {}",
            error.render_with_formatter(&serde_saphyr::UserMessageFormatter)
        ),
    })?;
    let information = document.rosbag2_bagfile_information;
    let mode = information.compression_mode.unwrap_or_default();
    // Compressed files are known by their first bytes.
    if !["", "none", "file"].contains(&mode.to_ascii_lowercase().as_str()) {
        return Err(BagError::Compression {
            path: folder.to_owned(),
            compression: format!("{} per {}", information.compression_format.unwrap_or_default(), mode),
            remedy: "convert it with `ros2 bag convert` to a bag without compression of single messages",
        });
    }
    // A file listed twice, under one path or two, is read once.
    let (mut names, mut seen) = (BTreeSet::new(), BTreeSet::new());
    Ok(information
        .relative_file_paths
        .iter()
        .filter(|relative| names.insert(relative.as_str()))
        .map(|relative| present(folder, relative))
        .filter(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())))
        .collect())
}

/// The path of a listed file: as listed, next to the metadata, or compressed or unpacked since; as listed if there is none.
fn present(folder: &Path, relative: &str) -> PathBuf {
    let listed = folder.join(relative);
    // Early versions of rosbag2 put the folder's name in front.
    let name = Path::new(relative).file_name().map(|name| folder.join(name));
    let name = name.unwrap_or_else(|| listed.clone());
    let mut packed = name.clone().into_os_string();
    packed.push(".zstd");
    let unpacked = match name.extension() {
        Some(extension) if PACKED.iter().any(|packed| extension == *packed) => name.with_extension(""),
        _ => name.clone(),
    };
    let found = [listed, name.clone(), unpacked, PathBuf::from(packed)];
    found.into_iter().find(|path| path.exists()).unwrap_or(name)
}
