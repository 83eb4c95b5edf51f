//! One change of one input, as a rule of the configuration asks for it.

use super::{FLUCTUATION, Knob, Operating};
use crate::alarms::sentence::number;
use flexdrill_config::{Advice, InputsConfig};

/// Largest factor by which advice raises an input: more would be another drilling programme, not a response to an
/// alarm. Assumption.
const MOST_RAISE: f64 = 3.0;

/// One change of one input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub quantity: Knob,
    pub raise: bool,
    /// r/min or kN.
    limit: f64,
}

impl Step {
    /// The steps of a rule in the order in which they are tried. Less speed comes first: it takes energy out of every
    /// motion of the tool.
    pub fn of(rule: &Advice) -> impl Iterator<Item = Self> {
        let step = |quantity, raise, limit: Option<f64>| limit.map(|limit| Self { quantity, raise, limit });
        [
            step(Knob::Speed, false, rule.lower_rotary_speed_rpm),
            step(Knob::Weight, false, rule.lower_weight_on_bit_kn),
            step(Knob::Speed, true, rule.raise_rotary_speed_rpm),
            step(Knob::Weight, true, rule.raise_weight_on_bit_kn),
        ]
        .into_iter()
        .flatten()
    }

    /// Whether the step changes the present inputs within their limits. `asked` says whether the advice already contains
    /// it.
    pub fn applies(&self, now: &Operating, inputs: &InputsConfig, asked: bool) -> bool {
        let value = self.quantity.now(now);
        let margin = if asked { FLUCTUATION * self.limit } else { 0.0 };
        if self.raise {
            value < self.limit + margin && self.limit < self.quantity.most(inputs) && self.limit <= MOST_RAISE * value
        } else {
            value > self.limit - margin
        }
    }

    /// Whether look-aheads have tried inputs beyond its limit.
    pub fn was_tried(&self, now: &Operating) -> bool {
        let part = self.limit / self.quantity.now(now);
        let [least, most] = self.quantity.tried();
        (least..=most).contains(&part)
    }

    /// Whether the step violates a limit of another rule: the other lowers the input that this one raises, or the
    /// reverse.
    pub fn is_against(&self, other: &Advice) -> bool {
        Self::of(other).any(|other| {
            other.quantity == self.quantity
                && other.raise != self.raise
                && if self.raise {
                    self.limit >= other.limit
                } else {
                    self.limit <= other.limit
                }
        })
    }

    /// Whether the step brings the input at least as far as `other` does.
    pub fn serves(&self, other: &Self) -> bool {
        self.quantity == other.quantity
            && self.raise == other.raise
            && if self.raise {
                self.limit >= other.limit
            } else {
                self.limit <= other.limit
            }
    }

    pub fn sentence(&self, now: &Operating) -> String {
        let (limit, value) = (self.limit, self.quantity.now(now));
        let (verb, side) = match (self.raise, value < limit) {
            (true, true) => ("Raise", "above"),
            (true, false) => ("Raise", "well above"),
            (false, false) => ("Lower", "below"),
            (false, true) => ("Lower", "well below"),
        };
        let (unit, digits) = match self.quantity {
            Knob::Speed => ("r/min", 0),
            Knob::Weight => ("kN", 1),
        };
        if self.quantity.is_unknown(now) {
            let (beyond, change) = if self.raise {
                ("below", "raise it above")
            } else {
                ("above", "lower it below")
            };
            return format!(
                "If the {} is {beyond} {limit} {unit}, {change} that and keep the {}.",
                self.quantity.name(),
                self.quantity.other().name()
            );
        }
        let value = number(value, digits).map_or(String::new(), |value| format!(" ({value} {unit} now)"));
        format!(
            "{verb} the {} {side} {limit} {unit}{value} and keep the {}.",
            self.quantity.name(),
            self.quantity.other().name()
        )
    }
}
