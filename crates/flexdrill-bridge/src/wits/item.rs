//! Items: a record, a number, a value.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// An item's address: `0108` is item 8 of record 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ItemCode {
    /// 0 to 99.
    pub record: u8,
    /// 0 to 99.
    pub item: u8,
}

/// Text that is no address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{text:?} is no item; it needs four digits, two of the record and two of the item, such as \"0108\"")]
pub struct NoItemCode {
    /// The text.
    pub text: String,
}

impl ItemCode {
    /// The address of these numbers, if both have at most two digits.
    pub const fn new(record: u8, item: u8) -> Option<Self> {
        if record > 99 || item > 99 {
            return None;
        }
        Some(Self { record, item })
    }

    /// The address at the begin of a line, and the rest of the line.
    pub fn of_line(line: &[u8]) -> Option<(Self, &[u8])> {
        let (code, rest) = line.split_at_checked(4)?;
        let digit = |index: usize| code[index].is_ascii_digit().then(|| code[index] - b'0');
        let record = 10 * digit(0)? + digit(1)?;
        let item = 10 * digit(2)? + digit(3)?;
        Some((Self { record, item }, rest.trim_ascii()))
    }
}

impl FromStr for ItemCode {
    type Err = NoItemCode;

    fn from_str(text: &str) -> Result<Self, NoItemCode> {
        match Self::of_line(text.as_bytes()) {
            Some((code, rest)) if rest.is_empty() && text.len() == 4 => Ok(code),
            _ => Err(NoItemCode { text: text.to_owned() }),
        }
    }
}

impl TryFrom<String> for ItemCode {
    type Error = NoItemCode;

    fn try_from(text: String) -> Result<Self, NoItemCode> {
        text.parse()
    }
}

impl From<ItemCode> for String {
    fn from(code: ItemCode) -> Self {
        code.to_string()
    }
}

impl fmt::Display for ItemCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}{:02}", self.record, self.item)
    }
}

/// The number of a value, if it is one. A comma is no decimal point: `1,234` may be a thousand.
pub(crate) fn number(text: &[u8]) -> Option<f64> {
    let text = str::from_utf8(text).ok()?;
    // Rust also reads "inf" and "nan", which no rig measures.
    let numeric = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E');
    if !text.bytes().all(numeric) {
        return None;
    }
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// Whether a value means "no value": it is one of `nulls`, or one of them rounded to the digits that the text has. Sources
/// write -999.25 as -999.2, -999.3 or -999. At least three digits must agree, so that 100 is no null of a site with 99.9.
pub(crate) fn is_null(text: &[u8], nulls: &[f64]) -> bool {
    let Some(value) = number(text) else { return false };
    let unit = last_digit(text);
    nulls.iter().any(|null| {
        let difference = (value - null).abs();
        // A thousandth of the last digit covers the error of a number with up to 16 digits.
        difference == 0.0 || (500.0 * unit <= null.abs() && difference <= 0.501 * unit)
    })
}

/// The value of one unit of a number's last digit: 0.01 for 1.25, 10 for 1.25e3.
fn last_digit(text: &[u8]) -> f64 {
    let text = String::from_utf8_lossy(text).to_ascii_lowercase();
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, digits)| digits.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10_f64.powi(exponent.saturating_sub_unsigned(u32::try_from(decimals).unwrap_or(u32::MAX)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_four_digits() {
        let (code, rest) = ItemCode::of_line(b"01083650.40").unwrap();
        assert_eq!((code.record, code.item, rest), (1, 8, b"3650.40".as_slice()));
        assert_eq!(code.to_string(), "0108");
        for wrong in ["", "108", "01081", "0x08", "01 8", "010"] {
            assert!(wrong.parse::<ItemCode>().is_err(), "{wrong}");
        }
        assert!(ItemCode::of_line("01\u{660}8".as_bytes()).is_none());
        assert_eq!(ItemCode::new(100, 1), None);
    }

    #[test]
    fn numbers_are_finite_and_have_a_point() {
        assert_eq!(number(b"-12.5"), Some(-12.5));
        assert_eq!(number(b"+1.2E3"), Some(1200.0));
        for wrong in [
            b"".as_slice(),
            b"1,5",
            b"nan",
            b"inf",
            b"1e999",
            b"12 5",
            b"0x10",
            b"\xff",
        ] {
            assert_eq!(number(wrong), None);
        }
    }
}
