//! The inputs: names, topics and units.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::units::{
    kn_to_n, m_per_h_to_m_per_s, m_per_s_to_m_per_h, mpa_to_pa, n_to_kn, pa_to_mpa, rad_per_s_to_rpm, rpm_to_rad_per_s,
};

/// The inputs of the twin. A rig sends the first two; the others are optional.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputKind {
    /// Of the top drive, r/min.
    RotarySpeed,
    /// Weight on bit, kN.
    WeightOnBit,
    /// Advance of the tool along the hole, m/h; negative when it is pulled back. Optional.
    RateOfPenetration,
    /// Pressure inside minus outside at the tool's top, MPa. Optional.
    StandpipePressure,
}

impl InputKind {
    /// Number of inputs.
    pub const COUNT: usize = 4;
    /// All, in the order of every per-input array.
    pub const ALL: [Self; Self::COUNT] = [
        Self::RotarySpeed,
        Self::WeightOnBit,
        Self::RateOfPenetration,
        Self::StandpipePressure,
    ];

    /// Index into per-input arrays.
    pub const fn index(self) -> usize {
        match self {
            Self::RotarySpeed => 0,
            Self::WeightOnBit => 1,
            Self::RateOfPenetration => 2,
            Self::StandpipePressure => 3,
        }
    }

    /// Whether many rigs do not send it: a configured constant then holds ([`super::InputState::Assumed`]).
    pub const fn is_optional(self) -> bool {
        match self {
            Self::RotarySpeed | Self::WeightOnBit => false,
            Self::RateOfPenetration | Self::StandpipePressure => true,
        }
    }

    /// The name in configuration and messages: `rotary_speed`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rotary_speed",
            Self::WeightOnBit => "weight_on_bit",
            Self::RateOfPenetration => "rate_of_penetration",
            Self::StandpipePressure => "standpipe_pressure",
        }
    }

    /// Topic relative to the node's namespace.
    pub const fn topic(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rig/rotary_speed_rpm",
            Self::WeightOnBit => "rig/weight_on_bit_kn",
            Self::RateOfPenetration => "rig/rate_of_penetration",
            Self::StandpipePressure => "rig/standpipe_pressure",
        }
    }

    /// Unit of the samples.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::RotarySpeed => "r/min",
            Self::WeightOnBit => "kN",
            Self::RateOfPenetration => "m/h",
            Self::StandpipePressure => "MPa",
        }
    }

    /// SI unit, that of [`crate::inputs::Inputs`].
    pub const fn si_unit(self) -> &'static str {
        match self {
            Self::RotarySpeed => "rad/s",
            Self::WeightOnBit => "N",
            Self::RateOfPenetration => "m/s",
            Self::StandpipePressure => "Pa",
        }
    }

    /// A sample in SI.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::RotarySpeed => rpm_to_rad_per_s(value),
            Self::WeightOnBit => kn_to_n(value),
            Self::RateOfPenetration => m_per_h_to_m_per_s(value),
            Self::StandpipePressure => mpa_to_pa(value),
        }
    }

    /// An SI value in the unit of the samples.
    pub fn from_si(self, value: f64) -> f64 {
        match self {
            Self::RotarySpeed => rad_per_s_to_rpm(value),
            Self::WeightOnBit => n_to_kn(value),
            Self::RateOfPenetration => m_per_s_to_m_per_h(value),
            Self::StandpipePressure => pa_to_mpa(value),
        }
    }

    /// The input of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl fmt::Display for InputKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
