//! The units in which logs and rigs give their quantities.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::units::{
    deg_to_rad, ft_to_m, kft_lbf_to_kn_m, kgf_to_kn, klbf_to_kn, kn_to_n, lbf_to_kn, m_per_h_to_m_per_s, mpa_to_pa,
    psi_to_mpa, rpm_to_rad_per_s, standard_gravities_to_m_per_s2, tf_to_kn,
};

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// SI unit: N.
    Force,
    /// SI unit: N m.
    Torque,
    /// SI unit: Pa.
    Pressure,
    /// SI unit: m/s.
    Speed,
    /// SI unit: m.
    Length,
    /// SI unit: rad/s.
    RotarySpeed,
    /// SI unit: m/s2.
    Acceleration,
    /// SI unit: rad.
    Angle,
    /// SI unit: rad/m.
    TurnRate,
    /// SI unit: s.
    Time,
    /// A number alone.
    Number,
}

impl Dimension {
    /// Its SI unit.
    pub const fn si(self) -> Unit {
        match self {
            Self::Force => Unit::Newton,
            Self::Torque => Unit::NewtonMetre,
            Self::Pressure => Unit::Pascal,
            Self::Speed => Unit::MetrePerSecond,
            Self::Length => Unit::Metre,
            Self::RotarySpeed => Unit::RadianPerSecond,
            Self::Acceleration => Unit::MetrePerSecondSquared,
            Self::Angle => Unit::Radian,
            Self::TurnRate => Unit::RadianPerMetre,
            Self::Time => Unit::Second,
            Self::Number => Unit::One,
        }
    }

    /// The unit in which people know a rig's values, for tables.
    pub const fn known_in(self) -> Unit {
        match self {
            Self::Force => Unit::Kilonewton,
            Self::Torque => Unit::KilonewtonMetre,
            Self::Pressure => Unit::Megapascal,
            Self::Speed => Unit::MetrePerHour,
            Self::RotarySpeed => Unit::TurnPerMinute,
            Self::Angle => Unit::Degree,
            Self::TurnRate => Unit::DegreePerMetre,
            Self::Length | Self::Acceleration | Self::Time | Self::Number => self.si(),
        }
    }

    /// The units of this dimension, by their names in files, for messages: `N, kN, ...`.
    pub fn units(self) -> String {
        let of_this = Unit::ALL.into_iter().filter(|unit| unit.dimension() == self);
        of_this.map(Unit::name).collect::<Vec<_>>().join(", ")
    }
}

macro_rules! units {
    ($($(#[$doc:meta])* $unit:ident $name:literal $($alias:literal)* in $dimension:ident: $to_si:expr;)*) => {
        /// A unit.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Unit {
            $($(#[$doc])* #[serde(rename = $name $(, alias = $alias)*)] $unit,)*
        }

        impl Unit {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$unit),*];

            /// The name in files and on displays.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$unit => $name,)* }
            }

            /// What it measures.
            pub const fn dimension(self) -> Dimension {
                match self { $(Self::$unit => Dimension::$dimension,)* }
            }

            /// A value in this unit, in the SI unit of its dimension.
            pub fn to_si(self, value: f64) -> f64 {
                match self { $(Self::$unit => ($to_si)(value),)* }
            }
        }
    };
}

/// A value as it is.
fn same(value: f64) -> f64 {
    value
}

units! {
    /// Newton.
    Newton "N" in Force: same;
    /// Kilonewton.
    Kilonewton "kN" in Force: kn_to_n;
    /// Decanewton: 10 N.
    Decanewton "daN" in Force: |value: f64| value * 10.0;
    /// Thousand decanewtons, 10 kN; WITS calls it KDN.
    Kilodecanewton "kdaN" "KDN" in Force: |value: f64| kn_to_n(value * 10.0);
    /// Kilogram-force.
    KilogramForce "kgf" in Force: |value: f64| kn_to_n(kgf_to_kn(value));
    /// Tonne-force: a thousand kilograms-force.
    TonneForce "tf" "t" in Force: |value: f64| kn_to_n(tf_to_kn(value));
    /// Pound-force.
    PoundForce "lbf" in Force: |value: f64| kn_to_n(lbf_to_kn(value));
    /// Thousand pounds-force.
    Kilopound "klbf" in Force: |value: f64| kn_to_n(klbf_to_kn(value));
    /// Newton metre.
    NewtonMetre "N.m" in Torque: same;
    /// Kilonewton metre.
    KilonewtonMetre "kN.m" in Torque: kn_to_n;
    /// Thousand decanewton metres, 10 kN m.
    KilodecanewtonMetre "kdaN.m" in Torque: |value: f64| kn_to_n(value * 10.0);
    /// Foot-pound-force.
    FootPound "ft.lbf" in Torque: |value: f64| kn_to_n(kft_lbf_to_kn_m(value / 1e3));
    /// Thousand foot-pounds-force.
    KilofootPound "kft.lbf" in Torque: |value: f64| kn_to_n(kft_lbf_to_kn_m(value));
    /// Pascal.
    Pascal "Pa" in Pressure: same;
    /// Kilopascal.
    Kilopascal "kPa" in Pressure: |value: f64| value * 1e3;
    /// Megapascal.
    Megapascal "MPa" in Pressure: mpa_to_pa;
    /// Bar.
    Bar "bar" in Pressure: |value: f64| value * 1e5;
    /// Pounds-force per square inch.
    Psi "psi" in Pressure: |value: f64| mpa_to_pa(psi_to_mpa(value));
    /// Metres per second.
    MetrePerSecond "m/s" in Speed: same;
    /// Metres per minute.
    MetrePerMinute "m/min" in Speed: |value: f64| value / 60.0;
    /// Metres per hour.
    MetrePerHour "m/h" "m/hr" in Speed: m_per_h_to_m_per_s;
    /// Feet per minute.
    FootPerMinute "ft/min" in Speed: |value: f64| ft_to_m(value) / 60.0;
    /// Feet per hour.
    FootPerHour "ft/h" "ft/hr" in Speed: |value: f64| m_per_h_to_m_per_s(ft_to_m(value));
    /// Metre.
    Metre "m" in Length: same;
    /// Millimetre.
    Millimetre "mm" in Length: |value: f64| value / 1e3;
    /// Foot.
    Foot "ft" in Length: ft_to_m;
    /// Radians per second.
    RadianPerSecond "rad/s" in RotarySpeed: same;
    /// Turns per minute.
    TurnPerMinute "r/min" "rpm" in RotarySpeed: rpm_to_rad_per_s;
    /// Turns per second.
    Hertz "Hz" in RotarySpeed: |value: f64| rpm_to_rad_per_s(value * 60.0);
    /// Metres per second squared.
    MetrePerSecondSquared "m/s2" in Acceleration: same;
    /// Standard gravity: 9.80665 m/s2.
    StandardGravity "g" in Acceleration: standard_gravities_to_m_per_s2;
    /// Radian.
    Radian "rad" in Angle: same;
    /// Degree.
    Degree "deg" in Angle: deg_to_rad;
    /// Radians per metre.
    RadianPerMetre "rad/m" in TurnRate: same;
    /// Degrees per metre.
    DegreePerMetre "deg/m" in TurnRate: deg_to_rad;
    /// Degrees per 30 metres.
    DegreePerThirtyMetres "deg/30m" in TurnRate: |value: f64| deg_to_rad(value) / 30.0;
    /// Degrees per 100 feet.
    DegreePerHundredFeet "deg/100ft" in TurnRate: |value: f64| deg_to_rad(value) / ft_to_m(100.0);
    /// Second.
    Second "s" in Time: same;
    /// A number alone.
    One "1" in Number: same;
}

impl Unit {
    /// An SI value in this unit: all units are proportional to that of SI.
    pub fn from_si(self, value: f64) -> f64 {
        value / self.to_si(1.0)
    }

    /// The unit of that name or of one of its other names.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::deserialize(serde::de::value::StrDeserializer::<serde::de::value::Error>::new(name)).ok()
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kilodecanewton_is_ten_kilonewtons_and_no_kilonewton() {
        assert_eq!(Unit::of_name("KDN"), Some(Unit::Kilodecanewton));
        assert_eq!(Unit::Kilodecanewton.to_si(12.0), 120e3);
        assert_eq!(Unit::Kilodecanewton.to_si(1.0), 10.0 * Unit::Kilonewton.to_si(1.0));
    }

    #[test]
    fn units_convert_both_ways_and_have_their_dimension() {
        for unit in Unit::ALL {
            assert_eq!(Unit::of_name(unit.name()), Some(unit));
            assert_eq!(unit.dimension().si().dimension(), unit.dimension());
            assert_eq!(unit.dimension().si().to_si(3.5), 3.5);
            let back = unit.from_si(unit.to_si(12.5));
            assert!((back - 12.5).abs() < 1e-12, "{unit}: {back}");
        }
        assert_eq!(Unit::Foot.to_si(10.0), 3.048);
        assert_eq!(Unit::StandardGravity.to_si(1.0), 9.806_65);
        // An arc of 3.2 m turns by 17.9 deg/m: 90 deg over its 5.03 m.
        assert!((Unit::DegreePerMetre.from_si(1.0 / 3.2) - 90.0 / (1.6 * std::f64::consts::PI)).abs() < 1e-12);
        assert!((Unit::DegreePerThirtyMetres.to_si(30.0) - Unit::DegreePerMetre.to_si(1.0)).abs() < 1e-15);
        assert!((Unit::DegreePerHundredFeet.to_si(30.48) - Unit::DegreePerMetre.to_si(1.0)).abs() < 1e-15);
        // 1 psi = 6.894757 kPa, 1 ft.lbf = 1.355818 N m (NIST SP 811, B.8), to their seven digits.
        assert!((Unit::Psi.to_si(1.0) - 6_894.757).abs() < 5e-4);
        assert!((Unit::FootPound.to_si(1.0) - 1.355_818).abs() < 5e-7);
    }
}
