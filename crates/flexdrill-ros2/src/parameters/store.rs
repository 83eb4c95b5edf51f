//! Declared parameters with their descriptions, limits and values.

use std::collections::BTreeMap;

use ros2_client::parameters::{NumericRange, ParameterDescriptor, raw};
use ros2_client::rcl_interfaces::ListParametersResult;
use ros2_client::{Parameter, ParameterValue};

use super::refusal::Refusal;
use crate::args::value::show;

/// The range of a number, as people and tools see it. The check of the whole configuration enforces it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberRange {
    /// Lower bound.
    pub low: f64,
    /// Upper bound, which is allowed.
    pub high: f64,
    /// Whether the lower bound is allowed.
    pub low_is_in: bool,
    /// Empty if dimensionless.
    pub unit: &'static str,
}

impl NumberRange {
    /// The lower end for ROS 2, whose ranges include both ends. Where the end itself is not allowed it is a number next to it
    /// that people can read: a billionth of the range above it, as a power of ten.
    fn smallest(&self) -> f64 {
        let range = self.high - self.low;
        if self.low_is_in || !range.is_finite() || range <= 0.0 {
            return self.low;
        }
        self.low + 10_f64.powi(range.log10().floor() as i32 - 9)
    }
}

impl std::fmt::Display for NumberRange {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { low, high, unit, .. } = self;
        let space = if unit.is_empty() { "" } else { " " };
        if self.low_is_in {
            write!(f, "{low} to {high}{space}{unit}")
        } else {
            write!(f, "above {low}, at most {high}{space}{unit}")
        }
    }
}

/// The declaration of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    /// Dotted name.
    pub name: String,
    /// One sentence with the unit.
    pub description: String,
    /// The range of a number.
    pub range: Option<NumberRange>,
    /// Why it cannot change while the node runs.
    pub read_only: Option<String>,
    /// Value; its type is the parameter's type.
    pub value: ParameterValue,
}

/// Declared parameters, by name.
#[derive(Debug, Clone, Default)]
pub struct ParameterStore {
    entries: BTreeMap<String, Declaration>,
}

impl ParameterStore {
    /// A store with these declarations.
    pub fn new(declarations: impl IntoIterator<Item = Declaration>) -> Self {
        Self {
            entries: declarations
                .into_iter()
                .map(|entry| (entry.name.clone(), entry))
                .collect(),
        }
    }

    /// A parameter's value.
    pub fn get(&self, name: &str) -> Option<&ParameterValue> {
        self.entries.get(name).map(|entry| &entry.value)
    }

    /// The value of a number, also of an integer.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            ParameterValue::Double(value) => Some(*value),
            ParameterValue::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }

    /// Replaces the range of a parameter, where it follows from other values.
    pub fn set_range(&mut self, name: &str, range: NumberRange) {
        if let Some(entry) = self.entries.get_mut(name) {
            entry.range = Some(range);
        }
    }

    /// All names, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
    }

    /// Current values of all parameters.
    pub fn all(&self) -> Vec<Parameter> {
        self.entries
            .values()
            .map(|entry| Parameter {
                name: entry.name.clone(),
                value: entry.value.clone(),
            })
            .collect()
    }

    /// Sets all of `changes` or none. `apply` gets the store with the new values and the changes, in the parameters' own
    /// types; it applies them as a whole, or refuses them. Returns the changes.
    ///
    /// # Errors
    /// When one of them is unknown, read-only or of the wrong type, or `apply` refuses them; then nothing has
    /// changed.
    pub fn set_atomically(
        &mut self,
        changes: &[Parameter],
        apply: impl FnOnce(&mut ParameterStore, &[Parameter]) -> Result<(), Refusal>,
    ) -> Result<Vec<Parameter>, Refusal> {
        let mut candidate = self.clone();
        let mut accepted = Vec::with_capacity(changes.len());
        for Parameter { name, value } in changes {
            let entry = candidate.entries.get_mut(name).ok_or_else(|| unknown(self, name))?;
            entry.value = allowed(entry, value)?;
            accepted.push(Parameter {
                name: name.clone(),
                value: entry.value.clone(),
            });
        }
        apply(&mut candidate, &accepted)?;
        *self = candidate;
        Ok(accepted)
    }

    /// The descriptor of a parameter, for `ros2 param describe`.
    pub fn describe(&self, name: &str) -> raw::ParameterDescriptor {
        let Some(entry) = self.entries.get(name) else {
            return ParameterDescriptor::unknown(name).into();
        };
        let range = match (&entry.value, entry.range) {
            (ParameterValue::Integer(_), Some(range)) => NumericRange::IntegerRange {
                from_value: range.smallest().ceil() as i64,
                to_value: range.high as i64,
                step: 0,
            },
            (_, Some(range)) => NumericRange::FloatingPointRange {
                from_value: range.smallest(),
                to_value: range.high,
                step: 0.0,
            },
            _ => NumericRange::NotSpecified,
        };
        ParameterDescriptor {
            name: name.to_owned(),
            param_type: entry.value.to_parameter_type(),
            description: entry.description.clone(),
            additional_constraints: match (&entry.read_only, entry.range) {
                (Some(why), _) => why.clone(),
                (None, Some(range)) => range.to_string(),
                (None, None) => String::new(),
            },
            read_only: entry.read_only.is_some(),
            dynamic_typing: false,
            range,
        }
        .into()
    }

    /// Names at or below the prefixes, down to `depth` levels below each of them (0: no limit), as in rclcpp.
    pub fn list(&self, prefixes: &[String], depth: u64) -> ListParametersResult {
        let shallow = |rest: &str| depth == 0 || (rest.matches('.').count() as u64) < depth;
        let wanted = |name: &str| {
            if prefixes.is_empty() {
                return shallow(name);
            }
            prefixes.iter().any(|prefix| {
                name == prefix
                    || name
                        .strip_prefix(prefix.as_str())
                        .and_then(|rest| rest.strip_prefix('.'))
                        .is_some_and(shallow)
            })
        };
        let names: Vec<String> = self.names().filter(|name| wanted(name)).map(str::to_owned).collect();
        let mut found: Vec<String> = names
            .iter()
            .filter_map(|name| name.rsplit_once('.').map(|(prefix, _)| prefix.to_owned()))
            .collect();
        found.sort();
        found.dedup();
        ListParametersResult { names, prefixes: found }
    }
}

fn unknown(store: &ParameterStore, name: &str) -> Refusal {
    let last = name.rsplit('.').next().unwrap_or(name);
    let close: Vec<&str> = store
        .names()
        .filter(|known| known.rsplit('.').next() == Some(last))
        .take(3)
        .collect();
    let hint = if close.is_empty() {
        "see `ros2 param list`".to_owned()
    } else {
        format!("did you mean {}?", close.join(" or "))
    };
    Refusal::Unknown {
        name: name.to_owned(),
        hint,
    }
}

/// The value in the parameter's own type, if it is allowed.
fn allowed(entry: &Declaration, value: &ParameterValue) -> Result<ParameterValue, Refusal> {
    let name = || entry.name.clone();
    if let Some(why) = &entry.read_only {
        // The present value is accepted, so that a file of `ros2 param dump` can be loaded again.
        if *value == entry.value {
            return Ok(value.clone());
        }
        return Err(Refusal::ReadOnly {
            name: name(),
            why: why.clone(),
        });
    }
    let value = match (&entry.value, value) {
        // YAML writes a float without fraction as an integer.
        (ParameterValue::Double(_), ParameterValue::Integer(whole)) => ParameterValue::Double(*whole as f64),
        (own, given) if std::mem::discriminant(own) == std::mem::discriminant(given) => given.clone(),
        (own, given) => {
            return Err(Refusal::WrongType {
                name: name(),
                own: own.to_parameter_type(),
                given: given.to_parameter_type(),
                value: show(given),
            });
        }
    };
    let number = match &value {
        ParameterValue::Double(number) => *number,
        ParameterValue::Integer(number) => *number as f64,
        _ => return Ok(value),
    };
    if !number.is_finite() {
        return Err(Refusal::NotFinite {
            name: name(),
            value: show(&value),
        });
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(low: f64, high: f64) -> NumberRange {
        NumberRange {
            low,
            high,
            low_is_in: true,
            unit: "",
        }
    }

    fn declare(name: &str, value: ParameterValue, range: Option<NumberRange>, read_only: bool) -> Declaration {
        Declaration {
            name: name.into(),
            description: "one sentence".into(),
            range,
            read_only: read_only.then(|| "it is part of the mesh".into()),
            value,
        }
    }

    fn store() -> ParameterStore {
        ParameterStore::new([
            declare(
                "friction.inner",
                ParameterValue::Double(0.2),
                Some(range(0.0, 1.0)),
                false,
            ),
            declare(
                "friction.outer",
                ParameterValue::Double(0.3),
                Some(range(0.0, 1.0)),
                false,
            ),
            declare("tool.links", ParameterValue::Integer(33), None, true),
            declare("count", ParameterValue::Integer(3), Some(range(1.0, 9.0)), false),
        ])
    }

    fn parameter(name: &str, value: ParameterValue) -> Parameter {
        Parameter {
            name: name.into(),
            value,
        }
    }

    #[test]
    fn all_or_nothing() {
        let mut store = store();
        let changes = [
            parameter("friction.inner", ParameterValue::Double(0.4)),
            parameter("friction.outer", ParameterValue::String("rough".into())),
        ];
        let reason = store.set_atomically(&changes, |_, _| Ok(())).unwrap_err().to_string();
        assert!(
            reason.contains("friction.outer") && reason.contains("rough"),
            "{reason}"
        );
        assert_eq!(store.number("friction.inner"), Some(0.2));
        let refused = store.set_atomically(&changes[..1], |new, changed| {
            assert_eq!(new.number("friction.inner"), Some(0.4));
            assert_eq!((changed.len(), changed[0].name.as_str()), (1, "friction.inner"));
            new.set_range("friction.inner", range(0.0, 0.5));
            Err(Refusal::Invalid("friction: no such key".into()))
        });
        assert!(refused.is_err());
        assert_eq!(store.describe("friction.inner").floating_point_range[0].to_value, 1.0);
        assert_eq!(store.number("friction.inner"), Some(0.2));
        assert_eq!(store.set_atomically(&changes[..1], |_, _| Ok(())).unwrap().len(), 1);
        assert_eq!(store.number("friction.inner"), Some(0.4));
    }

    #[test]
    fn refusals_say_why() {
        let mut store = store();
        let mut refuse = |name: &str, value| {
            let refused = store.set_atomically(&[parameter(name, value)], |_, _| Ok(()));
            refused.unwrap_err().to_string()
        };
        assert!(refuse("tool.links", ParameterValue::Integer(4)).contains("part of the mesh"));
        assert!(refuse("inner", ParameterValue::Double(0.1)).contains("did you mean friction.inner"));
        assert!(refuse("friction.inner", ParameterValue::String("low".into())).contains("low"));
        assert!(refuse("friction.inner", ParameterValue::Double(f64::NAN)).contains("finite"));
        assert!(refuse("count", ParameterValue::Double(2.0)).contains("Integer"));
    }

    #[test]
    fn integers_are_accepted_for_floats() {
        let mut store = store();
        store
            .set_atomically(
                &[parameter("friction.inner", ParameterValue::Integer(1))],
                |_, _| Ok(()),
            )
            .unwrap();
        assert_eq!(store.get("friction.inner"), Some(&ParameterValue::Double(1.0)));
    }

    #[test]
    fn lists_and_descriptions() {
        let store = store();
        assert_eq!(
            store.list(&[], 0).names,
            ["count", "friction.inner", "friction.outer", "tool.links"]
        );
        assert_eq!(
            store.list(&["friction".into()], 0).names,
            ["friction.inner", "friction.outer"]
        );
        assert_eq!(store.list(&[], 1).names, ["count"]);
        assert_eq!(
            store.list(&["friction".into()], 1).names,
            ["friction.inner", "friction.outer"]
        );
        let described = store.describe("friction.inner");
        assert_eq!(described.floating_point_range[0].to_value, 1.0);
        assert!(store.describe("tool.links").read_only);
        assert_eq!(store.describe("nothing").r#type, 0);
    }
}
