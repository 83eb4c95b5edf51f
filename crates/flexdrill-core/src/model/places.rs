//! Where what acts on the tool acts, in a numbering of its unknowns: the model's own, or a reduced one.

use super::Model;
use crate::tool::Direction;

/// Unknowns of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointPlaces {
    /// First rotation of the end above.
    pub above: usize,
    /// First rotation of the start below.
    pub below: usize,
}

/// Unknowns that forces act on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    /// The driven spin.
    pub driven: Option<usize>,
    /// Spin of the pipe's first node.
    pub top_spin: usize,
    /// u of the guide's first node.
    pub guide_top: usize,
    /// u of the pipe's first node.
    pub pipe_top: usize,
    /// Spin of the pipe's last node, at the bit.
    pub end_spin: usize,
    /// u of the pipe's last node.
    pub pipe_end: usize,
    /// u of the guide's last node, which takes the weight on bit.
    pub guide_end: usize,
    /// Multiplier of the axial tie of both.
    pub tie: Option<usize>,
    /// Of every joint.
    pub joints: Vec<JointPlaces>,
    /// Of every load.
    pub loads: Vec<usize>,
    /// Of every unknown that a support holds, in the order of [`Model::held`]; `None` where the numbering has none for
    /// it.
    pub held: Vec<Option<usize>>,
}

impl Places {
    /// In the model's numbering.
    pub fn of(model: &Model) -> Self {
        let bottom = &model.stations[model.last()];
        Self {
            driven: model.driven,
            top_spin: model.stations[0].pipe_above + Direction::Psi as usize,
            guide_top: model.stations[0].guide,
            pipe_top: model.stations[0].pipe_above,
            end_spin: bottom.pipe_above + Direction::Psi as usize,
            pipe_end: bottom.pipe_above,
            guide_end: bottom.guide,
            tie: model.tie,
            joints: (0..model.joints.len())
                .map(|joint| {
                    let station = &model.stations[model.joint_stations[joint]];
                    JointPlaces {
                        above: station.pipe_above + 3,
                        below: station.pipe_below + 3,
                    }
                })
                .collect(),
            loads: model.loads.iter().map(|load| load.unknown).collect(),
            held: model.held.iter().copied().map(Some).collect(),
        }
    }

    /// In another numbering, by the `place` of every unknown; of a `held` one it may have none.
    pub fn renumbered(&self, place: impl Fn(usize) -> usize, held: impl Fn(usize) -> Option<usize>) -> Self {
        Self {
            driven: self.driven.map(&place),
            top_spin: place(self.top_spin),
            guide_top: place(self.guide_top),
            pipe_top: place(self.pipe_top),
            end_spin: place(self.end_spin),
            pipe_end: place(self.pipe_end),
            guide_end: place(self.guide_end),
            tie: self.tie.map(&place),
            joints: self
                .joints
                .iter()
                .map(|joint| JointPlaces {
                    above: place(joint.above),
                    below: place(joint.below),
                })
                .collect(),
            loads: self.loads.iter().map(|&load| place(load)).collect(),
            held: self.held.iter().map(|at| at.and_then(&held)).collect(),
        }
    }
}
