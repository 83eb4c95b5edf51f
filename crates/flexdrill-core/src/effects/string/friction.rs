//! Coulomb friction of the string on the wall of the hole, lumped at one point of the string.
//!
//! Friction opposes the sliding of the pipe's surface, around with r omega and along with u', by one force of the size mu
//! N. The waves that arrive at the point fix the torque and the force that would stop it; what friction does not take
//! moves the point against the impedance of the line on both sides. The law has no regularisation: the point sticks, or it
//! slides with the full friction (Aarsnes and Shor, J. Pet. Sci. Eng. 163, 2018, for torsion; both directions here).

use crate::tool::description::WallFriction;

/// Most corrections of the sliding speed; Newton's method converges from below in some five.
const MOST_CORRECTIONS: u32 = 60;

/// What a point of the string does under the arriving waves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion {
    /// Angular speed (rad/s) and axial speed relative to the wall (m/s, down).
    pub speeds: [f64; 2],
    /// Torque (N m) and axial force (N) of friction against these speeds.
    pub friction: [f64; 2],
    /// Whether the point sticks or slides slowly, so that its friction is static.
    pub is_static: bool,
}

impl WallFriction {
    /// Motion of the point whose sticking takes the torque and force `held` (N m, N) and whose speeds are what friction
    /// leaves of them over the `impedances` (N m s, N s/m). `was_static` is whether its friction was static so far.
    pub fn motion(&self, held: [f64; 2], impedances: [f64; 2], was_static: bool) -> Motion {
        if self.sliding <= 0.0 {
            return Motion {
                speeds: [held[0] / impedances[0], held[1] / impedances[1]],
                ..Motion::default()
            };
        }
        let at = |size: f64| self.under(size, held, impedances);
        let full = self.sliding * self.static_ratio;
        if was_static {
            let (motion, speed) = at(full);
            if speed <= self.static_speed {
                return Motion {
                    is_static: true,
                    ..motion
                };
            }
        }
        let (motion, speed) = at(self.sliding);
        if speed >= self.static_speed && speed > 0.0 {
            return motion;
        }
        Motion {
            is_static: true,
            ..at(full).0
        }
    }

    /// Motion and sliding speed (m/s) under friction of the size `full` (N).
    fn under(&self, full: f64, held: [f64; 2], impedances: [f64; 2]) -> (Motion, f64) {
        let radius = self.radius;
        // As a force and an impedance at the surface, around and along.
        let force = [held[0] / radius, held[1]];
        let impedance = [impedances[0] / (radius * radius), impedances[1]];
        let size = (force[0] * force[0] + force[1] * force[1]).sqrt();
        if size <= full {
            let motion = Motion {
                friction: held,
                ..Motion::default()
            };
            return (motion, 0.0);
        }
        // With the sliding speed S, every component is force / (impedance + full / S). S is the root of the sum of
        // (force / (impedance S + full))^2 = 1, which falls and is convex, so that Newton's method from 0 stays below.
        let mut speed = 0.0;
        for _ in 0..MOST_CORRECTIONS {
            let (mut sum, mut slope) = (-1.0, 0.0);
            for k in 0..2 {
                let over = 1.0 / (impedance[k] * speed + full);
                let part = force[k] * over;
                sum += part * part;
                slope -= 2.0 * part * part * impedance[k] * over;
            }
            let change = -sum / slope;
            speed += change;
            // The rest is rounding.
            if change.abs() <= 1e-14 * speed {
                break;
            }
        }
        let of = |k: usize| force[k] / (impedance[k] + full / speed);
        let [around, along] = [of(0), of(1)];
        let motion = Motion {
            speeds: [around / radius, along],
            friction: [full * around / speed * radius, full * along / speed],
            is_static: false,
        };
        (motion, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT: WallFriction = WallFriction {
        sliding: 500.0,
        static_ratio: 1.5,
        static_speed: 0.0,
        radius: 0.05,
    };
    const IMPEDANCES: [f64; 2] = [95.0, 148e3];

    #[test]
    fn friction_takes_part_of_what_is_held_and_opposes_the_sliding() {
        for held in [[40.0, 0.0], [-26.0, 700.0], [3.0, -2e4], [900.0, 10.0]] {
            let got = POINT.motion(held, IMPEDANCES, false);
            assert!(!got.is_static);
            let sliding = [got.speeds[0] * POINT.radius, got.speeds[1]];
            let size = (sliding[0].powi(2) + sliding[1].powi(2)).sqrt();
            for k in 0..2 {
                let arm = [POINT.radius, 1.0][k];
                let left = held[k] - got.friction[k] - IMPEDANCES[k] * got.speeds[k];
                // Newton's rest relative to what is held.
                assert!(left.abs() < 1e-9 * held[0].hypot(held[1]), "{got:?}");
                let law = POINT.sliding * arm * sliding[k] / size;
                assert!((got.friction[k] - law).abs() < 1e-9 * POINT.sliding, "{got:?}");
            }
        }
    }

    #[test]
    fn a_stuck_point_breaks_loose_later_than_a_sliding_one_sticks() {
        let between = [1.2 * POINT.sliding * POINT.radius, 0.0];
        assert!(POINT.motion(between, IMPEDANCES, true).is_static);
        assert!(!POINT.motion(between, IMPEDANCES, false).is_static);
        let over = [1.6 * POINT.sliding * POINT.radius, 0.0];
        assert!(!POINT.motion(over, IMPEDANCES, true).is_static);
        assert!(POINT.motion([0.9 * between[0] / 1.2, 0.0], IMPEDANCES, false).is_static);
    }

    #[test]
    fn rotation_takes_the_friction_out_of_the_axial_direction() {
        let turning = POINT.motion([95.0 * 10.0, 50.0], IMPEDANCES, false);
        assert!(turning.friction[1].abs() < 0.1 * POINT.sliding, "{turning:?}");
        assert!(POINT.motion([0.0, 50.0], IMPEDANCES, false).is_static);
    }
}
