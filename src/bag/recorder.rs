//! Writing a recording that must be whole: the first error ends it.

use std::path::{Path, PathBuf};

use super::location::Location;
use super::metadata;
use super::part::{Entry, Part};
use super::storage::{Disk, Storage};
use super::{BagError, Losses, Topic};

/// A finished recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// The MCAP file; the first, when there are several.
    pub path: PathBuf,
    /// Messages in it.
    pub messages: u64,
    /// Messages per topic, in the order of the topics.
    pub per_topic: Vec<u64>,
    /// Messages that were to be recorded and are not in it.
    pub lost: u64,
    /// Of the messages in it, those that the disk may have lost.
    pub doubtful: u64,
    /// Lost and doubtful messages by cause.
    pub losses: Losses,
    /// Number of files.
    pub files: usize,
}

/// A recording to MCAP that is being written, one caller at a time.
///
/// A chunk is held in memory and written whole, at the latest after half a second, and then brought to the disk: when
/// the process or the machine dies, less than the last second is lost and everything before it can be read. The same
/// messages in the same order give the same bytes of every message; chunks are cut by log time, so that the whole file
/// is the same too as long as it is written faster than real time.
///
/// When writing fails (a full disk), the file is cut back to its last whole chunk and nothing more is recorded.
pub struct Recorder {
    location: Location,
    topics: Vec<Topic>,
    part: Part,
    /// Writing has failed.
    failed: bool,
    finished: bool,
}

impl Recorder {
    /// Begins a recording of `topics`: a path that ends in `.mcap` is a file with a metadata.yaml beside it, any other
    /// becomes a folder with both. The metadata.yaml is written at the end.
    ///
    /// # Errors
    /// When a file would be overwritten, another bag's metadata.yaml is in the folder, or the files cannot be made.
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

    /// Records one message. `topic` counts in the order of [`Recorder::topics`]; `log_time` is in ns since the clock's
    /// epoch (before it counts as at it); `bytes` are CDR with their header.
    ///
    /// # Errors
    /// When the topic does not exist, or writing fails; after a failed write, every call fails with
    /// [`BagError::Stopped`].
    pub fn record(&mut self, topic: usize, log_time: i64, bytes: &[u8]) -> Result<(), BagError> {
        self.record_as(topic, None, log_time, log_time, bytes)
    }

    /// Like [`Recorder::record`], with another publish time than log time, and a number in the topic: without one, it
    /// is the one after the last.
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
        self.whole()?;
        self.part.add(&entry)
    }

    /// Brings what was recorded into the file, and to the disk when the last time was long enough ago. To be called
    /// when no message may come for a while; [`Recorder::record`] does it by itself.
    ///
    /// # Errors
    /// When writing fails.
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.whole()?;
        let flushed = self.part.flush();
        self.keep(flushed)
    }

    /// Ends the recording: the rest of the messages, the index and the metadata.yaml.
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
        self.whole()?;
        let ended = self.part.end(&self.topics);
        self.keep(ended)?;
        self.write_metadata()
    }

    fn whole(&self) -> Result<(), BagError> {
        if self.failed {
            return Err(BagError::Stopped {
                path: self.location.file.clone(),
            });
        }
        Ok(())
    }

    /// After an error nothing more is written but what there is.
    fn keep(&mut self, result: Result<(), BagError>) -> Result<(), BagError> {
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
            // A recording that is dropped on the way out of an error is finished as well as it can be.
            let _ = self.close();
        }
    }
}
