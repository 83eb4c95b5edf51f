//! Queues of received samples and requests.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::{Notify, oneshot};

use crate::dds::frames::{Peer, RequestId};
use crate::dds::plan::Guid;

/// A sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Sample {
    /// As received.
    Body {
        /// Its writer.
        writer: Guid,
        /// CDR without its header.
        body: Vec<u8>,
    },
    /// Bytes that are not in the encoding of the topic, with the reason.
    Unreadable(String),
}

/// The recipient of a reply.
#[derive(Debug)]
pub(super) enum ReplyTo {
    /// A client on the network, through whichever DDS process there is then.
    Dds(RequestId),
    /// A part of this process.
    Local(oneshot::Sender<Vec<u8>>),
}

/// A request to a service.
#[derive(Debug)]
pub struct Request {
    pub(super) reply_to: ReplyTo,
    /// The client.
    pub client: Peer,
    /// CDR without its header.
    pub body: Vec<u8>,
    /// Why it must not be carried out, if it changes anything: it may be for an earlier node, or have been carried out.
    pub refused: Option<String>,
    /// Counts the request while it has no answer.
    _open: Option<OpenRequest>,
}

/// Counts a request that came over DDS until it is dropped.
#[derive(Debug)]
struct OpenRequest(Arc<AtomicU64>);

impl Drop for OpenRequest {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Request {
    /// A request that came over DDS; `open` counts it until it is answered or dropped.
    pub(super) fn of_a_client(
        id: RequestId,
        client: Peer,
        body: Vec<u8>,
        refused: Option<String>,
        open: &Arc<AtomicU64>,
    ) -> Self {
        open.fetch_add(1, Ordering::AcqRel);
        Self {
            reply_to: ReplyTo::Dds(id),
            client,
            body,
            refused,
            _open: Some(OpenRequest(Arc::clone(open))),
        }
    }

    /// A request with a CDR body from within this process. The receiver gets the body of the reply; it is closed where the
    /// service does not answer.
    pub fn of_this_process(client: Peer, body: Vec<u8>) -> (Self, oneshot::Receiver<Vec<u8>>) {
        let (sender, receiver) = oneshot::channel();
        let reply_to = ReplyTo::Local(sender);
        let request = Self {
            reply_to,
            client,
            body,
            refused: None,
            _open: None,
        };
        (request, receiver)
    }

    /// Whether it came over DDS, where clients use two forms of requests.
    pub fn is_from_dds(&self) -> bool {
        matches!(self.reply_to, ReplyTo::Dds(_))
    }
}

/// A bounded queue. When it is full it drops the oldest item: only the newest sample of an input counts, and the client of
/// such an old request has given up.
pub struct Inbox<T> {
    queue: Mutex<VecDeque<T>>,
    capacity: usize,
    dropped: AtomicU64,
    pushed: Notify,
}

impl<T> Inbox<T> {
    pub(super) fn new(capacity: usize) -> Self {
        Self {
            queue: Mutex::default(),
            capacity,
            dropped: AtomicU64::new(0),
            pushed: Notify::new(),
        }
    }

    /// Adds an item; a full queue drops its oldest.
    pub fn push(&self, item: T) {
        {
            let mut queue = self.lock();
            if queue.len() == self.capacity {
                queue.pop_front();
                self.dropped.fetch_add(1, Ordering::Relaxed);
            }
            queue.push_back(item);
        }
        self.pushed.notify_one();
    }

    /// Items dropped unread so far.
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    /// Removes the oldest item.
    pub fn pop(&self) -> Option<T> {
        self.lock().pop_front()
    }

    /// Waits for the next item.
    pub async fn next(&self) -> T {
        loop {
            if let Some(item) = self.pop() {
                return item;
            }
            // The notification remembers an item that came since.
            self.pushed.notified().await;
        }
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<T>> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_keeps_the_newest_in_order() {
        let inbox = Inbox::new(3);
        for item in 0..5 {
            inbox.push(item);
        }
        let left: Vec<i32> = std::iter::from_fn(|| inbox.pop()).collect();
        assert_eq!(left, [2, 3, 4]);
        assert_eq!(inbox.dropped(), 2);
    }

    #[tokio::test]
    async fn queued_items_come_without_waiting() {
        let inbox = Inbox::new(3);
        inbox.push(1);
        inbox.push(2);
        assert_eq!((inbox.next().await, inbox.next().await), (1, 2));
    }
}
