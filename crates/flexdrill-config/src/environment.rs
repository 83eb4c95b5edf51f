//! `environment`: what surrounds the tool.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

/// Gravity and buoyancy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// m/s2. Default 9.81.
    pub gravity: f64,
    /// 1 - fluid density / steel density. Default 0.86: water-based mud of 1100 kg/m3.
    pub buoyancy_factor: f64,
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            gravity: 9.81,
            buoyancy_factor: 0.86,
        }
    }
}

impl Environment {
    pub(super) fn check(&self, c: &mut Checker) {
        let reason = "0 to switch it off, 9.81 on earth";
        c.number("gravity", self.gravity, Bound::within(0.0, 100.0), "m/s2", reason);
        let reason = "1 is air, 0 a fluid as dense as the steel";
        c.number(
            "buoyancy_factor",
            self.buoyancy_factor,
            Bound::within(0.0, 1.0),
            "",
            reason,
        );
    }

    /// Effective gravity (m/s2).
    pub(super) fn effective_gravity(&self) -> f64 {
        self.gravity * self.buoyancy_factor
    }
}
