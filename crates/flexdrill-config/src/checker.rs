//! Checks values against their bounds and collects the problems, with their lines in the file.

use schemars::Schema;
use schemars::transform::Transform;
use serde::Serialize;
use serde_json::Number;

use super::error::{ConfigError, Problem};
use super::lines::Lines;

/// Limits of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    low: f64,
    high: f64,
    low_is_in: bool,
}

/// Writes a bound into the JSON Schema of a key, as a `transform` of schemars. A side that is infinite stays out: there
/// the limit depends on other keys, which a schema cannot express.
pub(crate) struct InSchema(Bound);

impl Transform for InSchema {
    fn transform(&mut self, schema: &mut Schema) {
        let is_integer = schema.get("type").is_some_and(|kind| kind == "integer");
        let number = |value: f64| {
            if is_integer && value.is_finite() {
                Some(Number::from(value as i64))
            } else {
                Number::from_f64(value)
            }
        };
        if let Some(low) = number(self.0.low) {
            let name = if self.0.low_is_in {
                "minimum"
            } else {
                "exclusiveMinimum"
            };
            schema.insert(name.to_owned(), low.into());
        }
        if let Some(high) = number(self.0.high) {
            schema.insert("maximum".to_owned(), high.into());
        }
    }
}

/// Limits of every item of a list, as a `transform` of schemars.
pub(crate) struct EachItem(pub(crate) Bound);

impl Transform for EachItem {
    fn transform(&mut self, schema: &mut Schema) {
        if let Some(Ok(items)) = schema.get_mut("items").map(<&mut Schema>::try_from) {
            self.0.in_schema().transform(items);
        }
    }
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

    /// This bound as a `transform` of the key's JSON Schema.
    pub(crate) const fn in_schema(self) -> InSchema {
        InSchema(self)
    }

    /// Whether a value is within; NaN never is.
    pub fn holds(self, value: f64) -> bool {
        let low = if self.low_is_in {
            value >= self.low
        } else {
            value > self.low
        };
        low && value <= self.high
    }

    /// The limits in words, with their unit, which is empty if dimensionless.
    pub fn words(self, unit: &str) -> String {
        let space = if unit.is_empty() { "" } else { " " };
        let (low, high) = (number(self.low), number(self.high));
        if self.low_is_in {
            format!("{low} to {high}{space}{unit}")
        } else {
            format!("above {low}, at most {high}{space}{unit}")
        }
    }
}

/// A numeric key of the configuration with its limits, for descriptions of it (ROS parameters).
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
    /// Reason of the limits.
    pub reason: &'static str,
}

impl NumberKey {
    /// Its limits.
    pub const fn bound(&self) -> Bound {
        if self.low_is_in {
            Bound::within(self.low, self.high)
        } else {
            Bound::above(self.low, self.high)
        }
    }
}

/// Walks a configuration, holds its values against their bounds and collects the problems.
pub struct Checker<'a> {
    file: &'a str,
    lines: &'a Lines,
    path: Vec<String>,
    problems: Vec<Problem>,
    /// Every number read so far, with its bounds; counts are not among them.
    pub numbers: Vec<NumberKey>,
}

impl<'a> Checker<'a> {
    /// A checker without problems, for `file`, whose keys are on `lines`.
    pub fn new(file: &'a str, lines: &'a Lines) -> Self {
        Self {
            file,
            lines,
            path: Vec::new(),
            problems: Vec::new(),
            numbers: Vec::new(),
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

    /// Runs `inside` with paths below `key`.
    pub fn below(&mut self, key: impl ToString, inside: impl FnOnce(&mut Self)) {
        self.path.push(key.to_string());
        inside(self);
        self.path.pop();
    }

    /// Checks a number against its limits. NaN and infinities never hold.
    pub fn number(&mut self, key: &str, value: f64, bound: Bound, unit: &'static str, reason: &'static str) {
        if !bound.holds(value) {
            self.wrong(key, number(value), unit, bound.words(unit), reason);
        }
        self.numbers.push(NumberKey {
            key: self.path_of(key),
            value,
            low: bound.low,
            high: bound.high,
            low_is_in: bound.low_is_in,
            unit,
            reason,
        });
    }

    /// Checks a count against its limits.
    pub fn count(&mut self, key: &str, value: usize, bound: Bound, reason: &str) {
        if !bound.holds(value as f64) {
            self.wrong(key, value, "", bound.words(""), reason);
        }
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

    /// Reports a wrong value.
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

/// A number in readable form: plain near one, with an exponent far from it.
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
