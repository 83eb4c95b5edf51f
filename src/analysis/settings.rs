//! What the whirl analysis and its warnings are told, SI. The reasons for the default numbers stand in
//! `config/default.yaml`.

use serde::{Deserialize, Serialize};

/// Settings of the whirl analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhirlSettings {
    /// Length of the sliding window (s).
    pub window: f64,
    /// Samples of the motion per second (Hz).
    pub sample_rate: f64,
    /// Which places are watched.
    pub watched: Watched,
    /// Below this rotary speed nothing is called whirl (rad/s).
    pub gate_speed: f64,
    /// Orbits whose RMS radius is below this part of the clearance are not called whirl.
    pub min_orbit_ratio: f64,
    /// A large orbit whose direction is less certain than this (0 to 1) is chaotic.
    pub min_confidence: f64,
    /// A level is left only when its quantities are below threshold x (1 - hysteresis).
    pub hysteresis: f64,
    /// And have been there for this long (s).
    pub hold_off: f64,
    /// When to watch.
    pub watch: WhirlThresholds,
    /// When to warn.
    pub warning: WhirlThresholds,
    /// When it is critical.
    pub critical: WhirlThresholds,
}

/// A level is reached when `duration` long either there is whirl with both `clearance_ratio` and `contact_duty`
/// exceeded, or the contact force exceeds `force`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WhirlThresholds {
    /// Largest distance from the gap's centre over the clearance.
    pub clearance_ratio: f64,
    /// Part of the window in contact, 0 to 1.
    pub contact_duty: f64,
    /// Peak normal contact force (N).
    pub force: f64,
    /// How long (s).
    pub duration: f64,
}

/// Which places are watched, on both pipes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Watched {
    /// The stations of the joints.
    #[default]
    Joints,
    /// Every station.
    All,
    /// These stations, 0-based from the top.
    Stations(Vec<usize>),
}
