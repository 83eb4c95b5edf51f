//! The recorder's thread behind a bounded queue: a slow disk loses messages of the recording, never time of the node.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::live::{Item, LiveRecorder};
use super::recording_health::RecordingHealth;
use super::storage::{Disk, Storage};
use super::{BagError, Recording, Topic};
use crate::messages::topics::{self, TopicInfo};

/// Messages that may wait for the disk: at 300 per second, over 20 s.
const QUEUE: usize = 8192;
/// Bytes that may wait for the disk: at 16 kB a message, as many as messages.
const QUEUE_BYTES: usize = 128 << 20;
/// How often it is looked what is due when no message comes.
const TICK: Duration = Duration::from_millis(50);
/// Longest wait for the beginning and for the end of a recording: a disk that does not answer must not hold the node.
const PATIENCE: Duration = Duration::from_secs(10);

/// A recording under way.
pub struct RecordingThread {
    queue: Option<SyncSender<Item>>,
    thread: Option<JoinHandle<Result<Recording, BagError>>>,
    health: Arc<RecordingHealth>,
    /// Next number of each topic of the node.
    sequences: [AtomicU32; topics::ALL.len()],
    queued: Arc<AtomicUsize>,
}

impl RecordingThread {
    /// Begins to record all topics of the node; `name` makes a topic's name absolute. Gives up after 10 s.
    ///
    /// # Errors
    /// When the file cannot be made; [`BagError::NotBegun`] when the disk does not answer.
    pub fn start(path: &Path, name: impl Fn(&TopicInfo) -> String) -> Result<Self, BagError> {
        Self::start_on(Arc::new(Disk), path, name)
    }

    /// Like [`RecordingThread::start`], on another file system than this machine's.
    ///
    /// # Errors
    /// As [`RecordingThread::start`].
    pub fn start_on(
        storage: Arc<dyn Storage>,
        path: &Path,
        name: impl Fn(&TopicInfo) -> String,
    ) -> Result<Self, BagError> {
        let recorded: Vec<Topic> = topics::ALL
            .iter()
            .map(|topic| Topic::new(name(topic), &topic.kind, topic.qos))
            .collect();
        let health = Arc::new(RecordingHealth::default());
        let (queue, items) = sync_channel(QUEUE);
        let queued = Arc::new(AtomicUsize::new(0));
        let (waiting, shared, place) = (Arc::clone(&queued), Arc::clone(&health), path.to_owned());
        let (begun_sender, begun) = sync_channel(1);
        let work = move || {
            // Here, since making a file can take for ever too.
            let recorder = LiveRecorder::start(storage, &place, recorded, shared);
            let (recorder, result) = match recorder {
                Ok(recorder) => (Some(recorder), Ok(())),
                Err(error) => (None, Err(error)),
            };
            // Nobody waits any more when that took too long.
            let _ = begun_sender.send(result);
            match recorder {
                Some(recorder) => write(recorder, &items, &waiting),
                None => Err(BagError::Stopped { path: place }),
            }
        };
        let thread = std::thread::Builder::new()
            .name("recorder".into())
            .spawn(work)
            .map_err(BagError::io("start the recorder of", path))?;
        match begun.recv_timeout(PATIENCE) {
            Ok(begun) => begun?,
            Err(_) => {
                return Err(BagError::NotBegun {
                    path: path.to_owned(),
                    seconds: PATIENCE.as_secs(),
                });
            }
        }
        Ok(Self {
            queue: Some(queue),
            thread: Some(thread),
            health,
            sequences: Default::default(),
            queued,
        })
    }

    /// Counts messages of a topic that did not get as far as here: lost, and left out of its numbers.
    pub fn lose(&self, topic: &TopicInfo, messages: u32) {
        if let Some(sequence) = topics::ALL
            .iter()
            .position(|known| known.name == topic.name)
            .and_then(|index| self.sequences.get(index))
        {
            sequence.fetch_add(messages, Ordering::Relaxed);
            self.health.flood(messages);
        }
    }

    /// Hands over a message; counts it as lost when there is no room. Never waits.
    pub fn record(&self, topic: &TopicInfo, log_time: i64, cdr: &[u8]) {
        let Some(index) = topics::ALL.iter().position(|known| known.name == topic.name) else {
            return;
        };
        let Some(sequence) = self.sequences.get(index) else {
            return;
        };
        // Counted whether there is room or not: a reader finds what is missing by its number.
        let sequence = sequence.fetch_add(1, Ordering::Relaxed);
        let room = self.queued.load(Ordering::Relaxed) + cdr.len() <= QUEUE_BYTES;
        let sent = room
            && self.queue.as_ref().is_some_and(|queue| {
                self.queued.fetch_add(cdr.len(), Ordering::Relaxed);
                let sent = queue.try_send(Item {
                    topic: index,
                    sequence,
                    log_time: u64::try_from(log_time).unwrap_or(0),
                    cdr: cdr.to_vec(),
                });
                if sent.is_err() {
                    self.queued.fetch_sub(cdr.len(), Ordering::Relaxed);
                }
                sent.is_ok()
            });
        self.health.offer(sent);
    }

    /// How it is doing.
    pub fn health(&self) -> &RecordingHealth {
        &self.health
    }

    /// Writes what is left, the index and the metadata. Gives up after 10 s.
    ///
    /// # Errors
    /// When something could not be written; [`BagError::Hung`] when the disk does not answer.
    pub fn finish(self) -> Result<Recording, BagError> {
        self.finish_within(PATIENCE)
    }

    /// Like [`RecordingThread::finish`], with another bound.
    ///
    /// # Errors
    /// As [`RecordingThread::finish`].
    pub fn finish_within(mut self, bound: Duration) -> Result<Recording, BagError> {
        drop(self.queue.take());
        let Some(thread) = self.thread.take() else {
            return Err(self.stopped());
        };
        let deadline = Instant::now() + bound;
        while !thread.is_finished() {
            if Instant::now() >= deadline {
                // The thread is left behind: nobody can end a call that waits for a disk.
                return Err(BagError::Hung {
                    path: self.health.path(),
                    seconds: bound.as_secs(),
                    messages: self.health.waiting(),
                });
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        thread.join().unwrap_or_else(|_| Err(self.stopped()))
    }

    fn stopped(&self) -> BagError {
        BagError::Stopped {
            path: self.health.path(),
        }
    }
}

fn write(mut recorder: LiveRecorder, items: &Receiver<Item>, queued: &AtomicUsize) -> Result<Recording, BagError> {
    let mut ticked = Instant::now();
    loop {
        match items.recv_timeout(TICK) {
            Ok(item) => {
                queued.fetch_sub(item.cdr.len(), Ordering::Relaxed);
                recorder.record(item);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return recorder.finish(),
        }
        if ticked.elapsed() >= TICK {
            recorder.tick();
            ticked = Instant::now();
        }
    }
}
