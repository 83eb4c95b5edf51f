//! Friction that sticks: Coulomb's law on an ellipse, with an elastic slip before it slides.
//!
//! The surfaces of a contact are held together by a tangential spring k_t. Over a step the contact slides by (dx_t,
//! dx_x) (m), so that a force F of the step before becomes F - k_t dx as long as that lies within the ellipse f =
//! sqrt((T / mu_t)^2 + (A / mu_x)^2) - Fn <= 0. Beyond it the contact slips along the gradient of f (maximum
//! dissipation), which is the closest point of the ellipse:
//!
//! ```text
//! trial F* = F0 - k_t dx;   f(F*) <= 0: F = F*          (sticks)
//!                           f(F*) > 0: F_i = F*_i mu_i^2 / (mu_i^2 + lambda), lambda > 0 so that f(F) = 0   (slips)
//! k_t = 2 (1 - nu) / (2 - nu) k_n                        (Mindlin 1949, J. Appl. Mech. 16)
//! ```
//!
//! With equal coefficients F is F* scaled to the circle. In steady sliding F is the force of [`super::vector`] without
//! regularisation. The tangent is that of the step (Simo & Hughes 1998, ch. 3): with M_i = mu_i^2 / (mu_i^2 + lambda)
//! and g_i = M_i F_i / mu_i^2
//!
//! ```text
//! dF = M dF* - g (g.dF* - Fn dFn) / sum(g_i F_i / mu_i^2).
//! ```
//!
//! T acts on the inner body in the sense of positive spin, A down the hole (N). The state is the force F, from which
//! the elastic slip is - F / k_t; it is zero where the gap is open. Energy |F|^2 / (2 k_t) is stored.

use super::{GapLaw, Sliding, Touch};
use crate::elements::slip::Slip;
use crate::simd::number::Number;

/// Normal force below which nothing sticks (N): a billionth of what a step balances.
const LEAST_NORMAL: f64 = 1e-9;
/// Part of the normal force by which a slipping friction may miss the ellipse: some roundings.
const ON_THE_ELLIPSE: f64 = 1e-14;
/// Most steps towards the ellipse. The equation is nearly linear in the form that is solved; eight have sufficed for
/// coefficients that differ by a factor of a thousand.
const MOST_STEPS: usize = 40;

/// Bristles of a layer.
#[derive(Debug, Clone)]
pub(super) struct Bristles {
    /// Force of each gap at the start of the step, around and along (N); zero where it was open.
    held: Vec<[f64; 2]>,
    /// Size of the step (s); 0 at rest, where the bristles keep their forces.
    step: f64,
}

/// The friction at the end of a step, or that in each of eight lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Friction<N = f64> {
    /// Force around and along (N).
    force: [N; 2],
    /// d force / d trial force: around, coupling, along (-).
    by_trial: [N; 3],
    /// d force / d normal force, around and along (-).
    by_normal: [N; 2],
}

impl<N: Number> Friction<N> {
    /// The forces `held` (N), which nothing changes.
    #[inline(always)]
    fn held(force: [N; 2]) -> Self {
        let zero = N::of(0.0);
        Self {
            force,
            by_trial: [zero; 3],
            by_normal: [zero; 2],
        }
    }

    /// The point of the ellipse of `normal` force (N) and coefficients `mu` that is next to a `trial` force (N).
    #[inline(always)]
    fn next_to(trial: [N; 2], mu: [N; 2], normal: N) -> Self {
        let (zero, one) = (N::of(0.0), N::of(1.0));
        // Without friction in one direction the ellipse is a line: a circle, and a force in the other direction only.
        let (mut full, mut scale) = (trial, mu);
        for (k, mu) in mu.iter().enumerate() {
            full[k] = trial[k].where_above(*mu, zero, zero);
            scale[k] = mu.where_above(*mu, zero, one);
        }
        let mut out = Self::on_ellipse(full, scale, normal);

        // A direction without friction has neither force nor slope; without a normal force no direction has.
        let least = N::of(LEAST_NORMAL);
        for (k, mu) in mu.iter().enumerate() {
            out.force[k] = zero.where_above(least, normal, out.force[k].where_above(*mu, zero, zero));
            out.by_trial[2 * k] = zero.where_above(least, normal, out.by_trial[2 * k].where_above(*mu, zero, zero));
            out.by_normal[k] = zero.where_above(least, normal, out.by_normal[k].where_above(*mu, zero, zero));
        }
        out.by_trial[1] = zero.where_above(least, normal, out.by_trial[1]);
        out
    }

    /// As [`Friction::next_to`] with friction in both directions.
    #[inline(always)]
    fn on_ellipse(trial: [N; 2], mu: [N; 2], normal: N) -> Self {
        let (zero, one) = (N::of(0.0), N::of(1.0));
        let square = [mu[0] * mu[0], mu[1] * mu[1]];

        // Newton's method for 1 / length = 1 / normal, which is concave in lambda: from 0 on it never oversteps. Lanes that
        // have arrived wait for the others where they are.
        let mut lambda = zero;
        // The share of the trial force that remains at lambda: all of it at first.
        let mut kept = [one; 2];
        let (mut scaled, mut length) = on_circle(trial, kept, mu);
        let whole = length;
        for _ in 0..MOST_STEPS {
            let excess = length.over(normal) - one;
            if !N::of(ON_THE_ELLIPSE).any_below(excess) {
                break;
            }
            let falls = [
                (scaled[0] * scaled[0]).over(square[0] + lambda),
                (scaled[1] * scaled[1]).over(square[1] + lambda),
            ];
            let stride = (excess * length * length).over(falls[0] + falls[1]);
            lambda = lambda + stride.where_above(excess, N::of(ON_THE_ELLIPSE), zero);
            kept = [square[0].over(square[0] + lambda), square[1].over(square[1] + lambda)];
            (scaled, length) = on_circle(trial, kept, mu);
        }

        // Outside, the closest point of the ellipse: the force with the most dissipation.
        let force = [trial[0] * kept[0], trial[1] * kept[1]];
        // The tangent follows from the condition of the ellipse; along the
        // gradient it is zero, because the size is fixed there.
        let slope = [force[0].over(square[0]), force[1].over(square[1])];
        let gradient = [kept[0] * slope[0], kept[1] * slope[1]];
        let over = one.over(gradient[0] * slope[0] + gradient[1] * slope[1]);

        // Within the ellipse the contact sticks, and the trial force is the force.
        let coupling = (-gradient[0]) * gradient[1] * over;
        let mut out = Self {
            force,
            by_trial: [zero, coupling.where_above(whole, normal, zero), zero],
            by_normal: [zero; 2],
        };
        for k in 0..2 {
            let by_trial = kept[k] - gradient[k] * gradient[k] * over;
            out.force[k] = force[k].where_above(whole, normal, trial[k]);
            out.by_trial[2 * k] = by_trial.where_above(whole, normal, one);
            out.by_normal[k] = (gradient[k] * normal * over).where_above(whole, normal, zero);
        }
        out
    }
}

/// The shares `kept` of a `trial` force on the scale on which the ellipse is a circle, and their length.
#[inline(always)]
fn on_circle<N: Number>(trial: [N; 2], kept: [N; 2], mu: [N; 2]) -> ([N; 2], N) {
    let scaled = [(trial[0] * kept[0]).over(mu[0]), (trial[1] * kept[1]).over(mu[1])];
    (scaled, (scaled[0] * scaled[0] + scaled[1] * scaled[1]).root())
}

impl Bristles {
    /// Bristles of `stations` gaps, without force.
    pub(super) fn new(stations: usize) -> Self {
        Self {
            held: vec![[0.0; 2]; stations],
            step: 0.0,
        }
    }

    /// Starts a step of size `step` (s) from the forces `held`; with 0 the bristles keep them.
    pub(super) fn begin(&mut self, held: impl Iterator<Item = [f64; 2]>, step: f64) {
        self.step = step;
        self.held.iter_mut().zip(held).for_each(|(to, from)| *to = from);
    }

    /// Force of the gap of a station at the start of the step, around and along (N).
    #[inline(always)]
    pub(super) fn held(&self, station: usize) -> [f64; 2] {
        self.held[station]
    }

    /// Sets the friction of a `touch` that has `travelled` since the start of the step (m; rotations times radius), when its
    /// bristles `held` forces around and along (N), with a `factor` on its coefficients.
    #[inline(always)]
    pub(super) fn rub<N: Number>(
        &self,
        law: &GapLaw,
        touch: &mut Touch<N>,
        travelled: Sliding<N>,
        held: [N; 2],
        factor: N,
    ) {
        touch.sliding_by = travelled.by;
        let slid = [travelled.around, travelled.along];

        // The force of the step before, less what the travel stretches the bristles by.
        let (zero, stiffness) = (N::of(0.0), N::of(law.bristle_stiffness));
        let normal = touch.normal;
        let trial = [held[0] - stiffness * slid[0], held[1] - stiffness * slid[1]];
        // Without a step nothing slips: the start evaluates forces that are to be held.
        let moves = self.step > 0.0;
        let friction = if moves {
            Friction::next_to(trial, law.friction(factor), normal)
        } else {
            Friction::held(held)
        };
        [touch.tangential, touch.axial] = friction.force;

        // The tangent multiplies these by the normal force.
        let per_normal = if moves {
            zero.where_above(N::of(LEAST_NORMAL), normal, stiffness.over(normal))
        } else {
            zero
        };
        touch.coupling = per_normal * friction.by_trial[1];
        for (k, slid) in slid.into_iter().enumerate() {
            touch.slip[k] = Slip {
                speed: slid,
                // The share of the normal force enters with the other sign, as the slope of friction against sliding.
                friction: -friction.by_normal[k],
                slope: per_normal * friction.by_trial[2 * k],
            };
        }

        // Slip is what the travel leaves after the change of the elastic slip.
        touch.friction_power = if moves && law.bristle_stiffness > 0.0 {
            let slipped = [
                friction.force[0] * (trial[0] - friction.force[0]),
                friction.force[1] * (trial[1] - friction.force[1]),
            ];
            (slipped[0] + slipped[1]).over(stiffness * N::of(self.step))
        } else {
            zero
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::aligned::Aligned;
    use crate::simd::number::{Eight, Lane};
    use crate::simd::vector::Portable;
    use crate::support::Random;

    /// Coefficients that are equal, differ, differ much, and vanish.
    const COEFFICIENTS: [[f64; 2]; 6] = [
        [0.3, 0.3],
        [0.2, 0.4],
        [0.7, 0.015],
        [0.3, 0.0],
        [0.0, 0.3],
        [1e-3, 1.0],
    ];

    #[test]
    fn the_force_is_on_the_ellipse_and_slips_with_most_dissipation() {
        let mut random = Random(5);
        for mu in COEFFICIENTS {
            for _ in 0..2000 {
                let normal = 1e3 * random.next().abs() + 1e-3;
                let trial = [0, 1].map(|_| 1e3 * random.next() * random.next().abs());
                let at = Friction::next_to(trial, mu, normal);
                let on = |force: [f64; 2]| {
                    let part = |k: usize| if mu[k] > 0.0 { force[k] / (mu[k] * normal) } else { 0.0 };
                    part(0) * part(0) + part(1) * part(1)
                };
                // Twice what the search leaves, as this is the square.
                assert!(on(at.force) <= 1.0 + 1e-13, "{mu:?} {trial:?} {at:?}");
                // Any other admissible force takes no more work from the slip F* - F: that is the closest point.
                let slip = [trial[0] - at.force[0], trial[1] - at.force[1]];
                let work = at.force[0] * slip[0] + at.force[1] * slip[1];
                let size = (trial[0] * trial[0] + trial[1] * trial[1]).max(normal * normal);
                assert!(work >= -1e-12 * size, "slip gives energy: {work}");
                for turn in 0..32 {
                    let angle = 0.2 * f64::from(turn);
                    let other = [mu[0] * normal * angle.cos(), mu[1] * normal * angle.sin()];
                    // Directions without friction have no slip that friction knows of.
                    let other = other[0] * slip[0] + other[1] * slip[1];
                    assert!(other <= work + 1e-9 * size, "{mu:?}: {other} against {work}");
                }
            }
        }
    }

    /// Lanes that stick, slip, have no normal force or no friction, side by side: each is to the bit what it is alone,
    /// however many steps the others need.
    #[test]
    fn eight_lanes_are_eight_times_one() {
        let mut random = Random(7);
        for group in 0..500 {
            let mu: [[f64; 2]; 8] = std::array::from_fn(|lane| COEFFICIENTS[(group + lane) % COEFFICIENTS.len()]);
            let normal: [f64; 8] = std::array::from_fn(|lane| match (group + lane) % 11 {
                0 => 0.0,
                1 => 0.5 * LEAST_NORMAL,
                _ => 1e3 * random.next().abs() + 1e-3,
            });
            let trial: [[f64; 2]; 8] = std::array::from_fn(|_| [1e3 * random.next(), 1e3 * random.next()]);
            let lanes = |of: &[[f64; 2]; 8]| -> [Eight<Portable>; 2] {
                let lane = |k: usize| Aligned(std::array::from_fn(|lane| of[lane][k]));
                [Eight::load(&lane(0)), Eight::load(&lane(1))]
            };
            let together = Friction::next_to(lanes(&trial), lanes(&mu), Eight::load(&Aligned(normal)));
            let Friction {
                force,
                by_trial,
                by_normal,
            } = together;
            let mut got = [Lane::default(); 7];
            let values = force.into_iter().chain(by_trial).chain(by_normal);
            got.iter_mut().zip(values).for_each(|(to, from)| from.store(to));
            for lane in 0..8 {
                let alone = Friction::next_to(trial[lane], mu[lane], normal[lane]);
                let expected = alone.force.into_iter().chain(alone.by_trial).chain(alone.by_normal);
                for (got, expected) in got.iter().zip(expected) {
                    assert!(expected.is_finite(), "{alone:?}");
                    assert_eq!(got[lane], expected, "{:?} {:?} {}", mu[lane], trial[lane], normal[lane]);
                }
            }
        }
    }

    #[test]
    fn the_derivatives_are_those_of_differences() {
        let mut random = Random(6);
        let mut slipping = 0;
        for mu in COEFFICIENTS {
            for _ in 0..500 {
                let normal = 1e3 * (0.1 + random.next().abs());
                let trial = [0, 1].map(|_| 1e3 * random.next());
                let at = Friction::next_to(trial, mu, normal);
                slipping += u32::from(at.by_trial != [1.0, 0.0, 1.0]);
                let h = 1e-4;
                let difference = |trial_by: [f64; 2], normal_by: f64| {
                    let side = |sign: f64| {
                        let moved = [trial[0] + sign * trial_by[0], trial[1] + sign * trial_by[1]];
                        Friction::next_to(moved, mu, normal + sign * normal_by).force
                    };
                    let (high, low) = (side(h), side(-h));
                    [0, 1].map(|k| (high[k] - low[k]) / (2.0 * h))
                };
                let [a, b, c] = at.by_trial;
                for (got, expected) in [
                    (difference([1.0, 0.0], 0.0), [a, b]),
                    (difference([0.0, 1.0], 0.0), [b, c]),
                    (difference([0.0, 0.0], 1.0), at.by_normal),
                ] {
                    for k in 0..2 {
                        // Forces of 1e3 N round to 1e-13 N over steps of 1e-4 N; the ellipse of coefficients a
                        // thousandfold apart curves by h / (mu^2 F).
                        assert!(
                            (got[k] - expected[k]).abs() < 2e-5,
                            "{mu:?} {trial:?}: {got:?} {expected:?}"
                        );
                    }
                }
            }
        }
        assert!(slipping > 1000, "{slipping}");
    }
}
