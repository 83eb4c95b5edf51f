//! What the motion means: whirl, stick-slip, contact statistics, severity. Pure: no clock, file, log or middleware.
//!
//! # Layout
//! - [`WhirlAnalysis`] takes samples of every watched station and keeps a [`WhirlReport`] and a [`WhirlWarningLevel`].
//!   - `watched_station`: one of them. `orbit_window`: its last seconds. `orbit`: centre, axes, radius and phase rate
//!     of the
//!     motion in a window. `full_spectrum`: its forward and backward lines.
//!   - `classify`: from these to a kind of whirl. `severity`: from kind, reach and contact to a level. `tool_level`:
//!     from
//!     the stations' levels to the one warning.
//! - [`StickSlip`] watches the bit's speed, [`ShockWatch`] the impulses of contact; `hysteresis`: how they rise and
//!   fall.
//! - [`IncidentLog`] makes a table of all this over a run.
//! - [`ContactStatistics`] and [`RootMeanSquare`] sum up what happens between two outputs.
//! - [`settings`]: every threshold, with its reason.

mod classify;
mod contact_statistics;
mod full_spectrum;
mod hysteresis;
mod incidents;
mod orbit;
mod orbit_window;
mod report;
pub mod settings;
mod severity;
mod shock;
mod stick_slip;
mod tool_level;
mod watched_station;
mod whirl;

pub use contact_statistics::{ContactStatistics, RootMeanSquare};
pub use hysteresis::{Alarm, AlarmThresholds};
pub use incidents::{Incident, IncidentKind, IncidentLocation, IncidentLog, Observation};
pub use report::{Severity, ShockLevel, WhirlKind, WhirlReport, WhirlWarningLevel};
pub use settings::{InputTrust, LevelThresholds, WhirlSettings};
pub use shock::{ShockSettings, ShockWatch, Shocks};
pub use stick_slip::{StickSlip, StickSlipSettings};
pub use watched_station::{StationSample, WatchedStation};
pub use whirl::WhirlAnalysis;
