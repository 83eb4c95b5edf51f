//! Numbers in sentences for people: counts with their noun, values without meaningless digits.

/// A count with its noun, whose plural ends in s: "1 run", "2 runs".
pub fn counted(count: u64, one: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {one}{ending}")
}

/// A value with at most six significant digits and no trailing zeros, as a person reads it: 39.9999999999 is 40.
pub fn six_digits(value: f64) -> String {
    let magnitude = value.abs().log10().floor();
    // Beyond these magnitudes zeros would be counted; zero and what is no number have no magnitude.
    if !(-5.0..9.0).contains(&magnitude) {
        return if value == 0.0 || !value.is_finite() {
            format!("{value}")
        } else {
            format!("{value:.5e}")
        };
    }
    let text = format!("{value:.*}", (5.0 - magnitude).max(0.0) as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A value with so many decimals, never a negative zero: what rounds to nothing has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|byte| matches!(byte, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// A share in whole per cent. Over a quantity that is nearly nothing a share has no meaning: beyond ten times the text says
/// only that.
pub fn percent(share: f64) -> String {
    match share {
        share if share.abs() > 10.0 => "more than 1000 %".to_owned(),
        // Rounding keeps the sign of a small negative number; adding a zero takes it off.
        share => format!("{:.0} %", (100.0 * share).round() + 0.0),
    }
}

/// A value that is refused for being beyond a bound, with as many digits as distinguish it from the bound.
pub fn beyond(value: f64, bound: f64) -> String {
    let text = six_digits(value);
    if text == six_digits(bound) && value != bound {
        format!("{value}")
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular() {
        let texts = [0, 1, 2].map(|count| counted(count, "look-ahead"));
        assert_eq!(texts, ["0 look-aheads", "1 look-ahead", "2 look-aheads"]);
    }

    #[test]
    fn a_share_of_nearly_nothing_is_no_number() {
        assert_eq!(
            [0.254, 1.0, 10.0, -1e-9].map(percent),
            ["25 %", "100 %", "1000 %", "0 %"]
        );
        assert_eq!([10.1, 4.6e16, f64::INFINITY].map(percent), ["more than 1000 %"; 3]);
    }

    #[test]
    fn no_text_has_more_than_six_digits() {
        let texts = [
            (0.1 + 0.2, "0.3"),
            (13.5 * 4.448_221_615_260_5, "60.051"),
            (5000.0, "5000"),
            (4_999.999_999_999_999, "5000"),
            (-201.0, "-201"),
            (0.0, "0"),
            (123_456_789.0, "123456789"),
            (4.604_568_085_764_167e18, "4.60457e18"),
            (1.5e-7, "1.50000e-7"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in texts {
            assert_eq!(six_digits(value), text);
        }
    }

    #[test]
    fn nothing_has_no_sign() {
        let texts = [-0.004, -0.0, 0.0, -0.006, 12.3456].map(|value| fixed(value, 2));
        assert_eq!(texts, ["0.00", "0.00", "0.00", "-0.01", "12.35"]);
        assert_eq!([fixed(-0.4, 0), fixed(f64::NAN, 2)], ["0", "NaN"]);
    }

    #[test]
    fn a_refused_value_does_not_read_as_its_bound() {
        assert_eq!(beyond(120.000_000_000_000_01, 120.0), "120.00000000000001");
        assert_eq!(beyond(60.050_991_806, 60.0), "60.051");
    }
}
