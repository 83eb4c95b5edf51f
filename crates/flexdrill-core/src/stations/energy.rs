//! Energies over all stations, and how far the joint rows are violated.

use super::Assembler;
use super::axial::{add, element_values};
use super::contacts::{add_mud_forces, inner_forces, mud_motions, outer_force};
use super::interactions::Interactions;
use super::slots::slots_energy;
use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::{State, joint_rotations};
use crate::effects::bodies::Bodies;
use crate::effects::contact::laws;
use crate::model::Model;

impl LedgerPoint {
    /// Forces and kinetic energy of the elements. Gives their elastic and geometric energy (J).
    fn add_elements(&mut self, assembler: &Assembler, model: &Model, state: &State, conditions: &Conditions) -> f64 {
        self.geometric.fill(0.0);
        self.damping.fill(0.0);
        self.inertia.fill(0.0);
        (self.has_nodes, self.sums.fallen) = (true, 0.0);
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        let (mut elastic, mut geometric, mut kinetic, mut foreseen) = (0.0, 0.0, 0.0, 0.0);
        let mut strained = state.clone();
        strained.axial_of_strain(model);
        strained.add_pressure(model, conditions);
        let in_use = state.pipe_axial.iter().chain(&state.guide_axial);
        let of_strain = strained.pipe_axial.iter().chain(&strained.guide_axial);
        // With shortening the pipe's axial force is that of its energy: nothing is foreseen, and N G q is no update.
        let later = if crate::effects::shortening::is_on(model) {
            model.pipe.len()
        } else {
            0
        };
        let elements = assembler.constants.elements.iter().zip(in_use.zip(of_strain));
        for (e, (element, (&tension, &strained))) in elements.enumerate() {
            let at = |values: &[f64]| element_values(values, element.nodes);
            let (mut q, v, a) = (at(&state.q), at(&state.v), at(&state.a));
            // Turning as a whole strains nothing; but hundreds of turns times the rounding of the forces would be as large
            // as what the steps make up.
            if e < model.pipe.len() {
                let spin = q[3];
                q[3] -= spin;
                q[9] -= spin;
            }
            let (tension, beyond) = if e < later {
                (0.0, 0.0)
            } else {
                (tension, tension - strained)
            };
            let (moving, slopes) = (element.mass * v, element.geometric * q);
            foreseen -= v.dot(&slopes) * beyond;
            elastic += q.dot(&(element.stiffness * q));
            geometric += q.dot(&slopes) * tension;
            kinetic += v.dot(&moving);
            add(&mut self.geometric, element.nodes, &(slopes * tension));
            add(
                &mut self.damping,
                element.nodes,
                &(moving * alpha + element.stiffness * v * beta),
            );
            add(&mut self.inertia, element.nodes, &(element.mass * a));
        }
        self.sums.kinetic = 0.5 * kinetic;
        self.sums.geometric_energy = 0.5 * geometric;
        self.sums.foresight = foreseen;
        0.5 * elastic + self.sums.geometric_energy
    }

    /// Evaluates at `state`, whose residual (reactions still in it) the assembler holds.
    pub fn evaluate(
        &mut self,
        carried: &mut Carried,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        assembler: &Assembler,
        interactions: &Interactions,
    ) {
        let numbered = assembler.constants.numbered(model);
        let mut stored = self.add_elements(assembler, model, state, conditions);
        for (preload, nodes) in super::constants::preloads(model) {
            stored += preload.energy(&element_values(&state.q, nodes));
        }
        if crate::effects::slots::is_on(model) {
            stored += slots_energy(model, state);
        }
        if crate::effects::shortening::is_on(model) {
            stored += self.add_shortening(model, state, conditions);
        }
        if let Some((pressure, _)) = &assembler.constants.pressure {
            carried.of_effects = [pressure.at_top(conditions.standpipe_pressure)];
        }
        self.add_mud(model, state, conditions);
        if let Some(bodies) = Bodies::at(model, Some) {
            bodies.add_to(self, state, conditions.rayleigh.alpha);
        }
        stored += self.sums.kinetic + numbered.hanger_energy(state);
        self.begin_touching();
        for (s, touch) in interactions.layers.inner.iter() {
            let station = &model.stations[s];
            let (pipe, guide) = inner_forces(model, station, &touch.friction_force().into());
            for k in 0..6 {
                self.friction[station.pipe_above + k] += pipe[k];
                self.friction[station.guide + k] += guide[k];
            }
            stored += touch.energy;
            self.sums.touch_dissipation += touch.dissipation;
        }
        for (s, touch) in interactions.layers.outer.iter() {
            let guide = outer_force(model, &touch.friction_force().into());
            let first = model.stations[s].guide;
            (0..6).for_each(|k| self.friction[first + k] += guide[k]);
            stored += touch.energy;
            self.sums.touch_dissipation += touch.dissipation;
        }
        let laws = laws(&model.description, conditions);
        interactions.layers.hold(&laws, conditions, self);
        self.finish(
            stored,
            &numbered,
            conditions,
            &interactions.joints,
            &assembler.residual,
            carried,
        );
    }

    /// Adds kinetic energy, inertia and damping of the mud at all stations, in the numbering of the model.
    fn add_mud(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        if self.drag.is_empty() {
            return;
        }
        let alpha = conditions.rayleigh.alpha;
        // The momentum first, from which the kinetic energy follows.
        self.drag.fill(0.0);
        model.add_mud_forces(&mut self.drag, |mud| mud.mass, |unknown| state.v[unknown]);
        self.sums.kinetic += 0.5 * self.drag.iter().zip(&state.v).map(|(p, v)| p * v).sum::<f64>();
        let damped = self.damping.iter_mut().zip(&self.drag);
        damped.for_each(|(force, momentum)| *force += alpha * momentum);
        model.add_mud_forces(&mut self.inertia, |mud| mud.mass, |unknown| state.a[unknown]);
        self.drag.fill(0.0);
        model.add_mud_forces(&mut self.drag, |mud| mud.drag, |unknown| state.v[unknown]);
        let near_wall = crate::effects::mud_wall::at_stations(model);
        for (station, near) in model.stations.iter().zip(near_wall) {
            let motions = mud_motions(model, station, state);
            let taken = [0, 1].map(|k| near[k].take(&motions[k]));
            self.sums.kinetic += taken[0].energy + taken[1].energy;
            add_mud_forces(&mut self.inertia, station, taken.map(|taken| taken.inertia));
            add_mud_forces(&mut self.drag, station, taken.map(|taken| taken.film));
        }
    }
}

/// Largest violation of the joint rows, Eq. 12 and 13: translations (m) and rotations (-).
pub fn joint_violation(model: &Model, state: &State) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for (j, joint) in model.joints.iter().enumerate() {
        let station = &model.stations[model.joint_stations[j]];
        let open = joint.upper * crate::dynamics::state::translation(&state.q, station.pipe_above)
            - joint.lower * crate::dynamics::state::translation(&state.q, station.pipe_below);
        worst.0 = worst.0.max(open.norm());
        let mut rows: [_; 2] = Default::default();
        joint.law.rows(&joint_rotations(model, j, &state.q), &mut rows);
        worst.1 = rows.iter().fold(worst.1, |w, row| w.max(row.value.abs()));
    }
    worst
}
