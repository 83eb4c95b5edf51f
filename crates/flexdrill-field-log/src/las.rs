//! LAS 1.2 and 2.0 by time: the sections before the data (CWLS, LAS Version 2.0, 2017). Fields of the data are between
//! blanks, and `#` begins a comment.

use crate::FieldLogError;
use crate::lines::Lines;

/// What the sections before the data say.
#[derive(Debug, Default)]
pub(crate) struct Las {
    /// The mnemonics of the curves, in the order of the data's fields.
    pub(crate) curves: csv::ByteRecord,
    /// The unit of each curve, as written.
    pub(crate) units: Vec<String>,
    /// The number that stands for no value.
    pub(crate) null: Option<f64>,
}

/// Whether the content is LAS: its first line that is no comment begins the section of the version.
pub(crate) fn is_las(content: &[u8]) -> bool {
    let first = Lines::of(content).without_comments(b'#').next();
    first.is_some_and(|(_, line)| matches!(line.trim_ascii_start(), [b'~', b'V' | b'v', ..]))
}

/// Reads up to the data, whose lines `lines` has next.
///
/// # Errors
/// When the version is not read, the lines are wrapped, or no data follow.
pub(crate) fn before_data(file: &str, lines: &mut Lines<'_>) -> Result<Las, FieldLogError> {
    let refused = |reason: String| FieldLogError::Las {
        file: file.to_owned(),
        reason,
    };
    let mut las = Las::default();
    let mut section = b' ';
    for (number, line) in lines {
        let line = line.trim_ascii();
        // The letter alone names a section; loggers write different words behind it.
        if let [b'~', letter, ..] = line {
            section = letter.to_ascii_uppercase();
            if section == b'A' {
                if las.curves.is_empty() {
                    return Err(refused("section ~C names no curve before the data".to_owned()));
                }
                return Ok(las);
            }
            continue;
        }
        let line = String::from_utf8_lossy(line);
        let Some(parts) = parts(&line) else { continue };
        match (section, parts.mnemonic.to_ascii_uppercase().as_str()) {
            (b'V', "VERS") if !matches!(parts.value.parse::<f64>(), Ok(version) if version < 3.0) => {
                let version = parts.value;
                return Err(refused(format!(
                    "row {number}: version {version:?}; versions 1.2 and 2.0 are read: export the log as one of them, or as CSV"
                )));
            }
            (b'V', "WRAP") if !parts.value.eq_ignore_ascii_case("NO") => {
                return Err(refused(format!(
                    "row {number}: a row is wrapped over several lines (WRAP {}); export the log without wrapping",
                    parts.value
                )));
            }
            (b'W', "NULL") => las.null = parts.value.parse().ok(),
            (b'C', _) => {
                las.curves.push_field(parts.mnemonic.as_bytes());
                las.units.push(parts.unit.to_owned());
            }
            _ => {}
        }
    }
    Err(refused("no section ~A with data".to_owned()))
}

/// A line of a section: `MNEMONIC.UNIT   VALUE : DESCRIPTION`.
struct Parts<'a> {
    mnemonic: &'a str,
    unit: &'a str,
    value: &'a str,
}

fn parts(line: &str) -> Option<Parts<'_>> {
    let (mnemonic, rest) = line.split_once('.')?;
    let (unit, rest) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    // The description begins after the last colon, since a value may be a time of day.
    let value = rest.rsplit_once(':').map_or(rest, |(value, _)| value);
    Some(Parts {
        mnemonic: mnemonic.trim(),
        unit: unit.trim_end_matches(':'),
        value: value.trim(),
    })
}
