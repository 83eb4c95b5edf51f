//! Friction against a sliding speed, of contacts and of the bit: a smooth sign of the speed, and the slope of it that
//! Newton takes.
//!
//! Where a body sticks or rolls, the smooth sign is much steeper than all else that holds the body: Newton's line through
//! a speed on one side of zero leads far to the other side, and from there back. So once a correction went too far
//! through zero, the slope is taken with the friction that the correction before counted on: of t sqrt(v^2 + w^2) = F v
//! with both the friction t and the speed v unknown, linearised in both (Chan, Golub and Mulet, SIAM J. Sci. Comput. 20,
//! 1999). It is never negative, and it is the exact slope where both agree, so that the last corrections are as good as
//! Newton's. The residual does not know of it: the solution is the same.

use crate::simd::number::Number;

/// Friction at a sliding speed, or one in each of eight lanes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Slip<N = f64> {
    /// Sliding speed (m/s, of the bit rad/s).
    pub speed: N,
    /// Friction that opposes it, of the sign of the speed: per normal force (-) in a contact, the torque (N m) of the bit.
    pub friction: N,
    /// d friction / d speed as the tangent takes it.
    pub slope: N,
}

impl<N: Number> Slip<N> {
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

/// What the corrections of a step have learned of one friction.
#[derive(Debug, Clone, Copy)]
pub struct SlipMemory {
    /// At the residual before.
    last: Slip,
    /// Whether a correction of this step went too far through zero without counting on it.
    crossed: bool,
}

impl SlipMemory {
    /// Begins with the first residual of a step.
    #[inline(always)]
    pub fn new(first: Slip) -> Self {
        Self {
            last: first,
            crossed: false,
        }
    }

    /// Takes the friction at the residual after a correction, of at most `full`, and sets its slope where the exact one
    /// would not converge.
    #[inline(always)]
    pub fn follow(&mut self, slip: &mut Slip, full: f64, width: f64) {
        let last = &self.last;
        let expected = (last.friction + last.slope * (slip.speed - last.speed)).clamp(-full, full);
        // Nearer to zero the sign is so straight that Newton comes back by itself.
        self.crossed |= expected * slip.friction < 0.0 && slip.speed.abs() > width;
        if self.crossed {
            // Without friction nothing crosses: `full` is no zero here.
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
    fn what_sticks_is_found_from_either_side() {
        // The bit under 10 kN in N m and rad/s: 36 N m s/rad is what a wave in the pipe's torsion gives. A contact under
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
        assert!(lost > 0, "Newton's own slope does it too: nothing is shown");
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
    fn without_friction_nothing_is_learned() {
        let mut memory = SlipMemory::new(Slip::at(1.0, 0.0, 0.01));
        for speed in [-1.0, 1.0, 0.0] {
            let mut slip = Slip::at(speed, 0.0, 0.01);
            memory.follow(&mut slip, 0.0, 0.01);
            assert_eq!((slip.friction, slip.slope), (0.0, 0.0));
        }
    }
}
