//! What the bit does across the hole, over every step: an instant would alias with the rotation.

use serde::{Deserialize, Serialize};

use crate::step::Stepper;
use crate::tool::Direction;
use crate::twin::snapshot::Steering;

/// Torque, speed, weight, side force (right, low) and tilt (right, low) of a step.
type Values = [f64; 7];

/// Integrals over the steps of an interval.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct SteeringMeans {
    integrals: Values,
    duration: f64,
}

impl SteeringMeans {
    /// Takes a step of `dt` (s), at its end.
    pub fn push(&mut self, dt: f64, stepper: &Stepper) {
        for (integral, value) in self.integrals.iter_mut().zip(present(stepper)) {
            *integral += value * dt;
        }
        self.duration += dt;
    }

    /// Starts the next interval.
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    /// Means of the interval so far; at its start the present values, over no time.
    pub fn value(&self, stepper: &Stepper) -> Steering {
        let values = if self.duration > 0.0 {
            self.integrals.map(|integral| integral / self.duration)
        } else {
            present(stepper)
        };
        let [torque, rotary_speed, weight_on_bit, right, low, tilt_right, tilt_low] = values;
        Steering {
            duration: self.duration,
            torque,
            rotary_speed,
            weight_on_bit,
            side_force: [right, low],
            tilt: [tilt_right, tilt_low],
        }
    }
}

/// The values at the end of the last step.
///
/// The supports at the bit hold it on the axis of the hole, as the rock does: their forces on both pipes together, across
/// the hole, are the opposite of what the bit pushes on the rock. The guide's last slope is that of the bit's axis.
fn present(stepper: &Stepper) -> Values {
    let model = stepper.model();
    let last = model.last();
    let bottom = &model.stations[last];
    let at_bit = model.held_nodes.iter().filter(|held| held.station == last);
    let held = at_bit.map(|held| stepper.reaction(held)[0]);
    let across = bottom.frame.tr_mul(&held.sum());
    let slope = |about: Direction| stepper.value(|state| &state.q, bottom.guide + about as usize);
    let bit = &stepper.interactions().bit;
    [
        bit.torque,
        stepper.bottom_motion().spin_rate,
        bit.weight,
        -across.y,
        -across.z,
        slope(Direction::PhiZ),
        -slope(Direction::PhiY),
    ]
}
