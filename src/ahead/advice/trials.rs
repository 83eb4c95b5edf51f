//! The changes that are tried, and in which order.

use super::point;
use crate::ahead::measured::is_judged_at;
use crate::alarms::{AlarmId, Change, Knob, TRIED_SPEED, TRIED_WEIGHT, rule};
use flexdrill_config::{Advice, Config};
use flexdrill_core::twin::SimulationSettings;

/// Changes that are tried, as parts of the present value, the smallest first. Between neighbours lie a tenth to a fifth of
/// the value: finer steps cost a round of members each, and a rig wavers by some percent. Speed is doubled too: from where a
/// bit sticks and slips a driller doubles the speed. A larger raise than the last would be another drilling programme.
const LOWER: [f64; 4] = [0.15, 0.3, 0.5, 0.7];
const FASTER: [f64; 4] = [0.15, 0.3, 0.5, 1.0];
const HEAVIER: [f64; 3] = [0.15, 0.3, 0.5];
// The words on a rule that is refuted depend on the range that is tried.
const _: () = assert!(1.0 - LOWER[3] - TRIED_SPEED[0] < 1e-12 && 1.0 - LOWER[3] - TRIED_WEIGHT[0] < 1e-12);
const _: () = assert!(1.0 + FASTER[3] == TRIED_SPEED[1] && 1.0 + HEAVIER[2] == TRIED_WEIGHT[1]);

/// A change to be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Trial {
    pub change: Change,
    pub raises: bool,
}

impl Trial {
    /// Whether another changes the same input in the same sense.
    fn is_along(&self, other: &Self) -> bool {
        (self.change.quantity, self.raises) == (other.change.quantity, other.raises)
    }
}

/// What a rule says of a direction: 0 where it names it, 1 where it says nothing, 2 where it names the opposite only.
fn rank(rule: &Advice, trial: &Trial) -> u8 {
    let named = |quantity, raises| match (quantity, raises) {
        (Knob::Speed, false) => rule.lower_rotary_speed_rpm.is_some(),
        (Knob::Speed, true) => rule.raise_rotary_speed_rpm.is_some(),
        (Knob::Weight, false) => rule.lower_weight_on_bit_kn.is_some(),
        (Knob::Weight, true) => rule.raise_weight_on_bit_kn.is_some(),
    };
    let quantity = trial.change.quantity;
    match (named(quantity, trial.raises), named(quantity, !trial.raises)) {
        (true, _) => 0,
        (false, false) => 1,
        (false, true) => 2,
    }
}

/// The changes from a speed (r/min) and a weight (kN), direction by direction, the smallest of each first. Directions that
/// the rule of the alarm names come first and those that it speaks against last; between equals less comes before more,
/// and speed before weight: less speed takes energy out of every motion of the tool.
pub(super) fn trials(config: &Config, rule: &Advice, rpm: f64, kn: f64) -> Vec<Trial> {
    let inputs = &config.inputs;
    let mut found: Vec<Trial> = Vec::new();
    let directions: [(Knob, &[f64], f64); 4] = [
        (Knob::Speed, &LOWER, -1.0),
        (Knob::Weight, &LOWER, -1.0),
        (Knob::Speed, &FASTER, 1.0),
        (Knob::Weight, &HEAVIER, 1.0),
    ];
    for (quantity, sizes, sense) in directions {
        // What a driller can set: whole turns per minute, half kilonewtons.
        let (value, step, [least, most]) = match quantity {
            Knob::Speed => (rpm, 1.0, [inputs.rotary_speed.min_rpm, inputs.rotary_speed.max_rpm]),
            Knob::Weight => (kn, 0.5, [inputs.weight_on_bit.min_kn, inputs.weight_on_bit.max_kn]),
        };
        for size in sizes {
            let to = (value * (1.0 + sense * size) / step).round() * step;
            let trial = Trial {
                change: Change { quantity, to },
                raises: sense > 0.0,
            };
            // Rounding can give the present value or a change that is already in the list; a second run of either would
            // cost a look-ahead and decide nothing. The bounds are those of the inputs: the node would refuse a value
            // beyond.
            let known = found.iter().any(|other| other.change == trial.change);
            if to > 0.0 && to != value && (least..=most).contains(&to) && !known {
                found.push(trial);
            }
        }
    }
    // The sort keeps the sequence of equals. The rule names directions from the mechanics of the alarm. It orders the trials
    // only, because the look-ahead decides.
    found.sort_by_key(|trial| rank(rule, trial));
    found
}

/// The changes that are tried against an alarm from a speed (r/min) and weight (kN): those to points at which it is
/// judged.
pub(super) fn judged_trials(
    config: &Config,
    settings: &SimulationSettings,
    alarm: AlarmId,
    from: [f64; 2],
) -> Vec<Trial> {
    let mut trials = trials(config, &rule(alarm, &config.alarms.advice), from[0], from[1]);
    trials.retain(|trial| is_judged_at(alarm, point(from, trial.change), settings));
    trials
}

/// The trials of each direction, as places in the list of all.
pub(super) fn ladders(trials: &[Trial]) -> Vec<Vec<usize>> {
    let mut ladders: Vec<Vec<usize>> = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let same = |ladder: &&mut Vec<usize>| ladder.first().is_some_and(|first| trials[*first].is_along(trial));
        match ladders.iter_mut().find(same) {
            Some(ladder) => ladder.push(index),
            None => ladders.push(vec![index]),
        }
    }
    ladders
}
