//! What came from the network, until the part of the node that it is for has time.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::{Notify, oneshot};

use crate::dds::frames::Peer;
use crate::dds::plan::Guid;

/// A sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Sample {
    /// As received.
    Body {
        /// Who wrote it.
        writer: Guid,
        /// CDR without its header.
        body: Vec<u8>,
    },
    /// No sample of the topic's encoding.
    Unreadable(String),
}

/// Where the reply to a request goes.
#[derive(Debug)]
pub(super) enum Way {
    /// Through the DDS process of this life.
    Dds { life: u64, ticket: u64 },
    /// To a part of this process.
    Here(oneshot::Sender<Vec<u8>>),
}

/// A request to a service.
#[derive(Debug)]
pub struct Request {
    pub(super) way: Way,
    /// Who asks.
    pub client: Peer,
    /// CDR without its header.
    pub body: Vec<u8>,
    /// Counts it for as long as it has no answer.
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
    /// Asked for over DDS; counted in `open` until it is answered or given up.
    pub(super) fn of_a_client(way: Way, client: Peer, body: Vec<u8>, open: &Arc<AtomicU64>) -> Self {
        open.fetch_add(1, Ordering::AcqRel);
        Self {
            way,
            client,
            body,
            _open: Some(OpenRequest(Arc::clone(open))),
        }
    }

    /// Asked for within this process, by `client`, with a CDR body; the body of the reply comes to the receiver, which hears
    /// nothing where the service does not answer.
    pub fn of_this_process(client: Peer, body: Vec<u8>) -> (Self, oneshot::Receiver<Vec<u8>>) {
        let (sender, receiver) = oneshot::channel();
        let way = Way::Here(sender);
        let request = Self {
            way,
            client,
            body,
            _open: None,
        };
        (request, receiver)
    }

    /// Whether it came over DDS, where clients speak in two forms.
    pub fn is_from_dds(&self) -> bool {
        matches!(self.way, Way::Dds { .. })
    }
}

/// A bounded queue. When it is full the oldest goes: of an input only the newest counts, and a client whose request is
/// that old has given up.
pub struct Inbox<T> {
    queue: Mutex<VecDeque<T>>,
    most: usize,
    given_up: AtomicU64,
    came: Notify,
}

impl<T> Inbox<T> {
    pub(super) fn new(most: usize) -> Self {
        Self {
            queue: Mutex::default(),
            most,
            given_up: AtomicU64::new(0),
            came: Notify::new(),
        }
    }

    /// Adds one; where there is no room, the oldest goes.
    pub(crate) fn put(&self, item: T) {
        {
            let mut queue = self.lock();
            if queue.len() == self.most {
                queue.pop_front();
                self.given_up.fetch_add(1, Ordering::Relaxed);
            }
            queue.push_back(item);
        }
        self.came.notify_one();
    }

    /// How many went unseen so far, since they came faster than they were taken.
    pub fn given_up(&self) -> u64 {
        self.given_up.load(Ordering::Relaxed)
    }

    /// The oldest one, if there is any.
    pub fn take(&self) -> Option<T> {
        self.lock().pop_front()
    }

    /// Waits for the next one.
    pub async fn next(&self) -> T {
        loop {
            if let Some(item) = self.take() {
                return item;
            }
            // One that came since is remembered by the notification.
            self.came.notified().await;
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
    fn the_newest_stay_in_order() {
        let inbox = Inbox::new(3);
        for item in 0..5 {
            inbox.put(item);
        }
        let left: Vec<i32> = std::iter::from_fn(|| inbox.take()).collect();
        assert_eq!(left, [2, 3, 4]);
        assert_eq!(inbox.given_up(), 2);
    }

    #[tokio::test]
    async fn what_is_there_is_not_waited_for() {
        let inbox = Inbox::new(3);
        inbox.put(1);
        inbox.put(2);
        assert_eq!((inbox.next().await, inbox.next().await), (1, 2));
    }
}
