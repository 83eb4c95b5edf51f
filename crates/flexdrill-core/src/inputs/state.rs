//! State of an input.

use std::fmt;

use serde::{Deserialize, Serialize};

/// State of an input; the discriminants are those of the messages' `INPUT_` constants.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
pub enum InputState {
    /// No sample yet: the configured start value acts.
    #[default]
    NotReceived = 0,
    /// Fresh: the newest sample is younger than `slow_age`.
    Ok = 1,
    /// Later than expected, not yet stale.
    Slow = 2,
    /// Too old: the value is held, then ramps to the safe value.
    Stale = 3,
    /// The newest sample was refused; the last good one is held and ages.
    Rejected = 4,
    /// An optional input of which no sample came: the configured constant acts.
    Assumed = 5,
}

impl InputState {
    /// The interface's word for it: `OK`, `STALE`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotReceived => "NOT_RECEIVED",
            Self::Ok => "OK",
            Self::Slow => "SLOW",
            Self::Stale => "STALE",
            Self::Rejected => "REJECTED",
            Self::Assumed => "ASSUMED",
        }
    }

    /// Rank for choosing the worse of two: OK and ASSUMED, SLOW, REJECTED, NOT_RECEIVED, STALE.
    pub const fn badness(self) -> u8 {
        match self {
            Self::Ok | Self::Assumed => 0,
            Self::Slow => 1,
            Self::Rejected => 2,
            Self::NotReceived => 3,
            Self::Stale => 4,
        }
    }

    /// The worse of two.
    pub fn worse(self, other: Self) -> Self {
        if other.badness() > self.badness() { other } else { self }
    }
}

impl fmt::Display for InputState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
