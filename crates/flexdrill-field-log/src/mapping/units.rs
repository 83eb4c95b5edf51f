//! Units of the columns.

use serde::de::Error as _;
use serde::de::value::StrDeserializer;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use flexdrill_core::inputs::Unit;
use flexdrill_core::units::{
    ft_to_m, kft_lbf_to_kn_m, kgf_to_kn, klbf_to_kn, lbf_to_kn, m_per_s_to_m_per_h, n_to_kn, psi_to_mpa,
    rad_per_s_to_rpm, tf_to_kn,
};

/// Reads a unit of one kind by the spellings that all inputs share; a spelling without a unit of this kind is refused by
/// the names of the kind.
macro_rules! by_spelling {
    ($kind:ident: $($unit:ident => $variant:ident),*) => {
        impl $kind {
            /// The unit in the list of all units.
            pub(crate) const fn unit(self) -> Unit {
                match self {
                    $(Self::$variant => Unit::$unit,)*
                }
            }
        }

        impl<'de> Deserialize<'de> for $kind {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = String::deserialize(deserializer)?;
                match Unit::of_spelling(&text) {
                    $(Some(Unit::$unit) => return Ok(Self::$variant),)*
                    _ => {}
                }
                if let Some(words) = Unit::ambiguous_spelling(&text) {
                    return Err(D::Error::custom(words));
                }
                // The derived function words the error of an unknown unit.
                Self::deserialize(StrDeserializer::<D::Error>::new(&text))
            }
        }

        impl Serialize for $kind {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                Self::serialize(self, serializer)
            }
        }
    };
}

by_spelling!(RateUnit: MetrePerHour => MetresPerHour, MetrePerMinute => MetresPerMinute,
    MetrePerSecond => MetresPerSecond, FootPerHour => FeetPerHour, FootPerMinute => FeetPerMinute);
by_spelling!(PressureUnit: Megapascal => Megapascal, Kilopascal => Kilopascal, Pascal => Pascal, Bar => Bar, Psi => Psi);
by_spelling!(TorqueUnit: NewtonMetre => NewtonMetre, KilonewtonMetre => KilonewtonMetre,
    KilodecanewtonMetre => KilodecanewtonMetre, FootPound => FootPound, KilofootPound => KilofootPound);
by_spelling!(SpeedUnit: TurnPerMinute => RevolutionsPerMinute, RadianPerSecond => RadiansPerSecond, Hertz => Hertz);
by_spelling!(WeightUnit: Newton => N, Kilonewton => Kilonewton, Decanewton => Decanewton,
    Kilodecanewton => Kilodecanewton, KilogramForce => KilogramForce, TonneForce => TonneForce,
    PoundForce => PoundForce, Kilopound => Kilopound);

/// Units of the rate of penetration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(remote = "Self")]
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
    /// Feet per minute.
    #[serde(rename = "ft/min")]
    FeetPerMinute,
}

impl RateUnit {
    pub(crate) fn to_m_per_h(self, value: f64) -> f64 {
        match self {
            Self::MetresPerHour => value,
            Self::MetresPerMinute => value * 60.0,
            Self::MetresPerSecond => m_per_s_to_m_per_h(value),
            Self::FeetPerHour => ft_to_m(value),
            Self::FeetPerMinute => ft_to_m(value) * 60.0,
        }
    }
}

/// Units of pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub enum PressureUnit {
    /// Megapascal.
    #[serde(rename = "MPa")]
    Megapascal,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Pascal.
    #[serde(rename = "Pa")]
    Pascal,
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
            Self::Pascal => value / 1e6,
            Self::Bar => value / 10.0,
            Self::Psi => psi_to_mpa(value),
        }
    }
}

/// Units of torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub enum TorqueUnit {
    /// Newton metre.
    #[serde(rename = "N.m")]
    NewtonMetre,
    /// Kilonewton metre.
    #[serde(rename = "kN.m")]
    KilonewtonMetre,
    /// Thousand decanewton metres (10 kN m).
    #[serde(rename = "kdaN.m")]
    KilodecanewtonMetre,
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
            Self::KilodecanewtonMetre => value * 10.0,
            Self::FootPound => kft_lbf_to_kn_m(value / 1e3),
            Self::KilofootPound => kft_lbf_to_kn_m(value),
        }
    }
}

/// Units of speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(remote = "Self")]
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
#[serde(remote = "Self")]
pub enum WeightUnit {
    /// Newton.
    N,
    /// Kilonewton.
    #[serde(rename = "kN")]
    Kilonewton,
    /// Decanewton: 10 N.
    #[serde(rename = "daN")]
    Decanewton,
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
            Self::Decanewton => n_to_kn(value * 10.0),
            Self::Kilodecanewton => value * 10.0,
            Self::KilogramForce => kgf_to_kn(value),
            Self::TonneForce => tf_to_kn(value),
            Self::PoundForce => lbf_to_kn(value),
            Self::Kilopound => klbf_to_kn(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
        T::deserialize(StrDeserializer::<serde::de::value::Error>::new(text)).map_err(|error| error.to_string())
    }

    #[test]
    fn measured_quantities_are_read_in_the_shared_spellings() {
        let text = |unit: &str| {
            format!(
                "columns:\n  time: {{column: t, format: seconds}}\n  rotary_speed: {{column: n, unit: RPM}}\n  \
                 weight_on_bit: {{direct: {{column: w, unit: kip}}}}\n  measured: {{hook_load: {{column: h, unit: {unit}}}}}\n"
            )
        };
        let read = |unit: &str| crate::Mapping::from_text("m.yaml", &text(unit));
        for (spelling, unit) in [
            ("klbs", Unit::Kilopound),
            ("tonne", Unit::TonneForce),
            ("KDN", Unit::Kilodecanewton),
        ] {
            let mapping = read(spelling).unwrap_or_else(|error| panic!("{error}"));
            assert!(
                mapping.columns.measured.values().all(|column| column.unit == unit),
                "{spelling}"
            );
        }
        let error = read("ton").unwrap_err().to_string();
        assert!(
            error.contains("m.yaml:5") && error.contains("write tf for a tonne"),
            "{error}"
        );
    }

    #[test]
    fn units_of_columns_are_read_in_the_shared_spellings() {
        assert_eq!(unit::<SpeedUnit>("RPM"), Ok(SpeedUnit::RevolutionsPerMinute));
        assert_eq!(unit::<WeightUnit>("klbs"), Ok(WeightUnit::Kilopound));
        assert_eq!(unit::<WeightUnit>("KDN"), Ok(WeightUnit::Kilodecanewton));
        assert_eq!(unit::<WeightUnit>("tonne"), Ok(WeightUnit::TonneForce));
        assert_eq!(unit::<TorqueUnit>("ft-lbf"), Ok(TorqueUnit::FootPound));
        assert_eq!(unit::<RateUnit>("FT/HR"), Ok(RateUnit::FeetPerHour));
        assert_eq!(unit::<PressureUnit>("PSI"), Ok(PressureUnit::Psi));
        assert!(unit::<WeightUnit>("ton").unwrap_err().contains("write tf"));
        assert!(unit::<SpeedUnit>("klbf").unwrap_err().contains("unknown variant"));
        assert!((WeightUnit::Decanewton.to_kn(100.0) - 1.0).abs() < 1e-15);
        assert!((RateUnit::FeetPerMinute.to_m_per_h(1.0) - 18.288).abs() < 1e-12);
    }
}
