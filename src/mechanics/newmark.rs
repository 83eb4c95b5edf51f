//! The Newmark scheme, Eq. 36 to 38 (the paper's kappa is beta).

use super::assembly::TangentFactors;
use super::state::State;

/// Parameters of the scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newmark {
    /// Weight of the new acceleration in the velocity; 1/2 has no numerical damping, more damps.
    pub gamma: f64,
    /// Weight of the new acceleration in the displacement.
    pub beta: f64,
}

impl Newmark {
    /// The scheme with the most damping of the highest frequencies for its `gamma`: beta = (gamma + 1/2)^2 / 4.
    pub fn damped(gamma: f64) -> Self {
        Self {
            gamma,
            beta: 0.25 * (gamma + 0.5).powi(2),
        }
    }

    /// Tangent factors for step `h` (s), Eq. 41.
    pub fn factors(&self, h: f64) -> TangentFactors {
        TangentFactors {
            stiffness: 1.0,
            damping: self.gamma / (self.beta * h),
            mass: 1.0 / (self.beta * h * h),
        }
    }

    /// Velocity and acceleration of one unknown after a step `h` in which it moved by `dq`.
    #[inline]
    pub fn rates(&self, h: f64, dq: f64, v0: f64, a0: f64) -> (f64, f64) {
        let a1 = (dq - h * v0) / (self.beta * h * h) - (0.5 / self.beta - 1.0) * a0;
        (v0 + h * ((1.0 - self.gamma) * a0 + self.gamma * a1), a1)
    }

    /// Displacement after a step in which the acceleration becomes `a1`.
    #[inline]
    pub fn displacement(&self, h: f64, v0: f64, a0: f64, a1: f64) -> f64 {
        h * v0 + h * h * ((0.5 - self.beta) * a0 + self.beta * a1)
    }

    /// Predicts `state` a step on, unknown by unknown, with the acceleration fading to zero.
    pub fn predict(&self, h: f64, from: &State, to: &mut State) {
        let n = from.q.len();
        let (q0, v0, a0) = (&from.q[..n], &from.v[..n], &from.a[..n]);
        let (q, v, a) = (&mut to.q[..n], &mut to.v[..n], &mut to.a[..n]);
        let (by_v, by_a) = (h, h * h * (0.5 - self.beta));
        let rate = h * (1.0 - self.gamma);
        for i in 0..n {
            q[i] = q0[i] + (by_v * v0[i] + by_a * a0[i]);
            v[i] = v0[i] + rate * a0[i];
            a[i] = 0.0;
        }
    }
}
