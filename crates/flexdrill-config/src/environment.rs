//! `environment`: what surrounds the tool.

use super::section::section;

section! {
    /// Gravity and buoyancy.
    #[derive(Copy)]
    pub struct Environment(this) {
        /// Acceleration of gravity (m/s2).
        gravity: f64 = 9.81, within(0.0, 100.0), "m/s2", "0 to switch it off, 9.81 on earth";
        /// Buoyancy factor, 1 - mud density / steel density. The default is for water-based mud of 1100 kg/m3.
        buoyancy_factor: f64 = 0.86, within(0.0, 1.0), "", "1 is air, 0 a fluid as dense as the steel";
    }
}

impl Environment {
    /// Effective gravity (m/s2).
    pub(super) fn effective_gravity(&self) -> f64 {
        self.gravity * self.buoyancy_factor
    }
}
