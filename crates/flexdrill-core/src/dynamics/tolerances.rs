//! When an iterate is accepted: how far a node may be out of balance, and a row from zero.

use crate::model::Model;

/// When an iterate is accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Largest unbalanced force on a node at rest (N).
    pub force: f64,
    /// Largest unbalanced moment on a node at rest (N m).
    pub moment: f64,
    /// The same in motion, in steps of [`WHOLE_STEP`] and more, as a part of the weight of both pipes, and at most this
    /// force (N); shorter steps have less ([`Limits::for_step`]).
    pub moving_force: (f64, f64),
    /// Moment per force in motion (m).
    pub moving_moment: f64,
    /// Largest opening of a joint (m) and largest value of a rotational row (-).
    pub constraint: f64,
    /// Corrections after which a sub-step counts as not converged.
    pub max_iterations: u32,
}

impl Default for Tolerances {
    /// 10 mN and 1 mN m at rest: a millionth of a weight on bit of 10 kN and a hundred-thousandth of its torque, five
    /// orders above the rounding of the stiffest element. In motion 1 N and 0.1 N m: a hundredth of the RMS contact
    /// forces and below the error of a step of [`WHOLE_STEP`]; statistics with a hundredth of it do not differ. Tools lighter
    /// than 2 kN have smaller limits in proportion. Rows to 1e-10 m, a tenth of the
    /// documented accuracy.
    fn default() -> Self {
        Self {
            force: 1e-2,
            moment: 1e-3,
            moving_force: (5e-4, 1.0),
            moving_moment: 0.1,
            constraint: 1e-10,
            max_iterations: 15,
        }
    }
}

impl Tolerances {
    /// The same with `factor` times the forces and moments.
    pub fn times(self, factor: f64) -> Self {
        let (part, most) = self.moving_force;
        Self {
            force: factor * self.force,
            moment: factor * self.moment,
            moving_force: (factor * part, factor * most),
            ..self
        }
    }

    /// Largest unbalanced force on a node of `model` in motion (N).
    pub(crate) fn moving_force(&self, model: &Model) -> f64 {
        let (part, most) = self.moving_force;
        (part * model.mass() * 9.81).clamp(self.force.min(most), most)
    }
}

/// Step (s) that the tolerances in motion are for.
const WHOLE_STEP: f64 = 0.5e-3;

/// How closely a step's equations are to be solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Accuracy {
    /// As the static start needs it.
    Rest,
    /// As motion needs it.
    Motion,
}

/// One over the limit on each residual, zero where there is no equation.
#[derive(Clone)]
pub(crate) struct Limits {
    rest: Vec<f64>,
    /// In motion, for [`WHOLE_STEP`].
    whole: Vec<f64>,
    /// In motion, for the step in hand.
    motion: Vec<f64>,
    step: f64,
}

impl Limits {
    /// From one over the limits at rest and in motion.
    pub(crate) fn new(rest: Vec<f64>, whole: Vec<f64>) -> Self {
        Self {
            motion: whole.clone(),
            rest,
            whole,
            step: WHOLE_STEP,
        }
    }

    /// Sets the limits in motion for steps of size `h` (s). The error of a step falls with its square, and so do the limits,
    /// down to those at rest: with 1 N, half and quarter steps, which begin nearer to their end, would stop a correction
    /// early, and the limit would determine their errors.
    pub(crate) fn for_step(&mut self, h: f64) {
        if h == self.step {
            return;
        }
        self.step = h;
        let tighter = (WHOLE_STEP / h).powi(2).max(1.0);
        for (motion, (whole, rest)) in self.motion.iter_mut().zip(self.whole.iter().zip(&self.rest)) {
            *motion = (whole * tighter).min(rest.max(*whole));
        }
    }

    /// One over the limits.
    pub(crate) fn weights(&self, accuracy: Accuracy) -> &[f64] {
        match accuracy {
            Accuracy::Rest => &self.rest,
            Accuracy::Motion => &self.motion,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_left_falls_with_the_square_of_the_step_down_to_that_at_rest() {
        // A force, a row, a row without an equation, a force whose limit in motion is the smaller one.
        let mut limits = Limits::new(vec![100.0, 1e10, 0.0, 100.0], vec![1.0, 1e10, 0.0, 1e5]);
        let mut at = |h: f64| {
            limits.for_step(h);
            limits.weights(Accuracy::Motion).to_vec()
        };
        assert_eq!(at(1e-3), [1.0, 1e10, 0.0, 1e5]);
        assert_eq!(at(0.25e-3), [4.0, 1e10, 0.0, 1e5]);
        assert_eq!(at(1e-6), [100.0, 1e10, 0.0, 1e5]);
        assert_eq!(at(0.5e-3), [1.0, 1e10, 0.0, 1e5]);
        assert_eq!(limits.weights(Accuracy::Rest), [100.0, 1e10, 0.0, 100.0]);
    }
}
