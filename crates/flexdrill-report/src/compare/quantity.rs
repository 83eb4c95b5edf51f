//! Quantities over time in both runs.

use super::{Figures, Pair, relative};
use crate::figures::FigureHistories;
use crate::history::History;
use crate::reading::Summary;
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn, pa_to_mpa, rad_per_s_to_rpm};
use flexdrill_outputs::figures::{Group, Kind};

/// Speeds below this differ by rounding and start-up only (rad/s): 0.01 r/min.
const SPEED: f64 = 1e-3;
/// The same of forces (N), as the resolution of a rig's weight indicator is coarser.
const FORCE: f64 = 1.0;
/// The same of torques (N m).
const TORQUE: f64 = 0.1;
/// The same of powers (W).
const POWER: f64 = 0.1;
/// The same of accelerations (m/s2).
const ACCELERATION: f64 = 0.1;
/// The same of numbers alone: the stick-slip index.
const NUMBER: f64 = 0.01;
/// The same of rates (m/s), depths (m) and shares.
const SMALL: f64 = 1e-6;
/// Names of the quantities that matter most.
const AT_THE_BIT: &str = "weight on bit, at the bit";
const TORQUE_OF_THE_ROCK: &str = "torque of the rock on the bit";
const ADVANCE: &str = "rate of penetration of the bit";
/// Difference below which even these count like all others: a chaotic motion differs by as much between any two runs.
const NOTABLE: f64 = 0.01;

/// The unit in which a quantity is shown, the factor from SI, and the size (SI) below which two values count as equal
/// under a tolerance: a relative difference of two numbers near zero says nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub shown: &'static str,
    pub factor: f64,
    pub small: f64,
}

const fn unit(shown: &'static str, factor: f64, small: f64) -> Unit {
    Unit { shown, factor, small }
}

/// What is compared: a name, its unit and how a summary holds it.
struct Known<'a> {
    name: String,
    unit: Unit,
    histories: [&'a History; 2],
}

/// What matters most to who compares two runs, in this order: what acts at the bit, how fast it drills, everything else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Importance {
    AtTheBit,
    Advance,
    Other,
}

/// The comparison of one quantity over time. Values in SI.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ComparedQuantity {
    pub name: String,
    pub unit: Unit,
    pub runs: Pair<Option<Figures>>,
}

impl ComparedQuantity {
    /// How much the difference of this quantity matters.
    pub(crate) fn importance(&self) -> Importance {
        match self.name.as_str() {
            _ if self.difference().is_none_or(|difference| difference < NOTABLE) => Importance::Other,
            AT_THE_BIT | TORQUE_OF_THE_ROCK => Importance::AtTheBit,
            ADVANCE => Importance::Advance,
            _ => Importance::Other,
        }
    }

    /// Difference of the means relative to the larger one (0 to 2); `None` if a run does not have the quantity.
    pub(crate) fn difference(&self) -> Option<f64> {
        let [a, b] = [self.runs.a.as_ref()?, self.runs.b.as_ref()?];
        Some(relative(a.mean, b.mean, self.unit.small))
    }

    /// Whether the runs agree. Without any tolerance least and largest values must be the same too.
    pub(crate) fn agrees(&self, tolerance: f64) -> bool {
        match (&self.runs.a, &self.runs.b) {
            (Some(a), Some(b)) if tolerance == 0.0 => a == b,
            (Some(_), Some(_)) => self.difference().is_some_and(|difference| difference <= tolerance),
            (None, None) => true,
            _ => false,
        }
    }
}

/// Means are taken over the time in which both runs have the quantity.
fn figures(histories: [&History; 2]) -> Pair<Option<Figures>> {
    let common = match histories.map(History::span) {
        [Some([from, to]), Some([begin, end])] => Some([from.max(begin), to.min(end)]),
        _ => None,
    };
    let of = |history: &History| {
        let range = history.range()?;
        let mean = common.and_then(|[from, to]| history.mean_between(from, to));
        Some(Figures {
            min: range.min,
            mean: mean.unwrap_or(range.mean),
            max: range.max,
        })
    };
    let [a, b] = histories.map(of);
    Pair { a, b }
}

/// All quantities that at least one run has and that are not zero throughout in both.
pub(crate) fn all(a: &Summary, b: &Summary) -> Vec<ComparedQuantity> {
    let acts = |figures: &Option<Figures>| figures.as_ref().is_some_and(|f| f.min != 0.0 || f.max != 0.0);
    known(a, b)
        .into_iter()
        .map(|known| ComparedQuantity {
            name: known.name,
            unit: known.unit,
            runs: figures(known.histories),
        })
        .filter(|quantity| acts(&quantity.runs.a) || acts(&quantity.runs.b))
        .collect()
}

fn known<'a>(a: &'a Summary, b: &'a Summary) -> Vec<Known<'a>> {
    // Each quantity has the size below which a difference is noise.
    let speed = unit("r/min", rad_per_s_to_rpm(1.0), SPEED);
    let force = unit("kN", n_to_kn(1.0), FORCE);
    let torque = unit("N m", 1.0, TORQUE);
    let advance = unit("m/h", m_per_s_to_m_per_h(1.0), SMALL);
    let pressure = unit("MPa", pa_to_mpa(1.0), 1e3);
    let mut all = Vec::new();
    // One function gives the history in both summaries, so that no pair can be mixed up.
    let mut add = |name: &str, unit: Unit, of: fn(&Summary) -> &History| {
        all.push(Known {
            name: name.to_owned(),
            unit,
            histories: [of(a), of(b)],
        });
    };
    // From the inputs to the bit: a reader looks for the first quantity that differs, which causes the others.
    add("rotary speed, received", speed, |s| &s.drive.received.rotary_speed);
    add("rotary speed, accepted", speed, |s| &s.drive.accepted.rotary_speed);
    add("weight on bit, received", force, |s| &s.drive.received.weight_on_bit);
    add("weight on bit, accepted", force, |s| &s.drive.accepted.weight_on_bit);
    add("rate of penetration, accepted", advance, |s| {
        &s.drive.rate_of_penetration.accepted
    });
    add("standpipe pressure, accepted", pressure, |s| {
        &s.drive.standpipe_pressure.accepted
    });
    add("torque at the uppermost joint", torque, |s| &s.drive.top_torque);
    // Every figure that tables show follows, so that one that is added is compared too.
    all.extend(figures_of([&a.bit, &b.bit]));
    all.extend(figures_of([&a.transfer.figures, &b.transfer.figures]));
    all
}

/// The figures of a message in both runs. They are the same, as one table lists them, so that equal ones are paired.
fn figures_of<'a, M>([a, b]: [&'a FigureHistories<M>; 2]) -> impl Iterator<Item = Known<'a>> {
    a.all.iter().zip(&b.all).map(|(a, b)| {
        // Powers have short names, and friction takes both torque and power.
        let before = match a.shown.group {
            Group::Friction => "torque: ",
            Group::PutIn => "power put in: ",
            Group::Taken => "power taken: ",
            Group::Bit | Group::Torque | Group::Weight | Group::Drag | Group::Whole => "",
        };
        let small = match a.figure.kind {
            Kind::Force | Kind::Weight => FORCE,
            Kind::Torque => TORQUE,
            Kind::Power => POWER,
            Kind::RotarySpeed => SPEED,
            Kind::Acceleration => ACCELERATION,
            Kind::Number => NUMBER,
            _ => SMALL,
        };
        let (shown, factor) = a.figure.kind.unit();
        Known {
            name: format!("{before}{}", a.shown.label),
            unit: unit(shown, factor, small),
            histories: [&a.history, &b.history],
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_outputs::figures::{BIT_STATE, Shown, TRANSFER};

    /// The names by which quantities are weighed are labels of their tables.
    #[test]
    fn what_matters_most_is_a_figure() {
        let labels = |shown: Vec<Option<Shown>>| shown.into_iter().flatten().map(|shown| shown.label).collect();
        let bit: Vec<&str> = labels(BIT_STATE.iter().map(|figure| figure.shown).collect());
        let transfer: Vec<&str> = labels(TRANSFER.iter().map(|figure| figure.shown).collect());
        assert!(
            bit.contains(&AT_THE_BIT) && bit.contains(&TORQUE_OF_THE_ROCK),
            "{bit:?}"
        );
        assert!(transfer.contains(&ADVANCE), "{transfer:?}");
    }
}
