//! What the motion means for an operator: the whirl analysis on the real mechanics, and the alarms made of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[allow(dead_code, reason = "each test takes what it needs")]
#[path = "../../crates/flexdrill-core/tests/support/random.rs"]
mod random;

use flexdrill::alarms::AlarmId;
use flexdrill_config::Config;
use flexdrill_motion::HazardKind;

/// A configuration whose alarms of the tool's motion return so long (s) after the end of the motion: a test of the motion
/// does not wait for as long as an operator's alarm is held.
fn with_off_delay(config: Config, seconds: f64) -> Config {
    HazardKind::ALL.into_iter().fold(config, |config, kind| {
        let key = format!("alarms.{}.off_delay", AlarmId::of_hazard(kind).id());
        config.with_value(&key, seconds).unwrap()
    })
}

mod advice;
mod ahead;
mod book;
mod chatter;
mod disagrees;
mod forecast;
mod friction;
mod leading;
mod plan;
mod rig;
mod transfer;
mod whirl;
mod words;
