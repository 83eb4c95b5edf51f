//! Friction against a sliding speed, of contacts and of the bit: a smooth sign of the speed, and its slope for Newton's
//! method.
//!
//! Where a body sticks or rolls, the smooth sign is much steeper than every other force on the body. Newton's tangent
//! at a speed on one side of zero then leads far to the other side, and back from there, without end. After a
//! correction has overshot zero, the slope is therefore taken from t sqrt(v^2 + w^2) = F v, linearised in both the
//! friction t and the speed v, with t as the previous correction predicted it (Chan, Golub and Mulet, SIAM J. Sci.
//! Comput. 20, 1999). This slope is never negative. It equals the exact one where prediction and friction agree, so
//! that the last corrections converge as Newton's do. The residual is unchanged, and so is the solution.

use crate::simd::number::{Lane, Number};

/// Friction at a sliding speed, or one in each of eight lanes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Slip<N = f64> {
    /// Sliding speed (m/s, of the bit rad/s).
    pub speed: N,
    /// Friction that opposes it, of the sign of the speed: per normal force (-) in a contact, the torque (N m) of the
    /// bit.
    pub friction: N,
    /// d friction / d speed that the tangent uses.
    pub slope: N,
}

impl<N: Number> Slip<N> {
    /// Reads all lanes from memory.
    #[inline(always)]
    pub(crate) fn load(from: &Slip<N::Memory>) -> Self {
        Self {
            speed: N::load(&from.speed),
            friction: N::load(&from.friction),
            slope: N::load(&from.slope),
        }
    }

    /// `full` friction times the smooth sign v / sqrt(v^2 + width^2) of the speed v, with its exact slope.
    #[inline(always)]
    pub fn at(speed: N, full: N, width: f64) -> Self {
        let square = N::of(width * width);
        let over = N::of(1.0).over(square.plus_product(speed, speed).root());
        Self {
            speed,
            friction: full * (speed * over),
            slope: full * (square * over * over * over),
        }
    }
}

impl Slip<Lane> {
    /// The slip in lane `k`.
    #[inline(always)]
    pub(crate) fn lane(&self, k: usize) -> Slip {
        Slip {
            speed: self.speed[k],
            friction: self.friction[k],
            slope: self.slope[k],
        }
    }

    /// Sets the slip in lane `k`.
    #[inline(always)]
    pub(crate) fn set_lane(&mut self, k: usize, from: &Slip) {
        (self.speed[k], self.friction[k], self.slope[k]) = (from.speed, from.friction, from.slope);
    }
}

/// Memory of one friction over the corrections of a step.
#[derive(Debug, Clone, Copy)]
pub struct SlipMemory {
    /// Friction at the previous residual.
    last: Slip,
    /// Whether a correction of this step has overshot zero, against its own prediction.
    crossed: bool,
}

impl SlipMemory {
    /// Starts from the first residual of a step.
    #[inline(always)]
    pub fn new(first: Slip) -> Self {
        Self {
            last: first,
            crossed: false,
        }
    }

    /// Takes the friction, at most `full`, at the residual after a correction, and replaces its slope where the exact
    /// one would not converge.
    #[inline(always)]
    pub fn follow(&mut self, slip: &mut Slip, full: f64, width: f64) {
        let last = &self.last;
        let expected = (last.friction + last.slope * (slip.speed - last.speed)).clamp(-full, full);
        // Within the width the sign is so nearly straight that Newton's own slope converges.
        self.crossed |= expected * slip.friction < 0.0 && slip.speed.abs() > width;
        if self.crossed {
            // `full` is not zero here: without friction the product above is zero and nothing crosses.
            slip.slope = (full - expected * slip.friction / full) / (slip.speed * slip.speed + width * width).sqrt();
        }
        self.last = *slip;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corrections until `inertia` v + friction(v) = `load` holds, from `speed`; `None` after 15.
    fn corrections(
        [inertia, full, width]: [f64; 3],
        load: f64,
        mut speed: f64,
        accurate: f64,
        learn: bool,
    ) -> Option<u32> {
        let mut memory = None::<SlipMemory>;
        for iteration in 0..15 {
            let mut slip = Slip::at(speed, full, width);
            match &mut memory {
                Some(memory) if learn => memory.follow(&mut slip, full, width),
                _ => memory = Some(SlipMemory::new(slip)),
            }
            let residual = inertia * speed + slip.friction - load;
            if residual.abs() < accurate {
                return Some(iteration);
            }
            assert!(slip.slope >= 0.0, "{slip:?}");
            speed -= residual / (inertia + slip.slope);
        }
        None
    }

    #[test]
    fn sticking_bodies_are_found_from_either_side() {
        // The bit under 10 kN in N m and rad/s: 36 N m s/rad is the torsional impedance of the pipe. A contact under
        // 1 kN with a friction of 0.7 in N and m/s: a link of 2.8 kg in a step of 0.5 ms.
        let bit = [1e-4, 1e-3, 0.1].map(|width| ([36.0, 92.0, width], 1e-3));
        let contact = [1e-3, 1e-2].map(|width| ([11e3, 700.0, width], 1.0));
        let mut lost = 0;
        for (body, accurate) in bit.into_iter().chain(contact) {
            let full = body[1];
            for load in [-0.99, -0.43, 0.0, 0.05, 0.65, 0.99, 1.3] {
                for speed in [-20.0, -0.3, -1e-3, 0.0, 1e-4, 0.02, 4.0, 30.0] {
                    let found = corrections(body, load * full, speed, accurate, true);
                    assert!(found.is_some(), "{load} of {body:?} from {speed}");
                    lost += u32::from(corrections(body, load * full, speed, accurate, false).is_none());
                }
            }
        }
        assert!(lost > 0, "Newton's own slope converges too: the test shows nothing");
    }

    #[test]
    fn a_slide_that_does_not_turn_keeps_the_exact_slope() {
        let (full, width) = (0.7, 0.01);
        let mut memory = SlipMemory::new(Slip::at(0.2, full, width));
        for speed in [0.03, 0.5, 0.001, -0.005] {
            let exact = Slip::at(speed, full, width);
            let mut slip = exact;
            memory.follow(&mut slip, full, width);
            assert_eq!(slip.slope, exact.slope, "at {speed}");
        }
    }

    #[test]
    fn without_friction_the_slope_stays_zero() {
        let mut memory = SlipMemory::new(Slip::at(1.0, 0.0, 0.01));
        for speed in [-1.0, 1.0, 0.0] {
            let mut slip = Slip::at(speed, 0.0, 0.01);
            memory.follow(&mut slip, 0.0, 0.01);
            assert_eq!((slip.friction, slip.slope), (0.0, 0.0));
        }
    }
}
