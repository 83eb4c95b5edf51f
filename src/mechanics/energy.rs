//! Energy audit of a step: work of every force by the trapezoid rule over the step, against the change of what is stored.
//!
//! With F the sum of all forces, Newmark gives exactly dT = dq . (F_0 + F_1)/2 - D, where D is the scheme's own loss. Linear elastic
//! forces then store exactly what they take, so the audit's error is what is left: the quadrature of contacts, stops and joint
//! rows, and Newton's residual. See `docs/decisions/energy_audit.md`.

use serde::{Deserialize, Serialize};

use super::assembly::{Assembler, inner_forces, outer_force};
use super::beam::ElementVector;
use super::conditions::Conditions;
use super::description::Direction;
use super::element_force::{ElementForce, Ends, plus};
use super::model::Model;
use super::outcome::EnergyAudit;
use super::state::{State, guide_element, joint_rotations, pipe_element};

/// Forces and energies at one end of a step that the trapezoid rule needs at the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EnergyPoint {
    /// Friction of both layers on every unknown (N, N m).
    friction: Vec<f64>,
    /// Geometric-stiffness force with the axial force in use, per element's unknowns, pipe then guide.
    geometric: Vec<ElementVector>,
    /// Point loads.
    loads: Vec<f64>,
    /// Kinetic, elastic, geometric, contact and stop energy (J).
    stored: f64,
    /// Part of `stored` in the geometric stiffness.
    geometric_energy: f64,
    /// Power of contact and stop damping (W).
    contact_dissipation: f64,
    /// Torque of the drive (N m).
    pub drive_torque: f64,
    bit_torque: f64,
    weight_on_bit: f64,
}

impl EnergyPoint {
    /// Room for `model`.
    pub fn new(model: &Model) -> Self {
        Self {
            friction: vec![0.0; model.unknowns()],
            geometric: vec![ElementVector::zeros(); model.pipe.len() + model.guide.len()],
            loads: vec![0.0; model.loads.len()],
            stored: 0.0,
            geometric_energy: 0.0,
            contact_dissipation: 0.0,
            drive_torque: 0.0,
            bit_torque: 0.0,
            weight_on_bit: 0.0,
        }
    }

    /// Whether it is for the same model as `other`.
    pub fn fits(&self, other: &Self) -> bool {
        self.friction.len() == other.friction.len()
            && self.geometric.len() == other.geometric.len()
            && self.loads.len() == other.loads.len()
    }

    /// Takes another point's values without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.friction.copy_from_slice(&other.friction);
        self.geometric.copy_from_slice(&other.geometric);
        self.loads.copy_from_slice(&other.loads);
        let Self {
            stored,
            geometric_energy,
            contact_dissipation,
            drive_torque,
            bit_torque,
            weight_on_bit,
            ..
        } = *other;
        (self.stored, self.geometric_energy, self.contact_dissipation) =
            (stored, geometric_energy, contact_dissipation);
        (self.drive_torque, self.bit_torque, self.weight_on_bit) = (drive_torque, bit_torque, weight_on_bit);
    }

    /// Evaluates at `state`, whose residual (reactions still in it) the assembler holds.
    pub fn evaluate(&mut self, model: &Model, state: &State, conditions: &Conditions, assembler: &Assembler) {
        let mut stored = 0.0;
        let mut geometric_energy = 0.0;
        let (pipes, guides) = self.geometric.split_at_mut(model.pipe.len());
        let mut add = |force: &ElementForce, q: &Ends, v: &Ends, tension: f64, out: &mut ElementVector| {
            let g = force.total(&[0.0; 12], &[0.0; 12], q, tension);
            geometric_energy += 0.5 * dot(q, &g);
            stored += 0.5 * (force.stiffness_between(q, q) + force.mass_between(v, v));
            out.data.0[0] = g;
        };
        for (e, element) in model.pipe.iter().enumerate() {
            let (q, v) = (pipe_element(model, e, &state.q), pipe_element(model, e, &state.v));
            add(&element.force, &q, &v, state.pipe_axial[e], &mut pipes[e]);
        }
        for (e, element) in model.guide.iter().enumerate() {
            let q = element.turn.to_chord(&guide_element(model, e, &state.q));
            let v = element.turn.to_chord(&guide_element(model, e, &state.v));
            add(&element.force, &q, &v, state.guide_axial[e], &mut guides[e]);
        }
        for point in &model.masses {
            let speed: f64 = (0..3).map(|k| state.v[point.unknown + k].powi(2)).sum();
            stored += 0.5 * point.mass * speed;
        }
        self.friction.fill(0.0);
        self.contact_dissipation = 0.0;
        for (s, station) in model.stations.iter().enumerate() {
            if let Some(touch) = &assembler.inner[s] {
                let (pipe, guide) = inner_forces(model, station, &touch.friction_force);
                for k in 0..6 {
                    self.friction[station.pipe_above + k] += pipe[k];
                    self.friction[station.guide + k] += guide[k];
                }
                stored += touch.energy;
                self.contact_dissipation += touch.dissipation;
            }
            if let Some(touch) = &assembler.outer[s] {
                let guide = outer_force(model, &touch.friction_force);
                (0..6).for_each(|k| self.friction[station.guide + k] += guide[k]);
                stored += touch.energy;
                self.contact_dissipation += touch.dissipation;
            }
        }
        for joint in &assembler.joints {
            stored += joint.stop.energy;
            self.contact_dissipation += joint.stop.dissipation;
        }
        for (value, load) in self.loads.iter_mut().zip(&model.loads) {
            *value = load.load.history.at(conditions.time);
        }
        self.stored = stored + geometric_energy;
        self.geometric_energy = geometric_energy;
        self.drive_torque = model.driven.map_or(0.0, |driven| assembler.residual[driven]);
        self.bit_torque = assembler.bit_torque;
        self.weight_on_bit = conditions.weight_on_bit;
    }
}

impl EnergyAudit {
    /// Adds the step of size `h` from `(s0, e0)` to `(s1, e1)`.
    pub fn add_step(
        &mut self,
        model: &Model,
        conditions: &Conditions,
        h: f64,
        (s0, e0): (&State, &EnergyPoint),
        (s1, e1): (&State, &EnergyPoint),
    ) {
        let moved = |unknown: usize| s1.q[unknown] - s0.q[unknown];
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        if let Some(driven) = model.driven {
            self.drive += mean(e0.drive_torque, e1.drive_torque) * moved(driven);
        }
        let bottom = &model.stations[model.last()];
        self.weight_on_bit -= mean(e0.weight_on_bit, e1.weight_on_bit) * moved(bottom.guide);
        self.bit += mean(e0.bit_torque, e1.bit_torque) * moved(bottom.pipe_above + Direction::Psi as usize);
        for (k, load) in model.loads.iter().enumerate() {
            self.loads += mean(e0.loads[k], e1.loads[k]) * moved(load.unknown);
        }
        for unknown in 0..s0.q.len() {
            self.friction -= mean(e0.friction[unknown], e1.friction[unknown]) * moved(unknown);
        }
        self.contact_damping += h * mean(e0.contact_dissipation, e1.contact_dissipation);

        let mut geometric_work = 0.0;
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        for (e, element) in model.pipe.iter().enumerate() {
            let at = |values: &[f64]| pipe_element(model, e, values);
            let dq = plus(&at(&s1.q), -1.0, &at(&s0.q));
            self.gravity += dot(&dq, &element.weight.data.0[0]);
            geometric_work += mean_work(&dq, &e0.geometric[e], &e1.geometric[e]);
            let rates = [at(&s0.v), at(&s1.v), at(&s0.a), at(&s1.a)];
            self.beam_losses(&element.force, &dq, &rates, alpha, beta);
        }
        for (e, element) in model.guide.iter().enumerate() {
            let at = |values: &[f64]| guide_element(model, e, values);
            let dq = plus(&at(&s1.q), -1.0, &at(&s0.q));
            self.gravity += dot(&dq, &element.weight.data.0[0]);
            let dq = element.turn.to_chord(&dq);
            let g = model.pipe.len() + e;
            geometric_work += mean_work(&dq, &e0.geometric[g], &e1.geometric[g]);
            let chord = |values: &[f64]| element.turn.to_chord(&at(values));
            let rates = [chord(&s0.v), chord(&s1.v), chord(&s0.a), chord(&s1.a)];
            self.beam_losses(&element.force, &dq, &rates, alpha, beta);
        }
        for point in &model.masses {
            for k in 0..3 {
                let u = point.unknown + k;
                let dq = moved(u);
                self.gravity += point.mass * point.gravity[k] * dq;
                self.rayleigh_damping += alpha * point.mass * dq * mean(s0.v[u], s1.v[u]);
                let kinetic = 0.5 * (s1.v[u].powi(2) - s0.v[u].powi(2));
                self.numerical_damping += point.mass * (dq * mean(s0.a[u], s1.a[u]) - kinetic);
            }
        }
        self.axial_update += (e1.geometric_energy - e0.geometric_energy) - geometric_work;
        self.stored += e1.stored - e0.stored;
        let worked_in = self.drive + self.weight_on_bit + self.gravity + self.loads + self.axial_update;
        let taken = self.bit + self.friction + self.contact_damping + self.rayleigh_damping + self.numerical_damping;
        self.error = worked_in - taken - self.stored;
    }

    /// Rayleigh damping and the scheme's own loss of one element that moves by `dq`; `v0`, `v1`, `a0`, `a1` are its rates at both ends
    /// of the step.
    fn beam_losses(&mut self, force: &ElementForce, dq: &Ends, [v0, v1, a0, a1]: &[Ends; 4], alpha: f64, beta: f64) {
        let v = mean(v0, v1);
        self.rayleigh_damping += alpha * force.mass_between(dq, &v) + beta * force.stiffness_between(dq, &v);
        // T_1 - T_0 = M (v_1 - v_0) . v.
        let kinetic = force.mass_between(&plus(v1, -1.0, v0), &v);
        self.numerical_damping += 0.5 * force.mass_between(dq, &plus(a0, 1.0, a1)) - kinetic;
    }
}

#[inline(always)]
fn dot(x: &Ends, y: &Ends) -> f64 {
    let mut sum = 0.0;
    for i in 0..12 {
        sum += x[i] * y[i];
    }
    sum
}

#[inline(always)]
fn mean(x: &Ends, y: &Ends) -> Ends {
    let mut sum = plus(x, 1.0, y);
    for x in &mut sum {
        *x *= 0.5;
    }
    sum
}

/// dq . (f0 + f1) / 2.
#[inline(always)]
fn mean_work(dq: &Ends, f0: &ElementVector, f1: &ElementVector) -> f64 {
    dot(dq, &mean(&f0.data.0[0], &f1.data.0[0]))
}

/// Largest violation of the joint rows: translations (m) and rotations (-).
pub fn joint_violation(model: &Model, state: &State) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for (j, joint) in model.joints.iter().enumerate() {
        let station = &model.stations[model.joint_stations[j]];
        let open = joint.upper * super::state::translation(&state.q, station.pipe_above)
            - joint.lower * super::state::translation(&state.q, station.pipe_below);
        worst.0 = worst.0.max(open.norm());
        let rows = joint.rows(&joint_rotations(model, j, &state.q));
        worst.1 = rows.iter().fold(worst.1, |w, row| w.max(row.value.abs()));
    }
    worst
}
