//! A bit that sticks: cutters and wear flats hold the rock elastically until the rock's torque is reached.
//!
//! Between bit and rock is a spring k in torsion with a damper c beside it. Turned by D from where it carried the twist x0,
//! it carries
//!
//! ```text
//! T* = k (x0 + D) + c D / h         as long as - T_back <= T* <= T_ahead: sticks, x = x0 + D
//! T  = T_ahead or - T_back          beyond: slips, and the twist x is the one of k x + c (x - x0) / h = T
//! ```
//!
//! T_ahead is the torque of cutting and wear flats, T_back that of the wear flats alone. The step is Euler's backward one, so
//! that spring, damper and slip never give energy. A bit under less than its limit does not turn, however long it is held: a
//! smooth sign of the speed would let it creep.

use serde::{Deserialize, Serialize};

/// Stiffness in torsion over the cube of the bit's radius (N/m2): 8.2e4 N m/rad for 118 mm. That is the stiffness of wear flats
/// that come to bear over 0.1 mm under 8.7 kN, spread evenly along the radius, k_n a^2 / 3, times Mindlin's ratio 0.82 of
/// tangential to normal stiffness. A rigid disc on rock of 10 GPa, 16/3 G a^3 (Reissner and Sagoci 1944), would be a hundred
/// times stiffer; blades and cutters touch a small part of it. 90 N m twist it by 1.1 mrad: a thousandth of the angle between
/// two blades, and the bit's own inertia swings on it in four steps of 0.5 ms.
const STIFFNESS: f64 = 4e8;
/// Damper over spring (s): a bit of 0.01 kg m2 rings with 0.3 of critical damping.
const RELAXATION: f64 = 2e-4;

/// The twist at the end of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Bristle {
    /// Angle of the bit less the twist (rad).
    root: f64,
    /// Twist (rad).
    twist: f64,
    /// Torque against the rotation (N m).
    torque: f64,
}

/// The torque after a turn.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Held {
    /// The state, should the step end here.
    pub bristle: Bristle,
    /// Derivative by the angle while it sticks (N m/rad).
    pub by_angle: f64,
    /// 1 while it slips ahead, -1 while it slips back, 0 while it sticks.
    pub slips: i8,
    /// Stiffness of the line from the middle of sticking to a torque beyond (N m/rad).
    pub secant: f64,
}

impl Bristle {
    /// Stiffness (N m/rad) for a bit of `radius` (m).
    pub fn stiffness(radius: f64) -> f64 {
        STIFFNESS * radius * radius * radius
    }

    /// Without torque, the bit at `angle` (rad).
    pub fn at(angle: f64) -> Self {
        Self {
            root: angle,
            ..Self::default()
        }
    }

    /// Angle at which cutters and rock meet (rad): that of the bit less the twist.
    pub fn root(&self) -> f64 {
        self.root
    }

    /// Torque against the rotation (N m).
    pub fn torque(&self) -> f64 {
        self.torque
    }

    /// Elastic energy (J) under a bit of `radius` (m).
    pub fn energy(&self, radius: f64) -> f64 {
        0.5 * Self::stiffness(radius) * self.twist * self.twist
    }

    /// Takes an angle (rad) off.
    pub fn unwind(&mut self, angle: f64) {
        self.root -= angle;
    }

    /// The torque once a bit of `radius` (m) is at `angle` (rad), a `step` (s) later, with at most the torques `ahead` and `back`
    /// (N m, >= 0). Without a step the torque stays.
    pub(super) fn turned(&self, radius: f64, step: f64, angle: f64, [ahead, back]: [f64; 2]) -> Held {
        // Without a step the bit neither turns nor relaxes.
        if step <= 0.0 {
            return Held {
                bristle: *self,
                ..Held::default()
            };
        }
        let stiffness = Self::stiffness(radius);
        // The damper by Euler's backward rule, its constant over the step.
        let damping = stiffness * RELAXATION / step;
        let twist = angle - self.root;
        let trial = stiffness * twist + damping * (twist - self.twist);
        let by_angle = stiffness + damping;
        // Ahead the rock resists with cutters and wear flats, back with the wear flats alone.
        let (torque, slips) = if trial > ahead {
            (ahead, 1)
        } else if trial < -back {
            (-back, -1)
        } else {
            (trial, 0)
        };
        // Within the limits the twist is elastic, root unchanged.
        if slips == 0 {
            return Held {
                bristle: Self {
                    root: self.root,
                    twist,
                    torque,
                },
                by_angle,
                slips,
                secant: by_angle,
            };
        }
        // Slipping, the torque is known. The twist follows from it, and the root moves along.
        let twist = (torque + damping * self.twist) / by_angle;
        Held {
            bristle: Self {
                root: angle - twist,
                twist,
                torque,
            },
            by_angle: 0.0,
            slips,
            // The secant instead of a slope of zero: Newton's next
            // correction would otherwise leave the torque as it is.
            secant: by_angle * (torque / trial).clamp(0.0, 1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::Random;

    const RADIUS: f64 = 0.059;
    const STEP: f64 = 5e-4;

    /// Spring, damper and slip take work and never give any, whatever the turns, steps and limits are.
    #[test]
    fn no_turn_gives_energy() {
        let mut random = Random(11);
        let mut bristle = Bristle::at(0.0);
        let mut angle = 0.0;
        let (mut stuck, mut slipped) = (0, [0; 2]);
        for _ in 0..20_000 {
            let turn = 3e-3 * random.next() * random.next().abs();
            let step = STEP * (0.1 + random.next().abs());
            let limits = [90.0 * random.next().abs(), 30.0 * random.next().abs()];
            angle += turn;
            let held = bristle.turned(RADIUS, step, angle, limits);
            let torque = held.bristle.torque;
            assert!((-limits[1]..=limits[0]).contains(&torque), "{held:?}");
            // A limit that falls makes the bit slip without a turn, out of the energy of the spring.
            let lost = torque * turn - (held.bristle.energy(RADIUS) - bristle.energy(RADIUS));
            // Rounding of angles up to some radians times torques.
            assert!(lost > -1e-12, "{lost} J from {bristle:?} to {held:?}");
            match held.slips {
                0 => stuck += 1,
                1 => slipped[0] += 1,
                _ => slipped[1] += 1,
            }
            bristle = held.bristle;
        }
        assert!(
            stuck > 1000 && slipped[0] > 1000 && slipped[1] > 1000,
            "{stuck} {slipped:?}"
        );
    }

    /// Under 80 % of its limit a bit stands: after the twist has come, 2e7 steps (10^4 s) turn it by nothing. At the limit it
    /// breaks off.
    #[test]
    fn a_bit_below_its_limit_does_not_creep() {
        let (limits, inertia) = ([92.4, 27.1], 0.01);
        let (mut angle, mut speed, mut bristle) = (0.0_f64, 0.0_f64, Bristle::at(0.0));
        // J w' = load - T by Euler's backward step, T linear while the bit sticks.
        let mut carried = 0.0;
        // The load comes within 0.25 s, so that the bit does not swing beyond it.
        let mut run = |to_carry: f64, steps: u32| {
            let from = carried;
            carried = to_carry;
            for step in 0..steps {
                let load = from + (to_carry - from) * (f64::from(step) / 500.0).min(1.0);
                let mut to = angle + STEP * speed;
                for _ in 0..50 {
                    let held = bristle.turned(RADIUS, STEP, to, limits);
                    let rest = inertia * ((to - angle) / STEP - speed) - STEP * (load - held.bristle.torque);
                    if rest.abs() < 1e-13 * load.abs() {
                        break;
                    }
                    to -= rest / (inertia / STEP + STEP * held.secant);
                }
                (speed, angle, bristle) = (
                    (to - angle) / STEP,
                    to,
                    bristle.turned(RADIUS, STEP, to, limits).bristle,
                );
            }
            (angle, speed)
        };
        let (before, _) = run(0.8 * limits[0], 2000);
        let (after, speed) = run(0.8 * limits[0], 20_000_000);
        assert!(
            (before - 0.8 * limits[0] / Bristle::stiffness(RADIUS)).abs() < 1e-12,
            "{before}"
        );
        // A creep of 1e-9 rad/s would have turned it by 1e-5 rad; the rest of each step turns it by rounding.
        assert!(
            (after - before).abs() < 1e-10 && speed.abs() < 1e-9,
            "{before} {after} {speed}"
        );
        // The same backwards, where only the wear flats hold.
        let (back, speed) = run(-0.8 * limits[1], 4000);
        assert!(
            (back + 0.8 * limits[1] / Bristle::stiffness(RADIUS)).abs() < 1e-9,
            "{back}"
        );
        assert!(speed.abs() < 1e-9);
        let (_, speed) = run(1.01 * limits[0], 2000);
        // J w' = 1 % of the limit over the 0.75 s after the load has come.
        assert!(speed > 0.7 * 0.01 * limits[0] / inertia, "it breaks off: {speed} rad/s");
    }
}
