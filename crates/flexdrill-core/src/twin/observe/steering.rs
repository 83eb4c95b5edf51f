//! What the bit does across the hole, over every step: an instant would alias with the rotation.

use nalgebra::Vector3;
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
    /// Length of hole made since the run began (m), over all intervals.
    drilled: f64,
}

impl SteeringMeans {
    /// Takes a step of `dt` (s), at its end, with torque, speed and weight of the bit, and the rate (m/s) at which the hole
    /// deepens.
    pub fn push(&mut self, dt: f64, bit: [f64; 3], deepens: f64, stepper: &Stepper) {
        for (integral, value) in self.integrals.iter_mut().zip(together(bit, across(stepper))) {
            *integral += value * dt;
        }
        self.duration += dt;
        self.drilled += deepens * dt;
    }

    /// Starts the next interval.
    pub fn restart(&mut self) {
        *self = Self {
            drilled: self.drilled,
            ..Self::default()
        };
    }

    /// Means of the interval so far; at its start the present values, over no time, with these of the bit.
    pub fn value(&self, bit: [f64; 3], stepper: &Stepper) -> Steering {
        let values = if self.duration > 0.0 {
            self.integrals.map(|integral| integral / self.duration)
        } else {
            together(bit, across(stepper))
        };
        let [torque, rotary_speed, weight_on_bit, right, low, tilt_right, tilt_low] = values;
        Steering {
            duration: self.duration,
            torque,
            rotary_speed,
            weight_on_bit,
            side_force: [right, low],
            tilt: [tilt_right, tilt_low],
            drilled: self.drilled,
        }
    }
}

/// All values of a step.
fn together([torque, speed, weight]: [f64; 3], [right, low, tilt_right, tilt_low]: [f64; 4]) -> Values {
    [torque, speed, weight, right, low, tilt_right, tilt_low]
}

/// Side force and tilt at the end of the last step.
///
/// The supports at the bit hold it on the axis of the hole, as the rock does: their forces on both pipes together, across
/// the hole, are the opposite of what the bit pushes on the rock. The guide's last slope is that of the bit's axis.
fn across(stepper: &Stepper) -> [f64; 4] {
    let model = stepper.model();
    let last = model.last();
    let [above, bottom] = [&model.stations[last - 1], &model.stations[last]];
    let at_bit = model.held_nodes.iter().filter(|held| held.station == last);
    let held: Vector3<f64> = at_bit.map(|held| stepper.reaction(held)[0]).sum();
    let across = bottom.frame.tr_mul(&held);
    let guide = |direction: Direction| stepper.value(|state| &state.q, bottom.guide + direction as usize);
    // A guide on the wall outside of the arc has a longer way, and its end lies some millimetres up the hole. A section that
    // slides by u has turned by kb u with the hole: that is no tilt against it. The hole bends in its vertical plane alone.
    let curvature = (bottom.inclination - above.inclination) / (bottom.depth - above.depth);
    let turned_with_the_hole = curvature * guide(Direction::U);
    [
        -across.y,
        -across.z,
        guide(Direction::PhiZ),
        turned_with_the_hole - guide(Direction::PhiY),
    ]
}
