//! Alarms as people manage them: the life of an alarm of ANSI/ISA-18.2-2016, with the states that
//! OPC UA Part 9 (Alarms and Conditions) keeps beside each other.
//!
//! Pure: it opens no file, reads no clock and knows nothing of drilling. Who uses it says what time it is, what its
//! conditions are and what people ask for; it answers with [`Event`]s, one per change, which are the journal.
//!
//! # Layout
//! - [`Standing`] is the state of one alarm, [`State`] its one word, [`Change`] what can happen to it. A standing
//!   changes by [`Standing::apply`] and in no other way, so that the journal gives the state.
//! - `alarm`: one alarm with its delays: when a condition is a change.
//! - [`AlarmSystem`]: a fixed set of alarms, numbered events, requests of operators (refused with a
//!   [`Refusal`]), [`Saved`] over a restart.
//! - [`Statistics`]: how many, how often repeated, how long in flood.
//! - [`Setpoints`]: from a value to a priority, with a deadband.
//!
//! # Choices
//! - **Time** is in ns since 1970 on whichever clock the caller keeps to; where it goes back, delays begin anew.
//! - **One alarm, three priorities.** What ISA-18.2 keeps as separate alarms (high, high-high) is here one alarm whose
//!   priority rises: a rise wants a new acknowledgement, a fall is journalled only.
//! - **Shelving covers up to MEDIUM**, or up to HIGH when it stood at HIGH as it was shelved. In ISA-18.2 shelving an
//!   alarm leaves the one of the next priority alone; so what rises to HIGH under a shelf ends the shelving.
//! - **What has not been acknowledged stays so** through suppression by design: a drive that is stopped because of an
//!   alarm does not wipe the alarm away.

mod alarm;
mod event;
mod request;
mod saved;
mod setpoints;
mod standing;
mod statistics;
mod system;

pub use alarm::{Delays, Observation};
pub use event::{Event, Operator};
pub use request::{Refusal, Shelving};
pub use saved::{FORMAT, Saved, SavedError};
pub use setpoints::Setpoints;
pub use standing::{Change, Priority, Shelf, Standing, State, Unshelving};
pub use statistics::{Figures, Statistics};
pub use system::{Alarm, AlarmSystem, Definition};

/// An instant (ns since 1970).
pub type Time = i64;

/// A span of seconds in ns; not below zero, and as long as it gets where the number is too large.
pub fn span(seconds: f64) -> Time {
    // A cast from float to integer saturates, and takes NaN for zero.
    ((seconds * 1e9).round() as Time).max(0)
}
