//! What the journal is made of.

use serde::{Deserialize, Serialize};

use crate::{Change, Priority, State, Time};

/// Who asks for something, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operator<'a> {
    /// A name that others know. Never empty where somebody asks.
    pub name: &'a str,
    /// For those who read the journal.
    pub reason: &'a str,
}

/// One change of one alarm.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// Counts from 1, over restarts too, without a gap.
    pub sequence: u64,
    /// When.
    pub time: Time,
    /// Which, in the order of the definitions.
    pub alarm: usize,
    /// What happened.
    pub change: Change,
    /// State before.
    pub from: State,
    /// State after: the same for what happens under a shelf or suppressed, and for a change of priority.
    pub to: State,
    /// The priority that the condition has now; of one that has gone, that which it had or which is to be acknowledged.
    pub priority: Option<Priority>,
    /// Who asked for it; empty where nobody did.
    pub operator: String,
    /// Why.
    pub reason: String,
    /// What the condition was judged by, in a sentence; empty where there was none.
    pub evidence: String,
}

impl Event {
    /// Whether it calls for somebody: the alarm stands unacknowledged and did not before. One that rises while it calls
    /// already is the same call.
    pub fn annunciates(&self) -> bool {
        self.to == State::ActiveUnacknowledged && self.from != State::ActiveUnacknowledged
    }

    /// Whether it calls with a higher priority than it did.
    pub fn rises(&self) -> bool {
        matches!(self.change, Change::Raised(_)) && self.to == State::ActiveUnacknowledged
    }
}
