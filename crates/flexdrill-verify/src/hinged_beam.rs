//! Closed forms of the hinged beam in a tube, Fig. 8 of the paper: as Eq. 45 is printed, and corrected.

/// Two links of length l, clamped at the left, on a roller at the right, a joint with a bend limit at mid-span, a load
/// F there, and a fixed tube around them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HingedBeam {
    /// EI (N m2).
    pub bending: f64,
    /// l (m).
    pub length: f64,
    /// chi (rad).
    pub limit: f64,
    /// delta, the gap (m).
    pub gap: f64,
}

impl HingedBeam {
    /// F_r (N), at which the joint reaches its limit: 6 EI chi / (5 l^2).
    pub fn limit_load(&self) -> f64 {
        6.0 * self.bending * self.limit / (5.0 * self.length * self.length)
    }

    /// F_1 (N), at which the beam meets the tube: 96 EI (delta - 5 chi l / 16) / (7 l^3).
    pub fn touch_load(&self) -> f64 {
        96.0 * self.bending * (self.gap - 5.0 * self.limit * self.length / 16.0) / (7.0 * self.length.powi(3))
    }

    /// Eq. 45 corrected: deflection of the joint under `load` (m, towards the load), by statics. The joint is free at
    /// first, then at its limit, and then the beam rests on the tube.
    pub fn corrected(&self, load: f64) -> f64 {
        if load <= self.limit_load() {
            load * self.length.powi(3) / (3.0 * self.bending)
        } else if load <= self.touch_load() {
            7.0 * load * self.length.powi(3) / (96.0 * self.bending) + 5.0 * self.limit * self.length / 16.0
        } else {
            self.gap
        }
    }

    /// The same as Eq. 45 is printed: without the power of l, and with the locked joint's stiffness in the first
    /// branch.
    pub fn printed(&self, load: f64) -> f64 {
        let bent = 7.0 * load * self.length / (96.0 * self.bending);
        if load <= self.limit_load() {
            bent
        } else if load <= self.touch_load() {
            bent + 5.0 * self.limit * self.length / 16.0
        } else {
            self.gap
        }
    }
}
