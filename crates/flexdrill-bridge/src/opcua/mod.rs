//! OPC UA both ways.
//!
//! # Layout
//! - [`server`]: the twin as a server: [`state`] of the twin with its status codes, the [`space`] of its nodes and
//!   [`alarms`], [`twin`] which keeps them up to date, [`conditions`] after Part 9, [`users`], and a [`gate`] in front
//!   that bounds connections. All of them report to the bridge by [`event`]s.
//! - [`client`]: a client of a rig's server, which comes back after a loss: [`mapping`] of nodes to quantities,
//!   [`values`] as messages for the twin.
//! - [`units`]: units by their UNECE codes. [`keys`]: the folder with our certificate and those of others.

pub mod alarms;
mod build;
pub mod client;
pub mod conditions;
pub mod event;
pub mod gate;
pub mod keys;
pub mod mapping;
mod nodes;
pub mod server;
pub mod space;
pub mod state;
pub mod twin;
pub mod units;
pub mod users;
pub mod values;

use ::opcua::types::DateTime;

/// An instant (ns since 1970) as OPC UA has it, in steps of 100 ns.
pub fn date_time(nanoseconds: i64) -> DateTime {
    // Ticks count from 1601-01-01, 11,644,473,600 s before 1970.
    DateTime::from((nanoseconds / 100).saturating_add(11_644_473_600 * 10_000_000))
}

/// An instant of OPC UA in ns since 1970; `None` where none is given or it lies outside what an `i64` holds.
pub fn nanoseconds(time: &DateTime) -> Option<i64> {
    if time.is_null() {
        return None;
    }
    time.as_chrono().timestamp_nanos_opt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_keep_their_100_nanoseconds() {
        let at = 1_700_000_000_123_456_700;
        assert_eq!(nanoseconds(&date_time(at)), Some(at));
        assert_eq!(nanoseconds(&DateTime::null()), None);
        assert_eq!(date_time(0).to_rfc3339()[..19], *"1970-01-01T00:00:00");
    }
}
