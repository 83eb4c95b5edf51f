//! The axial forces of the elements, and what a node's and an element's unknowns are.

use nalgebra::SVector;

use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::effects::pressure::PipePressure;
use crate::elements::beam::ElementVector;
use crate::model::Model;

/// A node's six values.
pub type NodeVector = SVector<f64, 6>;

impl State {
    /// The axial forces of pipe and guide that the velocities lead to `h` (s) from here. With the present forces instead
    /// a step would be of first order.
    pub(crate) fn foresee_axial(&self, model: &Model, h: f64, [pipe, guide]: &mut [Vec<f64>; 2]) {
        let q = |unknown: usize| self.q[unknown] + h * self.v[unknown];
        set_axial(model, [pipe, guide], q);
    }

    /// Sets the axial forces to those of the displacements but for a part of the difference to those that are `foreseen`
    /// for pipe and guide.
    pub(crate) fn blend_axial(&mut self, model: &Model, part: f64, foreseen: &[Vec<f64>; 2], conditions: &Conditions) {
        self.axial_of_strain(model);
        // With shortening the pipe's force is in the tangent, and is not foreseen.
        let pipe = if crate::effects::shortening::is_on(model) {
            0
        } else {
            self.pipe_axial.len()
        };
        let forces = self.pipe_axial[..pipe].iter_mut().chain(&mut self.guide_axial);
        for (force, foreseen) in forces.zip(foreseen[0][..pipe].iter().chain(&foreseen[1])) {
            *force += part * (foreseen - *force);
        }
        self.add_pressure(model, conditions);
    }

    /// Makes the axial forces of the pipe effective tensions.
    pub(super) fn add_pressure(&mut self, model: &Model, conditions: &Conditions) {
        if let Some(pressure) = PipePressure::around(model) {
            let at_top = pressure.at_top(conditions.standpipe_pressure);
            for (force, unstrained) in self.pipe_axial.iter_mut().zip(&pressure.unstrained) {
                *force += at_top * unstrained;
            }
        }
    }

    /// Sets the axial forces to those of the strains.
    pub(super) fn axial_of_strain(&mut self, model: &Model) {
        let Self {
            q,
            pipe_axial,
            guide_axial,
            ..
        } = self;
        set_axial(model, [pipe_axial, guide_axial], |unknown| q[unknown]);
    }
}

/// Sets the axial forces of `pipe` and `guide` to those of the displacements `q`, by unknown.
fn set_axial(model: &Model, [pipe, guide]: [&mut [f64]; 2], q: impl Fn(usize) -> f64) {
    let ends = model.stations.windows(2);
    for ((tension, element), ends) in pipe.iter_mut().zip(&model.pipe).zip(ends.clone()) {
        let shorter = if crate::effects::shortening::is_on(model) {
            let at = |k: usize| {
                if k < 6 {
                    q(ends[0].pipe_below + k)
                } else {
                    q(ends[1].pipe_above + k - 6)
                }
            };
            let ends = ElementVector::from_fn(|k, _| at(k));
            0.5 * ends.dot(&(element.geometric * ends))
        } else {
            0.0
        };
        *tension = element
            .beam
            .tension(q(ends[1].pipe_above) - q(ends[0].pipe_below) + shorter);
    }
    for ((tension, element), ends) in guide.iter_mut().zip(&model.guide).zip(ends) {
        *tension = element.tension(|k| q(ends[k / 6].guide + k % 6));
    }
}

/// The six values of the node that begins at `first`.
#[inline]
pub fn node(values: &[f64], first: usize) -> NodeVector {
    NodeVector::from_column_slice(&values[first..first + 6])
}

/// The values of an element's two nodes, which begin at `nodes`.
pub fn element_values(values: &[f64], nodes: [usize; 2]) -> ElementVector {
    ElementVector::from_fn(|k, _| values[nodes[k / 6] + k % 6])
}

/// Adds forces on the two nodes of an element, which begin at `nodes`.
pub fn add(forces: &mut [f64], nodes: [usize; 2], force: &ElementVector) {
    for (k, x) in force.iter().enumerate() {
        forces[nodes[k / 6] + k % 6] += x;
    }
}
