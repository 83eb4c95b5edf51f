//! The energy ledger of a step: work of every force by the trapezoid rule over the step, against the change of what is
//! stored.
//!
//! With F the sum of all forces, Newmark gives exactly dT = dq . (F_0 + F_1)/2 - D, where D is the scheme's own loss.
//! Linear elastic forces then store exactly what they take, so the ledger's error is what is left: the quadrature of
//! what touches, stops and joint rows, and Newton's residual. See `docs/decisions/energy_audit.md`.

mod step;

use serde::{Deserialize, Serialize};

pub(crate) use step::{SpanWorks, StepEnd, StepWork};

use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::joints::Joints;
use crate::dynamics::numbered::Numbered;
use crate::model::Model;

/// Places for numbers that the works of effects need of both ends of a step. The format of a checkpoint has so many.
pub(crate) const LEDGER_PLACES: usize = 6;

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

/// Energies and powers of the whole tool at one end of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// Kinetic, elastic and geometric energy, and that of springs that touch (J).
    pub(crate) stored: f64,
    /// Part of `stored` that is kinetic.
    pub(crate) kinetic: f64,
    /// Part of `stored` in the geometric stiffness.
    pub(crate) geometric_energy: f64,
    /// Power of the geometric stiffness with the axial force in use, less that with the axial force of the
    /// displacements (W).
    pub(crate) foresight: f64,
    /// Power of the damping of what touches: of effects at stations, stops and plays (W).
    pub(crate) touch_dissipation: f64,
    /// Force on the tool's lower end up the hole (N).
    pub(crate) pushed_up: f64,
    /// Rate at which the frame of the displacements advances with the tool (m/s).
    pub(crate) advance: f64,
    /// Energy that friction holds by an elastic slip (J), and has not taken yet.
    pub(crate) held: f64,
    /// Power of the advance against friction from outside (W).
    pub(crate) feed: f64,
    /// Work of the weight of what effects have at nodes, since the tool was undeflected (J).
    pub(crate) fallen: f64,
    /// What the works of effects need of this end of the step, each at its place.
    pub(crate) of_effects: [f64; LEDGER_PLACES],
}

/// Forces and energies at one end of a step that the ledger's trapezoid rule needs at the other. Nothing in the motion
/// reads them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LedgerPoint {
    /// Dry friction on every unknown (N, N m).
    pub(crate) friction: Vec<f64>,
    /// Geometric-stiffness force N G q with the axial force in use.
    pub(crate) geometric: Vec<f64>,
    /// Rayleigh damping's force C v.
    pub(crate) damping: Vec<f64>,
    /// Inertia force M a (N, N m).
    pub(crate) inertia: Vec<f64>,
    /// Viscous damping by effects on every unknown (N, N m); empty where none damps so.
    pub(crate) drag: Vec<f64>,
    /// Value of each point load (N, N m).
    pub(crate) loads: Vec<f64>,
    /// Geometric stiffness, damping and inertia of the spans of a chain; in the vectors above are then
    /// those at nodes only, where there are any.
    pub(crate) spans: Vec<SpanForces>,
    /// Moments of the pins' friction on the six rotations of each joint (N m), which are in `friction` too.
    pub(crate) pin_moments: Vec<[f64; 6]>,
    /// Whether damping and inertia have anything beyond the spans.
    pub(crate) has_nodes: bool,
    /// Energies and powers of the whole tool.
    pub(crate) sums: Sums,
}

impl LedgerPoint {
    /// Room for `model` in a numbering of so many unknowns; a chain has so many `spans`, all stations have none.
    /// `drags` where an effect damps by viscosity.
    pub fn new(model: &Model, unknowns: usize, spans: usize, drags: bool) -> Self {
        Self {
            friction: vec![0.0; unknowns],
            geometric: vec![0.0; unknowns],
            damping: vec![0.0; unknowns],
            inertia: vec![0.0; unknowns],
            drag: vec![0.0; if drags { unknowns } else { 0 }],
            loads: vec![0.0; model.loads.len()],
            spans: vec![SpanForces::default(); spans],
            pin_moments: vec![[0.0; 6]; model.joints_with_friction()],
            has_nodes: false,
            sums: Sums::default(),
        }
    }

    /// Lengths of its vectors.
    #[cfg(feature = "checkpoints")]
    fn lengths(&self) -> [usize; 8] {
        [
            self.friction.len(),
            self.geometric.len(),
            self.damping.len(),
            self.inertia.len(),
            self.drag.len(),
            self.loads.len(),
            self.spans.len(),
            self.pin_moments.len(),
        ]
    }

    /// Whether it is for the same model as `other`.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, other: &Self) -> bool {
        self.lengths() == other.lengths()
    }

    /// Takes another point's values without allocating: `clone_from` of a vector keeps its memory.
    pub fn copy_from(&mut self, other: &Self) {
        self.friction.clone_from(&other.friction);
        self.geometric.clone_from(&other.geometric);
        self.damping.clone_from(&other.damping);
        self.inertia.clone_from(&other.inertia);
        self.drag.clone_from(&other.drag);
        self.loads.clone_from(&other.loads);
        self.spans.clone_from(&other.spans);
        self.pin_moments.clone_from(&other.pin_moments);
        (self.has_nodes, self.sums) = (other.has_nodes, other.sums);
    }

    /// Nothing touches yet.
    pub(crate) fn begin_touching(&mut self) {
        self.friction.fill(0.0);
        (self.sums.touch_dissipation, self.sums.held, self.sums.feed) = (0.0, 0.0, 0.0);
    }

    /// Nothing acts at nodes yet.
    pub(crate) fn begin_nodes(&mut self) {
        self.sums.fallen = 0.0;
        self.has_nodes = false;
    }

    /// Damping and inertia at nodes, to be added to: zero when they are asked for first after [`LedgerPoint::begin_nodes`].
    pub(crate) fn at_nodes(&mut self) -> [&mut Vec<f64>; 2] {
        if !self.has_nodes {
            self.damping.fill(0.0);
            self.inertia.fill(0.0);
            self.has_nodes = true;
        }
        [&mut self.damping, &mut self.inertia]
    }

    /// Adds joints, loads and drive to what elements and effects have `stored` (J), and writes what supports,
    /// pins and drive carry.
    pub(crate) fn finish(
        &mut self,
        mut stored: f64,
        numbered: &Numbered<'_>,
        conditions: &Conditions,
        joints: &Joints,
        residual: &[f64],
        carried: &mut Carried,
    ) {
        let Numbered { model, places, .. } = *numbered;
        // Stops and plays store elastic energy and dissipate as all that touches.
        for stop in joints.stops() {
            stored += stop.energy;
            self.sums.touch_dissipation += stop.dissipation;
        }
        for play in joints.plays() {
            stored += play.energy;
            self.sums.touch_dissipation += play.dissipation;
        }
        let of_joints = carried
            .pin_power
            .iter_mut()
            .zip(&mut self.pin_moments)
            .zip(&places.joints);
        // Each pin's friction acts on the rotations of both its links; its
        // moments are kept for the work of the joint alone.
        for (((power, kept), joint), (moments, taken)) in of_joints.zip(joints.frictions()) {
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
        for (reaction, held) in carried.reactions.iter_mut().zip(&places.held) {
            *reaction = held.map_or(0.0, |held| residual[held]);
        }
        // What friction holds is stored, not lost.
        self.sums.stored = stored + self.sums.held;
        // At the driven spin the residual is the drive's torque. A string computes its own.
        let at_the_tool = places.driven.map_or(0.0, |driven| residual[driven]);
        carried.drive_torque = conditions.drive_torque.unwrap_or(at_the_tool);
    }
}
