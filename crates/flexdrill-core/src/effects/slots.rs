//! Slots of the guide that close as it bends: beyond that it bends with the stiffness of the whole tube.
//!
//! With open slots the tube has the bending stiffness EI_f = f EI. They are closed where its curvature against its
//! shape as made, of size |k|, exceeds k_c. Per length
//!
//! ```text
//! M = EI_f |k| + (EI - EI_f) (|k| - k_c)_+   along k,      U = EI_f |k|^2 / 2 + (EI - EI_f) (|k| - k_c)_+^2 / 2.
//! ```
//!
//! The elements and the [preload](super::preload) have the first part. This file has the second, by the mean curvature
//! of an element, which follows from the rotations of both its nodes: a spring between them that acts on one side. Within
//! an element the curvature varies as with open slots, so that elements must be short where the shear is large.
//! A tube is slotted all round, so that k_c is alike in every direction. In the axes of the path, with the curvature kf
//! of the tube as made, psi_0 its angle at psi = 0, and kb that of the path,
//!
//! ```text
//! k = [ kb + phi_y' - kb phi_z^2 / 2 - kf cos(psi + psi_0),   phi_z' + kb phi_y phi_z / 2 - kf sin(psi + psi_0) ].
//! ```
//!
//! The terms of second order let a bent tube swing about its chord as a rigid body. Closed slots store energy and damp
//! nothing. Signs as in the preload's file. SI.

use std::sync::Arc;

use crate::chain::{Additions, Chain, Effect, GUIDE, NODE, Precision, Touching, Under};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::tool::SectionProperties;
use crate::tool::section::BentTube;

/// The rotations of an element's nodes: psi, phi_y, phi_z of the upper one, then of the lower one (rad).
pub type Rotations = [f64; 6];

/// The slots of one guide element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slots {
    /// What closed slots add to the bending stiffness, EI - EI_f (N m2).
    pub stiffening: f64,
    /// Curvature at which they close (1/m).
    pub close_at: f64,
    /// The element in the path, with its shape as made.
    pub tube: BentTube,
}

/// What the closed slots of an element do at one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closed {
    /// Elastic energy beyond that of open slots (J).
    pub energy: f64,
    /// Its derivatives by the rotations (N m).
    pub moments: Rotations,
    /// Second derivatives of the energy by the curvature along and across itself, times the length (N m2 m).
    along: f64,
    across: f64,
    /// Derivatives of the size of the curvature, and of its direction times the size, by the rotations.
    size: Rotations,
    turn: Rotations,
    /// Moment along the means of both nodes' rotations by those: psi psi, phi_y phi_z, phi_z phi_z (N m/rad).
    by_means: [f64; 3],
}

impl Slots {
    /// The part of the closed slots in the bending moment (N m): to be added to that of open ones,
    /// [`Preload::moment`](super::preload::Preload::moment), whose arguments these are.
    pub fn moment(&self, spin: f64, bent: [f64; 2]) -> f64 {
        let [in_plane, across] = self.tube.change(spin, bent);
        self.stiffening * (libm::hypot(in_plane, across) - self.close_at).max(0.0)
    }

    /// What the slots do, where they are closed.
    pub fn at(&self, q: &Rotations) -> Option<Closed> {
        let Self {
            stiffening,
            close_at,
            tube,
        } = *self;
        let BentTube {
            length,
            path,
            made,
            phase,
        } = tube;
        // Slots are evaluated at the mean rotation, one point per element.
        let mean = |i: usize| 0.5 * (q[i] + q[3 + i]);
        let (psi, y, z) = (mean(0), mean(1), mean(2));
        let [mut a, mut b] = tube.change(psi, [q[4] - q[1], q[5] - q[2]]);
        // Second order in the tilts: the curvature is that of the turned section.
        a -= 0.5 * path * z * z;
        b += 0.5 * path * y * z;
        let k = libm::hypot(a, b);
        // NaN is no closure; the step is rejected by its residual.
        if k <= close_at || k.is_nan() {
            return None;
        }
        let beyond = k - close_at;

        // Derivatives of the curvature by the rotations.
        let (sin, cos) = if made == 0.0 {
            (0.0, 0.0)
        } else {
            libm::sincos(psi + phase)
        };
        let per_length = 1.0 / length;
        // Each curvature depends on the mean rotations and on the difference of the tilts.
        let by = |of_psi: f64, of_y: [f64; 2], of_z: [f64; 2]| [of_psi, of_y[0], of_z[0], of_psi, of_y[1], of_z[1]];
        let half = 0.5 * path;
        let a_by = by(0.5 * made * sin, [-per_length, per_length], [-half * z, -half * z]);
        let b_by = by(
            -0.5 * made * cos,
            [0.5 * half * z, 0.5 * half * z],
            [0.5 * half * y - per_length, 0.5 * half * y + per_length],
        );
        // The size of the curvature and its direction: the law acts along the size and carries the direction.
        let (along_a, along_b) = (a / k, b / k);
        let size: Rotations = std::array::from_fn(|i| along_a * a_by[i] + along_b * b_by[i]);
        let turn: Rotations = std::array::from_fn(|i| along_a * b_by[i] - along_b * a_by[i]);
        // The additional moment begins at zero where the slots close, so that the force has no jump.
        let moment = stiffening * beyond * length;
        Some(Closed {
            energy: 0.5 * moment * beyond,
            moments: size.map(|size| moment * size),
            along: stiffening * length,
            across: moment / k,
            size,
            turn,
            by_means: [
                moment * made * (along_a * cos + along_b * sin),
                moment * half * along_b,
                -moment * path * along_a,
            ],
        })
    }
}

impl Closed {
    /// Derivatives of the moments by the rotations (N m/rad); symmetric.
    pub fn tangent(&self) -> [Rotations; 6] {
        let mut out: [Rotations; 6] = std::array::from_fn(|j| {
            let (size, turn) = (self.along * self.size[j], self.across * self.turn[j]);
            std::array::from_fn(|i| size * self.size[i] + turn * self.turn[i])
        });
        // Each mean is half of both rotations.
        let [spin, y_z, z_z] = self.by_means.map(|x| 0.25 * x);
        for j in [0, 3] {
            for i in [0, 3] {
                out[j][i] += spin;
                out[j + 1][i + 2] += y_z;
                out[j + 2][i + 1] += y_z;
                out[j + 2][i + 2] += z_z;
            }
        }
        out
    }
}

/// Whether the slots of the guide close.
pub(crate) fn is_on(model: &Model) -> bool {
    model.description.guide_slots_close_at.is_some()
}

/// The slots of the guide's element `e`, where they close.
pub(crate) fn of_element(model: &Model, e: usize) -> Option<Slots> {
    let d = &model.description;
    let close_at = d.guide_slots_close_at?;
    let length = model.guide[e].beam.length;
    let turn = model.stations[e + 1].inclination - model.stations[e].inclination;
    let whole = SectionProperties::of(d.guide_section, d.material, 1.0);
    Some(Slots {
        stiffening: whole.bending - model.guide[e].beam.section.bending,
        close_at,
        tube: d.bent_guide(length, turn, model.above_bit(e)),
    })
}

/// First rotation of the guide among a node's unknowns.
const FIRST: usize = GUIDE + 3;

/// The slots of all elements, over a chain with a node at every station.
#[derive(Clone)]
pub(crate) struct SlottedGuide {
    /// Per span, which is one element.
    slots: Arc<[Slots]>,
    /// What they do where they are closed.
    closed: Vec<Option<Closed>>,
}

impl SlottedGuide {
    /// Of a guide whose slots close.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        let slots: Option<Arc<[Slots]>> = (0..chain.spans()).map(|e| of_element(model, e)).collect();
        slots.map(|slots| Self {
            closed: vec![None; slots.len()],
            slots,
        })
    }
}

impl Effect for SlottedGuide {
    fn force(&mut self, chain: &mut Chain, state: &mut State, _under: &Under<'_>) {
        let (nodes, _) = state.q.as_chunks::<NODE>();
        for (l, (slots, closed)) in self.slots.iter().zip(&mut self.closed).enumerate() {
            if !chain.is_active(l) {
                continue;
            }
            let rotations: Rotations = std::array::from_fn(|k| nodes[l + k / 3][FIRST + k % 3]);
            *closed = slots.at(&rotations);
            let Some(closed) = closed else { continue };
            let [_, guide] = chain.inside(l);
            for (k, moment) in closed.moments.iter().enumerate() {
                // The bottom end's six begin at 8.
                guide[3 + k + 5 * (k / 3)] += moment;
            }
        }
    }

    fn tangent<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, _state: &State, at: &Iteration<'_>) {
        let factor = at.factors.stiffness;
        let add = |to: &mut [S], from: &[f64]| {
            for (to, from) in to.iter_mut().zip(from) {
                *to += S::of(factor * from);
            }
        };
        for (l, closed) in self.closed.iter().enumerate().filter(|(l, _)| chain.is_active(*l)) {
            let Some(closed) = closed else { continue };
            let tangent = closed.tangent();
            for end in 0..2 {
                let block = to.block(l + end, Touching::Guide);
                for j in 0..3 {
                    let column = &tangent[3 * end + j][3 * end..3 * end + 3];
                    add(&mut block[FIRST + j][FIRST..FIRST + 3], column);
                }
            }
            // The guide's columns are the last six of twelve, its rotations the last three of those.
            let coupling = to.coupling(l, Touching::Guide);
            for j in 0..3 {
                add(&mut coupling.upper[9 + j][FIRST..FIRST + 3], &tangent[3 + j][..3]);
                add(&mut coupling.lower[9 + j][FIRST..FIRST + 3], &tangent[j][3..]);
            }
        }
    }

    fn energy(&self, _chain: &Chain, _point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        self.closed.iter().flatten().map(|closed| closed.energy).sum()
    }

    fn guide_moment(&self, e: usize, spin: f64, bent: [f64; 2]) -> f64 {
        self.slots[e].moment(spin, bent)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::support::Random;
    use crate::tool::FreeCurvature;

    const R: f64 = 3.2;
    const LENGTH: f64 = 0.15;

    fn slots(free: FreeCurvature, close_at: f64) -> Slots {
        Slots {
            stiffening: 6e5,
            close_at,
            tube: BentTube {
                length: LENGTH,
                path: 1.0 / R,
                made: free.curvature,
                phase: free.phase,
            },
        }
    }

    fn random(generator: &mut Random, size: f64) -> Rotations {
        std::array::from_fn(|_| size * generator.next())
    }

    /// Free shapes that differ in size and direction.
    const FREE: [FreeCurvature; 3] = [
        FreeCurvature {
            curvature: 0.0,
            phase: 0.0,
        },
        FreeCurvature {
            curvature: 1.0 / R,
            phase: 0.0,
        },
        FreeCurvature {
            curvature: 0.2,
            phase: 0.7,
        },
    ];

    #[test]
    fn moments_and_tangent_are_the_derivatives_of_the_energy() {
        let mut generator = Random(5);
        let mut closed_at = 0;
        for free in FREE {
            let slots = slots(free, 0.2);
            for _ in 0..30 {
                let mut q = random(&mut generator, 0.05);
                (q[0], q[3]) = (50.0 * q[0], 50.0 * q[3]);
                let Some(closed) = slots.at(&q) else { continue };
                closed_at += 1;
                let tangent = closed.tangent();
                let h = 1e-6;
                for j in 0..6 {
                    let moved = |by: f64| {
                        let mut q = q;
                        q[j] += by;
                        slots.at(&q).unwrap()
                    };
                    let (above, below) = (moved(h), moved(-h));
                    // Energies of 1e4 J round to 1e-12 over the step; differences of third order.
                    let slope = (above.energy - below.energy) / (2.0 * h);
                    assert!(
                        (slope - closed.moments[j]).abs() < 1e-3,
                        "{slope} for {}",
                        closed.moments[j]
                    );
                    for (i, column) in tangent.iter().enumerate() {
                        let slope = (above.moments[i] - below.moments[i]) / (2.0 * h);
                        // Of the largest entries, EI / l = 4e6 N m.
                        assert!((slope - tangent[j][i]).abs() < 1.0, "{slope} for {}", tangent[j][i]);
                        assert!((column[j] - tangent[j][i]).abs() < 1e-9 * 4e6);
                    }
                }
            }
        }
        assert!(closed_at > 40, "{closed_at}");
    }

    /// Straight tube with k_c = 0.2 1/m in an arc of R = 3.2 m: (EI - EI_f)(1/R - k_c) on top of EI_f / R, whatever it
    /// turns by; none where it is bent to 0.2 1/m only, in the plane or across it. Tolerance 1e-12: rounding.
    #[test]
    fn analytic_moment_of_closed_slots() {
        use crate::support::{figure, scaled_figure};
        let (slots, excess) = (slots(FREE[0], 0.2), 6e5 * (1.0 / R - 0.2));
        for spin in [0.0, 0.7, -2.0] {
            let quantity = format!("in the arc, turned by {spin} rad (N m)");
            figure(&quantity, excess, slots.moment(spin, [0.0; 2]), 1e-12);
        }
        let to = |curvature: f64, across: f64| [LENGTH * (curvature - 1.0 / R), LENGTH * across];
        scaled_figure("bent to k_c (N m)", 0.0, slots.moment(0.0, to(0.2, 0.0)), excess, 1e-12);
        scaled_figure(
            "across, to k_c (N m)",
            0.0,
            slots.moment(0.0, to(0.0, 0.2)),
            excess,
            1e-12,
        );
        figure(
            "across, to 1/R (N m)",
            excess,
            slots.moment(0.0, to(0.0, 1.0 / R)),
            1e-12,
        );
        figure(
            "0.3 1/m in both planes (N m)",
            6e5 * (0.18_f64.sqrt() - 0.2),
            slots.moment(0.0, to(0.3, 0.3)),
            1e-12,
        );
    }

    /// The energy is that of finite rotations to second order: a tube that swings about its chord, or turns about its
    /// axis where it was straight, bends no further.
    #[test]
    fn the_curvature_is_that_of_finite_rotations_to_second_order() {
        let mut generator = Random(31);
        let turn = LENGTH / R;
        for free in FREE {
            let mut slots = slots(free, 1e-3);
            slots.tube.path = 2.0 * (0.5 * turn).sin() / LENGTH;
            let energy = |q: &Rotations| slots.at(q).map_or(0.0, |closed| closed.energy);
            let exact = |q: &Rotations| {
                let ends = [0, 1].map(|end: usize| -> Matrix3<f64> {
                    let [psi, y, z] = [q[3 * end], q[3 * end + 1], q[3 * end + 2]];
                    let frame = Rotation3::from_axis_angle(&Vector3::y_axis(), [-0.5, 0.5][end] * turn);
                    let node = Rotation3::new(Vector3::new(0.0, y, z)) * Rotation3::new(Vector3::new(psi, 0.0, 0.0));
                    *(frame * node).matrix()
                });
                let bent = Rotation3::from_matrix_unchecked(ends[0].transpose() * ends[1]).scaled_axis();
                let (y, z) = (free.curvature * free.phase.cos(), free.curvature * free.phase.sin());
                let k = (bent.y / LENGTH - y).hypot(bent.z / LENGTH - z);
                0.5 * slots.stiffening * LENGTH * (k - slots.close_at).max(0.0).powi(2)
            };
            let size = 1e-3;
            // A tube that is without stress in the arc has the kink of |k| at rest: it is bent by 0.1 1/m here.
            let at = [0.0, -0.05 * LENGTH, 0.0, 0.0, 0.05 * LENGTH, 0.0];
            for _ in 0..20 {
                let mut by = random(&mut generator, size);
                // Neighbouring nodes differ by the turn of an element.
                for i in 0..3 {
                    by[3 + i] = by[i] + turn * size * generator.next();
                }
                let along = |sign: f64| -> Rotations { std::array::from_fn(|i| at[i] + sign * by[i]) };
                let orders = |energy: &dyn Fn(&Rotations) -> f64| {
                    let (plus, minus) = (energy(&along(1.0)), energy(&along(-1.0)));
                    (0.5 * (plus - minus), 0.5 * (plus + minus) - energy(&at))
                };
                let ((first, second), expected) = (orders(&energy), orders(&exact));
                // First order: the chord's curvature differs from that of the arc by turn^2 / 24 = 1e-4. Second order:
                // the tilts at `at`, 7.5 mrad, make part of it out of third order, against the turn of an element, 47
                // mrad.
                let scale = slots.stiffening / R * turn * size;
                assert!(
                    (first - expected.0).abs() < 1e-3 * scale,
                    "{free:?}: {first}, {expected:?}"
                );
                assert!(
                    (second - expected.1).abs() < 0.15 * scale * size,
                    "{free:?}: {second}, {expected:?}"
                );
            }
        }
    }
}
