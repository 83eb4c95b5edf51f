//! The queue of one viewer, bounded in number, bytes and age, so that a slow viewer costs little memory and sees recent
//! data. A slow viewer loses its oldest messages, and each loss is counted.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::body::Bytes;
use foxglove::ws_protocol::BinaryMessage as _;
use foxglove::ws_protocol::server::{MessageData, Time};
use tokio::sync::Notify;
use tokio_tungstenite::tungstenite::Message;

use flexdrill_text::log_ending;

/// Largest number of queued data messages: about a second of all topics of the default tool.
pub(crate) const MOST_DATA: usize = 256;
/// Largest size of the queued data (bytes). Viewers share the bytes of a message; one message always fits.
const MOST_DATA_BYTES: usize = 8 << 20;
/// Largest number of queued answers and notices. None of them may be dropped, so the server disconnects a viewer that
/// exceeds it.
const MOST_ANSWERS: usize = 256;
/// Largest size of the queued answers (bytes): several times the definitions of all topics and services.
const MOST_ANSWER_BYTES: usize = 4 << 20;
/// Longest time in the queue for a message that a newer one of its topic follows. Together with the socket's buffer
/// this bounds the lag of a viewer on a slow line.
const MOST_AGE: Duration = Duration::from_secs(1);

/// A queued message of a topic.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    /// Index of the topic in the hub.
    pub topic: usize,
    /// Whether the topic is latched: its newest state must reach the viewer at any age.
    pub is_latched: bool,
    /// The viewer's own number of its subscription.
    pub subscription: u32,
    /// ns since 1970.
    pub log_time: u64,
    /// CDR with its header, shared by all viewers.
    pub cdr: Bytes,
}

#[derive(Debug)]
enum Queued {
    Data {
        data: Data,
        since: Instant,
    },
    /// The time of the recording that is played (ns since 1970); a newer one replaces it.
    Time(u64),
    Answer(Message),
}

#[derive(Debug, Default)]
struct Queue {
    waiting: VecDeque<Queued>,
    data: usize,
    data_bytes: usize,
    answers: usize,
    answer_bytes: usize,
    dropped: u64,
    /// The queue accepts nothing more.
    is_closed: bool,
}

impl Queue {
    /// Whether a newer message of the same topic follows the one at `index`.
    fn is_superseded(&self, index: usize) -> bool {
        let Some(Queued::Data {
            data: Data { topic, .. },
            ..
        }) = self.waiting.get(index)
        else {
            return false;
        };
        let mut behind = self.waiting.iter().skip(index + 1);
        behind.any(|other| matches!(other, Queued::Data { data, .. } if data.topic == *topic))
    }

    /// The message to drop when the queue is full: the oldest one that a newer one of its topic supersedes, then the
    /// oldest one, and messages of latched topics last.
    fn least_needed(&self) -> Option<usize> {
        let oldest = |wanted: &dyn Fn(usize, &Data) -> bool| {
            let mut all = self.waiting.iter().enumerate();
            all.find_map(|(index, waiting)| match waiting {
                Queued::Data { data, .. } if wanted(index, data) => Some(index),
                _ => None,
            })
        };
        oldest(&|index, data| !data.is_latched && self.is_superseded(index))
            .or_else(|| oldest(&|_, data| !data.is_latched))
            .or_else(|| oldest(&|_, _| true))
    }

    fn remove(&mut self, index: usize) -> Option<Queued> {
        let removed = self.waiting.remove(index)?;
        match &removed {
            Queued::Data { data, .. } => {
                self.data -= 1;
                self.data_bytes -= data.cdr.len();
            }
            Queued::Answer(message) => {
                self.answers -= 1;
                self.answer_bytes -= message.len();
            }
            Queued::Time(_) => {}
        }
        Some(removed)
    }

    /// Adds a message. Returns how many messages were dropped for it.
    fn push_data(&mut self, data: Data, now: Instant) -> u64 {
        let mut dropped = 0;
        while self.data >= MOST_DATA || (self.data > 0 && self.data_bytes + data.cdr.len() > MOST_DATA_BYTES) {
            if self.least_needed().and_then(|index| self.remove(index)).is_none() {
                break;
            }
            dropped += 1;
        }
        self.data += 1;
        self.data_bytes += data.cdr.len();
        self.waiting.push_back(Queued::Data { data, since: now });
        self.dropped += dropped;
        dropped
    }

    /// Adds an answer. Returns whether there was room.
    fn push_answer(&mut self, message: Message) -> bool {
        if self.answers >= MOST_ANSWERS || self.answer_bytes + message.len() > MOST_ANSWER_BYTES {
            return false;
        }
        self.answers += 1;
        self.answer_bytes += message.len();
        self.waiting.push_back(Queued::Answer(message));
        true
    }

    /// Removes the next message. Returns it with the number of messages dropped because of their age.
    fn pop(&mut self, now: Instant) -> (Option<Message>, u64) {
        let mut dropped = 0;
        let next = loop {
            let is_old = match self.waiting.front() {
                Some(Queued::Data { data, since }) => {
                    !data.is_latched && now.saturating_duration_since(*since) > MOST_AGE && self.is_superseded(0)
                }
                _ => false,
            };
            match self.remove(0) {
                Some(_) if is_old => dropped += 1,
                None => break None,
                Some(Queued::Data { data, .. }) => {
                    let Data {
                        subscription,
                        log_time,
                        cdr,
                        ..
                    } = &data;
                    break Some(Message::from(&MessageData::new(*subscription, *log_time, cdr.as_ref())));
                }
                Some(Queued::Time(time)) => break Some(Message::binary(Time::new(time).to_bytes())),
                Some(Queued::Answer(message)) => break Some(message),
            }
        };
        self.dropped += dropped;
        (next, dropped)
    }
}

/// The queue of one viewer, filled by the hub and by the viewer's own requests, emptied by its connection. Filling it
/// never waits.
pub(crate) struct Backlog {
    viewer: SocketAddr,
    queue: Mutex<Queue>,
    filled: Notify,
}

impl Backlog {
    /// The empty queue of the viewer at this address.
    pub fn new(viewer: SocketAddr) -> Self {
        Self {
            viewer,
            queue: Mutex::default(),
            filled: Notify::new(),
        }
    }

    /// Adds a message of a topic; the oldest ones are dropped when the queue is full.
    pub fn data(&self, data: Data) {
        let dropped = {
            let mut queue = self.lock();
            if queue.is_closed {
                return;
            }
            queue.push_data(data, Instant::now())
        };
        self.filled.notify_one();
        self.log_dropped(dropped);
    }

    /// Adds the time of the recording that is played (ns since 1970); it replaces an older one.
    pub fn time(&self, time: u64) {
        {
            let mut queue = self.lock();
            if queue.is_closed {
                return;
            }
            queue.waiting.retain(|waiting| !matches!(waiting, Queued::Time(_)));
            queue.waiting.push_back(Queued::Time(time));
        }
        self.filled.notify_one();
    }

    /// Adds an answer or a notice. A viewer that does not read its answers is disconnected.
    pub fn answer(&self, message: impl Into<Message>) {
        let is_full = {
            let mut queue = self.lock();
            if queue.is_closed {
                return;
            }
            queue.is_closed = !queue.push_answer(message.into());
            queue.is_closed
        };
        if is_full && let Some(more) = log_ending("answers not read") {
            tracing::warn!(
                "the viewer at {} does not read its answers: at most {MOST_ANSWERS} answers and {MOST_ANSWER_BYTES} bytes \
                 are queued; its connection is closed{more}",
                self.viewer
            );
        }
        self.filled.notify_one();
    }

    /// The next message, if there is one. `Err` ends the connection.
    pub fn try_next(&self) -> Result<Option<Message>, Closed> {
        let (next, dropped) = {
            let mut queue = self.lock();
            if queue.is_closed {
                return Err(Closed);
            }
            queue.pop(Instant::now())
        };
        self.log_dropped(dropped);
        Ok(next)
    }

    /// Waits until a message has been added.
    pub async fn filled(&self) {
        self.filled.notified().await;
    }

    fn log_dropped(&self, dropped: u64) {
        if dropped == 0 {
            return;
        }
        if let Some(more) = log_ending("slow viewer") {
            tracing::warn!(
                "the viewer at {} is too slow for what it subscribes to: {} of its oldest messages have been dropped so far; \
                 subscribe to fewer topics{more}",
                self.viewer,
                self.lock().dropped
            );
        }
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The connection to the viewer must be closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Closed;

impl Drop for Backlog {
    fn drop(&mut self) {
        let dropped = self.lock().dropped;
        if dropped > 0
            && let Some(more) = log_ending("slow viewer gone")
        {
            tracing::info!(
                "the viewer at {} has disconnected; {dropped} messages had been dropped for it{more}",
                self.viewer
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATUS: usize = 0;
    const WARNINGS: usize = 1;

    fn data(topic: usize, number: u64, bytes: usize) -> Data {
        Data {
            topic,
            is_latched: topic == WARNINGS,
            subscription: 7,
            log_time: number,
            cdr: vec![0; bytes].into(),
        }
    }

    fn log_time(message: &Message) -> u64 {
        let Message::Binary(bytes) = message else {
            panic!("{message:?}")
        };
        u64::from_le_bytes(bytes[5..13].try_into().unwrap())
    }

    fn answer() -> Message {
        Message::text("x")
    }

    /// A viewer that reads nothing loses its oldest data, never an answer or the newest state of a latched topic.
    #[test]
    fn a_slow_viewer_loses_its_oldest_messages() {
        let (mut queue, now) = (Queue::default(), Instant::now());
        assert_eq!(queue.push_data(data(WARNINGS, 0, 8), now), 0);
        assert!(queue.push_answer(answer()));
        let dropped: u64 = (1..=300)
            .map(|number| queue.push_data(data(STATUS, number, 8), now))
            .sum();
        assert_eq!((dropped, queue.dropped), (45, 45), "256 stay, one of them the warning");
        assert_eq!(log_time(&queue.pop(now).0.unwrap()), 0, "the latched state");
        assert_eq!(queue.pop(now).0.unwrap(), answer());
        assert_eq!(log_time(&queue.pop(now).0.unwrap()), 46);
        for _ in 0..MOST_ANSWERS {
            assert!(queue.push_answer(answer()));
        }
        assert!(!queue.push_answer(answer()), "disconnected");
    }

    #[test]
    fn bytes_are_bounded_and_one_message_always_fits() {
        let (mut queue, now) = (Queue::default(), Instant::now());
        for number in 0..10 {
            queue.push_data(data(STATUS, number, MOST_DATA_BYTES / 4), now);
            assert!(queue.data_bytes <= MOST_DATA_BYTES);
        }
        assert_eq!(queue.data, 4);
        assert_eq!(queue.push_data(data(STATUS, 10, 2 * MOST_DATA_BYTES), now), 4);
        assert_eq!(queue.data, 1);
        assert!(!queue.push_answer(Message::text("x".repeat(MOST_ANSWER_BYTES + 1))));
    }

    /// On a slow line the lag is bounded by age, and yet each topic's newest message gets out.
    #[test]
    fn old_messages_go_when_a_newer_one_of_their_topic_waits() {
        let (mut queue, start) = (Queue::default(), Instant::now());
        for number in 0..20 {
            queue.push_data(data(STATUS, number, 8), start);
        }
        queue.push_data(data(WARNINGS, 100, 8), start);
        queue.push_data(data(WARNINGS, 101, 8), start);
        queue.push_data(data(2, 200, 8), start);
        let later = start + MOST_AGE + Duration::from_millis(1);
        queue.push_data(data(STATUS, 20, 8), later);
        let mut sent = Vec::new();
        while let (Some(message), _) = queue.pop(later) {
            sent.push(log_time(&message));
        }
        assert_eq!(sent, [100, 101, 200, 20]);
        assert_eq!((queue.dropped, queue.data, queue.data_bytes), (20, 0, 0));
    }

    #[test]
    fn the_newest_time_replaces_the_others() {
        let backlog = Backlog::new(([127, 0, 0, 1], 1).into());
        for time in [1, 2, 3] {
            backlog.time(time);
        }
        let Ok(Some(Message::Binary(bytes))) = backlog.try_next() else {
            panic!()
        };
        assert_eq!((bytes[0], bytes[1]), (2, 3));
        assert_eq!(backlog.try_next(), Ok(None));
    }
}
