//! Numbers on the command line, checked before any file is opened.

/// A number outside its bounds.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("use a number from {low} to {high}{}{unit}", if unit.is_empty() { "" } else { " " })]
pub(super) struct NumberError {
    low: String,
    high: String,
    unit: &'static str,
}

/// A number closer to 0 than this, yet not 0, is a typing error.
const LEAST: f64 = 1e-9;

fn number(text: &str, low: f64, high: f64, unit: &'static str) -> Result<f64, NumberError> {
    // NaN fails both comparisons.
    match text.trim().parse::<f64>() {
        Ok(value) if value >= low && value <= high && (value == 0.0 || value.abs() >= LEAST) => Ok(value),
        _ => Err(NumberError {
            low: low.to_string(),
            high: high.to_string(),
            unit,
        }),
    }
}

/// A duration (s): a millisecond to some months.
pub(super) fn seconds(text: &str) -> Result<f64, NumberError> {
    number(text, 1e-3, 1e7, "s")
}

/// A model step (s).
pub(super) fn time_step(text: &str) -> Result<f64, NumberError> {
    number(text, 1e-7, 1.0, "s")
}

/// A rotary speed (r/min), within the bounds of a configuration.
pub(super) fn rpm(text: &str) -> Result<f64, NumberError> {
    number(text, -5000.0, 5000.0, "r/min")
}

/// A weight on bit (kN), within the bounds of a configuration.
pub(super) fn kilonewton(text: &str) -> Result<f64, NumberError> {
    number(text, 0.0, 2000.0, "kN")
}

/// Length of a hole (m).
pub(super) fn length(text: &str) -> Result<f64, NumberError> {
    number(text, 0.1, 1000.0, "m")
}

/// A friction coefficient.
pub(super) fn friction(text: &str) -> Result<f64, NumberError> {
    number(text, 0.0, 2.0, "")
}

/// A rotary speed of drilling (r/min): a mean over a turn must fit into a minute.
pub(super) fn drilling_rpm(text: &str) -> Result<f64, NumberError> {
    number(text, 1.0, 5000.0, "r/min")
}

/// A rate of penetration of drilling (m/h).
pub(super) fn advance(text: &str) -> Result<f64, NumberError> {
    number(text, 0.01, 100.0, "m/h")
}

/// Metres ahead of the bit.
pub(super) fn metres_ahead(text: &str) -> Result<f64, NumberError> {
    number(text, 0.25, 20.0, "m")
}

/// Radius of an arc of a hole (m), within the bounds of a configuration.
pub(super) fn arc_radius(text: &str) -> Result<f64, NumberError> {
    number(text, 0.5, 10_000.0, "m")
}

/// A distance that counts as on plan (m).
pub(super) fn distance(text: &str) -> Result<f64, NumberError> {
    number(text, 0.01, 100.0, "m")
}

/// A speed along the hole on a trip (m/s).
pub(super) fn trip_speed(text: &str) -> Result<f64, NumberError> {
    number(text, 0.001, 10.0, "m/s")
}

/// A pull at the hook or along the guide (kN), within the bounds of a configuration.
pub(super) fn pull(text: &str) -> Result<f64, NumberError> {
    number(text, 0.1, 20_000.0, "kN")
}

/// A torque at the rig (N m).
pub(super) fn torque(text: &str) -> Result<f64, NumberError> {
    number(text, 1.0, 1e6, "N m")
}

/// A measured depth from the kick-off (m).
pub(super) fn measured_depth(text: &str) -> Result<f64, NumberError> {
    number(text, 0.0, 100_000.0, "m")
}

/// A number of threads.
pub(super) fn jobs() -> clap::builder::RangedU64ValueParser<usize> {
    clap::builder::RangedU64ValueParser::<usize>::new().range(1..=256)
}

/// A number of plausible tools.
pub(super) fn members() -> clap::builder::RangedU64ValueParser<usize> {
    clap::builder::RangedU64ValueParser::<usize>::new().range(1..=10_000)
}

/// Turns of the tool.
pub(super) fn turns(text: &str) -> Result<f64, NumberError> {
    number(text, 0.01, 10_000.0, "turns")
}

/// A speed relative to real time.
pub(super) fn rate(text: &str) -> Result<f64, NumberError> {
    number(text, 1e-3, 1e3, "times real time")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implausible_numbers_are_refused_with_the_bounds() {
        type Parser = fn(&str) -> Result<f64, NumberError>;
        let parsers: [Parser; 17] = [
            seconds,
            time_step,
            rpm,
            kilonewton,
            turns,
            rate,
            length,
            friction,
            drilling_rpm,
            advance,
            metres_ahead,
            arc_radius,
            distance,
            trip_speed,
            pull,
            torque,
            measured_depth,
        ];
        for parse in parsers {
            for text in [
                "nan", "NaN", "inf", "-inf", "1e999", "1e-308", "-1e-308", "5e-324", "1e300", "", "x", "1,5",
            ] {
                assert!(parse(text).is_err(), "{text}");
            }
        }
        let said = seconds("nan").unwrap_err().to_string();
        assert_eq!(said, "use a number from 0.001 to 10000000 s");
        assert_eq!(
            (seconds("2.5"), rpm("-40"), kilonewton("0")),
            (Ok(2.5), Ok(-40.0), Ok(0.0))
        );
    }
}
