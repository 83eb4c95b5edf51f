//! Results of the analysis, as plain arrays.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::hazards::Hold;
use flexdrill_base::Body;

/// Kinds of motion, in the words of D-WIS where it has one. The discriminants are those of the messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum WhirlKind {
    /// No orbit of significant size.
    #[default]
    None = 0,
    /// In the sense of the rotation.
    Forward = 1,
    /// Round the gap against the rotation.
    Backward = 2,
    /// Large motion without a steady direction.
    Chaotic = 3,
    /// A small orbit at twice the tool's speed that does not enclose the gap's centre: the joint's cross drives it.
    /// D-WIS has no term for it.
    JointVibration = 4,
}

impl WhirlKind {
    /// The name in sentences: `forward whirl`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "no whirl",
            Self::Forward => "forward whirl",
            Self::Backward => "backward whirl",
            Self::Chaotic => "chaotic whirl",
            Self::JointVibration => "joint vibration",
        }
    }
}

impl fmt::Display for WhirlKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Level of a warning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Severity {
    /// No action needed.
    #[default]
    Ok = 0,
    /// Observe.
    Watch = 1,
    /// Act soon: it wears the tool.
    Warning = 2,
    /// Act now: it may break the tool.
    Critical = 3,
}

impl Severity {
    /// The levels above OK, rising.
    pub const RAISED: [Self; 3] = [Self::Watch, Self::Warning, Self::Critical];

    /// The name in sentences: `ok`, `watch`, `warning`, `critical`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Watch => "watch",
            Self::Warning => "warning",
            Self::Critical => "critical",
        }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One entry per watched station and pipe; all arrays of the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WhirlReport {
    /// Station index from the top.
    pub station: Vec<usize>,
    /// Measured depth of each watched station (m).
    pub measured_depth: Vec<f64>,
    /// Inclination there (rad).
    pub inclination: Vec<f64>,
    /// Which pipe is watched there.
    pub body: Vec<Body>,
    /// Kind of whirl, or none.
    pub kind: Vec<WhirlKind>,
    /// Signed rate of the orbit (rad/s), positive in the sense of the rotation.
    pub whirl_rate: Vec<f64>,
    /// `whirl_rate` over the rotary speed; NaN where the motion is no whirl of one rate, and when the tool does not
    /// turn.
    pub whirl_ratio: Vec<f64>,
    /// Root mean square radius about the running mean (m).
    pub orbit_radius: Vec<f64>,
    /// Largest distance from the gap's centre in the window over the clearance.
    pub clearance_ratio: Vec<f64>,
    /// Part of the window in contact, 0 to 1.
    pub contact_duty: Vec<f64>,
    /// 0 to 1, lowered by doubtful inputs.
    pub confidence: Vec<f64>,
    /// Level of the station.
    pub severity: Vec<Severity>,
    /// Kind of whirl of the level, also during the hold-off.
    pub level_kind: Vec<WhirlKind>,
    /// Whether the whirl is backward and so near to rolling without slip that it counts as rolling.
    pub rolling: Vec<bool>,
    /// `whirl_rate` over that of rolling without slip, `-spin d / (D - d)`, for backward whirl of the driven pipe: 1
    /// rolls, less slides; 0 where there is no such whirl.
    pub rolling_share: Vec<f64>,
    /// Largest normal force in the window (N).
    pub peak_force: Vec<f64>,
    /// Turns about the gap's centre per turn of the tool, in the sense of the rotation; NaN while it stands.
    pub gap_turns: Vec<f64>,
    /// Bending cycles per turn of the tool that whirl of one rate brings; 0 elsewhere.
    pub bending_cycles: Vec<f64>,
    /// Largest impulse above the resting one in the window (N s).
    pub impulse: Vec<f64>,
    /// Impacts of at least 1 N s per second (1/s).
    pub impact_rate: Vec<f64>,
    /// Work of the friction per second and metre of the tool (W/m).
    pub friction_power: Vec<f64>,
}

/// Level of the whirl warning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WhirlWarningLevel {
    /// Level.
    pub severity: Severity,
    /// Kind of whirl behind it.
    pub kind: WhirlKind,
    /// Index into the [`WhirlReport`] of the station behind it.
    pub entry: usize,
    /// Whirl rate over rotary speed; NaN where there is none.
    pub whirl_ratio: f64,
    /// As in [`WhirlReport::rolling_share`].
    pub rolling_share: f64,
    /// Backward whirl so near to rolling without slip that it counts as rolling.
    pub rolling: bool,
    /// Largest distance over clearance.
    pub clearance_ratio: f64,
    /// 0 to 1.
    pub contact_duty: f64,
    /// Largest normal force in the window (N).
    pub peak_force: f64,
    /// Confidence in the kind, 0 to 1, lowered by doubtful inputs.
    pub confidence: f64,
    /// Length of the window (s).
    pub window: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Number of changes so far.
    pub sequence: u64,
}

/// State of the shock watch.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ShockLevel {
    /// Level.
    pub severity: Severity,
    /// 0 pipe in guide, 1 guide in hole.
    pub layer: usize,
    /// Station index from the top.
    pub station: usize,
    /// Impulse above the resting force (N s): the largest since the level was reached; that of the last interval while
    /// the level is OK.
    pub impulse: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Model time of that impulse (s).
    pub seen: f64,
    /// Whether impulses hold the level: the last one counts for the mean interval of the holding impulses.
    pub hold: Hold,
}
