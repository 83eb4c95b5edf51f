//! Codes of the messages and causes of failures as words for a person, the same in messages, tables and dashboards.

use super::{TwinStatus, WhirlState, WhirlWarning};
use flexdrill_core::dynamics::outcome::{FailureCause, StepFailure};
use flexdrill_core::tool::Body;

/// What stands for a code that this version does not know.
const UNKNOWN: &str = "?";

/// A warning's severity: `ok`, `watch`, `warning` or `critical`. All messages share the codes of [`WhirlWarning`].
pub fn severity(code: u8) -> &'static str {
    match code {
        WhirlWarning::OK => "ok",
        WhirlWarning::WATCH => "watch",
        WhirlWarning::WARNING => "warning",
        WhirlWarning::CRITICAL => "critical",
        _ => UNKNOWN,
    }
}

/// The kind of whirl in one word.
pub fn whirl_kind(code: u8) -> &'static str {
    match code {
        WhirlState::NONE => "none",
        WhirlState::FORWARD => "forward",
        WhirlState::BACKWARD => "backward",
        WhirlState::CHAOTIC => "chaotic",
        _ => UNKNOWN,
    }
}

/// `pipe` or `guide`.
pub fn body(body: Body) -> &'static str {
    match body {
        Body::Pipe => "pipe",
        Body::Guide => "guide",
    }
}

/// The layer of contacts, 0 or 1, by what meets in it.
pub fn layer(layer: usize) -> &'static str {
    if layer == 0 { "pipe-guide" } else { "guide-wall" }
}

/// The state of an input.
pub fn input_state(code: u8) -> &'static str {
    match code {
        TwinStatus::INPUT_NOT_RECEIVED => "not received",
        TwinStatus::INPUT_OK => "ok",
        TwinStatus::INPUT_SLOW => "slow",
        TwinStatus::INPUT_STALE => "stale",
        TwinStatus::INPUT_REJECTED => "rejected",
        _ => UNKNOWN,
    }
}

/// The cause of a rejected step as `TwinStatus.last_rejection_cause` says it.
pub fn cause(cause: FailureCause) -> &'static str {
    match cause {
        FailureCause::NotConverged => "not_converged",
        FailureCause::NotFinite => "not_finite",
        FailureCause::Singular => "singular",
        FailureCause::OutOfRange => "out_of_range",
    }
}

/// Cause and place of a failed step: `Newton's iterations did not converge (station 42 of the guide pipe, ...)`.
pub fn step_failure(failure: &StepFailure) -> String {
    let cause = match failure.cause {
        FailureCause::NotConverged => "Newton's iterations did not converge",
        FailureCause::NotFinite => "a number is not finite",
        FailureCause::Singular => "the linear system is singular",
        FailureCause::OutOfRange => "a displacement or tilt left the model's range",
    };
    let body = match failure.body {
        Body::Pipe => "pipe",
        Body::Guide => "guide pipe",
    };
    format!(
        "{cause} (station {} of the {body}, worst value {:.3e}, sub-step {:.3e} s)",
        failure.station, failure.value, failure.step
    )
}
