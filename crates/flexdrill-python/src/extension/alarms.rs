//! Events of alarms, as values in a fixed order.

use flexdrill_messages::AlarmEvent;

/// Model time (s), id, name, codes of change, state and priority, evidence, what the driller can do, what the engineer can
/// do, code of the body, measured depth (m), value.
pub(super) type Row = (f64, String, String, u8, u8, u8, String, String, String, u8, f64, f64);

/// The values of an event.
pub(super) fn row(event: &AlarmEvent) -> Row {
    let event = event.clone();
    (
        // Nanoseconds of model time are exact in a number up to half a year, and so is their quotient to the last digit.
        event.header.stamp.to_nanoseconds() as f64 / 1e9,
        event.id,
        event.name,
        event.change,
        event.to_state,
        event.priority,
        event.evidence,
        event.what_to_do,
        event.what_the_engineer_can_do,
        event.body,
        event.measured_depth,
        event.value,
    )
}
