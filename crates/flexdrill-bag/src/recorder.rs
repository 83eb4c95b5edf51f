//! Writes a recording that must be complete: the first error ends it.

use std::path::{Path, PathBuf};

use crate::location::Location;
use crate::metadata;
use crate::part::{Entry, Part};
use crate::storage::{Disk, Storage};
use crate::{BagError, Losses, Topic};

/// A finished recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// The MCAP file; the first, when there are several.
    pub path: PathBuf,
    /// Messages in all files together.
    pub messages: u64,
    /// Messages per topic, in the order of the topics.
    pub per_topic: Vec<u64>,
    /// Messages that arrived and are in none of the files.
    pub lost: u64,
    /// Messages in files that the disk failed to sync: written, and perhaps lost.
    pub doubtful: u64,
    /// Lost and doubtful messages by cause.
    pub losses: Losses,
    /// Number of files.
    pub files: usize,
}

/// A recording to MCAP under way, with one caller at a time.
///
/// The recorder collects a chunk in memory, writes it whole after at most half a second, and then syncs the file: when
/// the process or the machine dies, less than the last second is lost, and everything before it can be read. The same
/// messages in the same order give the same bytes of every message. Chunks also end by log time, so that the whole file
/// has the same bytes if it is written faster than real time.
///
/// When writing fails (a full disk), the recorder truncates the file to its last whole chunk and records nothing more.
pub struct Recorder {
    location: Location,
    topics: Vec<Topic>,
    part: Part,
    /// Writing has failed.
    failed: bool,
    finished: bool,
}

impl Recorder {
    /// Creates a recording of `topics`: a path that ends in `.mcap` names a file, with a metadata.yaml in the same
    /// folder; any other path names a folder for both. The metadata.yaml is written at the end.
    ///
    /// # Errors
    /// When a file would be overwritten, the folder has another bag's metadata.yaml, or a file cannot be created.
    pub fn create(path: &Path, topics: &[Topic]) -> Result<Self, BagError> {
        let location = Location::prepare(path)?;
        let part = Part::create(&Disk, &location.file, topics)?;
        Ok(Self {
            location,
            topics: topics.to_vec(),
            part,
            failed: false,
            finished: false,
        })
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
        self.part.taken().messages()
    }

    /// Records one message. `topic` is the index in [`Recorder::topics`]; `log_time` is in ns since the clock's epoch
    /// (a negative time is recorded as 0); `bytes` are CDR with their header.
    ///
    /// # Errors
    /// When the topic does not exist, or writing fails; after a failed write, every call fails with
    /// [`BagError::Stopped`].
    pub fn record(&mut self, topic: usize, log_time: i64, bytes: &[u8]) -> Result<(), BagError> {
        self.record_as(topic, None, log_time, log_time, bytes)
    }

    /// Like [`Recorder::record`], with a publish time apart from the log time, and with a sequence number in the topic;
    /// `None` continues the numbering.
    ///
    /// # Errors
    /// As [`Recorder::record`].
    pub fn record_as(
        &mut self,
        topic: usize,
        sequence: Option<u32>,
        log_time: i64,
        publish_time: i64,
        bytes: &[u8],
    ) -> Result<(), BagError> {
        let before = self.part.taken().per_topic.get(topic).copied().unwrap_or_default();
        let entry = Entry {
            topic,
            sequence: sequence.unwrap_or(before as u32),
            log_time: u64::try_from(log_time).unwrap_or(0),
            publish_time: u64::try_from(publish_time).unwrap_or(0),
            bytes,
        };
        if self.part.is_due(Some(entry.log_time)) {
            self.flush()?;
        }
        self.check_not_stopped()?;
        self.part.add(&entry)
    }

    /// Writes the open chunk, and syncs the file when the last sync is long enough ago. Only callers that expect a
    /// pause need this; [`Recorder::record`] does the same.
    ///
    /// # Errors
    /// When writing fails.
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.check_not_stopped()?;
        let flushed = self.part.flush();
        self.stop_on_error(flushed)
    }

    /// Ends the recording: writes the open chunk, the index and the metadata.yaml.
    ///
    /// # Errors
    /// When writing fails.
    pub fn finish(mut self) -> Result<Recording, BagError> {
        self.close()?;
        let written = self.part.in_file();
        Ok(Recording {
            path: self.location.file.clone(),
            messages: written.messages(),
            per_topic: written.per_topic.clone(),
            lost: 0,
            doubtful: 0,
            losses: Losses::default(),
            files: 1,
        })
    }

    fn close(&mut self) -> Result<(), BagError> {
        self.finished = true;
        self.check_not_stopped()?;
        let ended = self.part.end(&self.topics);
        self.stop_on_error(ended)?;
        self.write_metadata()
    }

    fn check_not_stopped(&self) -> Result<(), BagError> {
        if self.failed {
            return Err(BagError::Stopped {
                path: self.location.file.clone(),
            });
        }
        Ok(())
    }

    /// Stops the recording at the first error, and lists the file in the metadata.
    fn stop_on_error(&mut self, result: Result<(), BagError>) -> Result<(), BagError> {
        if result.is_err() {
            self.failed = true;
            let _ = self.write_metadata();
        }
        result
    }

    fn write_metadata(&self) -> Result<(), BagError> {
        let body = metadata::body(&self.topics, &[self.part.file_entry()], &[]);
        metadata::write(&Disk as &dyn Storage, &self.location.metadata, &body)
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if !self.finished && !self.failed {
            // The caller has failed elsewhere; the recording so far is completed if possible.
            let _ = self.close();
        }
    }
}
