//! Conditions on a column, such as "drilling" or "off bottom".

use serde::{Deserialize, Serialize};

use flexdrill_config::checker::Checker;

/// A condition on one column; give exactly one of `values`, `above`, `below`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// Name in the header.
    pub column: String,
    /// The value is one of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<f64>,
    /// The value is above this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub above: Option<f64>,
    /// The value is below this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub below: Option<f64>,
}

impl Condition {
    /// Whether the condition holds for this value of its column.
    pub fn holds(&self, value: f64) -> bool {
        self.values.contains(&value)
            || self.above.is_some_and(|bound| value > bound)
            || self.below.is_some_and(|bound| value < bound)
    }

    pub(crate) fn check(&self, c: &mut Checker) {
        let given = usize::from(!self.values.is_empty())
            + usize::from(self.above.is_some())
            + usize::from(self.below.is_some());
        c.require(
            given == 1,
            "",
            format!("{given} tests of column {}", self.column),
            "",
            "one of values, above, below",
            "",
        );
        let numbers = self.values.iter().chain(&self.above).chain(&self.below);
        for number in numbers {
            c.require(number.is_finite(), "", number, "", "a finite number", "");
        }
    }
}
