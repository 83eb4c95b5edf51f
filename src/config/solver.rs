//! `solver`: time integration.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

/// Newmark with Newton-Raphson, Eq. 36 to 44.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// s. Default 0.00025.
    pub time_step: f64,
    /// Newmark's gamma; beta = (gamma + 1/2)^2 / 4. Default 0.55.
    pub gamma: f64,
    /// Most Newton iterations per sub-step. Default 15.
    pub max_iterations: u32,
    /// Most halvings of a step that does not converge. Default 6.
    pub max_halvings: u32,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            time_step: 0.00025,
            gamma: 0.55,
            max_iterations: 15,
            max_halvings: 6,
        }
    }
}

impl Solver {
    pub(super) fn check(&self, c: &mut Checker) {
        let reason = "a stiff contact lasts some milliseconds: a longer step would jump over it";
        c.number("time_step", self.time_step, Bound::within(1e-7, 0.01), "s", reason);
        let reason = "below 1/2 the integration gains energy, above 1 it takes nearly all motion";
        c.number("gamma", self.gamma, Bound::within(0.5, 1.0), "", reason);
        let reason = "a linear step takes 2, a healthy contact 3 to 5";
        c.count("max_iterations", self.max_iterations as usize, 2, 100, reason);
        c.count(
            "max_halvings",
            self.max_halvings as usize,
            0,
            20,
            "each doubles the work of a step",
        );
    }
}
