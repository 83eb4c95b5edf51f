//! A string without bending stiffness that lies on the wall of its hole (Johancsik, Friesen and Dawson, J. Pet. Tech. 36 (6),
//! 1984), piece by piece.
//!
//! With the tension T, below 0 a push, the curvature kappa of the hole, above 0 where its inclination grows with the depth,
//! the inclination i, the weights per length w along and w' across the hole in mud, and the friction coefficient mu, from
//! below to above:
//!
//! ```text
//! dT/ds = w cos i + s mu f |T kappa - w' sin i|,      f = v / sqrt(v^2 + u^2),      s = +1 out of the hole, -1 into it
//! dM/ds = mu r g |T kappa - w' sin i|,                g = u / sqrt(v^2 + u^2),      u = omega r
//! ```
//!
//! Tension pulls the string to the high side of an arc, weight to the low side: both branches of Euler's and Eytelwein's rope
//! are in the absolute value. Friction opposes the whole sliding velocity, v along and u around the hole, so that what
//! rotation takes around is missing along. Without weight the law is e^(mu theta), in a straight hole w (cos i +- mu sin i).

use flexdrill_hole::Sense;

/// Longest step in an arc (m), where the law is integrated by the rule of Runge and Kutta, whose error falls with its fourth
/// power; a straight piece is one step.
const STEP: f64 = 0.02;

/// How a string moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Out of the hole or into it.
    pub sense: Sense,
    /// Speed along the hole (m/s); 0 only where it turns.
    pub along: f64,
    /// Angular speed (rad/s); 0 without rotation.
    pub spin: f64,
}

impl Motion {
    /// Without rotation.
    pub const fn sliding(sense: Sense) -> Self {
        Self {
            sense,
            along: 1.0,
            spin: 0.0,
        }
    }

    /// Turning in place: all of the friction acts around the hole.
    pub const TURNING: Self = Self {
        sense: Sense::Out,
        along: 0.0,
        spin: 1.0,
    };

    /// Shares of the friction at a radius (m) that act along and around the hole.
    pub fn shares(&self, radius: f64) -> [f64; 2] {
        let around = self.spin.abs() * radius;
        let whole = self.along.hypot(around);
        [self.along / whole, around / whole]
    }
}

/// A piece of a string in a piece of hole of one curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Length (m).
    pub length: f64,
    /// Inclination of the hole at the upper end (rad).
    pub inclination: f64,
    /// Change of inclination per length, down the hole (1/m).
    pub curvature: f64,
    /// Weight per length that hangs on the piece (N/m).
    pub along: f64,
    /// Weight per length that the wall carries where the hole is level (N/m).
    pub across: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Radius at which the string rubs (m).
    pub radius: f64,
}

/// Tension (N) and torque (N m) at a point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Load {
    /// Tension, below 0 a push.
    pub tension: f64,
    /// Torque with which the upper part turns the lower one.
    pub torque: f64,
}

impl Piece {
    /// Force on the wall per length (N/m) at a distance below the upper end (m): above 0 towards the high side.
    fn contact(&self, below: f64, tension: f64) -> f64 {
        tension * self.curvature - self.across * libm::sin(self.inclination + self.curvature * below)
    }

    /// Rise of tension and torque per length, upwards.
    fn rates(&self, below: f64, tension: f64, motion: &Motion) -> Load {
        let [axial, around] = motion.shares(self.radius);
        let rubs = self.friction * self.contact(below, tension).abs();
        let hangs = self.along * libm::cos(self.inclination + self.curvature * below);
        Load {
            tension: hangs + motion.sense.sign() * axial * rubs,
            torque: self.radius * around * rubs,
        }
    }

    /// Integrates from a distance below the upper end to another, with the load at the first.
    fn between(&self, from: f64, to: f64, at: Load, motion: &Motion) -> Load {
        // Upwards is against the distance.
        let step = from - to;
        let shifted = |rates: Load, share: f64| at.tension + share * step * rates.tension;
        let middle = f64::midpoint(from, to);
        let first = self.rates(from, at.tension, motion);
        let second = self.rates(middle, shifted(first, 0.5), motion);
        let third = self.rates(middle, shifted(second, 0.5), motion);
        let last = self.rates(to, shifted(third, 1.0), motion);
        let mean = |of: fn(&Load) -> f64| (of(&first) + 2.0 * (of(&second) + of(&third)) + of(&last)) / 6.0;
        Load {
            tension: at.tension + step * mean(|rates| rates.tension),
            torque: at.torque + step * mean(|rates| rates.torque),
        }
    }

    /// Steps of the integration.
    fn steps(&self) -> usize {
        if self.curvature == 0.0 {
            return 1;
        }
        (self.length / STEP).ceil().max(1.0) as usize
    }

    /// Load at the upper end from that at the lower one.
    pub fn above(&self, below: Load, motion: &Motion) -> Load {
        let (steps, step) = (self.steps(), self.length / self.steps() as f64);
        (0..steps).rev().fold(below, |load, index| {
            self.between((index + 1) as f64 * step, index as f64 * step, load, motion)
        })
    }

    /// Load at the lower end from that at the upper one. `most` is the largest tension that what hangs below allows (N): 0 where
    /// it stands and can only be pushed.
    pub fn below(&self, above: Load, motion: &Motion, most: f64) -> Load {
        let (steps, step) = (self.steps(), self.length / self.steps() as f64);
        (0..steps).fold(above, |load, index| {
            let load = self.between(index as f64 * step, (index + 1) as f64 * step, load, motion);
            Load {
                tension: load.tension.min(most),
                ..load
            }
        })
    }
}

/// Tension above a bend without length, of which only the angle (rad) is known, from that below it (N): e^(mu f theta).
pub fn above_bend(angle: f64, friction: f64, tension: f64, axial: f64, sense: Sense) -> f64 {
    let sign = if tension < 0.0 { -1.0 } else { 1.0 };
    tension * libm::exp(sense.sign() * sign * friction * axial * angle.abs())
}

/// Compression (N) at which a pipe of bending stiffness EI (N m2) with a clearance r (m) leaves the low side: F = 2
/// sqrt(EI q / r) with the force q per length that presses it there (Dawson and Paslay, J. Pet. Tech. 36 (10), 1984). In an
/// arc that builds, q = `across` + F kappa, so that F = 2 EI kappa / r (1 + sqrt(1 + r `across` / (EI kappa^2))).
pub fn buckling_load(bending: f64, clearance: f64, across: f64, curvature: f64) -> f64 {
    let bent = 2.0 * bending * curvature / clearance;
    bent + (bent * bent + 4.0 * bending * across / clearance).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_buckling_load_solves_its_equation() {
        for (across, curvature) in [(361.5, 0.0), (361.5, 1.0 / 3.2), (0.0, 1.0 / 3.2)] {
            let (bending, clearance) = (3.4e4, 0.008);
            let load = buckling_load(bending, clearance, across, curvature);
            let expected = 2.0 * (bending * (across + load * curvature) / clearance).sqrt();
            assert!((load / expected - 1.0).abs() < 1e-12, "{load} {expected}");
        }
    }
}
