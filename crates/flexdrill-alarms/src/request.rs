//! What operators ask for, and why it may be refused.

use crate::{Operator, State};

/// How an alarm is to be put aside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shelving {
    /// Until the condition goes, at most for the longest time.
    OneShot,
    /// For so long (s).
    Timed(f64),
}

/// Why a request was refused. `alarm` is the id.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// There is no such alarm.
    #[error("there is no alarm '{alarm}'; the alarms are {}", known.join(", "))]
    Unknown {
        /// As asked for.
        alarm: String,
        /// Those that there are.
        known: Vec<&'static str>,
    },
    /// Who asks must say who he is.
    #[error("operator is empty: say who asks, the journal keeps it")]
    NoOperator,
    /// What is put aside needs a reason.
    #[error("reason is empty: say why {alarm} is shelved, the journal keeps it")]
    NoReason {
        /// Which.
        alarm: &'static str,
    },
    /// There is nothing to acknowledge.
    #[error("{alarm} is {}: there is nothing to acknowledge", state.name())]
    NothingToAcknowledge {
        /// Which.
        alarm: &'static str,
        /// How it stands.
        state: State,
    },
    /// It is not on the shelf.
    #[error("{alarm} is {}: it is not shelved", state.name())]
    NotShelved {
        /// Which.
        alarm: &'static str,
        /// How it stands.
        state: State,
    },
    /// The configuration has switched it off.
    #[error("{alarm} is out of service: it is switched off in the configuration")]
    OutOfService {
        /// Which.
        alarm: &'static str,
    },
    /// Nothing is shelved for ever, or for no time.
    #[error("duration = {asked} s; shelving {alarm} takes above 0, at most {most} s")]
    Duration {
        /// Which.
        alarm: &'static str,
        /// As asked for (s).
        asked: f64,
        /// The longest (s).
        most: f64,
    },
}

/// Whether somebody says who he is.
pub(crate) fn named(by: &Operator<'_>) -> Result<(), Refusal> {
    if by.name.trim().is_empty() {
        Err(Refusal::NoOperator)
    } else {
        Ok(())
    }
}
