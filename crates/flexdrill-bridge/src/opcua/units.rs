//! Units as OPC UA has them: by the codes of UNECE Recommendation 20.

use ::opcua::types::{EUInformation, LocalizedText};
use flexdrill_core::inputs::Unit;

/// The namespace of these codes.
const UNECE: &str = "http://www.opcfoundation.org/UA/units/un/cefact";

/// The code of a unit; `None` where the recommendation has none.
pub const fn code(unit: Unit) -> Option<&'static str> {
    Some(match unit {
        Unit::Newton => "NEW",
        Unit::Kilonewton => "B47",
        Unit::KilogramForce => "B37",
        Unit::PoundForce => "C78",
        Unit::Kilopound => "M75",
        Unit::NewtonMetre => "NU",
        Unit::KilonewtonMetre => "B48",
        Unit::FootPound => "M92",
        Unit::Pascal => "PAL",
        Unit::Kilopascal => "KPA",
        Unit::Megapascal => "MPA",
        Unit::Bar => "BAR",
        Unit::Psi => "PS",
        Unit::MetrePerSecond => "MTS",
        Unit::MetrePerMinute => "2X",
        Unit::MetrePerHour => "M60",
        Unit::FootPerMinute => "FR",
        Unit::FootPerHour => "K14",
        Unit::Metre => "MTR",
        Unit::Millimetre => "MMT",
        Unit::Foot => "FOT",
        Unit::RadianPerSecond => "2A",
        Unit::TurnPerMinute => "RPM",
        Unit::Hertz => "HTZ",
        Unit::MetrePerSecondSquared => "MSK",
        Unit::StandardGravity => "K40",
        Unit::Radian => "C81",
        Unit::Degree => "DD",
        Unit::RadianPerMetre => "C84",
        Unit::DegreePerMetre => "H27",
        Unit::Second => "SEC",
        Unit::One => "C62",
        // Units of oil fields that the recommendation does not list: their text alone names them.
        Unit::Decanewton
        | Unit::Kilodecanewton
        | Unit::TonneForce
        | Unit::KilodecanewtonMetre
        | Unit::KilofootPound
        | Unit::DegreePerThirtyMetres
        | Unit::DegreePerHundredFeet => return None,
    })
}

/// The number of a code: its characters as the digits of a number to the base 256 (Part 8, 5.6.3).
fn number(code: &str) -> i32 {
    code.bytes().fold(0, |number, byte| (number << 8) | i32::from(byte))
}

/// A unit for the property `EngineeringUnits`.
pub fn engineering_units(unit: Unit) -> EUInformation {
    let name = match unit {
        // A reader sees the name next to the value.
        Unit::One => "",
        _ => unit.name(),
    };
    EUInformation {
        namespace_uri: UNECE.into(),
        unit_id: code(unit).map_or(-1, number),
        display_name: LocalizedText::new("", name),
        description: LocalizedText::new("", unit.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_that_the_foundation_publishes() {
        // UNECE_to_OPCUA.csv of the OPC Foundation.
        for (unit, number) in [
            (Unit::Newton, 5_129_559),
            (Unit::Metre, 5_067_858),
            (Unit::Second, 5_457_219),
            (Unit::MetrePerSecond, 5_067_859),
            (Unit::Degree, 17_476),
            (Unit::One, 4_404_786),
            (Unit::TurnPerMinute, 5_394_509),
        ] {
            assert_eq!(engineering_units(unit).unit_id, number, "{unit}");
        }
        assert_eq!(engineering_units(Unit::Kilodecanewton).unit_id, -1);
    }

    #[test]
    fn every_si_unit_has_a_code_and_no_two_share_one() {
        let mut seen = std::collections::BTreeSet::new();
        for unit in Unit::ALL {
            assert!(code(unit.dimension().si()).is_some());
            assert!(code(unit).is_none_or(|code| seen.insert(code)), "{unit}");
        }
    }
}
