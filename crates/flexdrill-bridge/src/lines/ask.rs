//! Requests to recorders that send a frame only in answer to one ("send and receive", "active", polled).

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::time::Instant;

/// What is written to a recorder so that it sends, and when.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ask {
    /// The request as it is written.
    pub request: Arc<[u8]>,
    /// Time between two requests.
    pub every: Duration,
    /// The first request of a connection is written after so long without a frame; zero: at once, whatever comes.
    pub after: Duration,
    /// A connection that is never given up for its silence, such as a serial line, is asked again after so long.
    pub again: Duration,
}

/// Whether the other end has begun a frame. The reading half of a connection sets it, the writing half looks.
#[derive(Debug, Default)]
pub(super) struct Heard {
    any: AtomicBool,
    last_was_mark: AtomicBool,
}

impl Heard {
    /// Looks for `&&`, which pieces of the stream may divide. Other bytes, such as those by which a terminal server
    /// negotiates, do not show that a recorder sends by itself.
    pub(super) fn bytes(&self, bytes: &[u8]) {
        let Some((&first, &last)) = bytes.first().zip(bytes.last()) else {
            return;
        };
        let divided = first == b'&' && self.last_was_mark.load(Ordering::Relaxed);
        if divided || bytes.windows(2).any(|pair| pair == b"&&") {
            self.any.store(true, Ordering::Relaxed);
        }
        self.last_was_mark.store(last == b'&', Ordering::Relaxed);
    }

    fn any(&self) -> bool {
        self.any.load(Ordering::Relaxed)
    }
}

/// When a connection is asked next.
#[derive(Debug)]
pub(super) struct Asking {
    ask: Ask,
    /// The next instant to act; none once the other end needs no request.
    next: Option<Instant>,
    asked: bool,
}

impl Asking {
    pub(super) fn new(ask: Ask) -> Self {
        Self {
            next: Some(Instant::now() + ask.after),
            ask,
            asked: false,
        }
    }

    /// Becomes ready at the next instant to act, or never.
    pub(super) async fn due(&self) {
        match self.next {
            Some(next) => tokio::time::sleep_until(next).await,
            None => std::future::pending().await,
        }
    }

    /// What to write at the instant that was due, if anything; `true` with a first request after silence. `ends`: silence
    /// ends this connection, so that the next one asks again.
    pub(super) fn take(&mut self, heard: &Heard, ends: bool) -> Option<(Arc<[u8]>, bool)> {
        let now = Instant::now();
        let by_itself = !self.ask.after.is_zero();
        // A recorder that sends unasked is left alone.
        if by_itself && !self.asked && heard.any() {
            self.next = None;
            return None;
        }
        // A request without an answer is not repeated where a new connection repeats it.
        if by_itself && self.asked && !heard.any() {
            if ends {
                self.next = None;
                return None;
            }
            self.next = Some(now + self.ask.again);
            return Some((Arc::clone(&self.ask.request), false));
        }
        let is_first = by_itself && !self.asked;
        self.asked = true;
        // The first answer is waited for; a line that stays silent is asked less often.
        self.next = Some(now + self.ask.every);
        Some((Arc::clone(&self.ask.request), is_first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(after: u64) -> Ask {
        Ask {
            request: Arc::from(b"?".as_slice()),
            every: Duration::from_secs(30),
            after: Duration::from_secs(after),
            again: Duration::from_secs(60),
        }
    }

    #[test]
    fn a_frame_begins_with_two_marks_that_pieces_may_divide() {
        for (pieces, expected) in [
            (vec![b"\xff\xfd\x01".as_slice()], false),
            (vec![b"x&", b"&\r\n"], true),
            (vec![b"&", b"", b"&"], true),
            (vec![b"&", b"x", b"&"], false),
            (vec![b"noise &&"], true),
        ] {
            let heard = Heard::default();
            for piece in &pieces {
                heard.bytes(piece);
            }
            assert_eq!(heard.any(), expected, "{pieces:?}");
        }
    }

    #[test]
    fn silence_is_asked_once_and_on_if_that_helped() {
        let (mut asking, heard) = (Asking::new(ask(10)), Heard::default());
        assert!(matches!(asking.take(&heard, true), Some((_, true))));
        // No answer: the connection ends by its silence.
        assert!(asking.take(&heard, true).is_none() && asking.next.is_none());
        // A serial line stays and is asked again.
        let mut asking = Asking::new(ask(10));
        assert!(matches!(asking.take(&heard, false), Some((_, true))));
        assert!(matches!(asking.take(&heard, false), Some((_, false))));
        heard.bytes(b"&&");
        assert!(matches!(asking.take(&heard, false), Some((_, false))));
        assert!(asking.next.is_some());
        // Who sends unasked is not asked.
        let mut asking = Asking::new(ask(10));
        assert!(asking.take(&heard, true).is_none() && asking.next.is_none());
        // A mapping that asks does so whatever comes.
        let mut asking = Asking::new(ask(0));
        assert!(matches!(asking.take(&heard, true), Some((_, false))));
        assert!(matches!(asking.take(&heard, true), Some((_, false))));
    }
}
