//! Chooses the column of each quantity, or none: by name and unit first, then by how columns change together.

use std::collections::BTreeMap;

use super::names::{GivenUnit, Meaning, meaning};
use super::numbers::{above, falls, growth_over_advance, quantile, rest_together, size, together, usual};
use super::sheet::{Column, Sheet};
use super::time::Times;
use super::{Codes, Quantity, Sure};
use flexdrill_core::inputs::{Dimension, Unit};
use flexdrill_text::{counted, six_digits};

/// Another column mirrors the hook load below this correlation; below the second, two columns confirm their names.
const MIRROR: f64 = -0.8;
const CONFIRMS_MIRROR: f64 = -0.5;
/// A column without a name is the weight or the hook load below this: recorders compute one from the other, and a weight that
/// is measured in the hole follows less closely.
const SAME_SENSOR: f64 = -0.85;
/// Columns rest together above this, and confirm their names above the second.
const REST: f64 = 0.8;
const CONFIRMS_REST: f64 = 0.5;
/// A column with more different numbers than this is no code of an activity.
const MOST_CODES: usize = 20;

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

    /// The weight that the bit takes is that which the hook loses.
    fn weight_and_hook_load(&mut self) {
        // The hook carries at least the block, so that a force that is often nothing is another one.
        if self
            .chosen_si(Quantity::HookLoad)
            .is_some_and(|hook| rests(&hook) > 0.02)
        {
            self.reject(
                Quantity::HookLoad,
                "a hook carries at least the block, and its numbers are often 0",
            );
        }
        let (Some(weight), Some(hook)) = (
            self.chosen_si(Quantity::WeightOnBit),
            self.chosen_si(Quantity::HookLoad),
        ) else {
            return;
        };
        let both = together(&weight, &hook);
        let higher = above(&weight, &hook, 0.0);
        if higher > 0.5 {
            let why = format!(
                "the weight on bit is above the hook load in {:.0} % of the rows",
                100.0 * higher
            );
            self.reject(Quantity::WeightOnBit, &why);
            self.reject(Quantity::HookLoad, &why);
            return;
        }
        match both {
            Some(both) if both < CONFIRMS_MIRROR => {
                let evidence = |other: Quantity| format!("mirrors {} (correlation {both:.2})", other.name());
                self.confirm(Quantity::WeightOnBit, evidence(Quantity::HookLoad));
                self.confirm(Quantity::HookLoad, evidence(Quantity::WeightOnBit));
            }
            both => {
                // Where another column mirrors the hook load instead, the names may be exchanged.
                if let Some(other) = self.other_mirror(&hook) {
                    let found = both.map_or_else(
                        || "does not".to_owned(),
                        |both| format!("does not (correlation {both:.2})"),
                    );
                    let why = format!("`{}` mirrors the hook load, and this column {found}", self.name(other));
                    self.reject(Quantity::WeightOnBit, &why);
                    let taken = self
                        .chosen
                        .values()
                        .find(|candidate| candidate.index == other)
                        .map(|one| one.quantity);
                    if let Some(quantity) = taken {
                        self.reject(quantity, "it mirrors the hook load");
                    }
                } else if let Some(both) = both.filter(|both| *both > -CONFIRMS_MIRROR) {
                    let why = format!("weight on bit and hook load rise and fall together (correlation {both:.2})");
                    self.reject(Quantity::WeightOnBit, &why);
                    self.reject(Quantity::HookLoad, &why);
                }
            }
        }
    }

    /// A column other than those of weight and hook load that mirrors the hook load.
    fn other_mirror(&self, hook: &[f64]) -> Option<usize> {
        let taken =
            [Quantity::WeightOnBit, Quantity::HookLoad].map(|quantity| self.chosen.get(&quantity).map(|one| one.index));
        let columns = self.sheet.columns.iter().enumerate();
        let others = columns.filter(|(index, column)| column.is_number && !taken.contains(&Some(*index)));
        let mut mirrors = others.filter(|(_, column)| together(&column.values, hook).is_some_and(|both| both < MIRROR));
        mirrors.next().map(|(index, _)| index)
    }

    /// A drive that turns needs a torque.
    fn speed_and_torque(&mut self) {
        let speed = self.chosen_si(Quantity::RotarySpeed);
        if let (Some(speed), Some(hook)) = (&speed, self.chosen_si(Quantity::HookLoad))
            && together(speed, &hook).is_some_and(|both| both < MIRROR)
        {
            self.reject(Quantity::RotarySpeed, "it mirrors the hook load, as a weight does");
            return;
        }
        let (Some(speed), Some(torque)) = (speed, self.chosen_si(Quantity::Torque)) else {
            return;
        };
        match rest_together(&speed, &torque) {
            Some(both) if both > CONFIRMS_REST => {
                let evidence = |other: Quantity| format!("at rest together with {} ({both:.2})", other.name());
                self.confirm(Quantity::RotarySpeed, evidence(Quantity::Torque));
                self.confirm(Quantity::Torque, evidence(Quantity::RotarySpeed));
            }
            Some(both) if both < 0.1 => {
                let taken = [Quantity::RotarySpeed, Quantity::Torque]
                    .map(|quantity| self.chosen.get(&quantity).map(|one| one.index));
                let columns = self.sheet.columns.iter().enumerate();
                let mut others = columns.filter(|(index, column)| column.is_number && !taken.contains(&Some(*index)));
                let other =
                    others.find(|(_, column)| rest_together(&column.values, &torque).is_some_and(|both| both > REST));
                if let Some((other, _)) = other {
                    let why = format!(
                        "`{}` is at rest together with the torque, and this column is not",
                        self.name(other)
                    );
                    self.reject(Quantity::RotarySpeed, &why);
                    self.reject(Quantity::Torque, "the speed is not at rest together with it");
                }
            }
            _ => {}
        }
    }

    /// A hole grows, and the bit is in it.
    fn depths(&mut self) {
        let (bit, hole) = (self.chosen_si(Quantity::BitDepth), self.chosen_si(Quantity::HoleDepth));
        let hole_falls = hole.as_deref().and_then(falls).is_some_and(|falls| falls > 0.2);
        // Half a metre is the rounding of recorders and the stretch of a string.
        let deeper = match (&bit, &hole) {
            (Some(bit), Some(hole)) => above(bit, hole, 0.5),
            _ => 0.0,
        };
        if deeper > 0.05 {
            let why = format!("the bit is below the hole's end in {:.0} % of the rows", 100.0 * deeper);
            self.reject(Quantity::BitDepth, &why);
            self.reject(Quantity::HoleDepth, &why);
        } else if hole_falls {
            self.reject(
                Quantity::HoleDepth,
                "a hole does not become shallower, and its numbers fall",
            );
        } else if bit.is_some() && hole.is_some() {
            self.confirm(Quantity::BitDepth, "never deeper than hole_depth".to_owned());
            self.confirm(
                Quantity::HoleDepth,
                "grows, and is never shallower than bit_depth".to_owned(),
            );
        }
    }

    /// A depth grows by the rate.
    fn rate(&mut self) {
        let depth = [Quantity::HoleDepth, Quantity::BitDepth]
            .into_iter()
            .find(|kind| self.chosen.contains_key(kind));
        let (Some(of_depth), Some(rate)) = (depth, self.chosen_si(Quantity::RateOfPenetration)) else {
            return;
        };
        let Some(depth) = self.chosen_si(of_depth) else { return };
        let rate: Vec<f64> = rate.iter().map(|rate| Unit::MetrePerHour.from_si(*rate)).collect();
        match growth_over_advance(&depth, &rate, self.times) {
            Some(ratio) if (0.6..1.6).contains(&ratio) => {
                self.confirm(
                    Quantity::RateOfPenetration,
                    format!("{} grows by it ({ratio:.2})", of_depth.name()),
                );
            }
            // Feet taken for metres give 3.3 or 0.3; it is not known in which of the two.
            Some(ratio) if !(0.4..2.5).contains(&ratio) => {
                let why = format!(
                    "{} grows by {ratio:.2} times the rate: one of their units is wrong",
                    of_depth.name()
                );
                self.reject(Quantity::RateOfPenetration, &why);
                self.reject(of_depth, &why);
            }
            _ => {}
        }
    }

    /// Forces without a name: the one that rests and mirrors the other is the weight on bit.
    fn opaque_forces(&mut self) {
        let forces: Vec<(usize, Unit)> = self
            .opaque
            .iter()
            .copied()
            .filter(|(_, unit)| unit.dimension() == Dimension::Force)
            .collect();
        let mirrors = |weight: &[f64], hook: &[f64]| {
            // Equal forces in both columns: a mirror in another scale is another quantity.
            let scale = spread(weight) / spread(hook);
            together(weight, hook).is_some_and(|both| both < SAME_SENSOR)
                && (0.3..3.0).contains(&scale)
                && usual(weight) < usual(hook)
        };
        let mut pairs: Vec<[Option<(usize, Unit)>; 2]> = Vec::new();
        match (
            self.chosen_si(Quantity::WeightOnBit),
            self.chosen_si(Quantity::HookLoad),
        ) {
            (Some(_), Some(_)) => return,
            (Some(weight), None) => {
                let found = forces
                    .iter()
                    .filter(|(index, unit)| mirrors(&weight, &self.si(*index, *unit)));
                pairs.extend(found.map(|hook| [None, Some(*hook)]));
            }
            (None, Some(hook)) => {
                let found = forces
                    .iter()
                    .filter(|(index, unit)| mirrors(&self.si(*index, *unit), &hook));
                pairs.extend(found.map(|weight| [Some(*weight), None]));
            }
            (None, None) => {
                for weight in &forces {
                    let values = self.si(weight.0, weight.1);
                    let hooks = forces.iter().filter(|hook| hook.0 != weight.0);
                    let hooks =
                        hooks.filter(|hook| rests(&values) > 0.02 && mirrors(&values, &self.si(hook.0, hook.1)));
                    pairs.extend(hooks.map(|hook| [Some(*weight), Some(*hook)]));
                }
            }
        }
        let [pair] = pairs[..] else { return };
        let open = [Quantity::WeightOnBit, Quantity::HookLoad];
        for (found, quantity) in pair.into_iter().zip(open) {
            if let Some((index, unit)) = found
                && self.is_open(quantity)
            {
                let evidence = match quantity {
                    Quantity::WeightOnBit => "mirrors the hook load, and is the smaller",
                    _ => "mirrors the weight on bit, and is the larger",
                };
                self.propose_weak(index, unit, quantity, evidence.to_owned());
            }
        }
    }

    /// A speed and a torque without names: they are at rest together.
    fn opaque_speed_and_torque(&mut self) {
        let of = |dimension: Dimension| -> Vec<(usize, Unit)> {
            self.opaque
                .iter()
                .copied()
                .filter(|(_, unit)| unit.dimension() == dimension)
                .collect()
        };
        let chosen = |quantity| self.chosen.get(&quantity).map(|one| (one.index, one.unit));
        let speeds = chosen(Quantity::RotarySpeed).map_or_else(|| of(Dimension::RotarySpeed), |one| vec![one]);
        let torques = chosen(Quantity::Torque).map_or_else(|| of(Dimension::Torque), |one| vec![one]);
        let mut pairs = Vec::new();
        for speed in &speeds {
            for torque in &torques {
                if rest_together(self.values(speed.0), self.values(torque.0)).is_some_and(|both| both > REST) {
                    pairs.push([(*speed, Quantity::RotarySpeed), (*torque, Quantity::Torque)]);
                }
            }
        }
        // With several speeds or torques each may be that of a motor or of a pump.
        let ([pair], [_], [_]) = (&pairs[..], &speeds[..], &torques[..]) else {
            return;
        };
        for ((index, unit), quantity) in *pair {
            let [least, most] = quantity.usual();
            let fits = (least..=most).contains(&unit.to_si(usual(self.values(index))));
            if self.is_open(quantity) && fits {
                let other = if quantity == Quantity::Torque {
                    "speed"
                } else {
                    "torque"
                };
                self.propose_weak(index, unit, quantity, format!("at rest together with the {other}"));
            }
        }
    }

    /// What has a unit and no name, and no other column that shows what it is.
    fn rest_of_opaque(&mut self) {
        for (index, unit) in std::mem::take(&mut self.opaque) {
            let fits: Vec<Quantity> = Quantity::ALL
                .into_iter()
                .filter(|quantity| quantity.dimension() == unit.dimension())
                .collect();
            let why = match fits.len() {
                0 => format!("its name says nothing, and nothing that the twin reads has the unit {unit}"),
                1 => format!("its name says nothing, and its unit {unit} alone does not show what was measured"),
                _ => {
                    let names: Vec<&str> = fits.iter().map(|quantity| quantity.name()).collect();
                    format!(
                        "its name says nothing, and its unit {unit} fits {} equally",
                        names.join(" and ")
                    )
                }
            };
            self.leave_out(index, fits, why);
        }
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

/// The usual size of the changes over ten rows.
fn spread(values: &[f64]) -> f64 {
    let later = values.iter().skip(10);
    quantile(
        values.iter().zip(later).map(|(value, later)| (later - value).abs()),
        0.75,
    )
}

/// The column of activities, with what the other columns have in each of its codes.
pub(crate) fn codes(sheet: &Sheet, proposals: &[Candidate]) -> Option<Codes> {
    let is_code = |column: &&Column| {
        let is_named = matches!(meaning(&column.name, "").0, Meaning::Other("a code of an activity"));
        is_named && column.is_number && column.has_own_name
    };
    let column = sheet.columns.iter().find(is_code)?;
    let mut rows: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (row, value) in column.values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
        // A code is a small whole number.
        if value.fract() != 0.0 || value.abs() > 1e6 || rows.len() > MOST_CODES {
            return None;
        }
        rows.entry(*value as i64).or_default().push(row);
    }
    let shown = [Quantity::HookLoad, Quantity::RotarySpeed, Quantity::Torque];
    let lines = rows.iter().map(|(code, rows)| {
        let mut line = format!("{code}: {}", counted(rows.len() as u64, "row"));
        for one in proposals.iter().filter(|one| shown.contains(&one.quantity)) {
            let values = sheet.columns.get(one.index).map_or(&[][..], |column| &column.values);
            let median = quantile(rows.iter().filter_map(|row| values.get(*row).copied()), 0.5);
            if median.is_finite() {
                line.push_str(&format!(
                    ", median {} {} {}",
                    one.quantity.name(),
                    six_digits(median),
                    one.unit
                ));
            }
        }
        line
    });
    Some(Codes {
        column: column.name.clone(),
        lines: lines.collect(),
    })
}
