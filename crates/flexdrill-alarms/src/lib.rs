//! The life of an alarm after ANSI/ISA-18.2-2016, with the states that OPC UA Part 9 (Alarms and Conditions) keeps
//! independent of each other.
//!
//! The crate opens no file, reads no clock and knows nothing of drilling. The caller gives the time, the conditions and
//! the requests of operators; the crate answers with [`Event`]s, one per change, which form the journal.
//!
//! # Layout
//! - [`Standing`] is the state of one alarm, [`State`] its name, [`Change`] an event in its life. A standing changes
//!   by [`Standing::apply`] only, so that the journal determines the state.
//! - `alarm`: one alarm with its delays, which decide when a condition becomes a change.
//! - [`AlarmSystem`]: a fixed set of alarms, numbered events, requests of operators (refused with a
//!   [`Refusal`]), [`Saved`] over a restart.
//! - [`Statistics`]: the number of alarms, their repetitions, and the time in flood.
//! - [`Incidents`]: from a journal to the times in which alarms stood.
//! - [`Setpoints`]: from a value to a priority, with a deadband.
//!
//! # Choices
//! - **Time** is in ns since 1970 on a clock of the caller's choice. When it steps back, delays start again.
//! - **One alarm, three priorities.** What ISA-18.2 keeps as separate alarms (high, high-high) is here one alarm whose
//!   priority rises: a rise requires a new acknowledgement, a fall is journalled only.
//! - **Shelving covers up to MEDIUM**, or up to HIGH for an alarm that stood at HIGH when it was shelved. In ISA-18.2
//!   shelving an alarm does not affect the one of the next priority; therefore a rise to HIGH ends the shelving.
//! - **Suppression by design keeps the need for acknowledgement**: stopping the drive because of an alarm does not clear
//!   the alarm.

mod alarm;
mod event;
mod incidents;
mod request;
mod saved;
mod setpoints;
mod standing;
mod statistics;
mod system;

pub use alarm::{Delays, Observation};
pub use event::{Event, Operator};
pub use incidents::{Course, Group, Incident, Incidents, Occurrence};
pub use request::{Refusal, Shelving};
pub use saved::{FORMAT, Saved, SavedError};
pub use setpoints::Setpoints;
pub use standing::{Change, Priority, Shelf, Standing, State, Unshelving};
pub use statistics::{Figures, Statistics};
pub use system::{Alarm, AlarmSystem, Definition};

/// An instant (ns since 1970).
pub type Time = i64;

/// A span of seconds in ns, clamped to zero below and to the largest time above.
pub fn span(seconds: f64) -> Time {
    // A cast from float to integer saturates, and maps NaN to zero.
    ((seconds * 1e9).round() as Time).max(0)
}
