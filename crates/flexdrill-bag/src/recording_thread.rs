//! The recorder's thread behind a bounded queue: a slow disk costs messages of the recording, never time of the node.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::failover::{FailoverRecorder, Item};
use crate::recording_health::RecordingHealth;
use crate::storage::{Disk, Storage};
use crate::{BagError, Recording, Topic};
use flexdrill_messages::topics::{self, TopicInfo};

/// Largest number of messages in the queue: over 20 s at 300 per second.
const QUEUE: usize = 8192;
/// Largest size of the queue (bytes): 16 kB per message.
const QUEUE_BYTES: usize = 128 << 20;
/// Interval of the recorder's periodic work when no message arrives.
const TICK: Duration = Duration::from_millis(50);
/// Longest wait for the creation and for the end of a recording: a disk that does not respond must not block the node.
const PATIENCE: Duration = Duration::from_secs(10);

/// A recording under way.
pub struct RecordingThread {
    queue: Option<SyncSender<Item>>,
    thread: Option<JoinHandle<Result<Recording, BagError>>>,
    health: Arc<RecordingHealth>,
    /// Next sequence number of each topic of the node.
    sequences: [AtomicU32; topics::ALL.len()],
    queued: Arc<AtomicUsize>,
}

impl RecordingThread {
    /// Starts to record all topics of the node; `name` makes a topic's name absolute. Waits at most 10 s.
    ///
    /// # Errors
    /// When the file cannot be created; [`BagError::NotBegun`] when the disk does not respond.
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
        // All topics are declared at the start, so that every file of the recording has the same channels.
        let recorded: Vec<Topic> = topics::ALL
            .iter()
            .map(|topic| Topic::new(name(topic), &topic.kind, topic.qos))
            .collect();
        let health = Arc::new(RecordingHealth::default());
        // The queue is bounded and never waited for: when it is full,
        // messages are counted as lost and the node continues.
        let (queue, items) = sync_channel(QUEUE);
        let queued = Arc::new(AtomicUsize::new(0));
        let (waiting, shared, target) = (Arc::clone(&queued), Arc::clone(&health), path.to_owned());
        let (begun_sender, begun) = sync_channel(1);
        let work = move || {
            // The thread creates the file, because a dead disk can block that call for ever.
            let recorder = FailoverRecorder::start(storage, &target, recorded, shared);
            let (recorder, result) = match recorder {
                Ok(recorder) => (Some(recorder), Ok(())),
                Err(error) => (None, Err(error)),
            };
            // The receiver is gone when that took too long.
            let _ = begun_sender.send(result);
            match recorder {
                Some(recorder) => write(recorder, &items, &waiting),
                None => Err(BagError::Stopped { path: target }),
            }
        };
        // A thread that cannot start leaves nothing behind, and its error is the caller's.
        let thread = std::thread::Builder::new()
            .name("recorder".into())
            .spawn(work)
            .map_err(BagError::io("start the recorder of", path))?;
        // The wait is bounded for the same dead disk. The thread is then abandoned, as nothing can interrupt its call.
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

    /// Counts messages of a topic that never arrived here: they are lost, and their sequence numbers are skipped.
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

    /// Queues a message, or counts it as lost when the queue is full. Never waits.
    pub fn record(&self, topic: &TopicInfo, log_time: i64, cdr: &[u8]) {
        let Some(index) = topics::ALL.iter().position(|known| known.name == topic.name) else {
            return;
        };
        let Some(sequence) = self.sequences.get(index) else {
            return;
        };
        // A lost message also uses up a number, so that a reader finds the gap.
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

    /// The state of the recording.
    pub fn health(&self) -> &RecordingHealth {
        &self.health
    }

    /// Writes the queued messages, the index and the metadata. Waits at most 10 s.
    ///
    /// # Errors
    /// When any of these could not be written; [`BagError::Hung`] when the disk does not respond.
    pub fn finish(self) -> Result<Recording, BagError> {
        self.finish_within(PATIENCE)
    }

    /// Like [`RecordingThread::finish`], with another longest wait.
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
                // The thread is abandoned: a call that waits for a disk cannot be interrupted.
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

fn write(mut recorder: FailoverRecorder, items: &Receiver<Item>, queued: &AtomicUsize) -> Result<Recording, BagError> {
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
