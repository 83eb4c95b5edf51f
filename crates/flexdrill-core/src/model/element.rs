//! Elements of both pipes: beams with their matrices in the frames of their nodes, Eq. 7 to 9.

use nalgebra::{Matrix3, Vector3};

use super::station::{Bore, Station};
use crate::elements::beam::{Beam, ElementMatrix, ElementVector};
use crate::elements::spine;
use crate::tool::{SectionProperties, ToolDescription, frame_along};

/// A pipe element, in its link's frame.
#[derive(Debug, Clone)]
pub struct PipeElement {
    /// Section and length; a link's frame is the beam's own.
    pub beam: Beam,
    /// G, geometric stiffness per unit of tension (Eq. 41), see [`Beam::geometric_along`].
    pub geometric: ElementMatrix,
    /// Consistent forces of gravity (N).
    pub weight: ElementVector,
}

/// A guide element, between station frames.
#[derive(Debug, Clone)]
pub struct GuideElement {
    /// Beam in its chord's frame.
    pub beam: Beam,
    /// Node frames to the chord frame, Eq. 8.
    pub rotation: [Matrix3<f64>; 2],
    /// Consistent forces of gravity on the nodes, in their frames (N).
    pub weight: ElementVector,
    /// Gamma^T K Gamma, Eq. 9.
    pub stiffness: ElementMatrix,
    /// Gamma^T M Gamma.
    pub mass: ElementMatrix,
    /// Gamma^T G Gamma, see [`Beam::geometric_along`].
    pub geometric: ElementMatrix,
    /// Elongation of the spine beyond that of the axis (m) by the nodes' values, where it lies off the axis.
    spine: Option<ElementVector>,
}

impl PipeElement {
    pub(super) fn new(d: &ToolDescription, bore: &Bore, e: usize) -> Self {
        let link = e / d.elements_per_link;
        let beam = Beam {
            section: SectionProperties::of(d.pipe_sections[e % d.elements_per_link], d.material, 1.0),
            length: bore.chord(link) / d.elements_per_link as f64,
        };
        let curvature = chord_curvature(bore.chord(link), bore.turn(link));
        Self {
            beam,
            geometric: beam.geometric_along(curvature),
            weight: beam.weight((bore.link_frames[link].transpose() * gravity(d)).into()),
        }
    }
}

impl GuideElement {
    /// The element between two stations. Gamma of Eq. 8 rotates their frames into the chord's; the matrices follow by
    /// Eq. 9.
    pub(super) fn new(d: &ToolDescription, above: &Station, below: &Station) -> Self {
        // The chord between the stations is the element's axis; frames of the nodes are tangents of the path.
        let span = below.position - above.position;
        let beam = Beam {
            section: SectionProperties::of(d.guide_section, d.material, d.guide_bending_factor),
            length: span.norm(),
        };
        // Both node frames are turned against the chord, by Eq. 8.
        let frame = frame_along(span.normalize());
        let rotation = [above.frame, below.frame].map(|node| frame.transpose() * node);
        let mut gamma = ElementMatrix::zeros();
        for (n, r) in rotation.iter().enumerate() {
            gamma.fixed_view_mut::<3, 3>(6 * n, 6 * n).copy_from(r);
            gamma.fixed_view_mut::<3, 3>(6 * n + 3, 6 * n + 3).copy_from(r);
        }
        // The turn is the curvature of the path, which bends the chord's geometric stiffness.
        let turn = below.inclination - above.inclination;
        let curvature = chord_curvature(beam.length, turn);
        let turned = |m: ElementMatrix| gamma.transpose() * m * gamma;
        let mut element = Self {
            rotation,
            weight: gamma.transpose() * beam.weight((frame.transpose() * gravity(d)).into()),
            stiffness: turned(beam.stiffness()),
            mass: turned(beam.mass()),
            geometric: turned(beam.geometric_along(curvature)),
            spine: None,
            beam,
        };
        // What stretches is the spine: stiffness, tension and what tension does all follow it.
        if let Some(off_axis) = d.guide_spine {
            element.stiffness += turned(spine::stiffness(off_axis, &beam));
            element.geometric += spine::geometric(off_axis, beam.length, turn);
            element.spine = Some(gamma.tr_mul(&spine::beyond_axis(off_axis)));
        }
        element
    }

    /// Axial force (N, tension positive) by the twelve values `q` of both nodes, in their frames.
    pub fn tension(&self, q: impl Fn(usize) -> f64) -> f64 {
        // Displacement along the chord, from those along and across in the node's frame.
        let along = |n: usize| self.rotation[n][(0, 0)] * q(6 * n) + self.rotation[n][(0, 2)] * q(6 * n + 2);
        let mut elongation = along(1) - along(0);
        if let Some(spine) = &self.spine {
            elongation += spine.iter().enumerate().map(|(k, row)| row * q(k)).sum::<f64>();
        }
        self.beam.tension(elongation)
    }
}

/// Slope per displacement along a chord of this `length` (m) that turns with an arc about its centre (1/m), for the `turn`
/// of the arc (rad): the inverse of the chord's distance from the centre.
fn chord_curvature(length: f64, turn: f64) -> f64 {
    2.0 * libm::tan(0.5 * turn) / length
}

/// Gravity in the world (m/s2).
fn gravity(d: &ToolDescription) -> Vector3<f64> {
    Vector3::z() * d.gravity
}
