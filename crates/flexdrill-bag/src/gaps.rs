//! Finds messages that a recording lost, from the sequence numbers of those that it holds.

use std::fmt;
use std::sync::Arc;

use crate::{BagMessage, Topic};

/// A topic of which messages are missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Gap {
    /// The topic.
    pub topic: Arc<Topic>,
    /// Messages missing between the first and the last present.
    pub messages: u64,
    /// Log times around the first missing message (ns).
    pub first: (i64, i64),
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let after = (self.first.1 - self.first.0) as f64 * 1e-9;
        write!(
            f,
            "{}: {} messages are missing, the first within the {after:.2} s after {} ns",
            self.topic.name, self.messages, self.first.0
        )
    }
}

/// The messages of one topic so far.
#[derive(Debug)]
struct Seen {
    topic: Arc<Topic>,
    lowest: u32,
    highest: u32,
    count: u64,
    last_time: i64,
    jump: Option<(i64, i64)>,
}

/// Finds gaps while a bag is read. It finds none in bags whose messages have no sequence numbers.
#[derive(Debug, Default)]
pub struct Gaps {
    seen: Vec<Option<Seen>>,
}

impl Gaps {
    /// Adds the next message of the bag.
    pub fn observe(&mut self, message: &BagMessage) {
        let Some(sequence) = message.sequence else { return };
        if self.seen.len() <= message.topic_index {
            self.seen.resize_with(message.topic_index + 1, || None);
        }
        let Some(slot) = self.seen.get_mut(message.topic_index) else {
            return;
        };
        let seen = slot.get_or_insert_with(|| Seen {
            topic: Arc::clone(&message.topic),
            lowest: sequence,
            highest: sequence,
            count: 0,
            last_time: message.log_time,
            jump: None,
        });
        if sequence > seen.highest.saturating_add(1) {
            seen.jump.get_or_insert((seen.last_time, message.log_time));
        }
        seen.lowest = seen.lowest.min(sequence);
        seen.highest = seen.highest.max(sequence);
        seen.count += 1;
        seen.last_time = message.log_time;
    }

    /// The topics of which messages are missing.
    pub fn found(&self) -> Vec<Gap> {
        self.seen
            .iter()
            .flatten()
            .filter_map(|seen| {
                let spanned = u64::from(seen.highest - seen.lowest) + 1;
                Some(Gap {
                    topic: Arc::clone(&seen.topic),
                    // Messages in another order than their numbers leave a jump, but none is missing.
                    messages: spanned.checked_sub(seen.count).filter(|missing| *missing > 0)?,
                    first: seen.jump?,
                })
            })
            .collect()
    }
}
