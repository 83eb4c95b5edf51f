//! What the motion means: whirl, stick-slip, contact statistics, severity. Pure: no clock, file, log or middleware.
//!
//! # Layout
//! - [`WhirlAnalysis`] takes samples of every watched place and keeps a [`WhirlReport`] and a [`WhirlWarningLevel`].
//!   - `orbit_window`: the last seconds of one place. `orbit`: centre, axes, radius and phase rate of the motion in a
//!     window. `full_spectrum`: its forward and backward lines.
//!   - `classify`: from these to a kind of whirl. `severity`: from kind, reach and contact to a level.
//! - [`StickSlip`] watches the bit's speed.
//! - [`ContactStatistics`] and [`RootMeanSquare`] sum up what happens between two outputs.
//! - [`settings`]: every threshold, with its reason.

mod classify;
mod contact_statistics;
mod full_spectrum;
mod orbit;
mod orbit_window;
mod report;
pub mod settings;
mod severity;
mod stick_slip;
mod whirl;

pub use contact_statistics::{ContactStatistics, RootMeanSquare};
pub use report::{Severity, WhirlKind, WhirlReport, WhirlWarningLevel};
pub use settings::{LevelThresholds, StickSlipSettings, WhirlSettings};
pub use stick_slip::StickSlip;
pub use whirl::{PlaceSample, WatchedPlace, WhirlAnalysis};
