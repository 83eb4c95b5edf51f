//! Columns with a unit and without a name: by how they change together with others.

use super::{Judged, REST, rests};
use crate::guess::Quantity;
use crate::guess::numbers::{quantile, rest_together, together, usual};
use flexdrill_core::inputs::{Dimension, Unit};

/// A column without a name is the weight or the hook load below this: recorders compute one from the other, and a weight that
/// is measured in the hole follows less closely.
const SAME_SENSOR: f64 = -0.85;

impl Judged<'_> {
    /// Forces without a name: the one that rests and mirrors the other is the weight on bit.
    pub(super) fn opaque_forces(&mut self) {
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
    pub(super) fn opaque_speed_and_torque(&mut self) {
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
    pub(super) fn rest_of_opaque(&mut self) {
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

/// The usual size of the changes over ten rows.
fn spread(values: &[f64]) -> f64 {
    let later = values.iter().skip(10);
    quantile(
        values.iter().zip(later).map(|(value, later)| (later - value).abs()),
        0.75,
    )
}
