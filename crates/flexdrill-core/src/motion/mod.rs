//! What the motion means: whirl, stick-slip, contact statistics, severity. Pure: no clock, file, log or middleware.
//!
//! # Layout
//! - [`WhirlAnalysis`] takes samples of every watched station and keeps a [`WhirlReport`] and a [`WhirlWarningLevel`].
//!   - `watched_station`: one of them. `orbit_window`: its last seconds. `orbit`: centre, axes, radius and phase rate of
//!     the motion in a window. `full_spectrum`: its forward and backward lines.
//!   - `classify`: from these to a kind of motion. `severity`: from kind, bending cycles and friction to a level.
//!     `tool_level`: from the stations' levels to the place that leads and the one warning.
//! - [`StickSlip`] watches the bit's speed, [`ShockWatch`] the impulses of contact, [`JointLoadWatch`] the stops of the
//!   joints, [`ChaoticWhirlWatch`] the power that collisions take; `hysteresis`: how levels rise and fall; `drive`:
//!   while the tool is run up none does.
//! - [`Hazards`]: all of these side by side, what alarms are made from.
//! - [`AgeingWatch`]: what ages fastest, by cycles counted in `rainflow` and the work of the friction.
//! - [`EpisodeLog`] makes a table of all this over a run.
//! - [`ContactStatistics`] and [`RootMeanSquare`] sum up what happens between two outputs.
//! - [`WhirlSettings`] and the settings of the other watches: every threshold, with its reason.

mod ageing;
mod chaotic_whirl;
mod classify;
mod contact_statistics;
mod drive;
mod episodes;
mod full_spectrum;
mod hazards;
mod hysteresis;
mod joint_load;
mod orbit;
mod orbit_window;
mod rainflow;
mod report;
mod settings;
mod severity;
mod shock;
mod stick_slip;
mod tool_level;
mod watched_station;
mod whirl;

pub use ageing::{Ageing, AgeingSettings, AgeingWatch};
pub use chaotic_whirl::{ChaoticWhirlLevel, ChaoticWhirlSettings, ChaoticWhirlWatch};
pub use contact_statistics::{ContactStatistics, RootMeanSquare};
pub use drive::DriveState;
pub use episodes::{Episode, EpisodeKind, EpisodeLog, Observation, ToolLocation};
pub(crate) use hazards::ended;
pub use hazards::{ENDED_AFTER, Hazard, HazardKind, Hazards};
pub use hysteresis::{Alarm, AlarmThresholds};
pub use joint_load::{JointLoadLevel, JointLoadSettings, JointLoadWatch};
pub use report::{Severity, ShockLevel, WhirlKind, WhirlReport, WhirlWarningLevel};
pub use settings::{InputTrust, WhirlSettings};
pub use shock::{MOST_REPEATS, ShockSettings, ShockWatch, Shocks};
pub use stick_slip::{StickSlip, StickSlipSettings};
pub use watched_station::{StationSample, WatchedStation};
pub use whirl::WhirlAnalysis;
