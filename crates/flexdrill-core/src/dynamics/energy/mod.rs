//! Energy audit of a step: work of every force by the trapezoid rule over the step, against the change of what is
//! stored.
//!
//! With F the sum of all forces, Newmark gives exactly dT = dq . (F_0 + F_1)/2 - D, where D is the scheme's own loss.
//! Linear elastic forces then store exactly what they take, so the audit's error is what is left: the quadrature of
//! contacts, stops and joint rows, and Newton's residual. See `docs/decisions/energy_audit.md`.

mod step;

use serde::{Deserialize, Serialize};

pub(crate) use step::{SpanWorks, StepEnds};

use crate::dynamics::conditions::Conditions;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::state::{Deflection, State, motion};
use crate::elements::string::StringLine;
use crate::model::Model;

/// Forces of a span on its ends, pipe and guide: six numbers of the top end, two zeros, six of the bottom end, two zeros.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct SpanForces {
    /// N G q with the axial force in use.
    pub(crate) geometric: [[f64; 16]; 2],
    /// C v.
    pub(crate) damping: [[f64; 16]; 2],
    /// M a.
    pub(crate) inertia: [[f64; 16]; 2],
}

/// What the joints of a chain carry.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct JointForces {
    /// Force of each span's pipe on its top end (N), along the axes of the link above.
    pub(crate) on_top: Vec<[f64; 3]>,
    /// Multipliers of the rotational rows of each joint (N m).
    pub(crate) multipliers: Vec<[f64; 2]>,
}

/// Forces and energies at one end of a step that the trapezoid rule needs at the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EnergyPoint {
    /// Friction of both layers on every unknown (N, N m).
    pub(crate) friction: Vec<f64>,
    /// Geometric-stiffness force N G q with the axial force in use.
    pub(crate) geometric: Vec<f64>,
    /// Rayleigh damping's force C v.
    pub(crate) damping: Vec<f64>,
    /// Inertia force M a (N, N m).
    pub(crate) inertia: Vec<f64>,
    /// Viscous damping of the mud on every unknown (N, N m); empty without mud.
    pub(crate) mud: Vec<f64>,
    /// Of a chain only.
    pub(crate) joints: JointForces,
    /// Geometric stiffness, damping and inertia of the spans of a chain; in the vectors above are then
    /// those of point masses only.
    pub(crate) spans: Vec<SpanForces>,
    /// How the contacts and the weight deflect each span of a chain: what the next step counts with.
    pub(crate) deflection: Vec<Deflection>,
    /// Value of each point load (N, N m).
    pub(crate) loads: Vec<f64>,
    /// Force of the support of each held unknown on the tool (N, N m), in the order of [`Model::held`].
    pub(crate) reactions: Vec<f64>,
    /// Kinetic, elastic, geometric, contact and stop energy (J).
    pub(crate) stored: f64,
    /// Part of `stored` that is kinetic.
    pub(crate) kinetic: f64,
    /// Part of `stored` in the geometric stiffness.
    pub(crate) geometric_energy: f64,
    /// Power of the geometric stiffness with the axial force in use, less that with the axial force of the
    /// displacements (W).
    pub(crate) foresight: f64,
    /// Power of contact, stop and play damping (W).
    pub(crate) contact_dissipation: f64,
    /// Power taken by the pins of each joint (W); of joints with friction only.
    pub(crate) joint_friction: Vec<f64>,
    /// Moments of the pins' friction on the six rotations of each joint (N m), which are in `friction` too.
    pub(crate) joint_moments: Vec<[f64; 6]>,
    /// Torque of the drive (N m).
    pub drive_torque: f64,
    bit_torque: f64,
    pub(crate) weight_on_bit: f64,
    /// Energy that the string has lost so far (J), to friction on the wall and inside.
    pub(crate) string_lost: f64,
    /// Work of the hoist so far (J).
    pub(crate) hoist_work: f64,
    /// Rate at which the frame advances with the tool below a hoist (m/s).
    pub(crate) advance: f64,
    /// Power of that advance in the weight on bit less that in the string's force (W): the string and the rock move in the
    /// frame of the hole, the tool in its own.
    pub(crate) advance_power: f64,
    /// Energy in the bristles of the contacts (J), which the friction has not taken yet.
    bristles: f64,
    /// Energy in the twist of a bit that sticks (J), which the rock has not taken yet.
    bit_elastic: f64,
    /// Power of the advance against the friction of the wall (W).
    feed: f64,
    /// Pressure in the pipe at the tool's top (Pa).
    pub(crate) pressure: f64,
    /// Shortening of the pipe's spans times the effective tension that they have without strain, per pressure at the top
    /// (N m/Pa); of spans that shorten only.
    pub(crate) lifted_by_pressure: f64,
}

impl EnergyPoint {
    /// Room for `model` in a numbering of so many unknowns; a chain has so many `spans`, all stations have none.
    pub fn new(model: &Model, unknowns: usize, spans: usize) -> Self {
        let rubbing_joints = if model.description.joint.friction.coefficient > 0.0 {
            model.joints.len()
        } else {
            0
        };
        Self {
            friction: vec![0.0; unknowns],
            geometric: vec![0.0; unknowns],
            damping: vec![0.0; unknowns],
            inertia: vec![0.0; unknowns],
            mud: vec![0.0; if model.description.mud.is_some() { unknowns } else { 0 }],
            joints: JointForces {
                on_top: vec![[0.0; 3]; spans],
                multipliers: vec![[0.0; 2]; if spans > 0 { model.joints.len() } else { 0 }],
            },
            spans: vec![SpanForces::default(); spans],
            deflection: vec![[[0.0; 16]; 2]; spans],
            loads: vec![0.0; model.loads.len()],
            reactions: vec![0.0; model.held.len()],
            stored: 0.0,
            kinetic: 0.0,
            geometric_energy: 0.0,
            foresight: 0.0,
            contact_dissipation: 0.0,
            joint_friction: vec![0.0; rubbing_joints],
            joint_moments: vec![[0.0; 6]; rubbing_joints],
            drive_torque: 0.0,
            bit_torque: 0.0,
            weight_on_bit: 0.0,
            string_lost: 0.0,
            hoist_work: 0.0,
            advance: 0.0,
            advance_power: 0.0,
            bristles: 0.0,
            bit_elastic: 0.0,
            feed: 0.0,
            pressure: 0.0,
            lifted_by_pressure: 0.0,
        }
    }

    /// Whether it is for the same model as `other`.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, other: &Self) -> bool {
        self.friction.len() == other.friction.len()
            && self.geometric.len() == other.geometric.len()
            && self.damping.len() == other.damping.len()
            && self.inertia.len() == other.inertia.len()
            && self.mud.len() == other.mud.len()
            && self.joints.on_top.len() == other.joints.on_top.len()
            && self.joints.multipliers.len() == other.joints.multipliers.len()
            && self.spans.len() == other.spans.len()
            && self.deflection.len() == other.deflection.len()
            && self.loads.len() == other.loads.len()
            && self.reactions.len() == other.reactions.len()
            && self.joint_friction.len() == other.joint_friction.len()
            && self.joint_moments.len() == other.joint_moments.len()
    }

    /// Takes another point's values without allocating.
    // Arrays first: slices of the same length are copied without allocating, which `clone` would.
    pub fn copy_from(&mut self, other: &Self) {
        self.friction.copy_from_slice(&other.friction);
        self.geometric.copy_from_slice(&other.geometric);
        self.damping.copy_from_slice(&other.damping);
        self.inertia.copy_from_slice(&other.inertia);
        self.mud.copy_from_slice(&other.mud);
        self.joints.on_top.copy_from_slice(&other.joints.on_top);
        self.joints.multipliers.copy_from_slice(&other.joints.multipliers);
        self.spans.copy_from_slice(&other.spans);
        self.deflection.copy_from_slice(&other.deflection);
        self.loads.copy_from_slice(&other.loads);
        self.reactions.copy_from_slice(&other.reactions);
        self.joint_friction.copy_from_slice(&other.joint_friction);
        self.joint_moments.copy_from_slice(&other.joint_moments);
        // By a pattern, because `*other` as a whole would take its arrays.
        let Self {
            stored,
            kinetic,
            geometric_energy,
            foresight,
            contact_dissipation,
            drive_torque,
            bit_torque,
            weight_on_bit,
            string_lost,
            hoist_work,
            advance,
            advance_power,
            bristles,
            bit_elastic,
            feed,
            pressure,
            lifted_by_pressure,
            ..
        } = *other;
        (self.string_lost, self.hoist_work) = (string_lost, hoist_work);
        (self.advance, self.advance_power) = (advance, advance_power);
        (self.bristles, self.bit_elastic, self.feed) = (bristles, bit_elastic, feed);
        (self.kinetic, self.foresight) = (kinetic, foresight);
        (self.stored, self.geometric_energy, self.contact_dissipation) =
            (stored, geometric_energy, contact_dissipation);
        (self.drive_torque, self.bit_torque, self.weight_on_bit) = (drive_torque, bit_torque, weight_on_bit);
        (self.pressure, self.lifted_by_pressure) = (pressure, lifted_by_pressure);
    }

    /// Adds what the string above stores, has lost, and has been given by the hoist.
    pub(crate) fn add_string(&mut self, string: &StringLine) {
        let [friction, mud] = string.lost();
        self.stored += string.stored();
        self.string_lost = friction + mud;
        self.hoist_work = string.hoist_work();
        if let Some(hoist) = string.hoist() {
            self.advance = hoist.advance;
            self.advance_power = (self.weight_on_bit - string.force_on_tool()) * hoist.advance;
        }
    }

    /// Adds kinetic energy, inertia and damping of point masses.
    pub(crate) fn add_masses(&mut self, numbered: &Numbered<'_>, state: &State, conditions: &Conditions) {
        let alpha = conditions.rayleigh.alpha;
        for (point, places) in numbered.model.masses.iter().zip(&numbered.places.masses) {
            let moving = motion(state, places);
            let moving = moving.as_node();
            self.kinetic += point.body.kinetic_energy(moving);
            let inertia = point.body.coupled_forces(moving, 0.0, [0.0; 3]);
            let damped = point.body.coupled_forces(moving, alpha, [0.0; 3]);
            for (k, mass) in point.body.diagonal().into_iter().enumerate() {
                let u = places[k];
                self.inertia[u] += mass * state.a[u] + inertia[k];
                self.damping[u] += alpha * mass * state.v[u] + (damped[k] - inertia[k]);
            }
        }
    }

    /// Adds joints, loads, drive and bit to what elements, masses and contacts have `stored` (J).
    pub(crate) fn finish(
        &mut self,
        mut stored: f64,
        numbered: &Numbered<'_>,
        conditions: &Conditions,
        interactions: &Interactions,
        residual: &[f64],
    ) {
        let Numbered { model, places, .. } = *numbered;
        // Stops and plays store elastic energy and dissipate as contacts do.
        for stop in interactions.joints.stops() {
            stored += stop.energy;
            self.contact_dissipation += stop.dissipation;
        }
        for play in interactions.joints.plays() {
            stored += play.energy;
            self.contact_dissipation += play.dissipation;
        }
        let of_joints = self
            .joint_friction
            .iter_mut()
            .zip(&mut self.joint_moments)
            .zip(&places.joints);
        // Each pin's friction acts on the rotations of both its links; its
        // moments are kept for the work of the joint alone.
        for (((power, kept), joint), (moments, taken)) in of_joints.zip(interactions.joints.frictions()) {
            (*power, *kept) = (taken, moments);
            let rotations = (joint.above..joint.above + 3).chain(joint.below..joint.below + 3);
            rotations
                .zip(moments)
                .for_each(|(place, moment)| self.friction[place] += moment);
        }
        // Loads depend on time only, and are evaluated at the time of this point.
        for (value, load) in self.loads.iter_mut().zip(&model.loads) {
            *value = load.load.history.at(conditions.time);
        }
        // At a support the residual is its reaction; a support inside a span has none here, see the chain's energy.
        for (reaction, held) in self.reactions.iter_mut().zip(&places.held) {
            *reaction = held.map_or(0.0, |held| residual[held]);
        }
        // Bristles of the contacts and of the bit are springs: what they hold is stored, not lost.
        self.bristles =
            interactions.inner.bristle_energy(&conditions.inner) + interactions.outer.bristle_energy(&conditions.outer);
        self.bit_elastic = interactions.bit.elastic;
        self.stored = stored + self.bristles + self.bit_elastic;
        // The wall moves past the guide by the advance. Without one the
        // sum must be exactly zero, and not a rounding of it.
        self.feed = if conditions.rate_of_penetration == 0.0 {
            0.0
        } else {
            let along = interactions.outer.iter().map(|(_, touch)| touch.axial);
            -conditions.rate_of_penetration * along.sum::<f64>()
        };
        // At the driven spin the residual is the drive's torque. A string computes its own.
        let at_the_tool = places.driven.map_or(0.0, |driven| residual[driven]);
        self.drive_torque = conditions.drive_torque.unwrap_or(at_the_tool);
        self.bit_torque = interactions.bit.torque;
        self.weight_on_bit = interactions.bit.weight;
        self.pressure = model.pressure_at_top(conditions.standpipe_pressure);
    }
}
