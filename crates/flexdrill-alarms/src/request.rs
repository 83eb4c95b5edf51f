//! Requests of operators and the reasons for a refusal.

use crate::{Operator, State};

/// How an alarm is shelved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shelving {
    /// Until the condition ends, at most for the longest time.
    OneShot,
    /// For a time (s).
    Timed(f64),
}

/// The reason for a refusal. `alarm` is the id.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// There is no such alarm.
    #[error("there is no alarm '{alarm}'; the alarms are {}", known.join(", "))]
    Unknown {
        /// The requested id.
        alarm: String,
        /// The existing ids.
        known: Vec<&'static str>,
    },
    /// The request has no name of an operator.
    #[error("operator is empty: give a name, which the journal keeps")]
    NoOperator,
    /// Shelving requires a reason.
    #[error("reason is empty: give a reason for shelving {alarm}, which the journal keeps")]
    NoReason {
        /// Its identifier, as in the request.
        alarm: &'static str,
    },
    /// There is nothing to acknowledge.
    #[error("{alarm} is {}: there is nothing to acknowledge", state.name())]
    NothingToAcknowledge {
        /// Its identifier, as in the request.
        alarm: &'static str,
        /// Its present state, which the request does not fit.
        state: State,
    },
    /// The alarm is not shelved.
    #[error("{alarm} is {}: it is not shelved", state.name())]
    NotShelved {
        /// Its identifier, as in the request.
        alarm: &'static str,
        /// Its present state, which the request does not fit.
        state: State,
    },
    /// The configuration has switched it off.
    #[error("{alarm} is out of service: it is switched off in the configuration")]
    OutOfService {
        /// Its identifier, as in the request.
        alarm: &'static str,
    },
    /// The duration is outside its bounds.
    #[error("duration = {asked} s; the duration for shelving {alarm} must be above 0 s and at most {most} s")]
    Duration {
        /// Its identifier, as in the request.
        alarm: &'static str,
        /// The requested duration (s).
        asked: f64,
        /// The longest duration (s).
        most: f64,
    },
}

/// Whether the request has the name of an operator.
pub(crate) fn named(by: &Operator<'_>) -> Result<(), Refusal> {
    if by.name.trim().is_empty() {
        Err(Refusal::NoOperator)
    } else {
        Ok(())
    }
}
