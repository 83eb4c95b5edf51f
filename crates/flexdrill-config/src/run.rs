//! `run`: what the file is for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

/// Longest name of a rig, a well or an operator (characters).
const LONGEST_NAME: usize = 200;
const DURATION: Bound = Bound::above(0.0, 1e7);

/// The run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Title of the run, for displays and reports. Default empty.
    pub title: String,
    /// Name of the rig, for reports. Default not given.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub rig: String,
    /// Name of the well, for reports. Default not given.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub well: String,
    /// Operating company, for reports. Default not given.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub operator: String,
    /// Model time after which a run ends (s). Default: it continues until it is stopped.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = DURATION.in_schema())]
    pub duration: Option<f64>,
}

impl Run {
    /// What is known of the place of the run, each with its name: rig, well, operator.
    pub fn place(&self) -> impl Iterator<Item = (&'static str, &str)> {
        [
            ("rig", self.rig.as_str()),
            ("well", self.well.as_str()),
            ("operator", self.operator.as_str()),
        ]
        .into_iter()
        .filter(|(_, name)| !name.is_empty())
    }

    pub(super) fn check(&self, c: &mut Checker) {
        for (key, name) in self.place() {
            let holds = name.chars().count() <= LONGEST_NAME && !name.chars().any(char::is_control);
            let (shown, bound) = (
                format!("{name:?}"),
                format!("one line of at most {LONGEST_NAME} characters"),
            );
            c.require(holds, key, shown, "", bound, "it is a name in the head of a report");
        }
        if let Some(duration) = self.duration {
            c.number("duration", duration, DURATION, "s", "some months");
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Config;

    const SMALL: &str = include_str!("../../../tests/data/small.yaml");

    fn with_run(run: &str) -> Result<Config, crate::ConfigError> {
        let own = SMALL.lines().filter(|line| line.starts_with("run:")).count();
        let text = if own == 0 {
            format!("run: {run}\n{SMALL}")
        } else {
            let rest = SMALL.split_once("run:").map_or("", |(_, rest)| rest);
            let next = rest.find("\n\n").map_or(rest, |end| &rest[end..]);
            format!("run: {run}{next}")
        };
        Config::from_text("small.yaml", &text)
    }

    /// A file without the names has the hash that it had before the keys existed, and names move no tool.
    #[test]
    fn names_that_are_not_given_are_left_out() {
        let (without, with) = (
            with_run("{}").unwrap(),
            with_run("{rig: \"Rig 7\", well: \"3 H\"}").unwrap(),
        );
        let yaml = without.to_yaml().unwrap();
        let run = yaml.split("well:\n").next().unwrap();
        assert!(!run.contains("rig:") && !run.contains("operator:"), "{run}");
        assert_eq!(without.run.place().count(), 0);
        assert_eq!(
            with.run.place().collect::<Vec<_>>(),
            [("rig", "Rig 7"), ("well", "3 H")]
        );
        assert_ne!(with.hash(), without.hash());
        assert_eq!(with.motion_hash(), without.motion_hash());
        let recorded = Config::from_text("recorded", &with.to_yaml().unwrap()).unwrap();
        assert_eq!(recorded, with);
    }

    #[test]
    fn a_name_is_one_line() {
        for bad in ["a\\nb".to_owned(), "x".repeat(201)] {
            let error = with_run(&format!("{{operator: \"{bad}\"}}")).unwrap_err().to_string();
            assert!(
                error.contains("operator") && error.contains("at most 200 characters"),
                "{error}"
            );
        }
    }
}
