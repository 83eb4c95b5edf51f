//! The MCAP writer, which writes to memory.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use mcap::write::NoSeek;
use mcap::{Compression, McapError, WriteOptions};

use crate::{Topic, qos};

/// The writer of one file.
pub(crate) type McapWriter = mcap::Writer<NoSeek<Sink>>;

/// The MCAP writer's output, in memory: only whole chunks reach the file, and this crate handles every error of the
/// file.
#[derive(Clone, Default)]
pub(crate) struct Sink(Arc<Mutex<Vec<u8>>>);

impl Sink {
    /// The bytes that have not been copied to the file.
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

/// Writes the header, schemas and channels. Returns the writer, the channels' ids and the number of schemas.
pub(crate) fn start(sink: Sink, topics: &[Topic]) -> Result<(McapWriter, Vec<u16>, u16), McapError> {
    let mut writer = WriteOptions::new()
        .profile("ros2")
        .library(concat!("flexdrill ", env!("CARGO_PKG_VERSION")))
        // Only `flush` ends a chunk.
        .chunk_size(None)
        .compression(Some(Compression::Zstd))
        // The calling thread compresses: chunks are small, and the result is the same on every machine.
        .compression_threads(0)
        // The writer completes a chunk in memory, so that no chunk without its size is ever written.
        .disable_seeking(true)
        .create(NoSeek::new(sink))?;
    let mut channels = Vec::with_capacity(topics.len());
    let mut schemas = 0;
    for topic in topics {
        let schema = writer.add_schema(&topic.ros_type, &topic.schema_encoding, topic.schema.as_bytes())?;
        // The writer numbers schemas from 1, and topics of one type share a schema.
        schemas = schema.max(schemas);
        let mut metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), qos::to_yaml(&topic.qos))]);
        if !topic.type_hash.is_empty() {
            metadata.insert("topic_type_hash".to_owned(), topic.type_hash.clone());
        }
        channels.push(writer.add_channel(schema, &topic.name, &topic.encoding, &metadata)?);
    }
    Ok((writer, channels, schemas))
}

/// Upper bound of a topic's share in the end of a file (bytes): its schema, channel and part of rosbag2's metadata.
pub(crate) fn end_size(topic: &Topic) -> u64 {
    let qos = qos::to_yaml(&topic.qos);
    let texts = [&topic.name, &topic.ros_type, &topic.schema, &topic.type_hash];
    let own: usize = texts.iter().map(|text| 2 * text.len()).sum();
    // The metadata indents each line of the QoS by six characters.
    (own + 2 * qos.len() + 6 * qos.lines().count() + 512) as u64
}
