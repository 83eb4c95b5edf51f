//! What is read after every step without the state in the model's numbering.

use nalgebra::Vector3;

/// How the bottom of the pipe moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BottomMotion {
    /// Spin rate of the bit (rad/s).
    pub spin_rate: f64,
    /// Its derivative (rad/s2).
    pub spin_acceleration: f64,
    /// Acceleration of the bit down the hole (m/s2).
    pub axial_acceleration: f64,
    /// Square of the lateral acceleration of the station above the bit, which the hole does not hold (m2/s4).
    pub lateral_square: f64,
}

impl BottomMotion {
    /// Of the spin's rate and acceleration, the bit's axial acceleration and the acceleration of the station above.
    pub fn new(spin: [f64; 2], axial_acceleration: f64, above: Vector3<f64>) -> Self {
        Self {
            spin_rate: spin[0],
            spin_acceleration: spin[1],
            axial_acceleration,
            lateral_square: above.y * above.y + above.z * above.z,
        }
    }
}
