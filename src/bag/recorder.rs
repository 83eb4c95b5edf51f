//! Writing a recording.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{BufWriter, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mcap::records::{MessageHeader, Metadata as McapMetadata};
use mcap::write::NoSeek;
use mcap::{Compression, McapError, WriteOptions};

use super::location::Location;
use super::metadata::Metadata;
use super::{BagError, Topic, qos};

/// Uncompressed size at which a chunk is closed (bytes).
const CHUNK_SIZE: u64 = 768 << 10;
/// Log time that a chunk spans at most (ns).
const CHUNK_SPAN: u64 = 1_000_000_000;
/// Time after which what was recorded is on the disk.
const SYNC_INTERVAL: Duration = Duration::from_secs(1);

type McapWriter = mcap::Writer<NoSeek<BufWriter<File>>>;

/// A finished recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// The MCAP file.
    pub path: PathBuf,
    /// Messages in it.
    pub messages: u64,
    /// Messages per topic, in the order of the topics.
    pub per_topic: Vec<u64>,
}

/// A recording to MCAP that is being written, one caller at a time.
///
/// A chunk is held in memory and written whole, at the latest after a second, and then brought to the disk: when the
/// process or the machine dies, the last second is lost and everything before it can be read. The same messages in the
/// same order give the same bytes of every message; chunks are cut by log time, so that the whole file is the same too
/// as long as it is written faster than real time.
///
/// When writing fails (a full disk), the file is cut back to its last whole chunk and nothing more is recorded.
pub struct Recorder {
    location: Location,
    topics: Vec<Topic>,
    channels: Vec<u16>,
    /// `None` once writing has failed.
    writer: Option<McapWriter>,
    /// The same file, to bring it to the disk or cut it.
    file: File,
    written: Tally,
    /// What of it is in the file for certain.
    flushed: Tally,
    /// Length of the file up to its last whole chunk.
    flushed_length: u64,
    /// Log time of the first message that is not yet in the file.
    chunk_start: Option<u64>,
    last_flush: Instant,
    finished: bool,
}

/// How much was recorded.
#[derive(Debug, Clone, Default)]
struct Tally {
    per_topic: Vec<u64>,
    bounds: Option<(u64, u64)>,
}

impl Recorder {
    /// Begins a recording of `topics`: a path that ends in `.mcap` is a file with a metadata.yaml beside it, any other
    /// becomes a folder with both.
    ///
    /// # Errors
    /// When a file would be overwritten, another bag's metadata.yaml is in the folder, or the files cannot be made.
    pub fn create(path: &Path, topics: &[Topic]) -> Result<Self, BagError> {
        let location = Location::prepare(path)?;
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&location.file)
            .map_err(|source| match source.kind() {
                ErrorKind::AlreadyExists => BagError::Exists {
                    path: location.file.clone(),
                },
                _ => BagError::io("make", &location.file)(source),
            })?;
        let handle = file.try_clone().map_err(BagError::io("open", &location.file))?;
        let (writer, channels) = start(file, topics).map_err(write_error(&location.file))?;
        let tally = Tally {
            per_topic: vec![0; topics.len()],
            bounds: None,
        };
        let recorder = Self {
            location,
            topics: topics.to_vec(),
            channels,
            writer: Some(writer),
            file: handle,
            written: tally.clone(),
            flushed: tally,
            flushed_length: 0,
            chunk_start: None,
            last_flush: Instant::now(),
            finished: false,
        };
        recorder.write_metadata()?;
        Ok(recorder)
    }

    /// The topics, as given.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The MCAP file.
    pub fn path(&self) -> &Path {
        &self.location.file
    }

    /// Messages recorded so far.
    pub fn messages(&self) -> u64 {
        self.written.per_topic.iter().sum()
    }

    /// Records one message. `topic` counts in the order of [`Recorder::topics`]; `log_time` is in ns since the clock's
    /// epoch (before it counts as at it); `bytes` are CDR with their header.
    ///
    /// # Errors
    /// When the topic does not exist, or writing fails; after a failed write, every call fails with
    /// [`BagError::Stopped`].
    pub fn record(&mut self, topic: usize, log_time: i64, bytes: &[u8]) -> Result<(), BagError> {
        self.record_published(topic, log_time, log_time, bytes)
    }

    /// Like [`Recorder::record`], with another publish time than log time.
    ///
    /// # Errors
    /// As [`Recorder::record`].
    pub fn record_published(
        &mut self,
        topic: usize,
        log_time: i64,
        publish_time: i64,
        bytes: &[u8],
    ) -> Result<(), BagError> {
        let (Some(&channel_id), Some(count)) = (self.channels.get(topic), self.written.per_topic.get(topic)) else {
            return Err(BagError::NoSuchIndex {
                path: self.location.file.clone(),
                index: topic,
                count: self.topics.len(),
            });
        };
        let log_time = u64::try_from(log_time).unwrap_or(0);
        let header = MessageHeader {
            channel_id,
            sequence: *count as u32,
            log_time,
            publish_time: u64::try_from(publish_time).unwrap_or(0),
        };
        let old_chunk = self
            .chunk_start
            .is_some_and(|start| log_time.saturating_sub(start) >= CHUNK_SPAN);
        if old_chunk || (self.chunk_start.is_some() && self.last_flush.elapsed() >= SYNC_INTERVAL) {
            self.flush()?;
        }
        self.write(|writer| writer.write_to_known_channel(&header, bytes))?;
        self.chunk_start.get_or_insert(log_time);
        self.written.per_topic[topic] += 1;
        self.written.bounds = Some(match self.written.bounds {
            None => (log_time, log_time),
            Some((first, last)) => (first.min(log_time), last.max(log_time)),
        });
        Ok(())
    }

    /// Brings what was recorded into the file, and to the disk when the last time was a second ago or more. To be
    /// called when no message may come for a while; [`Recorder::record`] does it by itself.
    ///
    /// # Errors
    /// When writing fails.
    pub fn flush(&mut self) -> Result<(), BagError> {
        // A chunk without messages would tell readers that the recording begins in 1970.
        if self.chunk_start.is_none() {
            return Ok(());
        }
        self.write(McapWriter::flush)?;
        self.chunk_start = None;
        self.flushed = self.written.clone();
        let due = self.last_flush.elapsed() >= SYNC_INTERVAL;
        let synced = if due { self.file.sync_data() } else { Ok(()) };
        if due {
            self.last_flush = Instant::now();
        }
        let length = synced.and_then(|()| self.file.metadata());
        self.flushed_length = length.map_err(BagError::io("write", &self.location.file))?.len();
        Ok(())
    }

    /// Ends the recording: the rest of the messages, the index and the final metadata.yaml.
    ///
    /// # Errors
    /// When writing fails.
    pub fn finish(mut self) -> Result<Recording, BagError> {
        self.close()?;
        Ok(Recording {
            path: self.location.file.clone(),
            messages: self.messages(),
            per_topic: self.written.per_topic.clone(),
        })
    }

    fn close(&mut self) -> Result<(), BagError> {
        self.finished = true;
        self.flush()?;
        let serialized = self.metadata(&self.written).body();
        self.write(|writer| {
            // rosbag2 keeps the metadata in the file too, so that the file can be opened alone.
            writer.write_metadata(&McapMetadata {
                name: "rosbag2".to_owned(),
                metadata: BTreeMap::from([("serialized_metadata".to_owned(), serialized)]),
            })?;
            writer.finish()?;
            Ok(())
        })?;
        if let Some(writer) = self.writer.take() {
            let flushed = writer.into_inner().into_inner().into_inner();
            let synced = flushed
                .map_err(|error| error.into_error())
                .and_then(|file| file.sync_all());
            synced.map_err(BagError::io("write", &self.location.file))?;
        }
        self.write_metadata()
    }

    /// Lets the MCAP writer do something. When that fails, the file is cut back to what is whole.
    fn write(&mut self, action: impl FnOnce(&mut McapWriter) -> Result<(), McapError>) -> Result<(), BagError> {
        let Some(writer) = &mut self.writer else {
            return Err(BagError::Stopped {
                path: self.location.file.clone(),
            });
        };
        let Err(error) = action(writer) else {
            return Ok(());
        };
        if let Some(writer) = self.writer.take() {
            // Neither the MCAP writer nor the buffer may write its rest when it is dropped.
            let _ = writer.into_inner().into_inner().into_parts();
        }
        let _ = self.file.set_len(self.flushed_length);
        let _ = self.metadata(&self.flushed).write(&self.location.metadata);
        Err(write_error(&self.location.file)(error))
    }

    fn metadata<'a>(&'a self, tally: &'a Tally) -> Metadata<'a> {
        Metadata {
            file: self
                .location
                .file
                .file_name()
                .and_then(|name| name.to_str())
                .unwrap_or_default(),
            topics: &self.topics,
            counts: &tally.per_topic,
            bounds: tally.bounds,
        }
    }

    fn write_metadata(&self) -> Result<(), BagError> {
        self.metadata(&self.written).write(&self.location.metadata)
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if !self.finished && self.writer.is_some() {
            // A recording that is dropped on the way out of an error is finished as well as it can be.
            let _ = self.close();
        }
    }
}

/// The header, schemas and channels.
fn start(file: File, topics: &[Topic]) -> Result<(McapWriter, Vec<u16>), McapError> {
    let mut writer = WriteOptions::new()
        .profile("ros2")
        .library(concat!("flexdrill ", env!("CARGO_PKG_VERSION")))
        .chunk_size(Some(CHUNK_SIZE))
        .compression(Some(Compression::Zstd))
        // Compression in this thread: chunks are small, and the result is the same on every machine.
        .compression_threads(0)
        // Chunks are put together in memory and written whole, never as an open end.
        .disable_seeking(true)
        .create(NoSeek::new(BufWriter::new(file)))?;
    let mut channels = Vec::with_capacity(topics.len());
    for topic in topics {
        let schema = writer.add_schema(&topic.ros_type, &topic.schema_encoding, topic.schema.as_bytes())?;
        let mut metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), qos::to_yaml(&topic.qos))]);
        if !topic.type_hash.is_empty() {
            metadata.insert("topic_type_hash".to_owned(), topic.type_hash.clone());
        }
        channels.push(writer.add_channel(schema, &topic.name, &topic.encoding, &metadata)?);
    }
    Ok((writer, channels))
}

fn write_error(path: &Path) -> impl FnOnce(McapError) -> BagError {
    let path = path.to_owned();
    move |source| match source {
        McapError::Io(source) => BagError::Io {
            action: "write",
            path,
            source,
        },
        source => BagError::Write { path, source },
    }
}
