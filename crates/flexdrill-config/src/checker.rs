//! Holds values against their bounds and collects what is wrong, with the place in the file.

use serde::Serialize;

use super::error::{ConfigError, Problem};
use super::lines::Lines;

/// Limits of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    low: f64,
    high: f64,
    low_is_in: bool,
}

impl Bound {
    /// low <= x <= high.
    pub const fn within(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            low_is_in: true,
        }
    }

    /// low < x <= high.
    pub const fn above(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            low_is_in: false,
        }
    }

    fn holds(self, value: f64) -> bool {
        let low = if self.low_is_in {
            value >= self.low
        } else {
            value > self.low
        };
        low && value <= self.high
    }

    fn words(self, unit: &str) -> String {
        let space = if unit.is_empty() { "" } else { " " };
        let (low, high) = (number(self.low), number(self.high));
        if self.low_is_in {
            format!("{low} to {high}{space}{unit}")
        } else {
            format!("above {low}, at most {high}{space}{unit}")
        }
    }
}

/// A numeric key of the configuration with its limits, for those who describe it to others (ROS parameters).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NumberKey {
    /// Dotted path.
    pub key: String,
    /// Its value.
    pub value: f64,
    /// Smallest (see `low_is_in`).
    pub low: f64,
    /// Largest, allowed itself.
    pub high: f64,
    /// Whether the smallest is allowed itself.
    pub low_is_in: bool,
    /// Empty if dimensionless.
    pub unit: &'static str,
    /// Why these limits.
    pub reason: &'static str,
}

/// What a number or a count was held against.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Dotted path.
    pub key: String,
    /// Smallest (see `low_is_in`).
    pub low: f64,
    /// Largest, allowed itself.
    pub high: f64,
    /// Whether the smallest is allowed itself.
    pub low_is_in: bool,
}

/// Walks a configuration.
pub struct Checker<'a> {
    file: &'a str,
    lines: &'a Lines,
    path: Vec<String>,
    /// Found so far.
    problems: Vec<Problem>,
    /// Every number read so far, with its bounds.
    pub numbers: Vec<NumberKey>,
    /// The same for the JSON Schema, with the counts.
    pub limits: Vec<Limit>,
}

impl<'a> Checker<'a> {
    /// Nothing found yet in `file`, whose keys stand on `lines`.
    pub fn new(file: &'a str, lines: &'a Lines) -> Self {
        Self {
            file,
            lines,
            path: Vec::new(),
            problems: Vec::new(),
            numbers: Vec::new(),
            limits: Vec::new(),
        }
    }

    /// Ends the walk.
    ///
    /// # Errors
    /// With every problem that was found.
    pub fn finish(self) -> Result<(), ConfigError> {
        if self.problems.is_empty() {
            Ok(())
        } else {
            Err(ConfigError::Invalid {
                problems: self.problems,
            })
        }
    }

    /// Everything checked in `inside` is below `key`.
    pub fn below(&mut self, key: impl ToString, inside: impl FnOnce(&mut Self)) {
        self.path.push(key.to_string());
        inside(self);
        self.path.pop();
    }

    /// A number against its limits. NaN and infinities never hold.
    pub fn number(&mut self, key: &str, value: f64, bound: Bound, unit: &'static str, reason: &'static str) {
        if !bound.holds(value) {
            self.wrong(key, number(value), unit, bound.words(unit), reason);
        }
        let path = self.path_of(key);
        self.limits.push(Limit {
            key: path.clone(),
            low: bound.low,
            high: bound.high,
            low_is_in: bound.low_is_in,
        });
        self.numbers.push(NumberKey {
            key: path,
            value,
            low: bound.low,
            high: bound.high,
            low_is_in: bound.low_is_in,
            unit,
            reason,
        });
    }

    /// A count against its limits, both allowed.
    pub fn count(&mut self, key: &str, value: usize, low: usize, high: usize, reason: &str) {
        if value < low || value > high {
            self.wrong(key, value, "", format!("{low} to {high}"), reason);
        }
        self.limits.push(Limit {
            key: self.path_of(key),
            low: low as f64,
            high: high as f64,
            low_is_in: true,
        });
    }

    /// Reports `value` unless `holds`.
    pub fn require(
        &mut self,
        holds: bool,
        key: &str,
        value: impl ToString,
        unit: &'static str,
        bound: impl ToString,
        reason: &str,
    ) {
        if !holds {
            self.wrong(key, value, unit, bound, reason);
        }
    }

    /// Reports a value.
    pub fn wrong(&mut self, key: &str, value: impl ToString, unit: &'static str, bound: impl ToString, reason: &str) {
        let key = self.path_of(key);
        let (line, exact) = self.lines.find(&key);
        self.problems.push(Problem {
            file: self.file.to_string(),
            line,
            is_default: !exact && line.is_some(),
            key,
            value: value.to_string(),
            unit,
            bound: bound.to_string(),
            reason: reason.to_string(),
        });
    }

    fn path_of(&self, key: &str) -> String {
        let mut path = self.path.join(".");
        if !key.is_empty() {
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(key);
        }
        path
    }
}

/// A number as a person would write it: plain near one, with an exponent far from it.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && value.is_finite() && !(1e-4..1e7).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_never_holds() {
        assert!(!Bound::within(0.0, 1.0).holds(f64::NAN));
        assert!(!Bound::within(0.0, 1.0).holds(f64::INFINITY));
        assert!(Bound::within(0.0, 1.0).holds(0.0));
        assert!(!Bound::above(0.0, 1.0).holds(0.0));
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(number(0.063), "0.063");
        assert_eq!(number(2.06e11), "2.06e11");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(1e-5), "1e-5");
    }
}
