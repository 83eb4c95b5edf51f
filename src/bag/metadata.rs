//! rosbag2's `metadata.yaml`, version 9: written beside a recording, read to find a bag's files.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{BagError, Topic, qos};

/// What the metadata says of a recording.
pub(super) struct Metadata<'a> {
    /// Name of the MCAP file, without folder.
    pub file: &'a str,
    /// Topics with their numbers of messages.
    pub topics: &'a [Topic],
    /// Messages per topic.
    pub counts: &'a [u64],
    /// First and last log time (ns), if there are messages.
    pub bounds: Option<(u64, u64)>,
}

impl Metadata<'_> {
    /// The YAML below `rosbag2_bagfile_information`.
    pub fn body(&self) -> String {
        let total: u64 = self.counts.iter().sum();
        let (start, end) = self.bounds.unwrap_or((0, 0));
        let (duration, file) = (end - start, quoted(self.file));
        let mut text = format!(
            concat!(
                "version: 9\nstorage_identifier: mcap\nduration:\n  nanoseconds: {duration}\n",
                "starting_time:\n  nanoseconds_since_epoch: {start}\nmessage_count: {total}\n",
                "topics_with_message_count:{none}\n",
            ),
            duration = duration,
            start = start,
            total = total,
            none = if self.topics.is_empty() { " []" } else { "" },
        );
        for (topic, count) in self.topics.iter().zip(self.counts) {
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
        let _ = write!(
            text,
            concat!(
                "compression_format: \"\"\ncompression_mode: \"\"\nrelative_file_paths:\n- {file}\n",
                "files:\n- path: {file}\n  starting_time:\n    nanoseconds_since_epoch: {start}\n",
                "  duration:\n    nanoseconds: {duration}\n  message_count: {total}\n",
                "custom_data: ~\nros_distro: jazzy\n",
            ),
            file = file,
            start = start,
            duration = duration,
            total = total,
        );
        text
    }

    /// Writes the file: first under another name, so that there is never half of one.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), BagError> {
        let temporary = path.with_extension("yaml.part");
        let text = format!("rosbag2_bagfile_information:{}", nested(&self.body(), "  "));
        let written = File::create(&temporary).and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            file.sync_all()
        });
        written
            .and_then(|()| std::fs::rename(&temporary, path))
            .map_err(|source| {
                let _ = std::fs::remove_file(&temporary);
                BagError::io("write", path)(source)
            })
    }
}

/// A double-quoted YAML scalar; JSON's escapes are YAML's too.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A block under a key: on lines of its own, moved in; a flow value stays on the key's line.
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

/// The files of the bag in `folder`, by its metadata.yaml.
///
/// # Errors
/// When the metadata cannot be read, or the bag is compressed in a way that we do not read.
pub(super) fn files(folder: &Path, metadata: &Path) -> Result<Vec<PathBuf>, BagError> {
    let text = std::fs::read_to_string(metadata).map_err(BagError::io("read", metadata))?;
    let document: Document = serde_saphyr::from_str(&text).map_err(|error| BagError::Metadata {
        path: metadata.to_owned(),
        problem: format!("not a rosbag2 metadata file: {error}"),
    })?;
    let information = document.rosbag2_bagfile_information;
    let mode = information.compression_mode.unwrap_or_default();
    if !mode.is_empty() && !mode.eq_ignore_ascii_case("none") {
        return Err(BagError::Compression {
            path: folder.to_owned(),
            compression: format!("{} per {}", information.compression_format.unwrap_or_default(), mode),
            remedy: "convert it with `ros2 bag convert` to a bag without rosbag2's own compression",
        });
    }
    Ok(information
        .relative_file_paths
        .iter()
        .map(|relative| {
            // Early versions put the folder's own name in front.
            let path = folder.join(relative);
            match Path::new(relative).file_name() {
                Some(name) if !path.exists() => folder.join(name),
                _ => path,
            }
        })
        .collect())
}
