//! The variables of an alarm, and its level and state in words.

use ::opcua::types::Variant;
use flexdrill_core::inputs::Unit;
use flexdrill_messages::Alarm;

use super::space::{Kind, number};

/// The variables of an alarm: name, description, type and value.
pub type AlarmVariable = (&'static str, &'static str, Kind, fn(&Alarm) -> Option<Variant>);

/// The same for every alarm; the words are those of the twin's own list.
pub const ALARM_VARIABLES: [AlarmVariable; 14] = [
    (
        "active",
        "The condition stands, also while the alarm is shelved",
        Kind::Flag,
        |alarm| Some(alarm.active.into()),
    ),
    ("level", "none, low, medium or high", Kind::Text, |alarm| {
        Some(level(alarm).into())
    }),
    ("state", "State of the alarm in words", Kind::Text, |alarm| {
        Some(state(alarm).into())
    }),
    ("acknowledged", "No acknowledgement is needed", Kind::Flag, |alarm| {
        Some(alarm.acknowledged.into())
    }),
    ("evidence", "What happened, in a sentence", Kind::Text, |alarm| {
        Some(alarm.evidence.clone().into())
    }),
    ("cause", "Why it happens", Kind::Text, |alarm| {
        Some(alarm.cause.clone().into())
    }),
    ("consequence", "The consequence without action", Kind::Text, |alarm| {
        Some(alarm.consequence.clone().into())
    }),
    ("advice", "What the driller can do", Kind::Text, |alarm| {
        Some(alarm.what_to_do.clone().into())
    }),
    ("advice_to_engineer", "What the engineer can do", Kind::Text, |alarm| {
        Some(alarm.what_the_engineer_can_do.clone().into())
    }),
    (
        "measured_depth",
        "Measured depth of the worst value from the kick-off",
        Kind::Number(Unit::Metre),
        |alarm| number(alarm.measured_depth),
    ),
    (
        "value",
        "The value that is judged, in the unit of the alarm",
        Kind::Number(Unit::One),
        |alarm| number(alarm.value),
    ),
    (
        "threshold",
        "The threshold that it is compared with, in the same unit",
        Kind::Number(Unit::One),
        |alarm| number(alarm.threshold),
    ),
    (
        "unit",
        "Unit of value and threshold; empty where they have none",
        Kind::Text,
        |alarm| Some(alarm.unit.clone().into()),
    ),
    (
        "annunciations",
        "Number of annunciations since the count began",
        Kind::Count,
        |alarm| Some(alarm.annunciations.into()),
    ),
];

/// The priority of an alarm in words.
pub const fn level(alarm: &Alarm) -> &'static str {
    match alarm.priority {
        Alarm::LOW => "low",
        Alarm::MEDIUM => "medium",
        Alarm::HIGH => "high",
        _ => "none",
    }
}

/// The state of an alarm in words.
pub const fn state(alarm: &Alarm) -> &'static str {
    match alarm.state {
        Alarm::NORMAL => "normal",
        Alarm::ACTIVE_UNACKNOWLEDGED => "active, not acknowledged",
        Alarm::ACTIVE_ACKNOWLEDGED => "active, acknowledged",
        Alarm::RETURNED_UNACKNOWLEDGED => "returned, not acknowledged",
        Alarm::SHELVED => "shelved",
        Alarm::SUPPRESSED_BY_DESIGN => "suppressed by design",
        Alarm::OUT_OF_SERVICE => "out of service",
        _ => "unknown",
    }
}
