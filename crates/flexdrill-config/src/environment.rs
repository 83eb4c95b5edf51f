//! `environment`: what surrounds the tool.

use super::mud::Mud;
use super::pressure::Pressure;
use super::section::section;

section! {
    /// Gravity, buoyancy, pump pressure and mud.
    #[derive(Copy)]
    pub struct Environment(this) {
        /// Acceleration of gravity (m/s2).
        gravity: f64 = 9.81, within(0.0, 100.0), "m/s2", "0 to switch it off, 9.81 on earth";
        /// Buoyancy factor, 1 - mud density / steel density. The default is for water-based mud of 1100 kg/m3.
        buoyancy_factor: f64 = 0.86, within(0.0, 1.0), "", "1 is air, 0 a fluid as dense as the steel";
        /// Pump pressure in the pipe. Default none: inside as outside.
        pressure: Option<Pressure> = None;
        /// Mud that moves with pipe and guide. Default none: it is in the buoyancy only.
        mud: Option<Mud> = None;
    }
}

impl Environment {
    /// Effective gravity (m/s2).
    pub(super) fn effective_gravity(&self) -> f64 {
        self.gravity * self.buoyancy_factor
    }
}
