//! Chooses the column of each quantity, or none: by name and unit first, then by how columns change together.

mod codes;
mod compare;
mod opaque;

use std::collections::BTreeMap;

use super::names::{GivenUnit, Meaning, meaning};
use super::numbers::{falls, size, usual};
use super::sheet::{Column, Sheet};
use super::time::Times;
use super::{Quantity, Sure};
pub(crate) use codes::codes;
use flexdrill_core::inputs::Unit;
use flexdrill_text::six_digits;

/// Columns rest together above this.
const REST: f64 = 0.8;

/// A column that is proposed for a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) index: usize,
    pub(crate) quantity: Quantity,
    pub(crate) unit: Unit,
    pub(crate) sure: Sure,
    pub(crate) evidence: Vec<String>,
}

/// What is proposed and what is not.
pub(crate) struct Choice {
    pub(crate) proposals: Vec<Candidate>,
    /// The column, what it may be, and why it is left out.
    pub(crate) left_out: Vec<(usize, Vec<Quantity>, String)>,
}

/// The columns of a log while they are judged.
struct Judged<'a> {
    sheet: &'a Sheet,
    /// Seconds of the rows; empty without a time.
    times: &'a [f64],
    chosen: BTreeMap<Quantity, Candidate>,
    /// Columns with a unit and a name that says nothing.
    opaque: Vec<(usize, Unit)>,
    left_out: Vec<(usize, Vec<Quantity>, String)>,
}

/// The columns of the quantities. Each step only takes columns away or adds them to quantities that have none.
pub(crate) fn choose(sheet: &Sheet, times: &Times) -> Choice {
    let mut judged = Judged {
        sheet,
        times: times.proposal.as_ref().map_or(&[], |time| &time.seconds),
        chosen: BTreeMap::new(),
        opaque: Vec::new(),
        left_out: Vec::new(),
    };
    let is_time = |index: usize| {
        times
            .proposal
            .as_ref()
            .is_some_and(|time| time.indices.contains(&index))
            || times.left_out.iter().any(|(left, _)| *left == index)
    };
    let mut named: BTreeMap<Quantity, Vec<Candidate>> = BTreeMap::new();
    for index in (0..sheet.columns.len()).filter(|index| !is_time(*index)) {
        if let Some(candidate) = judged.by_name(index) {
            named.entry(candidate.quantity).or_default().push(candidate);
        }
    }
    // Two columns of one name and meaning are equal: to take the first would be chance.
    for (quantity, mut candidates) in named {
        match (candidates.pop(), candidates.is_empty()) {
            (Some(only), true) => {
                judged.chosen.insert(quantity, only);
            }
            (last, _) => {
                let all: Vec<Candidate> = candidates.into_iter().chain(last).collect();
                let names: Vec<String> = all.iter().map(|one| format!("`{}`", judged.name(one.index))).collect();
                for one in all {
                    judged.leave_out(
                        one.index,
                        vec![quantity],
                        format!("{} fit equally", names.join(" and ")),
                    );
                }
            }
        }
    }
    judged.weight_and_hook_load();
    judged.speed_and_torque();
    judged.depths();
    judged.rate();
    judged.opaque_forces();
    judged.opaque_speed_and_torque();
    judged.rest_of_opaque();
    Choice {
        proposals: judged.chosen.into_values().collect(),
        left_out: judged.left_out,
    }
}

impl Judged<'_> {
    fn name(&self, index: usize) -> &str {
        self.sheet.columns.get(index).map_or("", |column| &column.name)
    }

    fn values(&self, index: usize) -> &[f64] {
        self.sheet.columns.get(index).map_or(&[], |column| &column.values)
    }

    /// The numbers of a chosen quantity, SI.
    fn chosen_si(&self, quantity: Quantity) -> Option<Vec<f64>> {
        let candidate = self.chosen.get(&quantity)?;
        Some(self.si(candidate.index, candidate.unit))
    }

    fn si(&self, index: usize, unit: Unit) -> Vec<f64> {
        self.values(index).iter().map(|value| unit.to_si(*value)).collect()
    }

    fn leave_out(&mut self, index: usize, may_be: Vec<Quantity>, why: String) {
        self.left_out.push((index, may_be, why));
    }

    /// Takes a quantity's column away again.
    fn reject(&mut self, quantity: Quantity, why: &str) {
        if let Some(candidate) = self.chosen.remove(&quantity) {
            self.leave_out(
                candidate.index,
                vec![quantity],
                format!("named as {}, but {why}", quantity.name()),
            );
        }
    }

    fn confirm(&mut self, quantity: Quantity, evidence: String) {
        if let Some(candidate) = self.chosen.get_mut(&quantity) {
            // A unit that only the size of the numbers shows remains likely.
            if candidate.evidence.iter().all(|evidence| !evidence.contains(BY_SIZE)) {
                candidate.sure = Sure::Sure;
            }
            candidate.evidence.push(evidence);
        }
    }

    fn propose_weak(&mut self, index: usize, unit: Unit, quantity: Quantity, evidence: String) {
        self.opaque.retain(|(other, _)| *other != index);
        let candidate = Candidate {
            index,
            quantity,
            unit,
            sure: Sure::Weak,
            evidence: vec![format!("unit {unit}"), evidence],
        };
        self.chosen.insert(quantity, candidate);
    }

    /// Whether a quantity has no column, nor one that was left out although its name says this quantity.
    fn is_open(&self, quantity: Quantity) -> bool {
        let is_named = |index: usize| meaning(self.name(index), "").0 != Meaning::Nothing;
        let mut left_out = self.left_out.iter();
        !self.chosen.contains_key(&quantity)
            && !left_out.any(|(index, may_be, _)| may_be.contains(&quantity) && is_named(*index))
    }

    /// The candidate of a column by its name and unit, where the numbers fit both.
    fn by_name(&mut self, index: usize) -> Option<Candidate> {
        let column = self.sheet.columns.get(index)?;
        let (means, unit) = meaning(&column.name, &column.unit);
        if let Some(why) = unusable(column) {
            let may_be = if let Meaning::Quantity(quantity) = means {
                vec![quantity]
            } else {
                Vec::new()
            };
            self.leave_out(index, may_be, why);
            return None;
        }
        let quantity = match means {
            Meaning::Quantity(quantity) => quantity,
            Meaning::Other(what) => {
                self.leave_out(index, Vec::new(), format!("{what}; the twin does not read it"));
                return None;
            }
            Meaning::Partly(quantity, word) => {
                let why = format!("its name also says `{word}`, which may make it another quantity");
                self.leave_out(index, vec![quantity], why);
                return None;
            }
            Meaning::Depth => {
                let why = "bit depth and hole depth fit equally".to_owned();
                self.leave_out(index, vec![Quantity::BitDepth, Quantity::HoleDepth], why);
                return None;
            }
            Meaning::Unknown => {
                self.leave_out(index, Vec::new(), "its name is not known here".to_owned());
                return None;
            }
            Meaning::Nothing => {
                match unit {
                    // Strokes of a pump are counted in 1/min too.
                    GivenUnit::Known(unit) if !column.unit.starts_with("1/") => self.opaque.push((index, unit)),
                    _ => {
                        let why = "its name says nothing, and numbers alone do not show a quantity and its unit";
                        self.leave_out(index, self.may_be_by_numbers(index), why.to_owned());
                    }
                }
                return None;
            }
        };
        let usual_size = usual(&column.values);
        let fits = |unit: Unit| {
            let [least, most] = quantity.usual();
            let size = unit.to_si(usual_size);
            (least..=most).contains(&size)
        };
        let named = format!("named as {}", quantity.name());
        // A given unit must fit; without one the size of the numbers must leave one unit only.
        let found = match unit {
            GivenUnit::Known(unit) if unit.dimension() != quantity.dimension() => Err(format!(
                "{named}, and its unit {unit} is none of {}",
                quantity.dimension().units()
            )),
            GivenUnit::Known(unit) if fits(unit) => Ok((unit, format!("unit {unit}"))),
            GivenUnit::Known(unit) => Err(format!(
                "{named}, and its usual size of {} {unit} is not that of a rig",
                six_digits(usual_size)
            )),
            GivenUnit::Several(text, write) => Err(format!("{named}, and its unit {text:?} is not clear: {write}")),
            GivenUnit::Unknown(text) => Err(format!("{named}, and its unit {text:?} is not known")),
            GivenUnit::None => {
                let fitting: Vec<Unit> = Unit::ALL
                    .into_iter()
                    .filter(|unit| unit.dimension() == quantity.dimension() && fits(*unit))
                    .collect();
                match &fitting[..] {
                    [only] => Ok((*only, format!("{BY_SIZE} only {only}"))),
                    [] => Err(format!(
                        "{named}, and with its usual size of {} no unit fits a rig",
                        six_digits(usual_size)
                    )),
                    several => {
                        let names: Vec<&str> = several.iter().map(|unit| unit.name()).collect();
                        Err(format!(
                            "{named}, and its unit is not in the log; {} fit",
                            names.join(", ")
                        ))
                    }
                }
            }
        };
        match found {
            Ok((unit, why)) => Some(Candidate {
                index,
                quantity,
                unit,
                sure: Sure::Likely,
                evidence: vec![named, why],
            }),
            Err(why) => {
                self.leave_out(index, vec![quantity], why);
                None
            }
        }
    }

    /// What a column without name and unit may be, by size: for the reader, and never believed.
    fn may_be_by_numbers(&self, index: usize) -> Vec<Quantity> {
        let values = self.values(index);
        let usual_size = usual(values);
        let in_usual_units = |quantity: Quantity| {
            let [least, most] = quantity.usual();
            (least..=most).contains(&quantity.dimension().known_in().to_si(usual_size))
        };
        let grows = falls(values).is_some_and(|falls| falls < 1e-3);
        let depths = [Quantity::BitDepth, Quantity::HoleDepth];
        let fits = |quantity: &Quantity| in_usual_units(*quantity) && depths.contains(quantity) == grows;
        Quantity::ALL.into_iter().filter(fits).collect()
    }
}

/// How the evidence of a unit begins that is in no word of the log.
const BY_SIZE: &str = "the size of its numbers fits";

/// Why a column cannot be used, whatever it is.
fn unusable(column: &Column) -> Option<String> {
    let why = if !column.has_own_name {
        "its name is empty, not text, or stands twice in the header"
    } else if column.first.is_empty() {
        "it is empty"
    } else if !column.is_number {
        "its fields are no numbers"
    } else if column.numbers().next().is_none() {
        "it has no value in any row"
    } else if column.numbers().all(|value| value == 0.0) {
        "it is 0 in all rows"
    } else {
        return None;
    };
    Some(why.to_owned())
}

/// The share of the rows at rest.
fn rests(values: &[f64]) -> f64 {
    let rest = 0.05 * size(values);
    let (mut all, mut resting) = (0_usize, 0_usize);
    for value in values.iter().filter(|value| !value.is_nan()) {
        all += 1;
        resting += usize::from(value.abs() <= rest);
    }
    if all == 0 { 0.0 } else { resting as f64 / all as f64 }
}
