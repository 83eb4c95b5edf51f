//! A recording that survives errors of the disk: it continues in another file as soon as one can be written.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::location::Location;
use crate::metadata::{self, FileEntry};
use crate::part::{Entry, Part};
use crate::recording_health::{Counts, RecordingHealth};
use crate::storage::Storage;
use crate::tally::Tally;
use crate::{BagError, Recording, Topic};
use flexdrill_text::log_ending;

/// Interval between checks that the file has not been moved or removed.
const CHECK: Duration = Duration::from_millis(500);
/// Wait before the next attempt to create a file; doubles with each attempt.
const FIRST_WAIT: Duration = Duration::from_secs(1);
/// Longest wait between attempts.
const LONGEST_WAIT: Duration = Duration::from_secs(10);
/// Number of names tried for a file when other files have them.
const NAMES: usize = 1000;

/// Number of files kept open because the disk had no room for their index.
const UNENDED: usize = 16;

/// A message in the recorder's queue.
#[derive(Debug)]
pub(crate) struct Item {
    /// Index of its topic in the recording.
    pub topic: usize,
    /// Its sequence number in its topic; a missing number is a lost message.
    pub sequence: u32,
    /// ns since the clock's epoch.
    pub log_time: u64,
    /// CDR with its header.
    pub cdr: Vec<u8>,
}

impl Item {
    fn entry(&self) -> Entry<'_> {
        Entry {
            topic: self.topic,
            sequence: self.sequence,
            log_time: self.log_time,
            publish_time: self.log_time,
            bytes: &self.cdr,
        }
    }
}

/// The time of the next attempt to create a file.
#[derive(Debug)]
struct Retry {
    at: Instant,
    wait: Duration,
}

impl Retry {
    fn new() -> Self {
        Self {
            at: Instant::now(),
            wait: FIRST_WAIT,
        }
    }

    fn postpone(&mut self) {
        self.at = Instant::now() + self.wait;
        self.wait = (self.wait * 2).min(LONGEST_WAIT);
    }
}

/// Writes a recording into one file, or into several when the disk fails or a file is full.
pub(crate) struct FailoverRecorder {
    storage: Arc<dyn Storage>,
    location: Location,
    topics: Vec<Topic>,
    /// Device of the folder at the start.
    device: u64,
    /// `None` while nothing can be written.
    part: Option<Part>,
    /// Number of the next file.
    next: usize,
    /// The finished files.
    done: Vec<FileEntry>,
    /// Messages in the finished files.
    done_messages: u64,
    /// Of these, the ones whose index the disk had no room for.
    unended: Vec<Part>,
    /// Messages of the open chunk: if the chunk cannot be written, the next file gets them.
    open: Vec<Item>,
    /// Messages in no file.
    lost: u64,
    /// Messages in files that the disk failed to sync.
    doubtful: u64,
    /// Why nothing can be written.
    error: Option<BagError>,
    retry: Retry,
    checked: Instant,
    health: Arc<RecordingHealth>,
}

impl FailoverRecorder {
    /// Creates the first file.
    ///
    /// # Errors
    /// When a file of the recording exists or cannot be created.
    pub fn start(
        storage: Arc<dyn Storage>,
        path: &Path,
        topics: Vec<Topic>,
        health: Arc<RecordingHealth>,
    ) -> Result<Self, BagError> {
        let location = Location::prepare(path)?;
        let part = Part::create(&*storage, &location.file, &topics)?;
        let folder = storage
            .id(&location.folder)
            .map_err(BagError::io("read", &location.folder))?;
        health.set_path(part.path());
        Ok(Self {
            storage,
            location,
            topics,
            device: folder.device,
            part: Some(part),
            next: 1,
            done: Vec::new(),
            done_messages: 0,
            unended: Vec::new(),
            open: Vec::new(),
            lost: 0,
            doubtful: 0,
            error: None,
            retry: Retry::new(),
            checked: Instant::now(),
            health,
        })
    }

    /// Records a message, or counts it as lost when no file can be written.
    pub fn record(&mut self, item: Item) {
        if self.part.as_ref().is_some_and(|part| part.is_due(Some(item.log_time))) {
            self.flush();
        }
        if self.part.is_none() && Instant::now() >= self.retry.at {
            self.resume();
        }
        match self.part.as_mut().map(|part| part.add(&item.entry())) {
            Some(Ok(())) => self.open.push(item),
            Some(Err(error)) => {
                if let Some(more) = log_ending("message not recorded") {
                    tracing::error!("a message cannot be recorded: {error}{more}");
                }
                self.lost += 1;
            }
            None => self.lost += 1,
        }
        self.report();
    }

    /// Flushes, syncs, checks and retries as due. The caller runs it several times a second.
    pub fn tick(&mut self) {
        if self.part.as_ref().is_some_and(|part| part.is_due(None)) {
            self.flush();
        } else if let Some(Err(error)) = self.part.as_mut().map(Part::sync_if_due) {
            self.fail(error);
        }
        if self.checked.elapsed() >= CHECK {
            self.check_in_place();
        }
        if self.part.is_none() && Instant::now() >= self.retry.at {
            self.resume();
        }
        self.report();
    }

    /// Ends the recording: writes the queued messages, the index and the metadata.yaml.
    ///
    /// # Errors
    /// [`BagError::Incomplete`] when any of these could not be written.
    pub fn finish(mut self) -> Result<Recording, BagError> {
        // A file that was moved or removed meanwhile is abandoned first, so
        // that the open chunk is written to one that is in place.
        self.check_in_place();
        self.flush();
        // A last attempt: the messages of the open chunk have no other file, and the disk may have space again.
        if self.part.is_none() {
            self.resume();
        }
        let mut problem = None;
        match self.part.take() {
            // The file is kept even if its index does not fit: a reader can do without one.
            Some(mut part) => {
                if let Err(error) = part.end(&self.topics) {
                    self.end_early(&mut part, &error);
                    problem = Some(error);
                }
                self.keep(&part);
            }
            None => {
                // Nothing can be written, so the open chunk is lost with it, and the
                // error that stopped the recording is the one to report.
                self.lost += self.open.len() as u64;
                problem = self.error.take();
            }
        }
        // Files whose index had no room get a last chance, now that nothing else is written.
        self.end_unended();
        self.report();
        // Messages that the queue refused never arrived here, but they are missing as well.
        let lost = self.lost + self.health.not_handed_over();
        // Without any file there is nothing that metadata could describe.
        if !self.done.is_empty() {
            let counted = [
                ("flexdrill_messages_lost", lost),
                ("flexdrill_messages_doubtful", self.doubtful),
            ];
            let custom: Vec<(&str, String)> = counted.map(|(key, count)| (key, count.to_string())).to_vec();
            let body = metadata::body(&self.topics, &self.done, &custom);
            let written = metadata::write(&*self.storage, &self.location.metadata, &body);
            // The first problem is the cause; a failure of the metadata is mostly its consequence.
            problem = problem.or(written.err());
        }
        let all = self.in_files();
        let path = self.first_file();
        match problem {
            Some(problem) => Err(BagError::Incomplete {
                path,
                messages: all.messages(),
                lost,
                problem: Box::new(problem),
            }),
            None => Ok(Recording {
                path,
                messages: all.messages(),
                per_topic: all.per_topic,
                lost,
                doubtful: self.doubtful,
                losses: self.health.losses(),
                files: self.done.len(),
            }),
        }
    }

    fn first_file(&self) -> PathBuf {
        let first = self.done.first().map(|file| self.location.folder.join(&file.name));
        first.unwrap_or_else(|| self.location.file.clone())
    }

    fn flush(&mut self) {
        let Some(part) = &mut self.part else { return };
        let flushed = part.flush();
        if part.in_file() == part.taken() {
            self.open.clear();
        }
        match flushed {
            Err(error) => self.fail(error),
            Ok(()) if part.is_full() => self.split(),
            Ok(()) => {}
        }
    }

    /// Ends a full file and continues in another.
    fn split(&mut self) {
        let Some(mut part) = self.part.take() else { return };
        if let Err(error) = part.end(&self.topics) {
            self.part = Some(part);
            return self.fail(error);
        }
        self.keep(&part);
        match self.begin() {
            Ok(part) => {
                tracing::info!("the recording continues in {}", part.path().display());
                self.health.set_path(part.path());
                self.part = Some(part);
            }
            Err(error) => {
                tracing::error!("the recording stopped: {error}; the twin continues without it");
                self.health.set_error(&error);
                self.error = Some(error);
                self.retry.postpone();
            }
        }
    }

    /// Fails over when the file was moved or removed.
    fn check_in_place(&mut self) {
        self.checked = Instant::now();
        if let Some(Err(error)) = self.part.as_ref().map(|part| part.check_in_place(&*self.storage)) {
            self.fail(error);
        }
    }

    /// Abandons the file, logs the error, and continues in another file: at once if the abandoned one had worked.
    fn fail(&mut self, error: BagError) {
        let Some(mut part) = self.part.take() else { return };
        tracing::error!("the recording stopped: {error}; the twin continues without it");
        let worked = part.safe().messages() > 0;
        let indexed = self.end_early(&mut part, &error);
        if matches!(error, BagError::Gone { .. }) {
            self.lost += part.in_file().messages();
        } else if part.in_file().messages() == 0 {
            let _ = self.storage.remove(part.path());
        } else {
            self.keep(&part);
            if !indexed && self.unended.len() < UNENDED {
                self.unended.push(part);
            }
        }
        self.health.set_error(&error);
        self.error = Some(error);
        if worked {
            self.retry = Retry::new();
            self.resume();
        } else {
            self.retry.postpone();
        }
    }

    /// Ends a file after an error and counts the messages that the disk may have lost. The kernel drops data whose sync
    /// failed, and reports success the next time. Returns whether the index fitted.
    fn end_early(&mut self, part: &mut Part, error: &BagError) -> bool {
        let ended = part.end_early();
        match error {
            BagError::Gone { .. } => {}
            BagError::NotSafe { messages, .. } => self.doubtful += messages,
            _ if !ended.safe => self.doubtful += part.in_file().messages() - part.safe().messages(),
            _ => {}
        }
        ended.indexed
    }

    /// Retries the index of the files whose index did not fit.
    fn end_unended(&mut self) {
        self.unended.retain_mut(|part| !part.end_early().indexed);
    }

    /// Continues in a new file, if one can be created.
    fn resume(&mut self) {
        match self.begin() {
            Ok(part) => {
                let before = self.error.take();
                tracing::warn!(
                    "the recording continues in {}; {} messages were lost so far",
                    part.path().display(),
                    self.lost + self.health.not_handed_over()
                );
                self.health.set_path(part.path());
                self.health.clear_error(before.as_ref());
                self.open.clear();
                self.part = Some(part);
                self.end_unended();
            }
            Err(error) => {
                tracing::debug!("the recording cannot continue yet: {error}");
                self.health.set_error(&error);
                self.error = Some(error);
                self.retry.postpone();
            }
        }
    }

    /// A new file that begins with the messages missing in the last one. A file that cannot be written is removed.
    fn begin(&mut self) -> Result<Part, BagError> {
        self.check_folder()?;
        for _ in 0..NAMES {
            let path = self.location.part(self.next);
            let begun = match Part::create(&*self.storage, &path, &self.topics) {
                Err(BagError::Exists { .. }) => {
                    self.next += 1;
                    continue;
                }
                begun => begun,
            };
            let filled = begun.and_then(|mut part| {
                for item in &self.open {
                    part.add(&item.entry())?;
                }
                part.flush()?;
                part.sync()?;
                Ok(part)
            });
            match filled {
                Ok(_) => self.next += 1,
                Err(_) => drop(self.storage.remove(&path)),
            }
            return filled;
        }
        Err(BagError::Exists {
            path: self.location.part(self.next),
        })
    }

    /// Checks that the folder is on its original disk, and creates it again if it was removed: when a disk is
    /// unmounted, its mount point becomes a folder of another disk.
    fn check_folder(&self) -> Result<(), BagError> {
        let folder = &self.location.folder;
        let read = |path: &Path| self.storage.id(path).map_err(BagError::io("read", path));
        let same = |device: u64| device == self.device;
        match self.storage.id(folder) {
            Ok(found) if same(found.device) => Ok(()),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty());
                if !same(read(parent.unwrap_or(Path::new(".")))?.device) {
                    return Err(BagError::OtherDisk { path: folder.clone() });
                }
                self.storage
                    .make_folder(folder)
                    .map_err(BagError::io("create the folder", folder))
            }
            Ok(_) => Err(BagError::OtherDisk { path: folder.clone() }),
            Err(error) => Err(BagError::io("read", folder)(error)),
        }
    }

    /// Adds a file to the recording.
    fn keep(&mut self, part: &Part) {
        self.done_messages += part.in_file().messages();
        self.done.push(part.file_entry());
    }

    fn in_files(&self) -> Tally {
        let mut all = Tally::new(self.topics.len());
        for file in &self.done {
            all.add(&file.tally);
        }
        all
    }

    fn report(&self) {
        let before = self.done_messages;
        let (in_file, safe) = self
            .part
            .as_ref()
            .map_or((0, 0), |part| (part.in_file().messages(), part.safe().messages()));
        self.health.set_counts(Counts {
            written: (before + in_file).saturating_sub(self.doubtful),
            safe: (before + safe).saturating_sub(self.doubtful),
            unwritten: self.lost,
            refused: self.doubtful,
        });
    }
}
