//! Recognises repeated requests, across restarts of the DDS process and of the node.
//!
//! A client's DDS keeps a request until all readers have acknowledged it, which a reader that died never does. A new reader
//! therefore receives old requests: those that this node has accepted, and those that were sent to an earlier node.
//! Accepted requests are known by writer and number. Requests to an earlier node are older than this node: the age of a
//! request is the time since its client sent it, by this machine's clock, and the age of the node is measured by the
//! monotonic clock, so that a change of the clock does not matter. The requests of a client on another machine whose clock is
//! slow look old; they are refused for half a minute after the start at most, when all requests to an earlier node have
//! arrived.
//!
//! A request of several datagrams arrives without its time: RustDDS keeps the time of the last datagram, and Cyclone DDS
//! sends it with the first. Such a request is new where its program has sent others to this node, or half a minute after
//! the start, when all requests to an earlier node have arrived.

use std::collections::BTreeMap;

use crate::dds::plan::Guid;

/// Bytes of an id that identify the program; the others identify a writer in it.
const PREFIX: usize = 12;
/// Most writers of requests that are remembered.
const MOST_CLIENTS: usize = 4096;
/// Time after the start (ns) in which requests to an earlier node arrive: three announcements of a participant, which are
/// 10 s apart at most.
const SETTLED: u64 = 30_000_000_000;
/// Numbers below a writer's highest for which acceptance is known one by one.
const WINDOW: i64 = 64;

/// The verdict on a request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// It must be carried out.
    New,
    /// It was accepted before.
    Repeated,
    /// It was sent before this node was started, by this time (s), and comes soon after the start.
    Older(f64),
    /// It does not state when it was sent and comes soon after the start, so that it may be for an earlier node.
    WithoutTime,
    /// Its writer was forgotten, so that it may have been accepted before.
    Forgotten,
}

/// One request as it arrives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrival {
    /// The client's writer.
    pub client: Guid,
    /// Number of the request among the writer's.
    pub sequence: i64,
    /// When it was sent, by the client's clock (ns since 1970).
    pub sent: Option<i64>,
    /// This machine's clock (ns since 1970).
    pub now: i64,
    /// Time since the node was started (ns).
    pub up: u64,
}

/// The accepted requests of one writer.
struct Client {
    highest: i64,
    /// Bit k: number `highest - 1 - k` was accepted.
    below: u64,
    /// When its newest request was sent.
    newest: i64,
    /// Count of all requests when its last one came.
    last: u64,
    /// Whether one of its accepted requests stated when it was sent.
    timed: bool,
}

/// The requests that were accepted.
#[derive(Default)]
pub(super) struct SeenRequests {
    clients: BTreeMap<Guid, Client>,
    /// Number of requests so far.
    count: u64,
    /// When the newest request of all forgotten writers was sent.
    forgotten: Option<i64>,
}

impl SeenRequests {
    /// Judges a request, and notes a new one.
    pub(super) fn judge(&mut self, arrival: &Arrival) -> Verdict {
        let &Arrival {
            client,
            sequence,
            sent,
            now,
            up,
        } = arrival;
        // The library loses the time of a request that came in fragments.
        let Some(sent) = sent else {
            return self.judge_without_time(arrival);
        };
        let older = i128::from(now) - i128::from(sent) - i128::from(up);
        // A refused request is noted, too, so that it is refused when it comes again.
        match self.note(client, sequence, sent) {
            Verdict::New if older > 0 && up < SETTLED => Verdict::Older(older as f64 * 1e-9),
            verdict => verdict,
        }
    }

    /// Judges a request by its number, and notes it.
    fn note(&mut self, client: Guid, sequence: i64, sent: i64) -> Verdict {
        self.count += 1;
        if let Some(known) = self.clients.get_mut(&client) {
            known.last = self.count;
            return known.judge(sequence, sent);
        }
        if self.forgotten.is_some_and(|forgotten| sent <= forgotten) {
            return Verdict::Forgotten;
        }
        if self.clients.len() == MOST_CLIENTS {
            self.forget_one();
        }
        self.clients.insert(client, Client::new(sequence, sent, self.count));
        Verdict::New
    }

    /// Judges a request that does not state when it was sent.
    fn judge_without_time(&mut self, arrival: &Arrival) -> Verdict {
        self.count += 1;
        if let Some(known) = self.clients.get_mut(&arrival.client) {
            known.last = self.count;
            return known.judge(arrival.sequence, known.newest);
        }
        let is_known = self.is_known(&arrival.client);
        if self.clients.len() == MOST_CLIENTS {
            self.forget_one();
        }
        // A refused request is noted, too, so that it is refused when it comes again.
        let client = Client {
            timed: false,
            ..Client::new(arrival.sequence, arrival.now, self.count)
        };
        self.clients.insert(arrival.client, client);
        if is_known || arrival.up >= SETTLED {
            Verdict::New
        } else {
            Verdict::WithoutTime
        }
    }

    /// Whether the program of a writer has sent a request to this node that states when it was sent.
    fn is_known(&self, client: &Guid) -> bool {
        let (mut first, mut last) = (*client, *client);
        first[PREFIX..].fill(0);
        last[PREFIX..].fill(u8::MAX);
        self.clients.range(first..=last).any(|(_, client)| client.timed)
    }

    /// Forgets the writer whose last request is the oldest.
    fn forget_one(&mut self) {
        let longest = self.clients.iter().min_by_key(|(_, client)| client.last);
        if let Some(guid) = longest.map(|(guid, _)| *guid)
            && let Some(client) = self.clients.remove(&guid)
        {
            self.forgotten = self.forgotten.max(Some(client.newest));
        }
    }
}

impl Client {
    fn new(sequence: i64, sent: i64, last: u64) -> Self {
        Self {
            highest: sequence,
            below: 0,
            newest: sent,
            last,
            timed: true,
        }
    }

    fn judge(&mut self, sequence: i64, sent: i64) -> Verdict {
        let ahead = sequence.saturating_sub(self.highest);
        if ahead > 0 {
            // The former highest number becomes the lowest bit.
            let with_highest = (self.below << 1) | 1;
            self.below = u32::try_from(ahead - 1)
                .ok()
                .and_then(|by| with_highest.checked_shl(by))
                .unwrap_or(0);
            self.highest = sequence;
        } else if sent > self.newest {
            // A restarted client with the same id counts from the beginning.
            *self = Self::new(sequence, sent, self.last);
        } else if ahead == 0 || ahead < -WINDOW {
            return Verdict::Repeated;
        } else {
            let bit = 1 << (-ahead - 1);
            if self.below & bit != 0 {
                return Verdict::Repeated;
            }
            self.below |= bit;
        }
        self.newest = self.newest.max(sent);
        Verdict::New
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: i64 = 1_000_000_000;
    /// The node was started at second 1000.
    const START: i64 = 1000 * SECOND;

    fn at(client: u8, sequence: i64, sent: i64, now: i64) -> Arrival {
        Arrival {
            client: [client; 16],
            sequence,
            sent: Some(sent),
            now,
            up: (now - START) as u64,
        }
    }

    #[test]
    fn a_request_is_accepted_once() {
        let mut seen = SeenRequests::default();
        let request = |sequence: i64, now: i64| at(7, sequence, START + sequence * SECOND, START + now * SECOND);
        for sequence in [1, 2, 5] {
            assert_eq!(seen.judge(&request(sequence, 10)), Verdict::New);
        }
        // A new reader is sent all of them again, with two that were lost in between.
        let again: Vec<Verdict> = (1..=6).map(|sequence| seen.judge(&request(sequence, 20))).collect();
        use Verdict::{New, Repeated};
        assert_eq!(again, [Repeated, Repeated, New, New, Repeated, New]);
        let third: Vec<Verdict> = (1..=6).map(|sequence| seen.judge(&request(sequence, 30))).collect();
        assert_eq!(third, [Repeated; 6]);
        // Far ahead, nothing of before is taken again.
        assert_eq!(seen.judge(&at(7, 500, START + 40 * SECOND, START + 40 * SECOND)), New);
        for sequence in 1..=6 {
            assert_eq!(seen.judge(&request(sequence, 50)), Repeated, "{sequence}");
        }
        // Another writer has numbers of its own.
        assert_eq!(seen.judge(&at(8, 1, START + SECOND, START + 50 * SECOND)), New);
    }

    #[test]
    fn requests_to_a_node_before_are_not_taken() {
        let mut seen = SeenRequests::default();
        let Verdict::Older(by) = seen.judge(&at(7, 1, START - 3 * SECOND, START + SECOND)) else {
            panic!("it was taken");
        };
        assert!((by - 3.0).abs() < 1e-9, "{by}");
        assert_eq!(seen.judge(&at(7, 2, START + 1, START + SECOND)), Verdict::New);
        // What was refused for its age is not taken by its number later either.
        let again = seen.judge(&at(7, 1, START - 3 * SECOND, START + 9 * SECOND));
        assert_eq!(again, Verdict::Repeated);
        let later = seen.judge(&at(7, 1, START - 3 * SECOND, START + 90 * SECOND));
        assert_eq!(later, Verdict::Repeated);
    }

    /// A machine without a radio clock is slow by five minutes: its clients are served half a minute after the start.
    #[test]
    fn a_client_with_a_slow_clock_is_refused_for_half_a_minute_at_most() {
        let mut seen = SeenRequests::default();
        let slow = |sequence: i64, after: i64| at(7, sequence, START + (after - 300) * SECOND, START + after * SECOND);
        for (sequence, after) in [(1, 2), (2, 29)] {
            assert!(
                matches!(seen.judge(&slow(sequence, after)), Verdict::Older(_)),
                "{after} s"
            );
        }
        assert_eq!(seen.judge(&slow(3, 30)), Verdict::New);
        assert_eq!(seen.judge(&slow(2, 29)), Verdict::Repeated);
        assert_eq!(seen.judge(&slow(3, 30)), Verdict::Repeated);
    }

    #[test]
    fn a_request_without_its_time_is_judged_by_its_number_and_the_time_since_the_start() {
        let mut seen = SeenRequests::default();
        let no_time = |client: u8, sequence: i64, after: i64| Arrival {
            sent: None,
            ..at(client, sequence, 0, START + after * SECOND)
        };
        // Its writer has sent a request to this node: what follows is to this node too.
        assert_eq!(seen.judge(&at(7, 2, START + 1, START + SECOND)), Verdict::New);
        assert_eq!(seen.judge(&no_time(7, 3, 2)), Verdict::New);
        assert_eq!(seen.judge(&no_time(7, 3, 3)), Verdict::Repeated);
        // Of an unknown writer it may be to a node before, soon after the start; it is not taken later either.
        assert_eq!(seen.judge(&no_time(8, 1, 5)), Verdict::WithoutTime);
        assert_eq!(seen.judge(&no_time(8, 1, 50)), Verdict::Repeated);
        assert_eq!(seen.judge(&no_time(8, 2, 51)), Verdict::New);
        assert_eq!(seen.judge(&no_time(9, 1, 52)), Verdict::New);
        // Another writer of a program that talks to this node.
        let mut other = no_time(7, 1, 6);
        other.client[PREFIX] = 0;
        assert_eq!(seen.judge(&other), Verdict::New);
        assert_eq!(seen.judge(&other), Verdict::Repeated);
    }

    /// Ages are by the monotonic clock: an hour that the system's clock is set by refuses nobody, and brings nothing back.
    #[test]
    fn a_clock_that_is_set_does_not_matter() {
        let up = (60 * SECOND) as u64;
        for set_by in [-3600 * SECOND, 3600 * SECOND] {
            let mut seen = SeenRequests::default();
            let now = START + 60 * SECOND + set_by;
            let fresh = Arrival {
                up,
                ..at(7, 1, now - SECOND / 100, now)
            };
            assert_eq!(seen.judge(&fresh), Verdict::New);
            assert_eq!(seen.judge(&fresh), Verdict::Repeated);
        }
    }

    #[test]
    fn a_client_that_comes_again_with_its_id_is_heard() {
        let mut seen = SeenRequests::default();
        let now = START + 100 * SECOND;
        for sequence in 1..=9 {
            assert_eq!(seen.judge(&at(7, sequence, START + sequence, now)), Verdict::New);
        }
        assert_eq!(seen.judge(&at(7, 1, START + 50, now)), Verdict::New);
        assert_eq!(seen.judge(&at(7, 2, START + 60, now)), Verdict::New);
        assert_eq!(seen.judge(&at(7, 1, START + 50, now)), Verdict::Repeated);
    }

    #[test]
    fn memory_is_bounded_and_what_was_forgotten_is_not_taken_again() {
        let mut seen = SeenRequests::default();
        let now = START + 1_000_000;
        let from = |number: usize, sent: i64| {
            let mut arrival = at(0, 1, sent, now);
            arrival.client[..8].copy_from_slice(&number.to_le_bytes());
            arrival
        };
        for number in 0..2 * MOST_CLIENTS {
            assert_eq!(seen.judge(&from(number, START + number as i64)), Verdict::New);
        }
        assert_eq!(seen.clients.len(), MOST_CLIENTS);
        assert_eq!(seen.judge(&from(3, START + 3)), Verdict::Forgotten);
        assert_eq!(seen.judge(&from(MOST_CLIENTS + 3, START + 3)), Verdict::Repeated);
        assert_eq!(seen.judge(&from(usize::MAX, now)), Verdict::New);
    }
}
