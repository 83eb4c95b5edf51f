//! The bending preload of a guide whose curvature as made is not that of the path.
//!
//! A tube with the free curvature kf is bent into a path of curvature kb. In the section's own axes, which turn by psi
//! about the tangent, it bends from kf to the curvature of its axis (Antman, Nonlinear Problems of Elasticity, 2nd ed.
//! 2005, ch. 8). With the curvature of the axis k_y in the plane of the well and k_z out of it, bending stiffness EI alike
//! about both axes, c = kf cos psi_0 and s = kf sin psi_0, where psi_0 is the angle of the free bend at psi = 0:
//!
//! ```text
//! U = EI/2 int |k|^2 + kf^2 - 2 [ k_y (c cos psi - s sin psi) + k_z (c sin psi + s cos psi) ] ds.
//! ```
//!
//! The elements have U for kf = kb at psi_0 = 0, a tube that is without stress in the path. This file has the rest, to
//! second order in the displacements, dk = kb - c. A guide in pieces has kf by the distance from the bit, each element the
//! mean over its length. For small tilts k_y = kb + phi_y' - kb phi_z^2 / 2 and
//! k_z = phi_z' + kb phi_y phi_z / 2, primes along the node frames:
//!
//! ```text
//! dU = EI int dk [ phi_y' + phi_z' psi - kb (psi^2 + phi_z^2) / 2 ]
//!           + s [ kb psi - phi_z' + phi_y' psi - kb phi_y phi_z / 2 ] ds.
//! ```
//!
//! The first term is the load: couples EI dk on both ends of an element, which cancel at inner stations of an arc. The
//! others are a constant symmetric stiffness. For kf = 0 they cancel the elements' stiffness against psi: a tube that was
//! straight turns about its axis without resistance. The term in phi_z^2 lets the bent tube swing about its chord as a
//! rigid body. Third order is left out: for 0 < kf the guide may turn by small angles only, for kf = 0 by any.
//!
//! Signs: phi_y = -dw/dx and phi_z = dv/dx; kb > 0 builds towards the high side, against z; psi turns y towards z. SI.

use crate::chain::{Chain, Effect, Parts, Segment};
use crate::elements::beam::{ElementMatrix, ElementVector};
use crate::elements::bend::{PHI_Y, PHI_Z, PSI, second_order};
use crate::model::Model;
use crate::tool::FreeCurvature;
use crate::tool::section::BentTube;

/// The preload of one guide element, in the frames of its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Preload {
    /// Couples on the nodes (N m).
    pub force: ElementVector,
    /// Second derivatives of dU by the rotations (N m/rad).
    pub stiffness: ElementMatrix,
    /// Bending stiffness (N m2).
    bending: f64,
    tube: BentTube,
}

impl Preload {
    /// Of an element of bending stiffness `bending` (N m2) and length `length` (m, the chord's) between two node frames
    /// that are turned by `turn` (rad) against each other, positive where the path builds.
    pub fn of(free: FreeCurvature, bending: f64, length: f64, turn: f64) -> Self {
        // Half the turn on each side of the chord: the node frames stand symmetrically to it.
        let (path, cos) = (BentTube::path_curvature(length, turn), libm::cos(0.5 * turn));
        let along = free.curvature * libm::cos(free.phase);
        let across = free.curvature * libm::sin(free.phase);
        // The excess of the path's curvature over the free one bends the guide in the plane of the well.
        let (excess, turned) = (bending * (path - along), path * length);

        let mut force = ElementVector::zeros();
        let mut add_force = |at: [usize; 2], values: [f64; 2]| {
            for (at, value) in at.into_iter().zip(values) {
                force[at] += value;
            }
        };
        // The couple at the ends is constant along the element, so it acts at the nodes only.
        add_force(PHI_Y, [excess, -excess]);
        let (sideways, half) = (bending * across, 0.5 * bending * across * turned);
        add_force(PHI_Z, [-sideways, sideways]);
        add_force(PSI, [-half, -half]);

        // A preload turns with the guide: its second variation is a stiffness, which may be negative. The terms of dU at the
        // head of this file are those of the curvature in the tube's axes.
        let stiffness = second_order(excess, -sideways, turned, cos);
        Self {
            force,
            stiffness,
            bending,
            tube: BentTube {
                length,
                path,
                made: free.curvature,
                phase: free.phase,
            },
        }
    }

    /// Bending moment (N m, >= 0) in the element: EI |k - kf|, with the curvature k of the axis and that of the tube as
    /// made, which turns with the guide. Closed [slots](super::slots) add theirs. `spin` (rad) is the mean of both nodes;
    /// `bent` the changes of phi_y and phi_z (rad) from the upper to the lower node.
    pub fn moment(&self, spin: f64, bent: [f64; 2]) -> f64 {
        let [in_plane, across] = self.tube.change(spin, bent);
        self.bending * libm::hypot(in_plane, across)
    }

    #[cfg(test)]
    /// dU (J) at the displacements `q` of both nodes.
    pub fn energy(&self, q: &ElementVector) -> f64 {
        0.5 * q.dot(&(self.stiffness * q)) - self.force.dot(q)
    }
}

/// The preload of the guide's element `e`, of a guide that is not without stress in the path.
pub(crate) fn of_element(model: &Model, e: usize) -> Option<Preload> {
    let free = model.description.bend_above_bit(model.above_bit(e))?;
    let beam = &model.guide[e].beam;
    let turn = model.stations[e + 1].inclination - model.stations[e].inclination;
    Some(Preload::of(free, beam.section.bending, beam.length, turn))
}

/// Adds couples and stiffness of the preload along a part of the tool. It turns with the guide: it does not damp.
pub(crate) fn linear(at: &Segment<'_>, parts: &mut Parts) {
    for e in 0..at.elements {
        let Some(preload) = of_element(at.model, at.first + e) else {
            return;
        };
        let mut part = at.matrix(&mut parts.undamped).view_mut((6 * e, 6 * e), (12, 12));
        part += &preload.stiffness;
        let mut part = at.vector(&mut parts.forces).rows_mut(6 * e, 12);
        part += &preload.force;
    }
}

/// The preloads of all elements.
#[derive(Clone)]
pub(crate) struct Preloaded {
    elements: std::sync::Arc<[Preload]>,
}

impl Preloaded {
    /// Of a guide with a preload.
    pub(crate) fn of(model: &Model, _chain: &Chain) -> Option<Self> {
        let elements: Option<_> = (0..model.guide.len()).map(|e| of_element(model, e)).collect();
        elements.map(|elements| Self { elements })
    }
}

impl Effect for Preloaded {
    fn bends_guide(&self) -> bool {
        true
    }

    fn guide_moment(&self, e: usize, spin: f64, bent: [f64; 2]) -> f64 {
        self.elements[e].moment(spin, bent)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::elements::beam::Beam;
    use crate::tool::{Material, SectionProperties, Tube};

    const R: f64 = 3.2;
    const TURN: f64 = 0.03 / R;

    fn beam() -> Beam {
        let tube = Tube {
            outer_diameter: 0.102,
            inner_diameter: 0.080,
        };
        Beam {
            section: SectionProperties::of(tube, Material::STEEL, 1.0),
            length: 2.0 * R * (0.5 * TURN).sin(),
        }
    }

    fn preload(free: FreeCurvature) -> Preload {
        let beam = beam();
        Preload::of(free, beam.section.bending, beam.length, TURN)
    }

    /// Frame of a node in the chord's. The path builds towards the high side, so that x turns towards -z: about +y.
    fn node_frame(end: usize) -> Matrix3<f64> {
        *Rotation3::from_axis_angle(&Vector3::y_axis(), [-0.5, 0.5][end] * TURN).matrix()
    }

    /// A rotation that a node's frame sees, as the tool has it: R = exp([0, phi_y, phi_z]) Rx(psi).
    fn rotation(q: &ElementVector, end: usize) -> Matrix3<f64> {
        let [psi, phi_y, phi_z] = [q[PSI[end]], q[PHI_Y[end]], q[PHI_Z[end]]];
        *(Rotation3::new(Vector3::new(0.0, phi_y, phi_z)) * Rotation3::new(Vector3::new(psi, 0.0, 0.0))).matrix()
    }

    /// dU (J) by finite rotations: a round tube that bends from node to node by a curvature that is constant about the tube's axes.
    fn exact(free: FreeCurvature, q: &ElementVector) -> f64 {
        let beam = beam();
        let ends = [0, 1].map(|end| node_frame(end) * rotation(q, end));
        let bent = Rotation3::from_matrix_unchecked(ends[0].transpose() * ends[1]).scaled_axis();
        let against = |y: f64, z: f64| (bent.y - y * beam.length).powi(2) + (bent.z - z * beam.length).powi(2);
        let (y, z) = (free.curvature * free.phase.cos(), free.curvature * free.phase.sin());
        beam.section.bending / (2.0 * beam.length) * (against(y, z) - against(1.0 / R, 0.0))
    }

    /// Bending moment of a tube in the arc, EI times the difference of the curvatures as held and as made, R = 3.2 m: a
    /// straight tube has EI / R whatever it turns by; one that is bent straight again has none; one that was made with the
    /// curvature of the arc has none, and turned by 0.1 rad 2 EI / R sin(0.05). Tolerance 1e-4: the curvature of a chord of
    /// 30 mm differs from that of the arc by the square of half its turn over six, 4e-6, and second order in the spin.
    #[test]
    fn analytic_moment_of_a_preloaded_tube() {
        use crate::support::{figure, scaled_figure};
        let of = |curvature: f64| preload(FreeCurvature { curvature, phase: 0.0 });
        let bending = beam().section.bending;
        let in_path = bending / R;
        for spin in [0.0, 0.7, -2.0] {
            let quantity = format!("straight, turned by {spin} rad (N m)");
            figure(&quantity, in_path, of(0.0).moment(spin, [0.0; 2]), 1e-5);
        }
        let straight = of(0.0).moment(0.3, [-TURN, 0.0]);
        scaled_figure("straight again (N m)", 0.0, straight, in_path, 1e-4);
        let as_made = of(1.0 / R).moment(0.0, [0.0; 2]);
        scaled_figure("made as the arc (N m)", 0.0, as_made, in_path, 1e-4);
        let turned = of(1.0 / R).moment(0.1, [0.0; 2]);
        figure(
            "made as the arc, turned by 0.1 rad (N m)",
            in_path * 2.0 * 0.05_f64.sin(),
            turned,
            1e-4,
        );
    }

    /// In an arc each element of a guide in pieces has EI |1/R - kf| with the curvature of its piece, and the one in which a piece
    /// ends that with the mean. Tolerance 1e-5: the chord of an element.
    #[test]
    fn each_element_has_the_curvature_of_its_piece() {
        use crate::tool::{Bend, Bends, ToolDescription};
        let change = |from, curvature| Bend { from, curvature };
        let tool = ToolDescription::paper().with(|tool| {
            tool.guide_free_curvature = Some(FreeCurvature {
                curvature: 0.3,
                phase: 0.0,
            });
            tool.guide_bends = Bends::new(&[change(1.0, 0.2), change(2.5, 0.0)]).unwrap();
        });
        let model = Model::new(&tool).unwrap();
        let bending = model.guide[0].beam.section.bending;
        let mut mixed = 0;
        for e in 0..model.guide.len() {
            let [near, far] = model.above_bit(e);
            let share = |end: f64| ((end - near) / (far - near)).clamp(0.0, 1.0);
            // 0.3 below 1 m, 0.2 up to 2.5 m, 0 above.
            let made = 0.1 * share(1.0) + 0.2 * share(2.5);
            mixed += usize::from([0.0, 0.2, 0.3].iter().all(|whole| (made - whole).abs() > 1e-9));
            let found = of_element(&model, e).unwrap().moment(0.0, [0.0; 2]);
            let expected = bending * (1.0 / R - made);
            assert!(
                (found - expected).abs() < 1e-5 * bending / R,
                "{e}: {found}, not {expected}"
            );
        }
        assert_eq!(mixed, 2);
        assert!(model.above_bit(model.guide.len() - 1)[0] == 0.0);
    }

    /// First and second order of the energy against finite rotations, for straight and bent tubes, with any phase.
    #[test]
    fn the_energy_is_that_of_finite_rotations_to_second_order() {
        let mut generator = crate::support::Random(77);
        let mut random = || generator.next();
        // Third order is odd, so that the even part is off by fourth order and the square of the turn of an element.
        let size = 1e-3;
        for (curvature, phase) in [(0.0, 0.0), (0.1, 0.0), (0.2, 0.5), (0.1, 2.5), (0.4, -1.2)] {
            let free = FreeCurvature { curvature, phase };
            let preload = preload(free);
            for _ in 0..20 {
                let mut q = ElementVector::zeros();
                for k in 3..6 {
                    // Neighbouring nodes differ as they do in a bent tube, by its turn.
                    q[k] = size * random();
                    q[6 + k] = q[k] + size * TURN * random();
                }
                let [plus, minus, rest] = [q, -q, ElementVector::zeros()].map(|q| exact(free, &q));
                let (odd, even) = (0.5 * (plus - minus), 0.5 * (plus + minus) - rest);
                let first = -preload.force.dot(&q);
                let second = 0.5 * q.dot(&(preload.stiffness * q));
                let scale = beam().section.bending / R * TURN * size;
                assert!((odd - first).abs() < 1e-4 * scale, "{free:?}: {first} for {odd}");
                assert!(
                    (even - second).abs() < 1e-3 * scale * size,
                    "{free:?}: {second} for {even}"
                );
                assert!((preload.energy(&q) - first - second).abs() < 1e-15 * scale);
            }
        }
    }

    /// A tube that was straight turns about its axis without resistance: the elements' stiffness and the preload's cancel.
    #[test]
    fn a_straight_tube_turns_freely() {
        let preload = preload(FreeCurvature {
            curvature: 0.0,
            phase: 0.0,
        });
        let mut gamma = ElementMatrix::zeros();
        for end in 0..2 {
            // From the node's axes to the chord's.
            let turn = node_frame(end);
            for at in [6 * end, 6 * end + 3] {
                gamma.fixed_view_mut::<3, 3>(at, at).copy_from(&turn);
            }
        }
        let built = gamma.transpose() * beam().stiffness() * gamma;
        let mut q = ElementVector::zeros();
        (q[PSI[0]], q[PSI[1]]) = (1.0, 1.0);
        let (held, free) = (built * q, (built + preload.stiffness) * q);
        // Of EI / R x the element's turn, which holds a tube that is without stress in the arc; rounding.
        let scale = beam().section.bending / R * TURN;
        assert!((q.dot(&held) / scale - 1.0).abs() < 1e-4, "{}", q.dot(&held));
        assert!(free.amax() < 1e-9 * scale, "{free}");
    }
}
