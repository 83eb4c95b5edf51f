//! Units of the columns, and how a log writes its numbers.

use serde::{Deserialize, Serialize};

use flexdrill_core::units::{
    ft_to_m, kft_lbf_to_kn_m, kgf_to_kn, klbf_to_kn, lbf_to_kn, m_per_s_to_m_per_h, n_to_kn, psi_to_mpa,
    rad_per_s_to_rpm, tf_to_kn,
};

/// The decimal separator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Decimal {
    /// `12.5`.
    #[default]
    Point,
    /// `12,5`. A point in a number is refused then: `1.234` may be a thousand or one.
    Comma,
}

impl Decimal {
    /// Parses a number of the log; `None` when the text is no number in this notation.
    pub(crate) fn parse(self, text: &str) -> Option<f64> {
        match self {
            Self::Point => text.parse().ok(),
            Self::Comma if text.contains('.') => None,
            Self::Comma => text.replacen(',', ".", 1).parse().ok(),
        }
    }

    /// The change of the mapping that would make `text` a number; empty when the other notation does not help.
    pub(crate) fn hint(self, text: &str) -> &'static str {
        let other = match self {
            Self::Point => Self::Comma,
            Self::Comma => Self::Point,
        };
        match self {
            // Text that both notations read, such as "inf", has another problem.
            _ if self.parse(text).is_some() || other.parse(text).is_none() => "",
            Self::Point => "; if its comma is a decimal comma, set `decimal: comma` in the mapping",
            Self::Comma => {
                "; under `decimal: comma` a point may separate thousands: remove `decimal: comma` if this is a decimal point"
            }
        }
    }
}

/// Units of the rate of penetration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RateUnit {
    /// Metres per hour.
    #[serde(rename = "m/h")]
    MetresPerHour,
    /// Metres per minute.
    #[serde(rename = "m/min")]
    MetresPerMinute,
    /// Metres per second.
    #[serde(rename = "m/s")]
    MetresPerSecond,
    /// Feet per hour.
    #[serde(rename = "ft/h", alias = "ft/hr")]
    FeetPerHour,
}

impl RateUnit {
    pub(crate) fn to_m_per_h(self, value: f64) -> f64 {
        match self {
            Self::MetresPerHour => value,
            Self::MetresPerMinute => value * 60.0,
            Self::MetresPerSecond => m_per_s_to_m_per_h(value),
            Self::FeetPerHour => ft_to_m(value),
        }
    }
}

/// Units of pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum PressureUnit {
    /// Megapascal.
    #[serde(rename = "MPa")]
    Megapascal,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Bar.
    #[serde(rename = "bar")]
    Bar,
    /// Pounds-force per square inch.
    #[serde(rename = "psi")]
    Psi,
}

impl PressureUnit {
    pub(crate) fn to_mpa(self, value: f64) -> f64 {
        match self {
            Self::Megapascal => value,
            Self::Kilopascal => value / 1e3,
            Self::Bar => value / 10.0,
            Self::Psi => psi_to_mpa(value),
        }
    }
}

/// Units of torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TorqueUnit {
    /// Newton metre.
    #[serde(rename = "N.m")]
    NewtonMetre,
    /// Kilonewton metre.
    #[serde(rename = "kN.m")]
    KilonewtonMetre,
    /// Foot-pound-force.
    #[serde(rename = "ft.lbf")]
    FootPound,
    /// Thousand foot-pounds-force.
    #[serde(rename = "kft.lbf")]
    KilofootPound,
}

impl TorqueUnit {
    pub(crate) fn to_kn_m(self, value: f64) -> f64 {
        match self {
            Self::NewtonMetre => n_to_kn(value),
            Self::KilonewtonMetre => value,
            Self::FootPound => kft_lbf_to_kn_m(value / 1e3),
            Self::KilofootPound => kft_lbf_to_kn_m(value),
        }
    }
}

/// Units of speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SpeedUnit {
    /// Turns per minute.
    #[serde(rename = "r/min", alias = "rpm")]
    RevolutionsPerMinute,
    /// Radians per second.
    #[serde(rename = "rad/s")]
    RadiansPerSecond,
    /// Turns per second.
    #[serde(rename = "Hz")]
    Hertz,
}

impl SpeedUnit {
    pub(crate) fn to_rpm(self, value: f64) -> f64 {
        match self {
            Self::RevolutionsPerMinute => value,
            Self::RadiansPerSecond => rad_per_s_to_rpm(value),
            Self::Hertz => value * 60.0,
        }
    }
}

/// Units of weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WeightUnit {
    /// Newton.
    N,
    /// Kilonewton.
    #[serde(rename = "kN")]
    Kilonewton,
    /// Thousand decanewtons (10 kN).
    #[serde(rename = "kdaN")]
    Kilodecanewton,
    /// Kilogram-force.
    #[serde(rename = "kgf")]
    KilogramForce,
    /// Tonne-force: a thousand kilograms-force.
    #[serde(rename = "tf", alias = "t")]
    TonneForce,
    /// Pound-force.
    #[serde(rename = "lbf")]
    PoundForce,
    /// Thousand pounds-force.
    #[serde(rename = "klbf")]
    Kilopound,
}

impl WeightUnit {
    pub(crate) fn to_kn(self, value: f64) -> f64 {
        match self {
            Self::N => n_to_kn(value),
            Self::Kilonewton => value,
            Self::Kilodecanewton => value * 10.0,
            Self::KilogramForce => kgf_to_kn(value),
            Self::TonneForce => tf_to_kn(value),
            Self::PoundForce => lbf_to_kn(value),
            Self::Kilopound => klbf_to_kn(value),
        }
    }
}
