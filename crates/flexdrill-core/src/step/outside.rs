//! The forces on the tool from outside at the end of the last step: with its inertia and damping they balance.
//!
//! A support's force is the residual of the unknown that it holds. The solver leaves a residual on the free unknowns too,
//! below its tolerance; [`OutsideForces::unbalance`] is the sum of those.

use nalgebra::Vector3;

use super::Stepper;
use crate::chain::Effect;
use crate::dynamics::energy::SpanForces;
use crate::model::HeldNode;
use crate::tool::Body;

/// Forces on both pipes together, along the axes of the world (N).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OutsideForces {
    /// Of all supports, and of the string above.
    pub supports: Vector3<f64>,
    /// Gravity.
    pub weight: Vector3<f64>,
    /// Of the wall on the guide: normal forces and friction, and what they and the supports have along the hole because the
    /// tool has moved along the arc, see [`Beam::geometric_along`](crate::elements::beam::Beam::geometric_along).
    pub wall: Vector3<f64>,
    /// Of the rock on the tool's lower end.
    pub end: Vector3<f64>,
    /// Of the point loads.
    pub loads: Vector3<f64>,
    /// Minus mass times acceleration.
    pub inertia: Vector3<f64>,
    /// Of the damping: the part that is proportional to the mass, since the other one acts between neighbours, and that
    /// of the mud in the hole.
    pub damping: Vector3<f64>,
}

impl OutsideForces {
    /// Sum of all: zero but for what the solver leaves.
    pub fn unbalance(&self) -> Vector3<f64> {
        self.supports + self.weight + self.wall + self.end + self.loads + self.inertia + self.damping
    }
}

impl Stepper {
    /// Force (N) and moment (N m) of a held node's support on the tool, along the axes of the world.
    pub fn reaction(&self, at: &HeldNode) -> [Vector3<f64>; 2] {
        let mut parts = [Vector3::zeros(); 2];
        for index in at.held.clone() {
            let direction = self.model.held[index] - at.node;
            parts[direction / 3] += at.frame.column(direction % 3) * self.track.carried.reactions[index];
        }
        parts
    }

    /// Force from above on the guide's first node (N), along the axes of the world; `None` where nothing there carries the tool.
    pub fn carried_from_above(&self) -> Option<Vector3<f64>> {
        Some(self.model.stations[0].frame.column(0) * self.carrier()?.force)
    }

    /// Torque on the top of the pipe (N m), positive where it drives.
    pub fn torque_at_kickoff(&self) -> f64 {
        self.load_above().map_or(self.drive_torque(), |above| above.torque)
    }

    /// Speed of the tool's top (rad/s).
    pub fn top_speed(&self) -> f64 {
        self.track.state.v[self.places().top_spin]
    }

    /// Rate at which the tool advances along the wall (m/s): the hoist's, or the one that is asked for.
    pub fn advance_of_frame(&self) -> f64 {
        let carrier = self.carrier();
        carrier.map_or(self.inputs.rate_of_penetration, |carrier| carrier.advance)
    }

    /// Depth of the bit below where it began (m), with a hoist: that of the frame and of the guide's end in it.
    pub fn bit_depth(&self) -> Option<f64> {
        let carrier = self.carrier()?;
        Some(carrier.depth + self.track.state.q[self.places().guide_end])
    }

    /// Axial force of the guide's support, or of the string, at the top (N), positive where it pushes the guide down the hole: what the weight
    /// on bit, the friction of the wall and the guide's weight come to there. `None` where the guide is not held.
    pub fn weight_at_kickoff(&self) -> Option<f64> {
        if let Some(carrier) = self.carrier() {
            return Some(carrier.force);
        }
        // What pulls the guide pushes the pipe by the same force, which both supports give back to the string.
        Some(self.held_at_guide_top()? + self.effects.pulls_guide(&self.track.carried))
    }

    /// Force of the support at the guide's top (N) along the hole, positive where it pushes the guide down; `None` where the
    /// guide is not held there.
    fn held_at_guide_top(&self) -> Option<f64> {
        let index = self.model.held.binary_search(&self.model.stations[0].guide).ok()?;
        Some(self.track.carried.reactions[index])
    }

    /// The weight (N) that the hoist is asked for where `set` is asked for; `None` where no hoist is fed by a weight.
    pub fn weight_of_hoist(&self, set: f64) -> Option<f64> {
        self.carrier()?.by_weight.then_some(set)
    }

    /// Share of an axial force that a rope which slides round the turns of the hole passes on, e^(-mu theta).
    pub fn arrives_round_the_arc(&self) -> f64 {
        libm::exp(-self.model.description.round_the_arc(&self.live))
    }

    /// Load on the hook (N): the weight of the string in mud and of all that hangs on its end, less what is slacked off.
    /// `None` without a string.
    pub fn hook_load(&self) -> Option<f64> {
        let above = self.load_above()?;
        // Where nothing carries the tool a support stands for the axial force on the guide.
        let held = match above.carrier {
            Some(_) => 0.0,
            None => self.held_at_guide_top().unwrap_or(0.0),
        };
        Some(above.hook_load - held - self.held_at_pipe_top())
    }

    /// Force of the support at the pipe's top (N) along the hole, positive where it pushes the pipe down: the string holds
    /// that support. 0 where nothing holds the pipe there.
    fn held_at_pipe_top(&self) -> f64 {
        let axis = self.model.stations[0].frame.column(0);
        let at_top = |at: &&HeldNode| at.station == 0 && at.body == Body::Pipe;
        let held = self.model.held_nodes.iter().filter(at_top);
        held.map(|at| self.reaction(at)[0].dot(&axis)).sum()
    }

    /// What the pins of a joint carry by effects, beyond the force between both links' ends (N, tension positive).
    pub fn on_pins(&self, joint: usize) -> f64 {
        self.effects.on_pins(joint, &self.track.carried)
    }

    /// Whether an effect bends the guide at rest.
    pub fn guide_is_bent(&self) -> bool {
        self.effects.bends_guide()
    }

    /// Whether an effect pushes the pipe together; `None` where none ever does.
    pub fn pipe_is_pushed(&self) -> Option<bool> {
        self.effects.pushes_pipe(&self.track.carried)
    }

    /// Sum of the forces of the tensions in the geometric stiffness (N, along the axes of the world). Tensions alone have none:
    /// this is how far the wall's forces turn as the tool moves along the hole.
    fn turned_with_the_tool(&self) -> Vector3<f64> {
        self.chain
            .turned_with_the_tool(&self.effects, &self.model, &self.track.state)
    }

    /// The sums of all forces on the tool from outside.
    pub fn outside_forces(&self) -> OutsideForces {
        let (model, energy) = (&self.model, &self.track.ledger);
        let bottom = &model.stations[model.last()];
        let mut wall = Vector3::zeros();
        self.effects.each_touched(Body::Guide, &mut |station, touched| {
            let [x, y, z, ..] = touched.force;
            wall += model.stations[station].frame * Vector3::new(x, y, z);
        });
        let loads = model.loads.iter().zip(&energy.loads).filter_map(|(load, value)| {
            let (node, _, frame) = model.node_of(load.unknown);
            let direction = load.unknown - node;
            (direction < 3).then(|| frame.column(direction) * *value)
        });
        let chain = &self.chain;
        let sum = |values: &[f64], spans: fn(&SpanForces) -> &[[f64; 16]; 2]| {
            chain.sum_in_world(model, values, energy.spans.iter().map(spans))
        };
        // What drags the guide against the wall is from outside; between pipe and guide it acts on both alike.
        let drag = if energy.drag.is_empty() {
            Vector3::zeros()
        } else {
            chain.sum_in_world(model, &energy.drag, std::iter::empty())
        };
        OutsideForces {
            supports: model
                .held_nodes
                .iter()
                .map(|at| self.reaction(at)[0])
                .sum::<Vector3<f64>>()
                + self.carried_from_above().unwrap_or_default(),
            weight: model.total_weight + self.effects.weight(),
            wall: wall - self.turned_with_the_tool(),
            end: bottom.frame.column(0) * -self.end_load().weight,
            loads: loads.sum(),
            inertia: -sum(&energy.inertia, |span| &span.inertia),
            damping: -sum(&energy.damping, |span| &span.damping) - drag,
        }
    }
}
