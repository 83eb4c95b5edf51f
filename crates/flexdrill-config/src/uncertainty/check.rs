//! The checks of `uncertainty`: distributions against the limits of their keys, and correlations against each other.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::{Correlated, Distribution, Form, UncertainKey, Uncertainty};
use crate::checker::{Checker, NumberKey, number};
use crate::lines::Lines;
use crate::reading::nearest;

/// Most entries: the correlation of all pairs is factored at every check.
const MOST_KEYS: usize = 200;
/// Name of the section, in the names of its own numbers.
const SECTION: &str = "uncertainty.";

impl Uncertainty {
    /// Checks the section, `known` being the numbers of all other sections.
    pub(crate) fn check(&self, c: &mut Checker, known: &[NumberKey]) {
        self.check_numbers(c);
        let size = self.keys.len().max(self.correlated.len());
        c.require(
            size <= MOST_KEYS,
            "keys",
            size,
            "entries",
            format!("at most {MOST_KEYS}"),
            "a table of this size is not stated from knowledge",
        );
        // The checks below are of all pairs; a longer list is refused already.
        if size > MOST_KEYS {
            return;
        }
        let known = by_name(known);
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        c.below("keys", |c| {
            for (index, entry) in self.keys.iter().enumerate() {
                c.below(index, |c| {
                    entry.check(c, &known);
                    for name in entry.names() {
                        let before = seen.insert(name, index);
                        c.require(
                            before.is_none(),
                            "key",
                            name,
                            "",
                            "given once",
                            "a key has one distribution",
                        );
                    }
                });
            }
        });
        self.check_correlations(c);
    }

    /// The section without the entries that do not hold for `known`, the numbers of all other sections.
    pub(crate) fn that_holds(mut self, known: &[NumberKey]) -> Self {
        let known = by_name(known);
        let lines = Lines::default();
        self.keys.retain(|entry| {
            let mut alone = Checker::new("", &lines);
            entry.check(&mut alone, &known);
            alone.finish().is_ok()
        });
        let mut correlated = std::mem::take(&mut self.correlated);
        for group in &mut correlated {
            group.keys.retain(|key| self.position(key).is_some());
        }
        // A group of one key states nothing.
        correlated.retain(|group| group.keys.len() >= 2);
        self.correlated = correlated;
        self
    }

    fn check_correlations(&self, c: &mut Checker) {
        let mut is_sound = true;
        c.below("correlated", |c| {
            for (index, group) in self.correlated.iter().enumerate() {
                c.below(index, |c| is_sound &= self.check_group(c, group));
            }
        });
        let count = self.keys.len();
        let mut matrix = DMatrix::<f64>::identity(count, count);
        let mut given = vec![false; count * count];
        for (first, second, correlation) in self.correlations() {
            let (row, column) = (first.min(second), first.max(second));
            if std::mem::replace(&mut given[row * count + column], true) {
                c.wrong(
                    "correlated",
                    format!("{} with {}", self.keys[row].key, self.keys[column].key),
                    "",
                    "given once",
                    "a pair has one correlation",
                );
                is_sound = false;
            }
            matrix[(row, column)] = correlation;
            matrix[(column, row)] = correlation;
        }
        // A group that is wrong by itself has been reported, and would be reported here a second time.
        c.require(
            !is_sound || matrix.cholesky().is_some(),
            "correlated",
            "the correlations of all pairs",
            "",
            "a positive definite matrix",
            "keys that each follow a third one also follow each other; n keys cannot all be correlated by less than \
             -1 / (n - 1)",
        );
    }

    /// Whether a group is sound by itself.
    fn check_group(&self, c: &mut Checker, group: &Correlated) -> bool {
        group.check_numbers(c);
        c.require(
            group.keys.len() >= 2,
            "keys",
            group.keys.len(),
            "keys",
            "at least 2",
            "a correlation is one of a pair",
        );
        let mut is_sound = group.keys.len() >= 2 && group.correlation.abs() < 1.0;
        let mut seen = Vec::new();
        for key in &group.keys {
            let Some(place) = self.position(key) else {
                let near = nearest(key, self.keys.iter().flat_map(UncertainKey::names));
                c.wrong(
                    "keys",
                    key,
                    "",
                    format!("a key of uncertainty.keys{}", hint(near)),
                    "only what is drawn is correlated",
                );
                is_sound = false;
                continue;
            };
            if seen.contains(&place) {
                c.wrong("keys", key, "", "another draw", "a draw has no correlation with itself");
                is_sound = false;
            }
            seen.push(place);
        }
        is_sound
    }
}

fn by_name(numbers: &[NumberKey]) -> BTreeMap<&str, &NumberKey> {
    numbers.iter().map(|number| (number.key.as_str(), number)).collect()
}

fn hint(near: Option<&str>) -> String {
    near.map_or_else(String::new, |near| format!("; did you mean {near}?"))
}

impl UncertainKey {
    fn check(&self, c: &mut Checker, known: &BTreeMap<&str, &NumberKey>) {
        c.require(
            !self.source.trim().is_empty(),
            "source",
            "an empty text",
            "",
            "where the distribution comes from, if only `assumption`",
            "a distribution without a source cannot be judged",
        );
        // With a shape that is none, the range has no meaning either.
        let shape = self.distribution.problem();
        if let Some((bound, reason)) = shape {
            c.wrong("distribution", self.distribution.words(), "", bound, reason);
        }
        for (at, name) in self.names().enumerate() {
            let place = if at == 0 { "key" } else { "also" };
            match known.get(name) {
                Some(of) if shape.is_none() => self.check_range(c, of),
                Some(_) => {}
                None => {
                    let near = nearest(name, known.keys().copied());
                    let reason = if name.starts_with(SECTION) {
                        "a distribution has no distribution"
                    } else {
                        "counts, words and keys that this file leaves out have no distribution"
                    };
                    let bound = format!("the name of a number of this configuration{}", hint(near));
                    c.wrong(place, name, "", bound, reason);
                }
            }
        }
    }

    /// Holds the stated range against the limits of a key.
    fn check_range(&self, c: &mut Checker, of: &NumberKey) {
        if self.form == Form::Factor && of.value == 0.0 {
            c.wrong(
                "form",
                "factor",
                "",
                format!("value or offset while {} is 0", of.key),
                "any factor on 0 is 0",
            );
            return;
        }
        let bound = of.bound();
        let ends = self.distribution.ends().map(|end| self.form.value(end, of.value));
        for end in ends {
            c.require(
                bound.holds(end),
                "distribution",
                format!("{}, which gives {} {}", self.distribution.words(), of.key, number(end)),
                of.unit,
                bound.words(of.unit),
                of.reason,
            );
        }
    }
}

impl Distribution {
    /// As in a file.
    fn words(&self) -> String {
        let name = self.name();
        match self {
            Self::Triangular { low, mode, high } => {
                let [low, mode, high] = [low, mode, high].map(|value| number(*value));
                format!("{name} {{low: {low}, mode: {mode}, high: {high}}}")
            }
            _ => {
                let [low, high] = self.ends().map(number);
                format!("{name} {{low: {low}, high: {high}}}")
            }
        }
    }

    /// What is wrong with the numbers among themselves: bound and reason.
    fn problem(&self) -> Option<(&'static str, &'static str)> {
        let [low, high] = self.ends();
        // Differences and ratios of the ends must be finite too.
        if !(low < high && (high - low).is_finite()) {
            return Some(("low below high, both finite", "a range has a width"));
        }
        match *self {
            Self::LogNormal { .. } if low <= 0.0 || !(high / low).is_finite() => {
                Some(("low above 0", "only positive numbers have a logarithm"))
            }
            Self::Triangular { mode, .. } if !(low..=high).contains(&mode) => {
                Some(("mode from low to high", "the likeliest value is one of the values"))
            }
            _ => None,
        }
    }
}
