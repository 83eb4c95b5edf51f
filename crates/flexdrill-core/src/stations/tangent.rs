//! The tangent K_T of Eq. 41: a part that lasts as long as the step size does, the geometric stiffness of the axial
//! forces, and what contacts, joints and the bit add in each iteration.

use super::assembler::Assembler;
use super::interactions::Interactions;
use super::linear::{BlockSystem, ContactBlock, add_columns};
use super::shortening::add_shortening_tangent;
use super::slots::add_slots_tangent;
use crate::chain::{Effect, Touching};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::numbered::along_the_hole;
use crate::dynamics::state::State;
use crate::effects::bodies::{self, Bodies};
use crate::elements::beam::ElementMatrix;
use crate::elements::factors::TangentFactors;
use crate::model::Model;

impl Assembler {
    /// Assembles the whole tangent, Eq. 41, from the parts linearised by the last [`Assembler::residual`] at `state`.
    pub fn tangent(
        &mut self,
        interactions: &Interactions,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) {
        self.build_step_constant(model, conditions, factors);
        self.system.copy_from(&self.step_constant);
        self.add_geometric_stiffness(model, state, factors.stiffness);
        if crate::effects::shortening::is_on(model) {
            add_shortening_tangent(&mut self.system, model, state, conditions, factors);
        }
        add_slots_tangent(&mut self.system, model, state, factors);
        self.linearise(interactions, model, state, conditions, factors);
        self.increment.add_to(&mut self.system);
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.system.hold(unknown);
        }
    }

    #[cfg(test)]
    /// The step-constant part of the tangent: elastic, damping and inertia terms and the joints' translational rows,
    /// with supports. It lasts as long as step size and damping do. Geometric stiffness is left out.
    pub fn step_constant(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) -> BlockSystem {
        self.build_step_constant(model, conditions, factors);
        let mut system = self.step_constant.clone();
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            system.hold(unknown);
        }
        system
    }

    /// What contacts, joints and the bit add to the tangent of Eq. 41: fills [`Assembler::increment`] from the parts
    /// linearised by the last [`Assembler::residual`] at `state`.
    pub fn linearise(
        &mut self,
        interactions: &Interactions,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) {
        self.contact_tangent(interactions, model, factors);
        self.joint_tangent(&interactions.joints, model, state, factors);
        let constants = self.constants.clone();
        let bit = self.bit.clone();
        // The nodes at both ends have no joint: pipe and guide are in the contact block.
        let mut add = |row: usize, column: usize, value: f64| {
            let station = model.layout.station_of(column);
            let first = model.layout.offset(station);
            self.contact_block(station)[column - first][row - first] += value;
        };
        bit.at_ends(factors, &mut add);
        constants.numbered(model).hanger_tangent(factors, add);
        for body in Bodies::at(model, Some).iter().flat_map(Bodies::coupled) {
            let factors = [factors.stiffness, factors.damping, factors.mass];
            let tangent = body.coupled_tangent(state, conditions.rayleigh.alpha, factors);
            self.add_body(model, body.places[0], &tangent);
        }
        self.increment.drop_held();
    }

    /// Adds the coupled part of a body on the node of `unknown`; its diagonal is in the step-constant part.
    fn add_body(&mut self, model: &Model, unknown: usize, tangent: &[[f64; 6]; 6]) {
        let station = model.layout.station_of(unknown);
        // The pipe's end above or the guide: both are in the contact block.
        let local = unknown - model.layout.offset(station);
        let block = self.contact_block(station);
        for (column, from) in block[local..].iter_mut().zip(tangent) {
            for (x, y) in column[local..].iter_mut().zip(from) {
                *x += y;
            }
        }
    }

    /// The contact block of a station, to be added to.
    fn contact_block(&mut self, station: usize) -> &mut ContactBlock {
        if self.increment.touching[station] == Touching::Nothing {
            self.increment.contact[station] = [[0.0; 12]; 12];
        }
        self.increment.touching[station] = Touching::Both;
        &mut self.increment.contact[station]
    }

    /// M, K and C (Eq. 7) of the K in Eq. 37, and the translational part of Phi_q, Eq. 16.
    fn build_step_constant(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) {
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        if self.step_constant_for == Some((factors, alpha, beta)) {
            return;
        }
        self.step_constant_for = Some((factors, alpha, beta));
        let elastic = factors.stiffness + factors.damping * beta;
        let inertial = factors.mass + factors.damping * alpha;
        self.step_constant.clear();
        for (e, element) in model.pipe.iter().enumerate() {
            let m = element.beam.stiffness() * elastic + element.beam.mass() * inertial;
            add_pipe_element(&mut self.step_constant, model, e, &m, 1.0);
        }
        for (e, element) in model.guide.iter().enumerate() {
            let mut m = element.stiffness * elastic + element.mass * inertial;
            if let Some(preload) = crate::effects::preload::of_element(model, e) {
                m += preload.stiffness * factors.stiffness;
            }
            add_guide_element(&mut self.step_constant, e, &m, 1.0);
        }
        for (unknown, masses) in bodies::at_nodes(model) {
            let station = model.layout.station_of(unknown);
            let local = unknown - model.layout.offset(station);
            for (k, inertia) in masses.into_iter().enumerate() {
                self.step_constant
                    .add(station, local + k, local + k, inertia * inertial);
            }
        }
        if let Some(mud) = crate::effects::mud::Mud::around(model) {
            for (s, (station, mud)) in model.stations.iter().zip(&mud.stations).enumerate() {
                let matrix = mud.mass.times(inertial).plus(mud.drag.times(factors.damping));
                let turn = &station.pipe_to_station;
                // Pipe node at 0, guide node at 6; across the hole are y and z of the station.
                for k in 1..3 {
                    for i in 0..3 {
                        for j in 0..3 {
                            let entry = turn[(k, i)] * turn[(k, j)] * matrix.pipe;
                            self.step_constant.add(s, i, j, entry);
                        }
                        let entry = turn[(k, i)] * matrix.coupling;
                        self.step_constant.add(s, i, 6 + k, entry);
                        self.step_constant.add(s, 6 + k, i, entry);
                    }
                    self.step_constant.add(s, 6 + k, 6 + k, matrix.guide);
                }
            }
        }
        for (j, joint) in model.joints.iter().enumerate() {
            let station = model.joint_stations[j];
            let upper = joint.upper * model.force_scale;
            let lower = joint.lower * -model.force_scale;
            self.step_constant.add_block(station, 18, 0, &upper);
            self.step_constant.add_block(station, 18, 12, &lower);
            self.step_constant.add_block(station, 0, 18, &upper.transpose());
            self.step_constant.add_block(station, 12, 18, &lower.transpose());
        }
        if model.tie.is_some() {
            let (last, scale) = (model.last(), model.force_scale);
            for (unknown, share) in along_the_hole(model.ends_along[1], 0, 6) {
                self.step_constant.add(last, unknown, 18, scale * share);
                self.step_constant.add(last, 18, unknown, scale * share);
            }
        }
    }

    /// Eq. 41's geometric part: N G of every element, with the axial forces of `state`, times `factor`.
    fn add_geometric_stiffness(&mut self, model: &Model, state: &State, factor: f64) {
        // With shortening the pipe's is in its tangent.
        let pipe = if crate::effects::shortening::is_on(model) {
            0
        } else {
            model.pipe.len()
        };
        for (e, element) in model.pipe[..pipe].iter().enumerate() {
            let tension = factor * state.pipe_axial[e];
            add_pipe_element(&mut self.system, model, e, &element.geometric, tension);
        }
        for (e, element) in model.guide.iter().enumerate() {
            add_guide_element(&mut self.system, e, &element.geometric, factor * state.guide_axial[e]);
        }
    }
}

pub(super) fn add_pipe_element(system: &mut BlockSystem, model: &Model, e: usize, m: &ElementMatrix, factor: f64) {
    let first = if model.stations[e].joint.is_some() { 12 } else { 0 };
    let m = &m.data.0;
    system.add_scaled(e, first, &part(m, 0, 0), factor);
    system.add_scaled(e + 1, 0, &part(m, 6, 6), factor);
    add_columns(&mut system.upper[e].pipe.data.0, 0, &part(m, 0, 6), factor);
    add_columns(&mut system.lower[e].pipe.data.0, 0, &part(m, 6, 0), factor);
}

pub(super) fn add_guide_element(system: &mut BlockSystem, e: usize, m: &ElementMatrix, factor: f64) {
    let m = &m.data.0;
    system.add_scaled(e, 6, &part(m, 0, 0), factor);
    system.add_scaled(e + 1, 6, &part(m, 6, 6), factor);
    add_columns(&mut system.upper[e].guide.data.0, 0, &part(m, 0, 6), factor);
    add_columns(&mut system.lower[e].guide.data.0, 0, &part(m, 6, 0), factor);
}

/// Six columns of six from (`row`, `column`).
#[inline(always)]
fn part(m: &[[f64; 12]; 12], row: usize, column: usize) -> [[f64; 6]; 6] {
    let mut out = [[0.0; 6]; 6];
    for (j, out) in out.iter_mut().enumerate() {
        out.copy_from_slice(&m[column + j][row..row + 6]);
    }
    out
}
