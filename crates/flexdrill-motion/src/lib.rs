//! Analysis of the motion: whirl, stick-slip, shock, contact statistics, severity. It uses no clock, file or log.
//!
//! # Layout
//! - [`WhirlAnalysis`] takes samples of every watched station and keeps a [`WhirlReport`] and a [`WhirlWarningLevel`].
//!   - `watched_station`: one of them. `orbit_window`: its last seconds. `orbit`: centre, axes, radius and phase rate of
//!     the motion in a window. `full_spectrum`: its forward and backward lines.
//!   - `classify` derives the kind of motion from these, `severity` the level from kind, bending cycles and friction, and
//!     `tool_level` the leading station and the one warning from the stations' levels.
//! - [`StickSlip`] watches the bit's speed, [`ShockWatch`] the impulses of contact, [`JointLoadWatch`] the stops of the
//!   joints, [`ChaoticWhirlWatch`] the power that collisions dissipate, [`LoadWatch`] a load against its rating. `hysteresis`
//!   defines how levels rise and fall; `drive` detects run-ups, in which no level rises.
//! - [`TransferWatch`] averages torque, weight and power from the surface to the bit.
//! - [`Hazards`] lists the results of all watches; alarms are made from it.
//! - [`AgeingWatch`] finds what ages fastest, from cycles counted in `rainflow` and from the work of the friction.
//!   [`Woehler`] and [`Detail`] turn counted cycles into the damage of a stated class, with its band.
//! - [`EpisodeLog`] tabulates the levels over a run.
//! - [`ContactStatistics`] and [`RootMeanSquare`] accumulate values between two outputs.
//! - [`WhirlSettings`] and the settings of the other watches: every threshold, with its reason; `validation` checks them.

#![deny(missing_docs)]

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
mod load_watch;
mod orbit;
mod orbit_window;
mod rainflow;
mod report;
mod settings;
mod severity;
mod shock;
mod stick_slip;
mod tool_level;
mod transfer;
mod validation;
mod watched_station;
mod whirl;
mod woehler;

pub use ageing::{Ageing, AgeingSettings, AgeingWatch};
pub use chaotic_whirl::{ChaoticWhirlLevel, ChaoticWhirlSettings, ChaoticWhirlWatch};
pub use contact_statistics::{ContactStatistics, Means, RootMeanSquare};
pub use drive::DriveState;
pub use episodes::{Episode, EpisodeKind, EpisodeLog, Observation, ToolLocation};
pub use hazards::{ENDED_AFTER, Hazard, HazardKind, Hazards, Hold};
pub use hysteresis::{Alarm, AlarmThresholds};
pub use joint_load::{JointLoadLevel, JointLoadSettings, JointLoadWatch};
pub use load_watch::{LoadLevel, LoadSettings, LoadWatch};
pub use report::{Severity, ShockLevel, WhirlKind, WhirlReport, WhirlWarningLevel};
pub use settings::{InputTrust, WhirlSettings};
pub use shock::{MOST_REPEATS, ShockSettings, ShockWatch, Shocks};
pub use stick_slip::{StickSlip, StickSlipSettings};
pub use transfer::{
    Along, BIT, KICK_OFF, SURFACE, Transfer, TransferLevel, TransferSample, TransferSettings, TransferWatch,
};
pub use watched_station::{StationSample, WatchedStation};
pub use whirl::WhirlAnalysis;
pub use woehler::{DESIGN_DEVIATIONS, Detail, Woehler, cycle_weight};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
