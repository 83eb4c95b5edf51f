//! The events of the journal.

use serde::{Deserialize, Serialize};

use crate::{Change, Priority, State, Time};

/// The operator of a request, with the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operator<'a> {
    /// The operator's name. It is never empty in a request.
    pub name: &'a str,
    /// The reason, for readers of the journal.
    pub reason: &'a str,
}

/// One change of one alarm.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// The number of the event, from 1 without a gap, continued over restarts.
    pub sequence: u64,
    /// The time of the event.
    pub time: Time,
    /// The index of the alarm in the order of the definitions.
    pub alarm: usize,
    /// The change.
    pub change: Change,
    /// The state before.
    pub from: State,
    /// The state after: the same for a change under a shelf or suppression, and for a change of priority.
    pub to: State,
    /// The present priority of the condition; after its end, the priority that it had or that is not yet acknowledged.
    pub priority: Option<Priority>,
    /// The operator who requested the change; empty without a request.
    pub operator: String,
    /// The reason of the request.
    pub reason: String,
    /// The evidence of the condition in a sentence; empty without one.
    pub evidence: String,
}

impl Event {
    /// Whether the event annunciates: the alarm is active and unacknowledged, and was not before. A rise of an alarm that
    /// is already unacknowledged belongs to the same annunciation.
    pub fn annunciates(&self) -> bool {
        self.to == State::ActiveUnacknowledged && self.from != State::ActiveUnacknowledged
    }

    /// Whether the event raises the priority of an unacknowledged alarm.
    pub fn rises(&self) -> bool {
        matches!(self.change, Change::Raised(_)) && self.to == State::ActiveUnacknowledged
    }
}
