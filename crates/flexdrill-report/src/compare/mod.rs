//! Two recordings next to each other: quantities over time and along the tool, and the alarms.
//!
//! Times of each run count from its own beginning. Means are taken over the time that both runs cover.

mod along;
pub(crate) mod figures;
mod json;
pub(crate) mod quantity;

use std::collections::BTreeMap;

pub(crate) use along::Along;
pub(crate) use quantity::ComparedQuantity;

use crate::incidents::seconds;
use crate::reading::Summary;

/// Something of both runs.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Pair<T> {
    pub a: T,
    pub b: T,
}

/// Least, mean and largest value over time (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Figures {
    pub min: f64,
    pub mean: f64,
    pub max: f64,
}

/// The incidents of one alarm in a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Stood {
    pub times: u64,
    /// s.
    pub duration: f64,
    /// Highest priority reached; 0 without an incident.
    pub priority: u8,
}

/// The comparison of one alarm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AlarmPair {
    pub id: String,
    pub name: String,
    pub runs: Pair<Stood>,
}

impl AlarmPair {
    /// Whether both runs reached the same priority; without any tolerance also as often and as long.
    pub(crate) fn agrees(&self, tolerance: f64) -> bool {
        let Pair { a, b } = &self.runs;
        if tolerance == 0.0 {
            a == b
        } else {
            a.priority == b.priority
        }
    }
}

/// Difference of two values relative to the larger one (0 to 2); 0 where both are at most `small`.
fn relative(a: f64, b: f64, small: f64) -> f64 {
    let size = a.abs().max(b.abs());
    if size <= small { 0.0 } else { (b - a).abs() / size }
}

/// Two recordings and their differences.
#[derive(Debug)]
pub struct Comparison<'a> {
    pub(crate) a: &'a Summary,
    pub(crate) b: &'a Summary,
    pub(crate) quantities: Vec<ComparedQuantity>,
    pub(crate) along: Vec<Along>,
    pub(crate) alarms: Vec<AlarmPair>,
}

impl<'a> Comparison<'a> {
    /// Compares the run B with the run A.
    pub fn new(a: &'a Summary, b: &'a Summary) -> Self {
        Self {
            quantities: quantity::all(a, b),
            along: along::all(&a.locations, &b.locations),
            alarms: alarms(a, b),
            a,
            b,
        }
    }

    /// What differs by more than `tolerance` (a share of the larger value, 0.02 is 2 %), in words, the largest first.
    ///
    /// - The mean of a quantity over time, in the time that both runs cover.
    /// - The mean or RMS of a quantity along the tool: the RMS over depth of the difference, relative to that of the curve.
    /// - An alarm that reached another priority.
    /// - A quantity that only one run has.
    ///
    /// With a tolerance of 0 the extremes, and the number and time of the alarms, must be the same too.
    pub fn beyond(&self, tolerance: f64) -> Vec<String> {
        let of = |name: &str, difference: Option<f64>| match difference {
            Some(difference) => (difference, format!("{name} ({:.3} %)", 100.0 * difference)),
            None => (f64::INFINITY, format!("{name} (only one run has it)")),
        };
        let mut all: Vec<(f64, String)> = Vec::new();
        let quantities = self.quantities.iter().filter(|quantity| !quantity.agrees(tolerance));
        all.extend(quantities.map(|quantity| of(&quantity.name, quantity.difference())));
        let along = self.along.iter().filter(|along| !along.agrees(tolerance));
        all.extend(along.map(|along| {
            let (difference, text) = of(along.name, along.worst.map(|worst| worst.relative));
            (difference, format!("along the tool: {text}"))
        }));
        all.extend(
            self.alarms
                .iter()
                .filter(|alarm| !alarm.agrees(tolerance))
                .map(|alarm| (f64::INFINITY, format!("the alarm \"{}\"", alarm.name))),
        );
        all.sort_by(|x, y| y.0.total_cmp(&x.0));
        all.into_iter().map(|(_, text)| text).collect()
    }

    /// The comparison for scripts, all values in SI.
    pub fn json(&self, tolerance: Option<f64>) -> serde_json::Value {
        json::of(self, tolerance)
    }
}

fn alarms(a: &Summary, b: &Summary) -> Vec<AlarmPair> {
    let mut all: BTreeMap<&str, AlarmPair> = BTreeMap::new();
    for (first, summary) in [(true, a), (false, b)] {
        for (id, group) in summary.incidents.by_id() {
            let pair = all.entry(id).or_insert_with(|| AlarmPair {
                id: id.to_owned(),
                name: group.worst.name.clone(),
                runs: Pair::default(),
            });
            let stood = Stood {
                times: group.times,
                duration: seconds(group.duration),
                priority: group.priority,
            };
            *(if first { &mut pair.runs.a } else { &mut pair.runs.b }) = stood;
        }
    }
    let mut all: Vec<AlarmPair> = all.into_values().collect();
    all.sort_by_key(|alarm| std::cmp::Reverse(alarm.runs.a.priority.max(alarm.runs.b.priority)));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_relative_to_the_larger_value() {
        assert_eq!(relative(8.0, 10.0, 0.1), 0.2);
        assert_eq!(relative(10.0, 8.0, 0.1), 0.2);
        assert_eq!(relative(-5.0, 5.0, 0.1), 2.0);
        // Values near zero say nothing.
        assert_eq!(relative(0.01, -0.05, 0.1), 0.0);
    }

    #[test]
    fn extremes_count_without_a_tolerance_only() {
        let figures = |max: f64| {
            Some(Figures {
                min: 0.0,
                mean: 100.0,
                max,
            })
        };
        let mut quantity = ComparedQuantity {
            name: String::new(),
            unit: quantity::Unit {
                shown: "N m",
                factor: 1.0,
                small: 0.1,
            },
            runs: Pair {
                a: figures(120.0),
                b: figures(150.0),
            },
        };
        assert!(quantity.agrees(1e-9) && !quantity.agrees(0.0));
        quantity.runs.b = None;
        assert!(!quantity.agrees(0.5) && quantity.difference().is_none());
    }
}
