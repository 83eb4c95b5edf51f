//! What acts linearly along a span beyond its beams, over all its nodes: data, which the chain condenses to the ends as it does
//! with the beams' matrices.

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::model::Model;

/// A segment of the tool whose matrices are made: so many `elements` below station `first`, with a node at every station. Six
/// numbers per node: the pipe's in the frame of its link, the guide's in that of the station.
pub(crate) struct Segment<'a> {
    pub model: &'a Model,
    pub first: usize,
    pub elements: usize,
}

impl Segment<'_> {
    /// Rotation of the pipe's displacements at node `i`, in its link's frame, to the station's frame.
    pub(crate) fn pipe_to_station(&self, i: usize) -> Matrix3<f64> {
        let station = &self.model.stations[self.first + i];
        match station.joint.filter(|_| i == 0) {
            // The station's own rotation is that of the link above.
            Some(joint) => station.frame.transpose() * self.model.joints[joint].lower,
            None => station.pipe_to_station,
        }
    }

    /// Numbers per body.
    fn size(&self) -> usize {
        6 * (self.elements + 1)
    }

    /// A matrix over all nodes of a body, zero when it is asked for first.
    pub(crate) fn matrix<'m>(&self, part: &'m mut Option<DMatrix<f64>>) -> &'m mut DMatrix<f64> {
        part.get_or_insert_with(|| DMatrix::zeros(self.size(), self.size()))
    }

    /// A vector over all nodes of a body, likewise.
    pub(crate) fn vector<'v>(&self, part: &'v mut Option<DVector<f64>>) -> &'v mut DVector<f64> {
        part.get_or_insert_with(|| DVector::zeros(self.size()))
    }
}

/// What effects add to the beams of a part of the tool; none stands for zero.
#[derive(Default)]
pub(crate) struct Parts {
    /// Stiffness that stores but does not damp, of the guide (N/m and like).
    pub undamped: Option<DMatrix<f64>>,
    /// Constant forces on the guide with a potential (N, N m).
    pub forces: Option<DVector<f64>>,
    /// What both bodies have of each other: none of it, or all.
    pub coupled: Option<CoupledParts>,
}

/// Mass (kg) and viscous damping (N s/m) of both bodies: of the pipe, of the pipe by the guide, of the guide.
pub(crate) struct CoupledParts {
    pub mass: [DMatrix<f64>; 3],
    pub damping: [DMatrix<f64>; 3],
}

/// A node's first unknown (of the model), and the masses (kg, kg m2) of its six directions.
pub(crate) type NodeMasses = (usize, [f64; 6]);

/// How effects act on the chain that is built: `every_station` is a node where one acts at single stations in a way that does
/// not follow from the ends of a span, `at_nodes` gives what must be nodes, `stiffness` that with which they may push stations
/// back, the pipe from the guide and the guide from outside (N/m), and `linear` adds what they have along a part of the tool.
#[derive(Clone, Copy)]
pub(crate) struct Acting {
    pub every_station: bool,
    pub at_nodes: fn(&Model) -> Vec<NodeMasses>,
    pub stiffness: fn(&Model) -> [f64; 2],
    pub linear: fn(&Segment<'_>, &mut Parts),
}

impl Acting {
    /// What they have along `at`.
    pub(super) fn parts(&self, at: &Segment<'_>) -> Parts {
        let mut parts = Parts::default();
        (self.linear)(at, &mut parts);
        parts
    }
}
