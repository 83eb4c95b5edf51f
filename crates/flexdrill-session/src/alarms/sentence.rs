//! Parts of sentences.

/// No quantity of this tool reaches this magnitude in any unit of the texts.
const IMPLAUSIBLE: f64 = 1e6;

/// A number for a sentence; none for one that was not measured, so that the sentence leaves it out.
pub fn number(value: f64, digits: usize) -> Option<String> {
    if !value.is_finite() || value.abs() >= IMPLAUSIBLE {
        return None;
    }
    let text = format!("{value:.digits$}");
    // Rounding keeps the sign of a small negative number.
    Some(match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|digit| digit == '0' || digit == '.') => zero.to_owned(),
        _ => text,
    })
}

/// The text with a capital first letter.
pub fn capitalized(text: &str) -> String {
    let (first, rest) = text.split_at(text.chars().next().map_or(0, char::len_utf8));
    first.to_uppercase() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_measured_numbers_are_written() {
        assert_eq!(number(2.345, 2).as_deref(), Some("2.35"));
        assert_eq!(number(-0.004, 2).as_deref(), Some("0.00"));
        assert_eq!(number(-0.6, 0).as_deref(), Some("-1"));
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
            assert_eq!(number(value, 1), None);
        }
    }
}
