//! The queue of outgoing messages until the DDS process reads them.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::TopicCounters;
use crate::dds::frames::{RequestId, ToSide};
use crate::dds::plan::Offer;

/// Most bytes in the queue: more than a second of all outputs of a tool with 200 stations.
const MOST_BYTES: usize = 8 << 20;
/// Most replies that are kept until their clients have them: as many as all services of the node take requests.
const MOST_REPLIES: usize = 1024;
/// Most bytes in them.
const MOST_REPLY_BYTES: usize = 4 << 20;
/// Longest time for which a client is assumed to wait for a reply.
const PATIENCE: Duration = Duration::from_secs(60);

/// A reply to a client on the network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reply {
    /// Number of the service in the plan.
    pub(super) service: u16,
    /// The request that it answers.
    pub(super) to: RequestId,
    /// CDR without its header.
    pub(super) body: Vec<u8>,
}

impl Reply {
    fn frame(&self) -> ToSide {
        ToSide::Reply {
            service: self.service,
            to: self.to,
            body: self.body.clone(),
        }
    }
}

/// A bounded queue to the DDS process, the newest state of every latched topic, and the replies that their clients do not
/// have yet.
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
    /// Replies until the process has reported that their clients have them.
    replies: VecDeque<(Instant, Reply)>,
    reply_bytes: usize,
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

    /// Sends a reply, and keeps it until its client has it.
    pub(super) fn reply(&self, reply: Reply) {
        let mut state = self.lock();
        if state.life.is_some() {
            state.push(reply.frame());
            self.0.added.notify_one();
        }
        state.keep(reply);
    }

    /// The client of a request has the reply.
    pub(super) fn replied(&self, service: u16, to: RequestId) {
        let mut state = self.lock();
        let is_that = |reply: &Reply| reply.service == service && reply.to == to;
        if let Some(at) = state.replies.iter().position(|(_, reply)| is_that(reply))
            && let Some((_, reply)) = state.replies.remove(at)
        {
            state.reply_bytes -= reply.body.len();
        }
    }

    /// Opens the queue for a process. The newest states are its first messages, then come the replies that did not reach
    /// their clients through the process before.
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
        let now = Instant::now();
        let waited_for = state
            .replies
            .iter()
            .filter(|(since, _)| now.duration_since(*since) < PATIENCE);
        let replies: Vec<ToSide> = waited_for.map(|(_, reply)| reply.frame()).collect();
        for frame in latched.into_iter().chain(replies) {
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

    fn keep(&mut self, reply: Reply) {
        self.reply_bytes += reply.body.len();
        self.replies.push_back((Instant::now(), reply));
        while (self.reply_bytes > MOST_REPLY_BYTES || self.replies.len() > MOST_REPLIES)
            && let Some((_, oldest)) = self.replies.pop_front()
        {
            self.reply_bytes -= oldest.body.len();
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

    const STREAM: Offer = Offer::usual(50.0);
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
    fn a_reply_is_sent_through_the_next_process_until_its_client_has_it() {
        let (outbox, _) = outbox();
        let reply = |number: i64| Reply {
            service: 0,
            to: RequestId {
                writer: [7; 16],
                number,
            },
            body: vec![number as u8; 10],
        };
        let sent = |frames: Vec<ToSide>| -> Vec<i64> {
            let number = |frame: &ToSide| match frame {
                ToSide::Reply { to, .. } => to.number,
                other => panic!("{other:?}"),
            };
            frames.iter().map(number).collect()
        };
        // There is no process yet.
        outbox.reply(reply(1));
        assert!(outbox.wait(Duration::ZERO).is_empty());
        outbox.open(1);
        outbox.reply(reply(2));
        outbox.reply(reply(3));
        assert_eq!(sent(outbox.wait(Duration::ZERO)), [1, 2, 3]);
        outbox.replied(0, reply(2).to);
        // Of the others the process may have lost either.
        outbox.close();
        outbox.open(2);
        assert_eq!(sent(outbox.wait(Duration::ZERO)), [1, 3]);
        for number in [1, 3] {
            outbox.replied(0, reply(number).to);
        }
        outbox.close();
        outbox.open(3);
        assert!(outbox.wait(Duration::ZERO).is_empty());
        assert_eq!(outbox.lock().reply_bytes, 0);
    }

    #[test]
    fn kept_replies_are_bounded() {
        let (outbox, _) = outbox();
        for number in 0..2 * MOST_REPLIES as i64 {
            outbox.reply(Reply {
                service: 0,
                to: RequestId {
                    writer: [7; 16],
                    number,
                },
                body: vec![0; 60_000],
            });
        }
        let state = outbox.lock();
        assert!(state.reply_bytes <= MOST_REPLY_BYTES, "{} bytes", state.reply_bytes);
        assert_eq!(state.reply_bytes, 60_000 * state.replies.len());
        assert_eq!(state.replies.back().unwrap().1.to.number, 2 * MOST_REPLIES as i64 - 1);
    }
}
