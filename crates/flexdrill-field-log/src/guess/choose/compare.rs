//! Columns with names, compared with each other: what changes together as their quantities do, and what does not.

use super::{Judged, REST, rests};
use crate::guess::Quantity;
use crate::guess::numbers::{above, falls, growth_over_advance, rest_together, together};
use flexdrill_core::inputs::Unit;

/// Another column mirrors the hook load below this correlation; below the second, two columns confirm their names.
const MIRROR: f64 = -0.8;
const CONFIRMS_MIRROR: f64 = -0.5;
/// Columns that rest together above this confirm their names.
const CONFIRMS_REST: f64 = 0.5;

impl Judged<'_> {
    /// The weight that the bit takes is that which the hook loses.
    pub(super) fn weight_and_hook_load(&mut self) {
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
    pub(super) fn speed_and_torque(&mut self) {
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
    pub(super) fn depths(&mut self) {
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
    pub(super) fn rate(&mut self) {
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
}
