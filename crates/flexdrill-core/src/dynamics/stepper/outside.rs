//! The forces on the tool from outside at the end of the last step: with its inertia and damping they balance.
//!
//! A support's force is the residual of the unknown that it holds. The solver leaves a residual on the free unknowns too,
//! below its tolerance; [`OutsideForces::unbalance`] is the sum of those.

use nalgebra::Vector3;

use super::Stepper;
use crate::model::HeldNode;

/// Forces on both pipes together, along the axes of the world (N).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OutsideForces {
    /// Of all supports.
    pub supports: Vector3<f64>,
    /// Gravity.
    pub weight: Vector3<f64>,
    /// Of the wall on the guide: normal forces and friction.
    pub wall: Vector3<f64>,
    /// Of the rock on the bit.
    pub bit: Vector3<f64>,
    /// Of the point loads.
    pub loads: Vector3<f64>,
    /// Minus mass times acceleration.
    pub inertia: Vector3<f64>,
    /// Of the damping: the part that is proportional to the mass, since the other one acts between neighbours.
    pub damping: Vector3<f64>,
}

impl OutsideForces {
    /// Sum of all: zero but for what the solver leaves.
    pub fn unbalance(&self) -> Vector3<f64> {
        self.supports + self.weight + self.wall + self.bit + self.loads + self.inertia + self.damping
    }
}

impl Stepper {
    /// Force (N) and moment (N m) of a held node's support on the tool, along the axes of the world.
    pub fn reaction(&self, at: &HeldNode) -> [Vector3<f64>; 2] {
        let mut parts = [Vector3::zeros(); 2];
        for index in at.held.clone() {
            let direction = self.model.held[index] - at.node;
            parts[direction / 3] += at.frame.column(direction % 3) * self.track.energy.reactions[index];
        }
        parts
    }

    /// The sums of all forces on the tool from outside.
    pub fn outside_forces(&self) -> OutsideForces {
        let (model, energy) = (&self.model, &self.track.energy);
        let bottom = &model.stations[model.last()];
        let wall = self.interactions.outer.iter().map(|(station, touch)| {
            let [x, y, z, ..] = touch.force();
            model.stations[station].frame * Vector3::new(x, y, z)
        });
        let loads = model.loads.iter().zip(&energy.loads).filter_map(|(load, value)| {
            let (node, _, frame) = model.node_of(load.unknown);
            let direction = load.unknown - node;
            (direction < 3).then(|| frame.column(direction) * *value)
        });
        let sum = |values: &[f64], spans: fn(&crate::dynamics::energy::SpanForces) -> &[[f64; 16]; 2]| match &self.chain
        {
            Some(chain) => chain.sum_in_world(model, values, energy.spans.iter().map(spans)),
            None => model.sum_in_world(values),
        };
        OutsideForces {
            supports: model.held_nodes.iter().map(|at| self.reaction(at)[0]).sum(),
            weight: model.total_weight,
            wall: wall.sum(),
            bit: bottom.frame.column(0) * -energy.weight_on_bit,
            loads: loads.sum(),
            inertia: -sum(&energy.inertia, |span| &span.inertia),
            damping: -sum(&energy.damping, |span| &span.damping),
        }
    }
}
