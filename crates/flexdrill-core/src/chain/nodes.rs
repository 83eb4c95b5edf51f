//! Where the chain has its nodes: at every station that something is attached to, and between them where a span would
//! otherwise have too many elements, vibrate too slowly or be too compliant. Where an effect acts at single stations
//! in a way that does not follow from the ends of a span: at every station.

use super::linear::Acting;
use super::slaving::LinkMatrices;
use super::{LEAST_FREQUENCY, MOST_COMPLIANCE, MOST_STATIONS, NODE};
use crate::model::Model;

/// A node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Node {
    /// The station that it is at.
    pub station: usize,
    /// The joint there. Without one the pipe passes the node in one piece.
    pub joint: Option<usize>,
}

/// Where the pipe passes a node in one piece, makes the rotations below those above to the bit: no equation would correct
/// the rounding that adds up between them.
#[inline(always)]
pub(super) fn pass(values: &mut [f64; NODE], node: Node) {
    if node.joint.is_none() {
        values.copy_within(0..3, 6);
    }
}

/// The nodes, top to bottom, and the spans between them.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    pub list: Vec<Node>,
    /// Span and number in it of each station; that of a node belongs to the span above it, the first one to the first
    /// span.
    pub stations: Vec<(usize, usize)>,
    /// Node of each joint.
    pub of_joints: Vec<usize>,
}

impl Nodes {
    /// A node at every station.
    pub(super) fn at_every_station(model: &Model, acting: &Acting) -> (Self, Vec<LinkMatrices>) {
        let spans = (0..model.last())
            .map(|top| LinkMatrices::of(model, acting, top, 1))
            .collect();
        (Self::at(model, &(0..=model.last()).collect::<Vec<_>>()), spans)
    }

    /// The nodes that steps of size `h` (s) need, or all of them where an effect asks for that, with the matrices of the
    /// spans between them.
    pub(super) fn of(model: &Model, acting: &Acting, h: f64) -> (Self, Vec<LinkMatrices>) {
        let last = model.last();
        let mut attached = vec![acting.every_station; last + 1];
        (attached[0], attached[last]) = (true, true);
        for &station in &model.joint_stations {
            attached[station] = true;
        }
        // A guide that is fixed as a whole moves nowhere: its supports need no nodes.
        let held = model.held.iter().filter(|&&unknown| {
            let guide = model.stations[model.layout.station_of(unknown)].guide;
            !(model.description.guide_fixed && (guide..guide + 6).contains(&unknown))
        });
        let loads = model.loads.iter().map(|load| load.unknown);
        let acted_on = (acting.at_nodes)(model).into_iter().map(|(unknown, _)| unknown);
        for unknown in held.copied().chain(loads).chain(acted_on) {
            attached[model.layout.station_of(unknown)] = true;
        }
        let (mut ends, mut spans) = (vec![0], Vec::new());
        let mut top = 0;
        let bottoms = (1..).zip(&attached[1..]).filter(|(_, attached)| **attached);
        for (bottom, _) in bottoms {
            split(model, acting, h, [top, bottom], &mut ends, &mut spans);
            top = bottom;
        }
        (Self::at(model, &ends), spans)
    }

    /// The nodes at these stations.
    fn at(model: &Model, ends: &[usize]) -> Self {
        let list: Vec<Node> = ends
            .iter()
            .map(|&station| Node {
                station,
                joint: model.stations[station].joint,
            })
            .collect();
        let mut stations = vec![(0, 0)];
        for (span, ends) in ends.windows(2).enumerate() {
            stations.extend((1..=ends[1] - ends[0]).map(|i| (span, i)));
        }
        let of_joints = list.iter().enumerate().filter(|(_, node)| node.joint.is_some());
        Self {
            of_joints: of_joints.map(|(k, _)| k).collect(),
            list,
            stations,
        }
    }

    /// Station at the top of span `l`, or of node `l`.
    #[inline(always)]
    pub(super) fn first(&self, l: usize) -> usize {
        self.list[l].station
    }

    /// Elements of span `l`.
    #[inline(always)]
    pub(super) fn elements(&self, l: usize) -> usize {
        self.list[l + 1].station - self.list[l].station
    }
}

/// Appends the span between two stations, or its halves where the whole cannot be one.
fn split(
    model: &Model,
    acting: &Acting,
    h: f64,
    [top, bottom]: [usize; 2],
    ends: &mut Vec<usize>,
    spans: &mut Vec<LinkMatrices>,
) {
    let elements = bottom - top;
    let whole = (elements <= MOST_STATIONS).then(|| LinkMatrices::of(model, acting, top, elements));
    let pushed_back = (acting.stiffness)(model);
    let will_do =
        |span: &LinkMatrices| span.slowest * h >= LEAST_FREQUENCY && span.compliance(pushed_back) <= MOST_COMPLIANCE;
    match whole {
        Some(span) if elements == 1 || will_do(&span) => {
            ends.push(bottom);
            spans.push(span);
        }
        _ => {
            let middle = top + elements.div_ceil(2);
            split(model, acting, h, [top, middle], ends, spans);
            split(model, acting, h, [middle, bottom], ends, spans);
        }
    }
}
