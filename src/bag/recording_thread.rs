//! The recorder's thread behind a bounded queue: a slow disk loses messages of the recording, never time of the node.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use super::{BagError, Recorder, Recording, Topic};
use crate::messages::topics::{self, TopicInfo};

/// Messages that may wait for the disk: at 300 per second, over 20 s.
const QUEUE: usize = 8192;
/// Silence after which what was recorded is brought to the disk.
const IDLE: Duration = Duration::from_millis(500);

struct Item {
    topic: usize,
    log_time: i64,
    cdr: Vec<u8>,
}

/// How the recording is doing.
#[derive(Debug, Default)]
pub struct RecordingHealth {
    messages: AtomicU64,
    drops: AtomicU64,
    failed: AtomicBool,
    error: Mutex<Option<String>>,
}

impl RecordingHealth {
    /// Messages written.
    pub fn messages(&self) -> u64 {
        self.messages.load(Ordering::Relaxed)
    }

    /// Messages lost because the queue was full or writing failed.
    pub fn drops(&self) -> u64 {
        self.drops.load(Ordering::Relaxed)
    }

    /// Whether writing failed; nothing more is recorded then.
    pub fn failed(&self) -> bool {
        self.failed.load(Ordering::Acquire)
    }

    /// Why writing failed, for a person.
    pub fn error(&self) -> Option<String> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A recording under way.
pub struct RecordingThread {
    queue: Option<SyncSender<Item>>,
    thread: Option<JoinHandle<Result<Recording, BagError>>>,
    health: Arc<RecordingHealth>,
    path: PathBuf,
}

impl RecordingThread {
    /// Begins to record all topics of the node; `name` makes a topic's name absolute.
    ///
    /// # Errors
    /// When the file cannot be made.
    pub fn start(path: &Path, name: impl Fn(&TopicInfo) -> String) -> Result<Self, BagError> {
        let recorded: Vec<Topic> = topics::ALL
            .iter()
            .map(|topic| Topic::new(name(topic), &topic.kind, topic.qos))
            .collect();
        let recorder = Recorder::create(path, &recorded)?;
        let path = recorder.path().to_owned();
        let (queue, items) = sync_channel(QUEUE);
        let health = Arc::new(RecordingHealth::default());
        let shared = Arc::clone(&health);
        let thread = std::thread::Builder::new()
            .name("recorder".into())
            .spawn(move || write(recorder, &items, &shared))
            .map_err(|source| BagError::Io {
                action: "start the recorder of",
                path: path.clone(),
                source,
            })?;
        Ok(Self {
            queue: Some(queue),
            thread: Some(thread),
            health,
            path,
        })
    }

    /// Hands over a message; counts it as lost when there is no room.
    pub fn record(&self, topic: &TopicInfo, log_time: i64, cdr: &[u8]) {
        let Some(index) = topics::ALL.iter().position(|known| known.name == topic.name) else {
            return;
        };
        let item = Item {
            topic: index,
            log_time,
            cdr: cdr.to_vec(),
        };
        let sent = self.queue.as_ref().is_some_and(|queue| queue.try_send(item).is_ok());
        if !sent {
            self.health.drops.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// How it is doing.
    pub fn health(&self) -> &RecordingHealth {
        &self.health
    }

    /// The MCAP file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is left, the index and the metadata.
    ///
    /// # Errors
    /// When writing failed, now or before.
    pub fn finish(mut self) -> Result<Recording, BagError> {
        drop(self.queue.take());
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            _ => Err(BagError::Stopped {
                path: self.path.clone(),
            }),
        }
    }
}

fn write(mut recorder: Recorder, items: &Receiver<Item>, health: &RecordingHealth) -> Result<Recording, BagError> {
    let mut first_error = None;
    loop {
        let result = match items.recv_timeout(IDLE) {
            Ok(item) => {
                let recorded = recorder.record(item.topic, item.log_time, &item.cdr);
                let counter = if recorded.is_ok() {
                    &health.messages
                } else {
                    &health.drops
                };
                counter.fetch_add(1, Ordering::Relaxed);
                recorded
            }
            Err(RecvTimeoutError::Timeout) if first_error.is_none() => recorder.flush(),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => break,
        };
        if let Err(error) = result
            && first_error.is_none()
        {
            tracing::error!("the recording stopped: {error}; the twin goes on without it");
            *health.error.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
            health.failed.store(true, Ordering::Release);
            first_error = Some(error);
        }
    }
    match first_error {
        Some(error) => Err(error),
        None => recorder.finish(),
    }
}
