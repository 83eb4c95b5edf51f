//! The MCAP writer, writing to memory.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use mcap::write::NoSeek;
use mcap::{Compression, McapError, WriteOptions};

use super::{Topic, qos};

/// The writer of one file.
pub(super) type McapWriter = mcap::Writer<NoSeek<Sink>>;

/// Where the MCAP writer writes: memory, so that only whole chunks go to the file, and every error of the file is ours.
#[derive(Clone, Default)]
pub(super) struct Sink(Arc<Mutex<Vec<u8>>>);

impl Sink {
    /// What was written and not yet taken.
    pub fn bytes(&self) -> MutexGuard<'_, Vec<u8>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The header, schemas and channels; the channels, and the number of schemas.
pub(super) fn start(sink: Sink, topics: &[Topic]) -> Result<(McapWriter, Vec<u16>, u16), McapError> {
    let mut writer = WriteOptions::new()
        .profile("ros2")
        .library(concat!("flexdrill ", env!("CARGO_PKG_VERSION")))
        // Chunks are closed by `flush` alone.
        .chunk_size(None)
        .compression(Some(Compression::Zstd))
        // Compression in this thread: chunks are small, and the result is the same on every machine.
        .compression_threads(0)
        // Chunks are put together in memory and written whole, never as an open end.
        .disable_seeking(true)
        .create(NoSeek::new(sink))?;
    let mut channels = Vec::with_capacity(topics.len());
    let mut schemas = 0;
    for topic in topics {
        let schema = writer.add_schema(&topic.ros_type, &topic.schema_encoding, topic.schema.as_bytes())?;
        // Schemas are numbered from 1; topics of one type share one.
        schemas = schema.max(schemas);
        let mut metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), qos::to_yaml(&topic.qos))]);
        if !topic.type_hash.is_empty() {
            metadata.insert("topic_type_hash".to_owned(), topic.type_hash.clone());
        }
        channels.push(writer.add_channel(schema, &topic.name, &topic.encoding, &metadata)?);
    }
    Ok((writer, channels, schemas))
}

/// What a topic takes in the end of a file: its schema and channel, and its part of rosbag2's metadata.
pub(super) fn end_size(topic: &Topic) -> u64 {
    let qos = qos::to_yaml(&topic.qos);
    let texts = [&topic.name, &topic.ros_type, &topic.schema, &topic.type_hash];
    let own: usize = texts.iter().map(|text| 2 * text.len()).sum();
    // The metadata moves the QoS in by six places a line.
    (own + 2 * qos.len() + 6 * qos.lines().count() + 512) as u64
}
