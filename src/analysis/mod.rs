//! What the motion means: whirl, stick-slip, contact statistics, severity. Pure: no clock, file, log or middleware.

mod report;
mod settings;

pub use report::{Severity, WhirlKind, WhirlReport, WhirlWarningLevel};
pub use settings::{Watched, WhirlSettings, WhirlThresholds};
