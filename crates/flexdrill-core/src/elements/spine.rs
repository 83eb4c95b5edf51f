//! A guide whose spine lies off its axis: thrust bends it.
//!
//! Slots on one side of a tube leave a spine at a distance e from the tube's axis, which carries the axial force N. The
//! stretch that N belongs to is that of the spine, and bending is about the spine's own neutral axis. Per length, with the
//! stretch u' of the axis and the curvature k of the guide towards the side opposite to the spine, against that in the
//! path ([`bend`]),
//!
//! ```text
//! U = E A (u' + e k)^2 / 2 + E I k^2 / 2,      N = E A (u' + e k),      moment about the axis: E I k + e N.
//! ```
//!
//! A thrust C = -N on the axis therefore bends the guide by e C / (E I), away from the spine. The curvature of an element
//! varies along it and N does not, so that the strain of the spine counts by its mean: with the elongation of the element's
//! axis a . q and the turn of its ends b . q,
//!
//! ```text
//! U = (E A / L) (a . q + e b . q)^2 / 2,      in place of (E A / L) (a . q)^2 / 2.
//! ```
//!
//! That is exact where no axial load acts within an element: an inner node on the axis would find the same N on both its
//! sides. The rest is linear, symmetric, and damped as the beam's stretch is. To second order the spine becomes longer by the
//! turned curvature too, which N times e [`second_order`] holds in the geometric stiffness: a thrust holds a guide that it
//! bends with the path against turning, and turns one that it bends against it.
//!
//! Signs: N > 0 is tension; phi_y = -dw/dx, phi_z = dv/dx, so that a fibre at (y, z) is longer than the axis by
//! z phi_y' - y phi_z'. Lengths in m, angles in rad, forces in N.

use crate::elements::beam::{Beam, ElementMatrix, ElementVector};
use crate::elements::bend::{PHI_Y, PHI_Z, second_order};
use crate::tool::Spine;
use crate::tool::section::BentTube;

/// e b: elongation of the spine beyond that of the axis (m) by the rotations of both nodes in the chord's frame (rad).
pub fn beyond_axis(spine: Spine) -> ElementVector {
    let mut row = ElementVector::zeros();
    for (at, part) in [(PHI_Y, libm::cos(spine.phase)), (PHI_Z, libm::sin(spine.phase))] {
        (row[at[0]], row[at[1]]) = (-spine.offset * part, spine.offset * part);
    }
    row
}

/// What the stretch of the spine adds to the stiffness of a beam whose axis stretches, in the chord's frame.
pub fn stiffness(spine: Spine, beam: &Beam) -> ElementMatrix {
    let mut axis = ElementVector::zeros();
    (axis[0], axis[6]) = (-1.0, 1.0);
    let beyond = beyond_axis(spine);
    let both = axis + beyond;
    // Without the product of the axis by itself, which the beam has.
    (both * beyond.transpose() + beyond * axis.transpose()) * beam.tension(1.0)
}

/// What the spine adds to the geometric stiffness per tension, in the frames of the nodes, which are turned by `turn` (rad)
/// against each other over the `length` (m) of the chord.
pub fn geometric(spine: Spine, length: f64, turn: f64) -> ElementMatrix {
    let (sin, cos) = libm::sincos(spine.phase);
    let turned = BentTube::path_curvature(length, turn) * length;
    second_order(spine.offset * cos, spine.offset * sin, turned, libm::cos(0.5 * turn))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::elements::bend::PSI;
    use crate::support::Random;
    use crate::tool::{Material, SectionProperties, Tube};

    const R: f64 = 3.2;
    const TURN: f64 = 0.03 / R;

    fn beam() -> Beam {
        let tube = Tube {
            outer_diameter: 0.102,
            inner_diameter: 0.080,
        };
        Beam {
            section: SectionProperties::of(tube, Material::STEEL, 0.01),
            length: 2.0 * R * (0.5 * TURN).sin(),
        }
    }

    /// Spines that bend the guide with the path, against it, and across it.
    const PHASES: [f64; 4] = [0.0, std::f64::consts::PI, 0.7, -1.9];

    fn spine(phase: f64) -> Spine {
        Spine { offset: 0.04, phase }
    }

    /// A cantilever of one element under a thrust C on its axis: e C / (E I) all along, without a shear or a twist, the spine as
    /// short as C makes it, and the axis by e times the turn shorter than that. All is exact in a cubic element: rounding of
    /// a stiffness that is E A e^2 / (E I) = 150 times that of bending.
    #[test]
    fn a_thrust_bends_a_cantilever_about_its_spine() {
        let (beam, thrust) = (beam(), 1e4);
        for phase in PHASES {
            let spine = spine(phase);
            let whole = beam.stiffness() + stiffness(spine, &beam);
            let free = whole.fixed_view::<6, 6>(6, 6).clone_owned();
            let mut load = nalgebra::SVector::<f64, 6>::zeros();
            load[0] = -thrust;
            let end = free.lu().solve(&load).unwrap();
            let bend = spine.offset * thrust / beam.section.bending;
            let length = beam.length;
            let expected = [
                -thrust / beam.section.axial * length - spine.offset * bend * length,
                0.5 * bend * phase.sin() * length * length,
                -0.5 * bend * phase.cos() * length * length,
                0.0,
                bend * phase.cos() * length,
                bend * phase.sin() * length,
            ];
            for (k, expected) in expected.into_iter().enumerate() {
                let size = if k < 3 { bend * length * length } else { bend * length };
                assert!(
                    (end[k] - expected).abs() < 1e-8 * size,
                    "phase {phase}, {k}: {} for {expected}",
                    end[k]
                );
            }
        }
    }

    /// Rigid motions in a straight hole need no force, and the forces on an element's ends balance as forces and as moments: N
    /// at the spine is N on the axis with the couple e N, whose arm both ends have.
    #[test]
    fn forces_and_moments_on_an_element_balance() {
        let (beam, mut generator) = (beam(), Random(11));
        for phase in PHASES {
            let added = stiffness(spine(phase), &beam);
            assert!((added - added.transpose()).amax() <= 1e-15 * added.amax());
            for _ in 0..10 {
                let q = ElementVector::from_fn(|_, _| 1e-3 * generator.next());
                let force = added * q;
                for k in 0..6 {
                    let sum: f64 = force[k] + force[6 + k];
                    assert!(sum.abs() < 1e-12 * force.amax(), "{phase}, {k}: {sum}");
                }
                // Neither a twist nor a shear.
                for k in [1, 2, 3, 7, 8, 9] {
                    assert_eq!(force[k], 0.0, "{phase}, {k}");
                }
                // The couple is e times the axial force, towards the side opposite to the spine. The beam has the rest of N.
                let tension = force[6] + beam.tension(q[6] - q[0]);
                let couple = spine(phase).offset * tension;
                assert!((force[10] - couple * phase.cos()).abs() < 1e-12 * force.amax());
                assert!((force[11] - couple * phase.sin()).abs() < 1e-12 * force.amax());
            }
        }
    }

    /// Frame of a node in the chord's. The path builds towards the high side, so that x turns towards -z: about +y.
    fn node_frame(end: usize) -> Matrix3<f64> {
        *Rotation3::from_axis_angle(&Vector3::y_axis(), [-0.5, 0.5][end] * TURN).matrix()
    }

    fn rotation(q: &ElementVector, end: usize) -> Matrix3<f64> {
        let [psi, phi_y, phi_z] = [q[PSI[end]], q[PHI_Y[end]], q[PHI_Z[end]]];
        *(Rotation3::new(Vector3::new(0.0, phi_y, phi_z)) * Rotation3::new(Vector3::new(psi, 0.0, 0.0))).matrix()
    }

    /// Elongation of the spine by the rotations of the nodes (m), by finite rotations: e times the part of the rotation from
    /// node to node that bends towards the side opposite to the spine, in axes that turn with the guide.
    fn exact(spine: Spine, q: &ElementVector) -> f64 {
        let ends = [0, 1].map(|end| node_frame(end) * rotation(q, end));
        let bent = Rotation3::from_matrix_unchecked(ends[0].transpose() * ends[1]).scaled_axis();
        spine.offset * (bent.y * spine.phase.cos() + bent.z * spine.phase.sin())
    }

    /// First order in the chord's frame and second order in the geometric stiffness, against finite rotations. Bars as for the
    /// preload, which has the same curvature: third order is odd, and the square of the turn of an element.
    #[test]
    fn the_spine_becomes_longer_as_finite_rotations_say() {
        let mut gamma = ElementMatrix::zeros();
        for end in 0..2 {
            let turn = node_frame(end);
            for at in [6 * end, 6 * end + 3] {
                gamma.fixed_view_mut::<3, 3>(at, at).copy_from(&turn);
            }
        }
        let mut generator = Random(77);
        let size = 1e-3;
        for phase in PHASES {
            let spine = spine(phase);
            let (row, second) = (gamma.tr_mul(&beyond_axis(spine)), geometric(spine, beam().length, TURN));
            for _ in 0..20 {
                let mut q = ElementVector::zeros();
                for k in 3..6 {
                    // Neighbouring nodes differ as they do in a bent tube, by its turn.
                    q[k] = size * generator.next();
                    q[6 + k] = q[k] + size * TURN * generator.next();
                }
                let [plus, minus, rest] = [q, -q, ElementVector::zeros()].map(|q| exact(spine, &q));
                let (odd, even) = (0.5 * (plus - minus), 0.5 * (plus + minus) - rest);
                let (first, second) = (row.dot(&q), 0.5 * q.dot(&(second * q)));
                let scale = spine.offset * TURN * size;
                assert!((odd - first).abs() < 1e-4 * scale, "{phase}: {first} for {odd}");
                assert!(
                    (even - second).abs() < 1e-3 * scale * size,
                    "{phase}: {second} for {even}"
                );
            }
        }
    }

    #[test]
    fn a_spine_on_the_axis_adds_nothing() {
        let none = Spine {
            offset: 0.0,
            phase: 0.4,
        };
        assert_eq!(stiffness(none, &beam()).amax(), 0.0);
        assert_eq!(geometric(none, beam().length, TURN).amax(), 0.0);
    }
}
