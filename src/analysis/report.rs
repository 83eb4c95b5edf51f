//! Results of the analysis, as plain arrays.

use serde::{Deserialize, Serialize};

use crate::mechanics::Body;

/// Kinds of whirl, in the words of D-WIS. The discriminants are those of the messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum WhirlKind {
    /// No orbit worth the name.
    #[default]
    None = 0,
    /// In the sense of the rotation.
    Forward = 1,
    /// Against it.
    Backward = 2,
    /// Large motion without a steady direction.
    Chaotic = 3,
}

/// How bad.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Severity {
    /// Nothing to do.
    #[default]
    Ok = 0,
    /// Keep an eye on it.
    Watch = 1,
    /// Act soon.
    Warning = 2,
    /// Act now.
    Critical = 3,
}

/// One entry per watched station and pipe; all arrays of the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WhirlReport {
    /// m.
    pub measured_depth: Vec<f64>,
    /// rad.
    pub inclination: Vec<f64>,
    /// Which pipe.
    pub body: Vec<Body>,
    /// Kind.
    pub kind: Vec<WhirlKind>,
    /// Signed rate of the orbit (rad/s), positive in the sense of the rotation.
    pub whirl_rate: Vec<f64>,
    /// `whirl_rate` over the rotary speed; 0 when the tool does not turn.
    pub whirl_ratio: Vec<f64>,
    /// Root mean square radius about the running mean (m).
    pub orbit_radius: Vec<f64>,
    /// Largest distance from the gap's centre in the window over the clearance.
    pub clearance_ratio: Vec<f64>,
    /// Part of the window in contact, 0 to 1.
    pub contact_duty: Vec<f64>,
    /// 0 to 1.
    pub confidence: Vec<f64>,
}

/// State of the warning logic.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WhirlWarningLevel {
    /// Level.
    pub severity: Severity,
    /// Kind of whirl behind it.
    pub kind: WhirlKind,
    /// Index into the [`WhirlReport`] of the place behind it.
    pub entry: usize,
    /// rad/s over rad/s.
    pub whirl_ratio: f64,
    /// Largest distance over clearance.
    pub clearance_ratio: f64,
    /// 0 to 1.
    pub contact_duty: f64,
    /// Length of the window (s).
    pub window: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Number of changes so far.
    pub sequence: u64,
}
