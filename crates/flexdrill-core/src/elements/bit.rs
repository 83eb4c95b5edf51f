//! The rock's torque on the bit: Eq. 1 times a smooth sign of the bit's speed.

use super::slip::{Slip, SlipMemory};

/// The torque and its slope at the last residual, with the memory of the step's corrections.
#[derive(Debug, Clone, Copy, Default)]
pub struct BitTorque {
    /// Torque against the rotation (N m).
    pub torque: f64,
    /// d torque / d speed that the tangent uses (N m s/rad).
    pub slope: f64,
    /// `None` before the first residual of a step.
    memory: Option<SlipMemory>,
}

impl BitTorque {
    /// Clears the memory at the start of a step.
    pub fn begin(&mut self) {
        self.memory = None;
    }

    /// Evaluates torque and slope at `speed` (rad/s). `full` is the torque of Eq. 1 (N m, >= 0), `slip_rate` the speed
    /// over which its sign changes (rad/s).
    pub fn evaluate(&mut self, full: f64, speed: f64, slip_rate: f64) {
        let mut slip = Slip::at(speed, full, slip_rate);
        match &mut self.memory {
            Some(memory) => memory.follow(&mut slip, full, slip_rate),
            None => self.memory = Some(SlipMemory::new(slip)),
        }
        (self.torque, self.slope) = (slip.friction, slip.slope);
    }
}
