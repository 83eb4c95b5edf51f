//! Words for the codes of the messages, the same in logs, tables and dashboards. A name of the core is used where there is
//! one.

use flexdrill_alarms::{Priority, State};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::QualityLevel;
use flexdrill_messages::{Alarm, TwinStatus, WhirlState};
use flexdrill_motion::Severity;

/// The word for an unknown code.
const UNKNOWN: &str = "?";

/// A warning's severity: `ok`, `watch`, `warning` or `critical`. All messages share the codes.
pub fn severity(code: u8) -> &'static str {
    let known = [Severity::Ok, Severity::Watch, Severity::Warning, Severity::Critical];
    let found = known.into_iter().find(|severity| *severity as u8 == code);
    found.map_or(UNKNOWN, Severity::name)
}

/// An alarm's state, in the words of ISA-18.2.
pub fn alarm_state(code: u8) -> &'static str {
    let found = State::ALL.into_iter().find(|state| *state as u8 == code);
    found.map_or(UNKNOWN, State::name)
}

/// An alarm's priority: `low`, `medium` or `high`; a dash where there is none.
pub fn alarm_priority(code: u8) -> &'static str {
    match code {
        Alarm::NO_PRIORITY => "-",
        Alarm::LOW => Priority::Low.name(),
        Alarm::MEDIUM => Priority::Medium.name(),
        Alarm::HIGH => Priority::High.name(),
        _ => UNKNOWN,
    }
}

/// An alarm's priority in messages.
pub fn priority_code(priority: Option<Priority>) -> u8 {
    match priority {
        None => Alarm::NO_PRIORITY,
        Some(Priority::Low) => Alarm::LOW,
        Some(Priority::Medium) => Alarm::MEDIUM,
        Some(Priority::High) => Alarm::HIGH,
    }
}

/// The kind of whirl in one word.
pub fn whirl_kind(code: u8) -> &'static str {
    match code {
        WhirlState::NONE => "none",
        WhirlState::FORWARD => "forward",
        WhirlState::BACKWARD => "backward",
        WhirlState::CHAOTIC => "chaotic",
        WhirlState::JOINT_VIBRATION => "joint vibration",
        _ => UNKNOWN,
    }
}

/// `pipe` or `guide`, for narrow columns.
pub fn body(body: Body) -> &'static str {
    match body {
        Body::Pipe => "pipe",
        Body::Guide => "guide",
    }
}

/// The contact layer 0 or 1, by its two bodies.
pub fn layer(layer: usize) -> &'static str {
    if layer == 0 { "pipe-guide" } else { "guide-wall" }
}

/// How far the motion can be trusted: `good`, `degraded` or `poor`.
pub fn model_quality(code: u8) -> &'static str {
    let known = [QualityLevel::Good, QualityLevel::Degraded, QualityLevel::Poor];
    let found = known.into_iter().find(|level| *level as u8 == code);
    found.map_or(UNKNOWN, QualityLevel::name)
}

/// The state of the twin.
pub fn twin_state(code: u8) -> &'static str {
    match code {
        TwinStatus::STARTING => "starting",
        TwinStatus::RUNNING => "running",
        TwinStatus::PAUSED => "paused",
        TwinStatus::FAILED => "failed",
        _ => UNKNOWN,
    }
}

/// Whether the twin is recording: `off`, `on` or `failed`.
pub fn recording_state(code: u8) -> &'static str {
    match code {
        TwinStatus::RECORDING_OFF => "off",
        TwinStatus::RECORDING_ON => "on",
        TwinStatus::RECORDING_FAILED => "failed",
        _ => UNKNOWN,
    }
}

/// The state of an input.
pub fn input_state(code: u8) -> &'static str {
    match code {
        TwinStatus::INPUT_NOT_RECEIVED => "not received",
        TwinStatus::INPUT_OK => "ok",
        TwinStatus::INPUT_SLOW => "slow",
        TwinStatus::INPUT_STALE => "stale",
        TwinStatus::INPUT_REJECTED => "rejected",
        TwinStatus::INPUT_ASSUMED => "assumed",
        _ => UNKNOWN,
    }
}
