//! One MCAP file that is being written.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mcap::McapError;
use mcap::records::{MessageHeader, Metadata as McapMetadata};

use super::mcap_file::early_end::{self, Content};
use super::metadata::{self, FileEntry};
use super::sink::{McapWriter, Sink, end_size, start};
use super::storage::{Storage, StorageFile};
use super::tally::Tally;
use super::{BagError, Topic};

/// Uncompressed size at which a chunk is closed (bytes).
const CHUNK_SIZE: usize = 768 << 10;
/// Time that the first chunk spans, of messages and of the wall clock: what is recorded is on the disk from then on.
const FIRST_SPAN: Duration = Duration::from_millis(100);
/// Time that a chunk spans at most. With the time that a disk takes to write it, less than a second can be lost.
const LONGEST_SPAN: Duration = Duration::from_millis(500);
/// Bytes that a message takes in a chunk beside its own.
const MESSAGE_HEAD: usize = 31;
/// Chunks after which a recording goes on in another file: six hours at two a second. The index of the chunks is in memory
/// until the file ends, some 400 bytes each, 20 MB in all.
const MOST_CHUNKS: u32 = 43_200;
/// Size beyond which a recording goes on in another file (bytes): below the 4 GiB that a FAT file system takes.
const LARGEST_FILE: u64 = (4 << 30) - (64 << 20);
/// Bytes of the index per chunk, and per channel in each chunk.
const CHUNK_INDEX: u64 = 128;
const CHANNEL_INDEX: u64 = 10;

/// A message as it is recorded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry<'a> {
    /// Its topic, in the order of the recording.
    pub topic: usize,
    /// Its number in its topic.
    pub sequence: u32,
    /// ns since the clock's epoch.
    pub log_time: u64,
    /// ns since the clock's epoch.
    pub publish_time: u64,
    /// CDR with its header.
    pub bytes: &'a [u8],
}

/// How a file was ended early.
#[derive(Debug, Clone, Copy)]
pub(super) struct EarlyEnd {
    /// With an index.
    pub indexed: bool,
    /// Everything in it is on the disk, for all that the disk says.
    pub safe: bool,
}

/// A file of a recording. A chunk is put together in memory and written whole; the first after a tenth of a second,
/// later ones after half a second, and then brought to the disk.
///
/// After an error the file is cut back to its last whole chunk, and only [`Part::end_early`] may follow.
pub(super) struct Part {
    path: PathBuf,
    file: Box<dyn StorageFile>,
    sink: Sink,
    writer: McapWriter,
    channels: Vec<u16>,
    schemas: u16,
    /// Its own end is in it.
    ended: bool,
    /// Length of the file up to its last whole chunk.
    length: u64,
    /// Length that it may have (bytes).
    largest: u64,
    /// What its end takes at most beside the chunks' index (bytes).
    end_size: u64,
    largest_chunk: u64,
    /// With the open chunk.
    taken: Tally,
    in_file: Tally,
    /// What of it is on the disk for certain.
    safe: Tally,
    /// Log time of the first message of the open chunk, and when it came.
    chunk: Option<(u64, Instant)>,
    chunk_bytes: usize,
    chunks: u32,
    syncs: u32,
    last_sync: Instant,
}

impl Part {
    /// Makes a file that begins as MCAP.
    ///
    /// # Errors
    /// When the file is there already or cannot be written; what was made of it is left.
    pub fn create(storage: &dyn Storage, path: &Path, topics: &[Topic]) -> Result<Self, BagError> {
        let sink = Sink::default();
        let (writer, channels, schemas) = start(sink.clone(), topics).map_err(write_error(path))?;
        let file = storage.create(path).map_err(|source| match source.kind() {
            ErrorKind::AlreadyExists => BagError::Exists { path: path.to_owned() },
            _ => BagError::io("make", path)(source),
        })?;
        let tally = Tally::new(topics.len());
        let mut part = Self {
            path: path.to_owned(),
            file,
            sink,
            writer,
            channels,
            schemas,
            ended: false,
            length: 0,
            largest: storage.largest_file().unwrap_or(u64::MAX).min(LARGEST_FILE),
            end_size: topics.iter().map(end_size).sum(),
            largest_chunk: 0,
            taken: tally.clone(),
            in_file: tally.clone(),
            safe: tally,
            chunk: None,
            chunk_bytes: 0,
            chunks: 0,
            syncs: 0,
            last_sync: Instant::now(),
        };
        part.put_sink()?;
        Ok(part)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What is in the file.
    pub fn in_file(&self) -> &Tally {
        &self.in_file
    }

    /// What is in the file or in the open chunk.
    pub fn taken(&self) -> &Tally {
        &self.taken
    }

    /// What is on the disk for certain.
    pub fn safe(&self) -> &Tally {
        &self.safe
    }

    /// Whether the open chunk is to be written before a message of this log time, if there is one, is added.
    pub fn is_due(&self, log_time: Option<u64>) -> bool {
        let Some((first, began)) = self.chunk else {
            return false;
        };
        let span = span(self.chunks);
        // By log time too: files that are written faster than real time are cut the same every time.
        let spans = log_time.is_some_and(|time| u128::from(time.saturating_sub(first)) >= span.as_nanos());
        spans || began.elapsed() >= span || self.chunk_bytes >= CHUNK_SIZE
    }

    /// Adds a message to the open chunk, in memory.
    ///
    /// # Errors
    /// When the topic does not exist.
    pub fn add(&mut self, entry: &Entry<'_>) -> Result<(), BagError> {
        let Some(&channel_id) = self.channels.get(entry.topic) else {
            return Err(BagError::NoSuchIndex {
                path: self.path.clone(),
                index: entry.topic,
                count: self.channels.len(),
            });
        };
        let header = MessageHeader {
            channel_id,
            sequence: entry.sequence,
            log_time: entry.log_time,
            publish_time: entry.publish_time,
        };
        self.writer
            .write_to_known_channel(&header, entry.bytes)
            .map_err(write_error(&self.path))?;
        self.chunk.get_or_insert_with(|| (entry.log_time, Instant::now()));
        self.chunk_bytes += MESSAGE_HEAD + entry.bytes.len();
        self.taken.count(entry.topic, entry.log_time);
        Ok(())
    }

    /// Writes the open chunk, and brings the file to the disk when the last time is long enough ago.
    ///
    /// # Errors
    /// When writing fails: the messages of the open chunk are then not in the file. When the disk refuses:
    /// [`BagError::NotSafe`].
    pub fn flush(&mut self) -> Result<(), BagError> {
        // A chunk without messages would tell readers that the recording begins in 1970.
        if self.chunk.is_some() {
            self.writer.flush().map_err(write_error(&self.path))?;
            let before = self.length;
            self.put_sink()?;
            self.largest_chunk = self.largest_chunk.max(self.length - before);
            self.in_file = self.taken.clone();
            (self.chunk, self.chunk_bytes) = (None, 0);
            self.chunks = self.chunks.saturating_add(1);
        }
        self.sync_if_due()
    }

    /// Whether the file is to be ended before it takes another chunk: its end would have no room then, or its index would
    /// take too much memory.
    pub fn is_full(&self) -> bool {
        if self.chunks >= MOST_CHUNKS {
            return true;
        }
        let index = u64::from(self.chunks) * (CHUNK_INDEX + CHANNEL_INDEX * self.channels.len() as u64);
        // The next chunk may be larger than any before.
        self.length + 2 * self.largest_chunk + index + self.end_size > self.largest
    }

    /// Brings the file to the disk when the last time is long enough ago.
    ///
    /// # Errors
    /// As [`Part::sync`].
    pub fn sync_if_due(&mut self) -> Result<(), BagError> {
        if self.in_file != self.safe && self.last_sync.elapsed() >= span(self.syncs) {
            self.sync()?;
        }
        Ok(())
    }

    /// Brings the file to the disk.
    ///
    /// # Errors
    /// [`BagError::NotSafe`] when the disk refuses.
    pub fn sync(&mut self) -> Result<(), BagError> {
        self.last_sync = Instant::now();
        self.file.sync().map_err(|source| BagError::NotSafe {
            path: self.path.clone(),
            messages: self.in_file.messages() - self.safe.messages(),
            source,
        })?;
        self.syncs = self.syncs.saturating_add(1);
        self.safe = self.in_file.clone();
        Ok(())
    }

    /// Whether the file still stands where it was made.
    ///
    /// # Errors
    /// [`BagError::Gone`] when it does not.
    pub fn look(&self, storage: &dyn Storage) -> Result<(), BagError> {
        match (storage.id(&self.path), self.file.id()) {
            (Ok(there), Ok(here)) if there == here => Ok(()),
            _ => Err(BagError::Gone {
                path: self.path.clone(),
                messages: self.in_file.messages(),
            }),
        }
    }

    /// Ends the file: the open chunk, rosbag2's metadata, the index.
    ///
    /// # Errors
    /// As [`Part::flush`].
    pub fn end(&mut self, topics: &[Topic]) -> Result<(), BagError> {
        self.flush()?;
        // rosbag2 keeps the metadata in the file too, so that the file can be opened alone.
        let serialized = metadata::body(topics, &[self.file_entry()], &[]);
        let ended = self.writer.write_metadata(&McapMetadata {
            name: "rosbag2".to_owned(),
            metadata: BTreeMap::from([("serialized_metadata".to_owned(), serialized)]),
        });
        ended
            .and_then(|()| self.writer.finish().map(drop))
            .map_err(write_error(&self.path))?;
        // Kept for an early end, should this one have no room.
        let end = self.sink.bytes().clone();
        self.length = self.put(&end).map_err(BagError::io("write", &self.path))?;
        self.ended = true;
        self.sync()
    }

    /// Ends the file where it is whole, as well as the disk lets it. To be tried again later where that is not with an
    /// index: readers that want one are many.
    pub fn end_early(&mut self) -> EarlyEnd {
        let finished = self.writer.finish().is_ok();
        let bounds = self.in_file.bounds.unwrap_or((0, 0));
        let content = Content {
            length: self.length,
            counts: self
                .channels
                .iter()
                .copied()
                .zip(self.in_file.per_topic.iter().copied())
                .collect(),
            bounds,
            schemas: self.schemas,
        };
        let indexed = early_end::indexed(&self.sink.bytes(), &content);
        let has_room = self.ended || finished && self.put(&indexed).is_ok();
        if !has_room {
            let _ = self.put(&early_end::shortest());
        }
        EarlyEnd {
            indexed: has_room,
            // What is in the file is brought to the disk even where its end has no room.
            safe: self.file.sync().is_ok() || self.in_file == self.safe,
        }
    }

    /// What the metadata says of the file.
    pub fn file_entry(&self) -> FileEntry {
        FileEntry {
            name: self
                .path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default(),
            tally: self.in_file.clone(),
        }
    }

    /// Writes what the MCAP writer has put into memory.
    fn put_sink(&mut self) -> Result<(), BagError> {
        let bytes = std::mem::take(&mut *self.sink.bytes());
        self.length = self.put(&bytes).map_err(BagError::io("write", &self.path))?;
        Ok(())
    }

    /// Writes all of `bytes` behind what is whole, or cuts the file back to that. Where it ends then (bytes).
    fn put(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let mut rest = bytes;
        let mut offset = self.length;
        while !rest.is_empty() {
            match self.file.write_at(rest, offset) {
                Ok(0) => return self.cut_back(ErrorKind::WriteZero.into()),
                Ok(count) => {
                    rest = rest.get(count..).unwrap_or_default();
                    offset += count as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return self.cut_back(error),
            }
        }
        Ok(offset)
    }

    fn cut_back(&mut self, error: io::Error) -> io::Result<u64> {
        // Where this fails too, readers find the half chunk and stop before it.
        let _ = self.file.set_len(self.length);
        Err(error)
    }
}

/// Time that a chunk spans, or that passes between two times the file is brought to the disk, after so many.
fn span(before: u32) -> Duration {
    FIRST_SPAN.saturating_mul(1 << before.min(8)).min(LONGEST_SPAN)
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
