//! What changes while the tool moves: displacements, velocities, accelerations, multipliers.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use crate::elements::element_force::{Ends, ends, plus};
use crate::elements::joint::JointVector;
use crate::model::Model;

/// A node's six values.
pub type NodeVector = SVector<f64, 6>;

/// State at one instant, in the model's numbering. Multiplier slots of `q` hold scaled multipliers; their velocity and acceleration
/// are zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Displacements, spins, tilts, multipliers.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
    /// Accelerations that the time scheme lets lag behind `a`, see [`Scheme`](crate::dynamics::scheme::Scheme).
    pub lagged: Vec<f64>,
    /// Step size (s) that `lagged` is for; 0 before the first step.
    pub scheme_step: f64,
    /// Axial force of each pipe element as foreseen for the last step (N): the N of the geometric stiffness.
    pub pipe_axial: Vec<f64>,
    /// The same for the guide.
    pub guide_axial: Vec<f64>,
    /// Model time (s).
    pub time: f64,
    /// Angle of the drive (rad) as prescribed at this time.
    pub drive_angle: f64,
}

impl State {
    /// At rest and undeflected.
    pub fn at_rest(model: &Model) -> Self {
        let n = model.unknowns();
        Self {
            q: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            lagged: vec![0.0; n],
            scheme_step: 0.0,
            pipe_axial: vec![0.0; model.pipe.len()],
            guide_axial: vec![0.0; model.guide.len()],
            time: 0.0,
            drive_angle: 0.0,
        }
    }

    /// Takes another state's values without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.lagged.copy_from_slice(&other.lagged);
        self.scheme_step = other.scheme_step;
        self.pipe_axial.copy_from_slice(&other.pipe_axial);
        self.guide_axial.copy_from_slice(&other.guide_axial);
        self.time = other.time;
        self.drive_angle = other.drive_angle;
    }

    /// Sets the axial forces for a step of size `h` to those that the velocities of `from` lead to at its end. Forces of the step before
    /// would make the step one of first order.
    pub fn predict_axial(&mut self, model: &Model, from: &Self, h: f64) {
        let ahead = |q: &Ends, v: &Ends| plus(q, h, v);
        for (e, element) in model.pipe.iter().enumerate() {
            let q = ahead(&pipe_element(model, e, &from.q), &pipe_element(model, e, &from.v));
            self.pipe_axial[e] = element.force.tension(&q);
        }
        for (e, element) in model.guide.iter().enumerate() {
            let q = ahead(&guide_element(model, e, &from.q), &guide_element(model, e, &from.v));
            self.guide_axial[e] = element.force.tension(&element.turn.to_chord(&q));
        }
    }

    /// Sets the lagged axial forces from the displacements.
    pub fn update_axial(&mut self, model: &Model) {
        for (e, element) in model.pipe.iter().enumerate() {
            self.pipe_axial[e] = element.force.tension(&pipe_element(model, e, &self.q));
        }
        for (e, element) in model.guide.iter().enumerate() {
            let q = element.turn.to_chord(&guide_element(model, e, &self.q));
            self.guide_axial[e] = element.force.tension(&q);
        }
    }
}

/// The six values of the node that begins at `first`.
#[inline]
pub fn node(values: &[f64], first: usize) -> NodeVector {
    NodeVector::from_column_slice(&values[first..first + 6])
}

/// Displacement of a node.
#[inline]
pub fn translation(values: &[f64], first: usize) -> Vector3<f64> {
    Vector3::new(values[first], values[first + 1], values[first + 2])
}

/// Nodal values of pipe element `e`.
#[inline]
pub fn pipe_element(model: &Model, e: usize, values: &[f64]) -> Ends {
    ends(values, model.stations[e].pipe_below, model.stations[e + 1].pipe_above)
}

/// Nodal values of guide element `e`, in the nodes' frames.
#[inline]
pub fn guide_element(model: &Model, e: usize, values: &[f64]) -> Ends {
    ends(values, model.stations[e].guide, model.stations[e + 1].guide)
}

/// The six rotational values of joint `joint`.
#[inline]
pub fn joint_rotations(model: &Model, joint: usize, values: &[f64]) -> JointVector {
    let station = &model.stations[model.joint_stations[joint]];
    let mut x = JointVector::zeros();
    x.as_mut_slice()[..3].copy_from_slice(&values[station.pipe_above + 3..station.pipe_above + 6]);
    x.as_mut_slice()[3..].copy_from_slice(&values[station.pipe_below + 3..station.pipe_below + 6]);
    x
}
