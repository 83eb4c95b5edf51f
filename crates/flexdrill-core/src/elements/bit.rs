//! The rock's torque on the bit: Eq. 1 times a smooth sign of the bit's speed.

use super::slip::{Slip, SlipMemory};

/// The torque at the last residual with its slope, and what the corrections of a step have learned.
#[derive(Debug, Clone, Copy, Default)]
pub struct BitTorque {
    /// Torque against the rotation (N m).
    pub torque: f64,
    /// d torque / d speed as the tangent takes it (N m s/rad).
    pub slope: f64,
    /// None before a step's first residual.
    memory: Option<SlipMemory>,
}

impl BitTorque {
    /// Begins the corrections of a step.
    pub fn begin(&mut self) {
        self.memory = None;
    }

    /// Evaluates at a speed (rad/s), for the full torque (N m, >= 0) and the width of the sign (rad/s).
    pub fn evaluate(&mut self, full: f64, speed: f64, slip_rate: f64) {
        let mut slip = Slip::at(speed, full, slip_rate);
        match &mut self.memory {
            Some(memory) => memory.follow(&mut slip, full, slip_rate),
            None => self.memory = Some(SlipMemory::new(slip)),
        }
        (self.torque, self.slope) = (slip.friction, slip.slope);
    }
}
