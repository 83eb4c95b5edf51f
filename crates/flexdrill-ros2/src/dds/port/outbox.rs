//! The queue of outgoing messages until the DDS process reads them.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::TopicCounters;
use crate::dds::frames::ToSide;
use crate::dds::plan::Offer;

/// Most bytes in the queue: more than a second of all outputs of a tool with 200 stations.
const MOST_BYTES: usize = 8 << 20;

/// A bounded queue to the DDS process, and the newest state of every latched topic.
#[derive(Clone, Default)]
pub(super) struct Outbox(Arc<Inner>);

#[derive(Default)]
struct Inner {
    state: Mutex<State>,
    added: Condvar,
}

#[derive(Default)]
struct State {
    topics: Vec<(Offer, Arc<TopicCounters>)>,
    waiting: VecDeque<ToSide>,
    bytes: usize,
    /// Number of the process that reads the queue; none while there is no process.
    life: Option<u64>,
    latched: BTreeMap<u16, Vec<u8>>,
}

impl Outbox {
    pub(super) fn add(&self, offer: Offer, counters: Arc<TopicCounters>) {
        self.lock().topics.push((offer, counters));
    }

    pub(super) fn publish(&self, writer: u16, body: Vec<u8>) {
        let mut state = self.lock();
        let Some((offer, counters)) = state.topics.get(usize::from(writer)) else {
            return;
        };
        let (is_state, counters) = (offer.is_state(), Arc::clone(counters));
        if is_state {
            state.latched.insert(writer, body.clone());
        }
        if state.life.is_some() {
            state.push(ToSide::Publish { writer, body });
            self.0.added.notify_one();
        } else if !is_state {
            counters.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    pub(super) fn reply(&self, life: u64, reply: ToSide) {
        let mut state = self.lock();
        if state.life == Some(life) {
            state.push(reply);
            self.0.added.notify_one();
        }
    }

    /// Opens the queue for a process. The newest states are its first messages.
    pub(super) fn open(&self, life: u64) {
        let mut state = self.lock();
        state.life = Some(life);
        let latched: Vec<ToSide> = state
            .latched
            .iter()
            .map(|(writer, body)| ToSide::Publish {
                writer: *writer,
                body: body.clone(),
            })
            .collect();
        for frame in latched {
            state.push(frame);
        }
    }

    /// Closes the queue after the end of the process, and counts its messages as dropped.
    pub(super) fn close(&self) {
        let mut state = self.lock();
        state.life = None;
        while state.pop().is_some_and(|frame| state.count_dropped(&frame)) {}
    }

    /// All queued messages; waits for the first one, `longest` at most.
    pub(super) fn wait(&self, longest: Duration) -> Vec<ToSide> {
        let state = self.lock();
        let (mut state, _) = self
            .0
            .added
            .wait_timeout_while(state, longest, |state| state.waiting.is_empty())
            .unwrap_or_else(PoisonError::into_inner);
        state.bytes = 0;
        state.waiting.drain(..).collect()
    }

    /// Ends a wait.
    pub(super) fn wake(&self) {
        self.0.added.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn push(&mut self, frame: ToSide) {
        self.bytes += size(&frame);
        self.waiting.push_back(frame);
        while self.bytes > MOST_BYTES
            && let Some(oldest) = self.pop()
        {
            self.count_dropped(&oldest);
        }
    }

    fn pop(&mut self) -> Option<ToSide> {
        let frame = self.waiting.pop_front()?;
        self.bytes = self.bytes.saturating_sub(size(&frame));
        Some(frame)
    }

    fn count_dropped(&self, frame: &ToSide) -> bool {
        if let ToSide::Publish { writer, .. } = frame
            && let Some((_, counters)) = self.topics.get(usize::from(*writer))
        {
            counters.dropped.fetch_add(1, Ordering::Relaxed);
        }
        true
    }
}

fn size(frame: &ToSide) -> usize {
    match frame {
        ToSide::Publish { body, .. } | ToSide::Reply { body, .. } => body.len() + 16,
        ToSide::Begin(_) | ToSide::End => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STREAM: Offer = Offer {
        reliable: true,
        latched: false,
        depth: 10,
        rate: 50.0,
        lifespan: None,
    };
    const LATCHED: Offer = Offer {
        latched: true,
        depth: 1,
        ..STREAM
    };

    fn outbox() -> (Outbox, [Arc<TopicCounters>; 2]) {
        let outbox = Outbox::default();
        let counters: [Arc<TopicCounters>; 2] = std::array::from_fn(|_| Arc::default());
        outbox.add(STREAM, Arc::clone(&counters[0]));
        outbox.add(LATCHED, Arc::clone(&counters[1]));
        (outbox, counters)
    }

    fn bodies(frames: &[ToSide]) -> Vec<(u16, usize)> {
        frames
            .iter()
            .map(|frame| match frame {
                ToSide::Publish { writer, body } => (*writer, body.len()),
                other => panic!("{other:?}"),
            })
            .collect()
    }

    #[test]
    fn a_new_process_gets_the_newest_states_and_nothing_old() {
        let (outbox, [stream, latched]) = outbox();
        outbox.publish(0, vec![0; 3]);
        outbox.publish(1, vec![0; 4]);
        outbox.publish(1, vec![0; 5]);
        outbox.open(1);
        outbox.publish(0, vec![0; 6]);
        assert_eq!(bodies(&outbox.wait(Duration::ZERO)), [(1, 5), (0, 6)]);
        assert_eq!(stream.dropped.load(Ordering::Relaxed), 1);
        assert_eq!(latched.dropped.load(Ordering::Relaxed), 0);
        outbox.publish(0, vec![0; 7]);
        outbox.close();
        assert_eq!(stream.dropped.load(Ordering::Relaxed), 2);
        outbox.open(2);
        assert_eq!(bodies(&outbox.wait(Duration::ZERO)), [(1, 5)]);
    }

    #[test]
    fn memory_is_bounded_and_the_oldest_messages_are_dropped() {
        let (outbox, [stream, _]) = outbox();
        outbox.open(1);
        for _ in 0..20 {
            outbox.publish(0, vec![0; 1 << 20]);
        }
        let kept = outbox.wait(Duration::ZERO).len();
        assert_eq!(kept, 7);
        assert_eq!(stream.dropped.load(Ordering::Relaxed), 20 - 7);
    }

    #[test]
    fn a_reply_is_not_sent_to_another_process() {
        let (outbox, _) = outbox();
        outbox.open(2);
        let reply = || ToSide::Reply {
            service: 0,
            ticket: 7,
            body: vec![],
        };
        outbox.reply(1, reply());
        assert!(outbox.wait(Duration::ZERO).is_empty());
        outbox.reply(2, reply());
        assert_eq!(outbox.wait(Duration::ZERO).len(), 1);
    }
}
