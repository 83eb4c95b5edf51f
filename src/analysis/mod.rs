//! What the motion means: whirl, stick-slip, contact statistics, severity. Pure: no clock, file, log or middleware.

mod report;

pub use report::{Severity, WhirlKind, WhirlReport, WhirlWarningLevel};
