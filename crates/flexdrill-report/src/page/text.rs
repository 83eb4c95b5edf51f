//! Numbers, times and locations as text.

use flexdrill_core::units::rad_to_deg;
use flexdrill_messages::Alarm;

/// A number with three to four significant digits; a dash if it is not finite.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    let text = match size {
        _ if !value.is_finite() => return "–".to_owned(),
        // A value this small is rounding, in any unit used here.
        ..1e-6 => "0".to_owned(),
        ..1e-3 => format!("{value:.1e}"),
        ..1.0 => format!("{value:.3}"),
        ..10.0 => format!("{value:.2}"),
        ..1000.0 => format!("{value:.1}"),
        ..1e7 => format!("{value:.0}"),
        _ => format!("{value:.2e}"),
    };
    // A fraction of zeros is dropped.
    let text = match text.split_once('.') {
        Some((whole, rest)) if rest.chars().all(|digit| digit == '0') => whole.to_owned(),
        _ => text,
    };
    text.replace('-', "−")
}

/// A share (0 to 1) in per cent.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        value if !value.is_finite() => "–".to_owned(),
        // A non-zero share is never rounded to 0 %, and a partial one never to 100 %.
        value if value > 0.0 && value < 0.1 => "below 0.1 %".to_owned(),
        value if value > 99.9 && value < 100.0 => "above 99.9 %".to_owned(),
        // A share of next to nothing has no digits that mean anything.
        value if value.abs() > 1000.0 => if value > 0.0 { "above 1000 %" } else { "below −1000 %" }.to_owned(),
        value => format!("{} %", number((value * 10.0).round() / 10.0)),
    }
}

/// A number of occurrences.
pub(super) fn times(count: u64) -> String {
    if count == 1 {
        "once".to_owned()
    } else {
        format!("{count} times")
    }
}

/// The text with its first letter in upper case.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A duration in s, min or h.
pub(super) fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match seconds {
        ..60.0 => format!("{seconds:.1} s"),
        ..3600.0 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

/// Depth and inclination of a location; empty if the depth is not finite.
pub(super) fn location(body: u8, measured_depth: f64, inclination: f64) -> String {
    if !measured_depth.is_finite() {
        return String::new();
    }
    let body = match body {
        Alarm::PIPE => "pipe, ",
        Alarm::GUIDE => "guide, ",
        _ => "",
    };
    if inclination.is_finite() {
        format!("{body}{measured_depth:.2} m, {:.0}°", rad_to_deg(inclination))
    } else {
        format!("{body}{measured_depth:.2} m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let cases = [
            (0.0, "0"),
            (40.0, "40"),
            (4.23456, "4.23"),
            (-0.0456, "−0.046"),
            (123.456, "123.5"),
            (98_765.4, "98765"),
            (f64::NAN, "–"),
            (-1.9e-9, "0"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(duration(59.94), "59.9 s");
        assert_eq!(duration(125.0), "2 min 05 s");
        assert_eq!(duration(7260.0), "2 h 01 min");
        let shares = [
            (0.0, "0 %"),
            (0.0004, "below 0.1 %"),
            (0.5657, "56.6 %"),
            (0.9999, "above 99.9 %"),
            (1.0, "100 %"),
            (10.0, "1000 %"),
            (4.6e16, "above 1000 %"),
            (-11.0, "below −1000 %"),
        ];
        for (share, text) in shares {
            assert_eq!(percent(share), text);
        }
        assert_eq!(
            (times(1).as_str(), times(3).as_str(), capital("shock").as_str()),
            ("once", "3 times", "Shock")
        );
    }
}
