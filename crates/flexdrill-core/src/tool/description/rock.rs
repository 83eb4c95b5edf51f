//! The rock under the bit, as described. Its laws are in `elements/rock`.

use serde::{Deserialize, Serialize};

/// How the rock answers the bit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RockLaw {
    /// Eq. 1: the torque is proportional to the weight.
    #[default]
    Paper,
    /// Eq. 1 with a torque that falls with the speed.
    Weakening(Weakening),
    /// Cutting and wear flats: weight and torque follow from the depth of cut.
    DepthOfCut(DepthOfCut),
}

/// P(omega) = 1 + (ratio - 1) exp(-|omega| / rate).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Weakening {
    /// Torque at standstill over that at high speed, mu_s / mu_k, at least 1; 1 is no weakening.
    pub ratio: f64,
    /// Speed over which the difference falls to 37 %, omega_c (rad/s).
    pub rate: f64,
}

impl Weakening {
    /// No weakening.
    pub const NONE: Self = Self { ratio: 1.0, rate: 1.0 };
}

/// Bit and rock of the law with depth of cut.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DepthOfCut {
    /// Number of blades n.
    pub blades: u32,
    /// Energy to cut a volume of rock, e (Pa).
    pub specific_energy: f64,
    /// Weight over torque-like force of a sharp cutter, zeta (-).
    pub cutter_inclination: f64,
    /// Largest force of the wear flats, sigma l a (N).
    pub wear_flat_force: f64,
    /// Friction of the wear flats with the bit's geometry, mu_g (-).
    pub wear_flat_friction: f64,
    /// Distance over which the wear flats come to bear (m).
    pub wear_flat_travel: f64,
    /// How the friction of the wear flats falls with the speed.
    pub weakening: Weakening,
}
