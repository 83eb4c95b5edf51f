//! The two inputs: names, topics and units.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::units::{kn_to_n, rpm_to_rad_per_s};

/// The two inputs of the twin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputKind {
    /// Of the top drive, r/min.
    RotarySpeed,
    /// Weight on bit, kN.
    WeightOnBit,
}

impl InputKind {
    /// Both, in the order of every per-input array.
    pub const ALL: [Self; 2] = [Self::RotarySpeed, Self::WeightOnBit];

    /// 0 or 1: index into per-input arrays.
    pub const fn index(self) -> usize {
        match self {
            Self::RotarySpeed => 0,
            Self::WeightOnBit => 1,
        }
    }

    /// `rotary_speed` or `weight_on_bit`, as in configuration and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rotary_speed",
            Self::WeightOnBit => "weight_on_bit",
        }
    }

    /// Topic relative to the node's namespace.
    pub const fn topic(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rig/rotary_speed_rpm",
            Self::WeightOnBit => "rig/weight_on_bit_kn",
        }
    }

    /// Unit of the samples.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::RotarySpeed => "r/min",
            Self::WeightOnBit => "kN",
        }
    }

    /// SI unit, that of [`crate::inputs::Inputs`].
    pub const fn si_unit(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rad/s",
            Self::WeightOnBit => "N",
        }
    }

    /// A sample in SI: rad/s or N.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::RotarySpeed => rpm_to_rad_per_s(value),
            Self::WeightOnBit => kn_to_n(value),
        }
    }
}

impl fmt::Display for InputKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
