//! What a column's name and unit say, by the vocabulary of recorders, logs and people.

use super::Quantity;
use super::vocabulary::{OTHERS, PLAIN, QUANTITIES};
use flexdrill_core::inputs::{Dimension, Unit};

/// What a name says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Meaning {
    /// One quantity, and nothing else.
    Quantity(Quantity),
    /// A depth without the word that says whose.
    Depth,
    /// Something else, in words.
    Other(&'static str),
    /// A quantity with further words that may change it.
    Partly(Quantity, String),
    /// Something that is not known here.
    Unknown,
    /// Nothing, such as `CH3`.
    Nothing,
}

/// What the log says about a unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum GivenUnit {
    /// A unit, and whether its spelling is used for nothing but its quantity.
    Known(Unit),
    /// A spelling that means several units, with what to write.
    Several(String, &'static str),
    /// A spelling that is not known.
    Unknown(String),
    /// Nothing.
    None,
}

/// The words of a name: split at blanks and marks, before a capital letter behind a small one, and where two known words
/// stand without anything between them.
pub(crate) fn words(name: &str) -> Vec<String> {
    let mut spaced = String::with_capacity(name.len() + 8);
    let mut previous = ' ';
    for character in name.chars() {
        if character.is_uppercase() && previous.is_lowercase() {
            spaced.push(' ');
        }
        spaced.push(if character.is_alphanumeric() || character == '/' {
            character
        } else {
            ' '
        });
        previous = character;
    }
    let mut words = Vec::new();
    for word in spaced.to_lowercase().split_whitespace() {
        match joined(word, 0) {
            Some(parts) => words.extend(parts),
            None => words.push(word.to_owned()),
        }
    }
    words
}

fn is_known(word: &str) -> bool {
    QUANTITIES
        .iter()
        .any(|words| words.with.contains(&word) || words.names.iter().any(|name| name.contains(&word)))
        || PLAIN.contains(&word)
        || OTHERS.iter().any(|(_, words)| words.contains(&word))
        || word == "depth"
}

/// A word that is several known ones without blanks, such as `topdriverpm`.
fn joined(word: &str, depth: usize) -> Option<Vec<String>> {
    if is_known(word) {
        return Some(vec![word.to_owned()]);
    }
    // Five words are the longest name; short parts match by chance.
    if depth >= 5 {
        return None;
    }
    (2..word.len().saturating_sub(1)).rev().find_map(|end| {
        let (head, tail) = (word.get(..end)?, word.get(end..)?);
        if !is_known(head) || tail.len() < 2 {
            return None;
        }
        let mut parts = vec![head.to_owned()];
        parts.extend(joined(tail, depth + 1)?);
        Some(parts)
    })
}

/// What a name and the unit of its column say. `written` is the unit that the log gives apart from the name.
pub(crate) fn meaning(name: &str, written: &str) -> (Meaning, GivenUnit) {
    let without_brackets = without_unit_in_brackets(name);
    let all = words(without_brackets);
    let given = given(written);
    // The name as it is comes first: the last word of `top_drive_rpm` is a unit and the quantity's name.
    let whole = of_words(&all);
    let (rest, unit_behind) = without_unit_behind(&all, without_brackets);
    let unit_by_name = unit_behind.map_or(GivenUnit::None, GivenUnit::Known);
    let (meaning, by_name) = match whole {
        Meaning::Quantity(quantity) => (
            Meaning::Quantity(quantity),
            // A speed that is called RPM is one in r/min.
            match unit_by_name {
                GivenUnit::Known(unit) if quantity.dimension() == unit.dimension() => GivenUnit::Known(unit),
                _ if quantity == Quantity::RotarySpeed && all.iter().any(|word| word == "rpm") => {
                    GivenUnit::Known(Unit::TurnPerMinute)
                }
                _ => GivenUnit::None,
            },
        ),
        whole if !rest.is_empty() && rest.len() < all.len() => match (of_words(&rest), whole) {
            // The speed of the bit is not that of the drive: only a word that says nothing may stand before RPM.
            (Meaning::Nothing, Meaning::Partly(quantity, word)) if !says_nothing(&rest) => {
                (Meaning::Partly(quantity, word), unit_by_name)
            }
            (rest, _) => (rest, unit_by_name),
        },
        other => (other, GivenUnit::None),
    };
    let meaning = match meaning {
        Meaning::Nothing if !says_nothing(&rest) => Meaning::Unknown,
        other => other,
    };
    // Where two spellings of the log disagree, neither is believed.
    let unit = match (given, by_name) {
        (GivenUnit::None, by_name) => by_name,
        (GivenUnit::Known(written), GivenUnit::Known(named)) if written != named => {
            GivenUnit::Unknown(format!("{written} and {named}"))
        }
        (given, _) => given,
    };
    (meaning, unit)
}

/// What the words of a name mean.
fn of_words(words: &[String]) -> Meaning {
    let has = |wanted: &[&str]| wanted.iter().all(|wanted| words.iter().any(|word| word == wanted));
    let mut partly = None;
    for entry in QUANTITIES {
        if !entry.names.iter().any(|name| has(name)) {
            continue;
        }
        let belongs = |word: &&String| {
            let word = word.as_str();
            let in_names = entry.names.iter().any(|name| name.contains(&word));
            in_names || entry.with.contains(&word) || PLAIN.contains(&word)
        };
        match words.iter().find(|word| !belongs(word)) {
            None => return Meaning::Quantity(entry.quantity),
            Some(word) => partly = partly.or_else(|| Some((entry.quantity, word.clone()))),
        }
    }
    for (meaning, marks) in OTHERS {
        if words.iter().any(|word| marks.contains(&word.as_str())) {
            return Meaning::Other(meaning);
        }
    }
    if let Some((quantity, word)) = partly {
        return Meaning::Partly(quantity, word);
    }
    let is_depth = |word: &String| word.starts_with("dept") || word == "md";
    if words.iter().any(is_depth)
        && words
            .iter()
            .all(|word| is_depth(word) || matches!(&**word, "measured" | "the"))
    {
        return Meaning::Depth;
    }
    Meaning::Nothing
}

/// Whether words are mere marks of a channel: letters with digits, one or two letters, or a word for any channel.
fn says_nothing(words: &[String]) -> bool {
    const ANY: [&str; 12] = [
        "chan", "channel", "col", "column", "tag", "sensor", "input", "var", "variable", "signal", "value", "data",
    ];
    words.iter().all(|word| {
        ANY.contains(&word.as_str())
            || word.chars().count() <= 2
            || word.chars().any(|character| character.is_ascii_digit()) && word.chars().count() <= 6
    })
}

/// The unit that is written apart from the name.
fn given(written: &str) -> GivenUnit {
    let written = written.trim();
    if written.is_empty() {
        return GivenUnit::None;
    }
    match (Unit::of_spelling(written), Unit::ambiguous_spelling(written)) {
        (Some(unit), _) => GivenUnit::Known(unit),
        (None, Some(words)) => GivenUnit::Several(written.to_owned(), words),
        (None, None) => GivenUnit::Unknown(written.to_owned()),
    }
}

/// The name without brackets at its end.
fn without_unit_in_brackets(name: &str) -> &str {
    let name = name.trim();
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let Some((before, _)) = name.strip_suffix(close).and_then(|name| name.rsplit_once(open)) {
            return before;
        }
    }
    name
}

/// The words before a unit at the end of a name, such as `hookload_klbf` or `rop_m_per_h`, and the unit.
fn without_unit_behind(words: &[String], name: &str) -> (Vec<String>, Option<Unit>) {
    // Known words were split, so the unit is looked for in the words as written.
    let written: Vec<String> = name
        .split(|character: char| !character.is_alphanumeric() && character != '/')
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect();
    for count in (1..=3).rev().filter(|count| *count < written.len()) {
        let (head, tail) = written.split_at(written.len() - count);
        let joined = tail.join(" ");
        let mut spellings = vec![joined.clone(), tail.join("/")];
        if tail.iter().any(|word| word == "per") {
            spellings.push(joined.replace(" per ", "/"));
        }
        if let Some(unit) = spellings.iter().find_map(|spelling| Unit::of_spelling(spelling))
            // A number alone is no unit here.
            && unit.dimension() != Dimension::Number
        {
            return (self::words(&head.join(" ")), Some(unit));
        }
    }
    (words.to_vec(), None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_recorders_and_people_are_read() {
        for (name, written, quantity, unit) in [
            ("Rotary Speed", "rpm", Quantity::RotarySpeed, Some(Unit::TurnPerMinute)),
            ("top_drive_rpm", "", Quantity::RotarySpeed, Some(Unit::TurnPerMinute)),
            ("TDRPM", "", Quantity::RotarySpeed, Some(Unit::TurnPerMinute)),
            ("RPMA", "", Quantity::RotarySpeed, None),
            ("WOB (klbs)", "klbs", Quantity::WeightOnBit, Some(Unit::Kilopound)),
            ("WeightOnBit", "", Quantity::WeightOnBit, None),
            ("hookload_klbf", "", Quantity::HookLoad, Some(Unit::Kilopound)),
            ("Hook Load [kN]", "kN", Quantity::HookLoad, Some(Unit::Kilonewton)),
            ("top_drive_torque_ftlb", "", Quantity::Torque, Some(Unit::FootPound)),
            ("Torque_kN_m", "", Quantity::Torque, Some(Unit::KilonewtonMetre)),
            ("rop_m_per_h", "", Quantity::RateOfPenetration, Some(Unit::MetrePerHour)),
            (
                "ROP avg ft/hr",
                "",
                Quantity::RateOfPenetration,
                Some(Unit::FootPerHour),
            ),
            ("spp_psi", "", Quantity::StandpipePressure, Some(Unit::Psi)),
            (
                "Standpipe Pressure",
                "kPa",
                Quantity::StandpipePressure,
                Some(Unit::Kilopascal),
            ),
            ("BITDEPTH", "M", Quantity::BitDepth, Some(Unit::Metre)),
            ("DMEA", "", Quantity::HoleDepth, None),
        ] {
            let (meaning, found) = meaning(name, written);
            assert_eq!(meaning, Meaning::Quantity(quantity), "{name}");
            let expected = unit.map_or(GivenUnit::None, GivenUnit::Known);
            assert_eq!(found, expected, "{name}");
        }
    }

    #[test]
    fn what_is_easily_taken_for_an_input_is_none() {
        for name in [
            "SPM",
            "spm1",
            "Pump Strokes",
            "Pump 1 SPM",
            "Motor RPM",
            "Downhole WOB",
            "RPM setpoint",
            "WOB limit",
            "Max Torque",
            "Makeup Torque",
            "Block Height",
            "block_height_ft",
            "Casing Pressure",
            "flow_out_pct",
            "Differential Pressure",
            "incl_deg",
            "azi_deg",
            "instance",
            "rig_state",
            "Pump RPM",
            "Total RPM",
            "Delta Torque",
        ] {
            assert!(
                matches!(meaning(name, "").0, Meaning::Other(_)),
                "{name}: {:?}",
                meaning(name, "").0
            );
        }
        for name in ["Bit RPM", "RPM xyz", "Kelly torque", "WOB 2"] {
            assert!(
                matches!(meaning(name, "").0, Meaning::Partly(..)),
                "{name}: {:?}",
                meaning(name, "").0
            );
        }
        for name in ["CH1", "a", "", "µ", "Channel 7", "ch2_rpm"] {
            assert_eq!(meaning(name, "").0, Meaning::Nothing, "{name}");
        }
        for name in ["Lunch", "Temperament", "Elapsed"] {
            assert_eq!(meaning(name, "").0, Meaning::Unknown, "{name}");
        }
        assert_eq!(meaning("Depth", "m").0, Meaning::Depth);
    }

    #[test]
    fn two_units_that_disagree_are_not_believed() {
        assert!(matches!(meaning("hookload_klbf", "kN").1, GivenUnit::Unknown(_)));
        assert!(matches!(meaning("WOB (ton)", "ton").1, GivenUnit::Several(..)));
        assert!(matches!(meaning("WOB", "furlong").1, GivenUnit::Unknown(_)));
    }
}
