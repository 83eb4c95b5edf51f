//! The rock's torque on the bit: Eq. 1 times a smooth sign of the bit's speed.
//!
//! Where the bit sticks, the smooth sign is much steeper than all else that holds the bit: Newton's line through a
//! speed on one side of zero leads far to the other, and back. There the slope is taken with the torque that the
//! correction before counted on: of t sqrt(v^2 + s^2) = T v with both t and v unknown, linearised in both (Chan, Golub
//! and Mulet, SIAM J. Sci. Comput. 20, 1999). It is the exact slope where both agree, so that the last corrections are
//! as good as Newton's; the solution is the same.

use super::gap::regularised_sign;

/// The torque at the last residual with its slope, and what the corrections of a step have learned.
#[derive(Debug, Clone, Copy, Default)]
pub struct BitTorque {
    /// Torque against the rotation (N m).
    pub torque: f64,
    /// d torque / d speed as the tangent takes it (N m s/rad).
    pub slope: f64,
    /// Part of the full torque that the last correction counted on, -1 to 1.
    expected: Option<f64>,
    /// Whether a correction of this step went through zero without counting on it.
    crossed: bool,
}

impl BitTorque {
    /// Begins the corrections of a step.
    pub fn begin(&mut self) {
        (self.expected, self.crossed) = (None, false);
    }

    /// Evaluates at a speed (rad/s), for the full torque (N m, >= 0) and the width of the sign (rad/s).
    pub fn evaluate(&mut self, full: f64, speed: f64, slip_rate: f64) {
        let (sign, slope) = regularised_sign(speed, slip_rate);
        self.torque = full * sign;
        self.slope = full * slope;
        let Some(expected) = self.expected.take() else { return };
        self.crossed |= expected * sign < 0.0;
        if self.crossed {
            self.slope = full * (1.0 - expected * sign) / (speed * speed + slip_rate * slip_rate).sqrt();
        }
    }

    /// Notes that a correction changes the speed by `by` (rad/s) with the full torque `full`.
    pub fn corrected(&mut self, full: f64, by: f64) {
        self.expected = (full > 0.0).then(|| ((self.torque + self.slope * by) / full).clamp(-1.0, 1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corrections until `give` v + torque(v) = `load` holds, from `speed`; `None` after 15.
    fn corrections(give: f64, load: f64, slip_rate: f64, mut speed: f64, learn: bool) -> Option<u32> {
        let (mut bit, full) = (BitTorque::default(), 92.0);
        for iteration in 0..15 {
            bit.evaluate(full, speed, slip_rate);
            let residual = give * speed + bit.torque - load;
            if residual.abs() < 1e-3 {
                return Some(iteration);
            }
            let by = -residual / (give + bit.slope);
            if learn {
                bit.corrected(full, by);
            }
            speed += by;
        }
        None
    }

    #[test]
    fn a_bit_that_sticks_is_found_from_either_side() {
        let mut lost = 0;
        for slip_rate in [1e-4, 1e-3, 0.1] {
            for load in [-91.0, -40.0, 0.0, 5.0, 60.0, 91.9, 120.0] {
                for speed in [-20.0, -0.3, -1e-3, 0.0, 1e-4, 0.02, 4.0, 30.0] {
                    // 36 N m s/rad: what a wave in the pipe's torsion gives.
                    let found = corrections(36.0, load, slip_rate, speed, true);
                    assert!(found.is_some(), "{load} N m from {speed} rad/s at {slip_rate} rad/s");
                    lost += u32::from(corrections(36.0, load, slip_rate, speed, false).is_none());
                }
            }
        }
        assert!(lost > 0, "Newton's own slope does it too: nothing is shown");
    }
}
