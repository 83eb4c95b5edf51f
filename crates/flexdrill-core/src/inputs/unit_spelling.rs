//! The spellings of units that recorders, logs and people write: one list for logs, WITS, OPC UA and YAML.

use super::Unit;

/// Spellings without case, blanks, dots, hyphens and brackets; the names and other names of [`Unit`] are read without
/// this list. A word that means several units is in [`ambiguity`] and not here.
const SPELLINGS: &[(Unit, &[&str])] = &[
    (Unit::Newton, &["newton", "newtons"]),
    (Unit::Kilonewton, &["kn", "kilonewton", "kilonewtons"]),
    (Unit::Decanewton, &["dan", "decanewton"]),
    (Unit::Kilodecanewton, &["kdan", "kdn", "1000dan"]),
    (Unit::KilogramForce, &["kgf", "kg", "kgs"]),
    (
        Unit::TonneForce,
        &["tf", "t", "te", "mt", "tonne", "tonnes", "tonf", "metricton"],
    ),
    (Unit::PoundForce, &["lbf", "lb", "lbs", "lbsf", "pound", "pounds"]),
    (
        Unit::Kilopound,
        &[
            "klbf", "klb", "klbs", "klbsf", "kip", "kips", "1000lbf", "1000lb", "1000lbs",
        ],
    ),
    (Unit::NewtonMetre, &["nm"]),
    (Unit::KilonewtonMetre, &["knm"]),
    (Unit::KilodecanewtonMetre, &["kdanm", "kdnm"]),
    (
        Unit::FootPound,
        &[
            "ftlbf",
            "ftlb",
            "ftlbs",
            "ftlbsf",
            "lbfft",
            "lbft",
            "lbsft",
            "footpound",
            "footpounds",
        ],
    ),
    (
        Unit::KilofootPound,
        &[
            "kftlbf",
            "kftlb",
            "kftlbs",
            "kftlbsf",
            "klbfft",
            "klbft",
            "klbsft",
            "1000ftlbf",
            "1000ftlb",
            "1000ftlbs",
        ],
    ),
    (Unit::Pascal, &["pa"]),
    (Unit::Kilopascal, &["kpa"]),
    (Unit::Megapascal, &["mpa"]),
    (Unit::Bar, &["bar", "bars"]),
    (Unit::Psi, &["psi", "psig", "lbf/in2"]),
    (Unit::MetrePerSecond, &["m/s", "m/sec"]),
    (Unit::MetrePerMinute, &["m/min"]),
    (Unit::MetrePerHour, &["m/h", "m/hr", "m/hour"]),
    (Unit::FootPerMinute, &["ft/min", "fpm"]),
    (Unit::FootPerHour, &["ft/h", "ft/hr", "ft/hour", "fph", "ftph"]),
    (Unit::Metre, &["m", "meter", "meters", "metre", "metres"]),
    (Unit::Millimetre, &["mm"]),
    (Unit::Foot, &["ft", "foot", "feet"]),
    (Unit::RadianPerSecond, &["rad/s", "rad/sec"]),
    (
        Unit::TurnPerMinute,
        &["r/min", "rpm", "rev/min", "revs/min", "tr/min", "u/min", "1/min"],
    ),
    (Unit::Hertz, &["hz", "rev/s", "rps"]),
    (Unit::MetrePerSecondSquared, &["m/s2", "m/s^2"]),
    (Unit::StandardGravity, &["g"]),
    (Unit::Radian, &["rad", "rads"]),
    (Unit::Degree, &["deg", "degs", "degree", "degrees", "dega", "°"]),
    (Unit::RadianPerMetre, &["rad/m"]),
    (Unit::DegreePerMetre, &["deg/m", "°/m"]),
    (Unit::DegreePerThirtyMetres, &["deg/30m", "°/30m"]),
    (Unit::DegreePerHundredFeet, &["deg/100ft", "°/100ft"]),
    (Unit::Second, &["s", "sec", "secs", "second", "seconds"]),
];

/// The spelling without what does not distinguish units.
fn key(spelling: &str) -> String {
    let plain = spelling.chars().filter(|character| {
        !character.is_whitespace() && !matches!(character, '.' | '-' | '_' | '*' | '·' | '[' | ']' | '(' | ')')
    });
    plain.flat_map(char::to_lowercase).collect()
}

/// Why a word is no unit here, although people write it for several; `None` where it is not such a word.
fn ambiguity(spelling: &str) -> Option<&'static str> {
    // Case distinguishes milli from mega.
    if spelling.trim().starts_with("mP") {
        return Some("mPa is a millipascal: write MPa for a megapascal");
    }
    match key(spelling).as_str() {
        "ton" | "tons" => Some(
            "a ton may be 8.90 kN (short ton of 2000 lbf), 9.81 kN (tonne) or 9.96 kN (long ton): write tf for a tonne, or \
             klbf with scale 2 for a short ton",
        ),
        "mph" => Some("mph may be metres or miles per hour: write m/h"),
        "mlbs" | "mlb" | "mlbf" => Some("M may be a thousand or a million: write klbf for a thousand lbf"),
        "psia" => Some("psia includes the atmosphere of 14.7 psi: subtract it, and write psi"),
        _ => None,
    }
}

impl Unit {
    /// The unit of a spelling, such as `RPM`, `rev/min`, `klbs`, `kip`, `ft-lbf` or `KDN`; `None` where it has no unit
    /// here or several.
    pub fn of_spelling(spelling: &str) -> Option<Self> {
        if let Some(unit) = Self::of_name(spelling.trim()) {
            return Some(unit);
        }
        if ambiguity(spelling).is_some() {
            return None;
        }
        let key = key(spelling);
        let found = SPELLINGS
            .iter()
            .find(|(_, spellings)| spellings.contains(&key.as_str()));
        found.map(|(unit, _)| *unit)
    }

    /// What to write in place of a spelling that means several units; `None` where it does not.
    pub fn ambiguous_spelling(spelling: &str) -> Option<&'static str> {
        ambiguity(spelling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_recorders_and_people_are_read() {
        for (spelling, unit) in [
            ("RPM", Unit::TurnPerMinute),
            ("rev/min", Unit::TurnPerMinute),
            ("klbs", Unit::Kilopound),
            ("KLB", Unit::Kilopound),
            ("kip", Unit::Kilopound),
            ("1000 lbf", Unit::Kilopound),
            ("daN", Unit::Decanewton),
            ("KDN", Unit::Kilodecanewton),
            ("kDaN", Unit::Kilodecanewton),
            ("tonne", Unit::TonneForce),
            ("ft-lbf", Unit::FootPound),
            ("ft lbs", Unit::FootPound),
            ("kN-m", Unit::KilonewtonMetre),
            ("kNm", Unit::KilonewtonMetre),
            ("[kft.lbf]", Unit::KilofootPound),
            ("ft/hr", Unit::FootPerHour),
            ("FT/HR", Unit::FootPerHour),
            ("PSI", Unit::Psi),
            ("KPA", Unit::Kilopascal),
            ("m/hr", Unit::MetrePerHour),
        ] {
            assert_eq!(Unit::of_spelling(spelling), Some(unit), "{spelling}");
        }
    }

    #[test]
    fn every_name_is_a_spelling_and_no_spelling_stands_twice() {
        let mut seen = std::collections::BTreeSet::new();
        for unit in Unit::ALL {
            assert_eq!(Unit::of_spelling(unit.name()), Some(unit));
        }
        for (unit, spellings) in SPELLINGS {
            for spelling in *spellings {
                assert_eq!(key(spelling), *spelling);
                assert_eq!(Unit::of_spelling(spelling), Some(*unit), "{spelling}");
                assert!(seen.insert(*spelling), "{spelling}");
            }
        }
    }

    #[test]
    fn a_word_of_several_units_is_none_and_says_what_to_write() {
        for spelling in ["ton", "Tons", "mph", "mPa", "Mlbs", "psia"] {
            assert_eq!(Unit::of_spelling(spelling), None, "{spelling}");
            assert!(Unit::ambiguous_spelling(spelling).is_some_and(|words| words.contains("write")));
        }
        for spelling in ["", "furlong", "kNN", "m/s/s/s"] {
            assert_eq!(Unit::of_spelling(spelling), None, "{spelling}");
            assert_eq!(Unit::ambiguous_spelling(spelling), None, "{spelling}");
        }
    }
}
