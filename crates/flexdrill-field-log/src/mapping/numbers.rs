//! How a log writes its numbers.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// The decimal separator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Decimal {
    /// `12.5`.
    #[default]
    Point,
    /// `12,5`. A single point in a number is refused then: `1.234` may be a thousand or one.
    Comma,
}

impl Decimal {
    /// The character.
    pub(crate) const fn mark(self) -> char {
        match self {
            Self::Point => '.',
            Self::Comma => ',',
        }
    }

    /// Parses a number of the log; `None` when the text is no number in this notation. Thousands are read where only one
    /// reading is possible: `1,234.5`, `1,234,567`, and groups between blanks or apostrophes.
    pub(crate) fn parse(self, text: &str) -> Option<f64> {
        let plain = match self {
            Self::Point => text.parse().ok(),
            Self::Comma if text.contains('.') => None,
            Self::Comma => text.replacen(',', ".", 1).parse().ok(),
        };
        plain.or_else(|| grouped(text, self, None))
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
            Self::Point if grouped(text, self, Some(',')).is_some() => {
                "; if its comma is a decimal comma, set `decimal: comma` in the mapping, if it separates thousands, set \
                 `thousands: \",\"`"
            }
            Self::Point => "; if its comma is a decimal comma, set `decimal: comma` in the mapping",
            Self::Comma => {
                "; under `decimal: comma` a point may separate thousands: set `thousands: \".\"` in the mapping if it does, \
                 remove `decimal: comma` if this is a decimal point"
            }
        }
    }
}

/// The notation of numbers: decimal separator, and the separator of thousands where the mapping names it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Notation {
    pub(crate) decimal: Decimal,
    pub(crate) thousands: Option<char>,
}

impl Notation {
    /// Parses a number; `None` when the text is none in this notation.
    pub(crate) fn parse(self, text: &str) -> Option<f64> {
        // A separator that the mapping names comes first: it is certain, and `1,234` is then no decimal comma.
        let named = self
            .thousands
            .and_then(|separator| grouped(text, self.decimal, Some(separator)));
        named.or_else(|| self.decimal.parse(text))
    }
}

/// A number whose whole part is in groups of three digits. `named` is the separator that the mapping gives, which is
/// believed between any groups; a comma or point that it does not give needs a second sign that it separates thousands.
fn grouped(text: &str, decimal: Decimal, named: Option<char>) -> Option<f64> {
    let (mark, other) = match decimal {
        Decimal::Point => (Decimal::Point.mark(), ','),
        Decimal::Comma => (Decimal::Comma.mark(), '.'),
    };
    let (sign, unsigned) = match text.strip_prefix(['-', '+']) {
        Some(rest) if text.starts_with('-') => (-1.0, rest),
        Some(rest) => (1.0, rest),
        None => (1.0, text),
    };
    let (whole, fraction) = match unsigned.split_once(mark) {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (unsigned, None),
    };
    let separator = whole.chars().find(|character| !character.is_ascii_digit())?;
    let groups: Vec<&str> = whole.split(separator).collect();
    let believed = match separator {
        ' ' | '\'' | '’' => true,
        _ if named == Some(separator) => true,
        _ => separator == other && (fraction.is_some() || groups.len() > 2),
    };
    let digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let (first, rest) = groups.split_first()?;
    let in_threes =
        (1..=3).contains(&first.len()) && digits(first) && rest.iter().all(|group| group.len() == 3 && digits(group));
    if !believed || !in_threes || !fraction.is_none_or(digits) {
        return None;
    }
    let plain = format!("{}.{}", groups.concat(), fraction.unwrap_or("0"));
    plain.parse::<f64>().ok().map(|value| sign * value)
}

/// A text with plain blanks in place of no-break ones, which spreadsheets and reports write next to numbers.
pub(crate) fn plain_blanks(line: &[u8]) -> Cow<'_, [u8]> {
    // In UTF-8: U+00A0, U+2007 and U+202F.
    const NO_BREAK: [&[u8]; 3] = [b"\xc2\xa0", b"\xe2\x80\x87", b"\xe2\x80\xaf"];
    let length_at = |rest: &[u8]| {
        NO_BREAK
            .iter()
            .find(|blank| rest.starts_with(blank))
            .map(|blank| blank.len())
    };
    if !line.iter().any(|byte| matches!(byte, 0xc2 | 0xe2)) {
        return Cow::Borrowed(line);
    }
    let mut plain = Vec::with_capacity(line.len());
    let mut rest = line;
    while let Some((byte, after)) = rest.split_first() {
        match length_at(rest) {
            Some(length) => {
                plain.push(b' ');
                rest = rest.get(length..).unwrap_or_default();
            }
            None => {
                plain.push(*byte);
                rest = after;
            }
        }
    }
    Cow::Owned(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_read_where_only_one_reading_is_possible() {
        for (decimal, text, value) in [
            (Decimal::Point, "1,234.5", Some(1234.5)),
            (Decimal::Point, "-1,234,567", Some(-1_234_567.0)),
            (Decimal::Point, "1 234.5", Some(1234.5)),
            (Decimal::Point, "1'234", Some(1234.0)),
            (Decimal::Point, "1,234", None),
            (Decimal::Point, "12,34.5", None),
            (Decimal::Point, "1,2345.5", None),
            (Decimal::Point, "1 23", None),
            (Decimal::Point, "1,234 567.5", None),
            (Decimal::Comma, "1.234,5", Some(1234.5)),
            (Decimal::Comma, "1 234,5", Some(1234.5)),
            (Decimal::Comma, "1.234", None),
            (Decimal::Point, "", None),
            (Decimal::Point, ",", None),
            (Decimal::Point, "-", None),
        ] {
            assert_eq!(decimal.parse(text), value, "{text:?}");
        }
        let named = Notation {
            decimal: Decimal::Point,
            thousands: Some(','),
        };
        assert_eq!(named.parse("1,234"), Some(1234.0));
        assert_eq!(named.parse("12.5"), Some(12.5));
        assert_eq!(named.parse("1,23"), None);
        assert!(Decimal::Point.hint("1,234").contains("`thousands: \",\"`"));
    }

    #[test]
    fn no_break_blanks_are_blanks() {
        assert_eq!(&*plain_blanks("\u{a0}1\u{202f}234\u{2007}".as_bytes()), b" 1 234 ");
        assert_eq!(&*plain_blanks("°\u{e2}x".as_bytes()), "°\u{e2}x".as_bytes());
        assert_eq!(&*plain_blanks(b"\xc2"), b"\xc2");
    }
}
