//! One MCAP file under way.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mcap::McapError;
use mcap::records::{MessageHeader, Metadata as McapMetadata};

use crate::mcap_file::early_end::{self, Content};
use crate::metadata::{self, FileEntry};
use crate::sink::{McapWriter, Sink, end_size, start};
use crate::storage::{Storage, StorageFile};
use crate::tally::Tally;
use crate::{BagError, Topic};

/// Uncompressed size at which a chunk is written (bytes).
const CHUNK_SIZE: usize = 768 << 10;
/// Longest time of the first chunk, in log time and in wall time: a recording reaches the disk within this time.
const FIRST_SPAN: Duration = Duration::from_millis(100);
/// Longest time of a later chunk. Together with the time for writing it, less than a second can be lost.
const LONGEST_SPAN: Duration = Duration::from_millis(500);
/// Bytes of a message record in addition to its data.
const MESSAGE_HEAD: usize = 31;
/// Number of chunks at which a file is full: six hours at two per second. The index of the chunks stays in memory until
/// the file ends, about 400 bytes each, 20 MB in all.
const MOST_CHUNKS: u32 = 43_200;
/// Size at which a file is full (bytes): below the 4 GiB that a FAT file system allows.
const LARGEST_FILE: u64 = (4 << 30) - (64 << 20);
/// Bytes of the index per chunk, and per channel in each chunk.
const CHUNK_INDEX: u64 = 128;
const CHANNEL_INDEX: u64 = 10;

/// A message to record.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// Index of its topic in the recording.
    pub topic: usize,
    /// Its sequence number in its topic.
    pub sequence: u32,
    /// ns since the clock's epoch.
    pub log_time: u64,
    /// ns since the clock's epoch.
    pub publish_time: u64,
    /// CDR with its header.
    pub bytes: &'a [u8],
}

/// Result of ending a file early.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EarlyEnd {
    /// The file has an index.
    pub indexed: bool,
    /// The disk reports that it holds the whole file.
    pub safe: bool,
}

/// A file of a recording. It collects a chunk in memory, writes it whole (the first after a tenth of a second, later
/// ones after half a second) and then syncs the file to the disk.
///
/// After an error it truncates the file to the last whole chunk, and only [`Part::end_early`] may follow.
pub(crate) struct Part {
    path: PathBuf,
    file: Box<dyn StorageFile>,
    sink: Sink,
    writer: McapWriter,
    channels: Vec<u16>,
    schemas: u16,
    /// The end of the file has been written.
    ended: bool,
    /// Length of the file up to its last whole chunk.
    length: u64,
    /// Largest length allowed (bytes).
    largest: u64,
    /// Largest size of the file's end without the index of the chunks (bytes).
    end_size: u64,
    largest_chunk: u64,
    /// Messages in the file and in the open chunk.
    taken: Tally,
    /// Messages in the file.
    in_file: Tally,
    /// Messages that the disk has confirmed.
    safe: Tally,
    /// Log time of the open chunk's first message, and the time of its arrival.
    chunk: Option<(u64, Instant)>,
    chunk_bytes: usize,
    chunks: u32,
    syncs: u32,
    last_sync: Instant,
}

impl Part {
    /// Creates a file and writes the beginning of MCAP.
    ///
    /// # Errors
    /// When the file exists already or cannot be written; an unfinished file remains.
    pub fn create(storage: &dyn Storage, path: &Path, topics: &[Topic]) -> Result<Self, BagError> {
        let sink = Sink::default();
        let (writer, channels, schemas) = start(sink.clone(), topics).map_err(write_error(path))?;
        let file = storage.create(path).map_err(|source| match source.kind() {
            ErrorKind::AlreadyExists => BagError::Exists { path: path.to_owned() },
            _ => BagError::io("create", path)(source),
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
        part.write_sink()?;
        Ok(part)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Messages in the file.
    pub fn in_file(&self) -> &Tally {
        &self.in_file
    }

    /// Messages in the file or in the open chunk.
    pub fn taken(&self) -> &Tally {
        &self.taken
    }

    /// Messages that the disk has confirmed.
    pub fn safe(&self) -> &Tally {
        &self.safe
    }

    /// Whether the open chunk must be written before the next message; `log_time` is that of the message, if there is
    /// one.
    pub fn is_due(&self, log_time: Option<u64>) -> bool {
        let Some((first, began)) = self.chunk else {
            return false;
        };
        let span = span(self.chunks);
        // The log time also counts, so that a file written faster than real time has the same chunks every time.
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

    /// Writes the open chunk, and syncs the file when the last sync is long enough ago.
    ///
    /// # Errors
    /// When writing fails: the messages of the open chunk are then not in the file. [`BagError::NotSafe`] when the sync
    /// fails.
    pub fn flush(&mut self) -> Result<(), BagError> {
        // A chunk without messages would have the times 0, and readers would date the recording to 1970.
        if self.chunk.is_some() {
            self.writer.flush().map_err(write_error(&self.path))?;
            let before = self.length;
            self.write_sink()?;
            self.largest_chunk = self.largest_chunk.max(self.length - before);
            self.in_file = self.taken.clone();
            (self.chunk, self.chunk_bytes) = (None, 0);
            self.chunks = self.chunks.saturating_add(1);
        }
        self.sync_if_due()
    }

    /// Whether the file must end before the next chunk: otherwise its end might exceed the largest size, or its index
    /// too much memory.
    pub fn is_full(&self) -> bool {
        if self.chunks >= MOST_CHUNKS {
            return true;
        }
        let index = u64::from(self.chunks) * (CHUNK_INDEX + CHANNEL_INDEX * self.channels.len() as u64);
        // The next chunk may be larger than any before.
        self.length + 2 * self.largest_chunk + index + self.end_size > self.largest
    }

    /// Syncs the file when the last sync is long enough ago.
    ///
    /// # Errors
    /// As [`Part::sync`].
    pub fn sync_if_due(&mut self) -> Result<(), BagError> {
        if self.in_file != self.safe && self.last_sync.elapsed() >= span(self.syncs) {
            self.sync()?;
        }
        Ok(())
    }

    /// Syncs the file to the disk.
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

    /// Checks that the file is at its path.
    ///
    /// # Errors
    /// [`BagError::Gone`] when it was removed, moved or replaced.
    pub fn check_in_place(&self, storage: &dyn Storage) -> Result<(), BagError> {
        match (storage.id(&self.path), self.file.id()) {
            (Ok(there), Ok(here)) if there == here => Ok(()),
            _ => Err(BagError::Gone {
                path: self.path.clone(),
                messages: self.in_file.messages(),
            }),
        }
    }

    /// Ends the file: writes the open chunk, rosbag2's metadata and the index.
    ///
    /// # Errors
    /// As [`Part::flush`].
    pub fn end(&mut self, topics: &[Topic]) -> Result<(), BagError> {
        self.flush()?;
        // rosbag2 stores the metadata in the file too, so that the file can be opened alone.
        let serialized = metadata::body(topics, &[self.file_entry()], &[]);
        let ended = self.writer.write_metadata(&McapMetadata {
            name: "rosbag2".to_owned(),
            metadata: BTreeMap::from([("serialized_metadata".to_owned(), serialized)]),
        });
        ended
            .and_then(|()| self.writer.finish().map(drop))
            .map_err(write_error(&self.path))?;
        // The sink keeps the bytes for an early end, in case the disk has no room for this one.
        let end = self.sink.bytes().clone();
        self.length = self.append(&end).map_err(BagError::io("write", &self.path))?;
        self.ended = true;
        self.sync()
    }

    /// Ends the file behind its last whole chunk, with an index if the disk has room for one. Many readers need the
    /// index, so the caller tries again later when there was no room.
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
        let has_room = self.ended || finished && self.append(&indexed).is_ok();
        if !has_room {
            let _ = self.append(&early_end::shortest());
        }
        EarlyEnd {
            indexed: has_room,
            // The content is synced even when the end did not fit.
            safe: self.file.sync().is_ok() || self.in_file == self.safe,
        }
    }

    /// The file's entry in the metadata.
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

    /// Writes the bytes that the MCAP writer has produced.
    fn write_sink(&mut self) -> Result<(), BagError> {
        let bytes = std::mem::take(&mut *self.sink.bytes());
        self.length = self.append(&bytes).map_err(BagError::io("write", &self.path))?;
        Ok(())
    }

    /// Appends all of `bytes` to the whole part of the file, or truncates the file to that part. Returns the new
    /// length.
    fn append(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let mut rest = bytes;
        let mut offset = self.length;
        while !rest.is_empty() {
            match self.file.write_at(rest, offset) {
                Ok(0) => return self.truncate(ErrorKind::WriteZero.into()),
                Ok(count) => {
                    rest = rest.get(count..).unwrap_or_default();
                    offset += count as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return self.truncate(error),
            }
        }
        Ok(offset)
    }

    fn truncate(&mut self, error: io::Error) -> io::Result<u64> {
        // If this fails too, readers find the partial chunk and stop before it.
        let _ = self.file.set_len(self.length);
        Err(error)
    }
}

/// Longest time of a chunk, or between two syncs, after `before` of them.
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
