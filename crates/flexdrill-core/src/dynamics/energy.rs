//! Energy audit of a step: work of every force by the trapezoid rule over the step, against the change of what is
//! stored.
//!
//! With F the sum of all forces, Newmark gives exactly dT = dq . (F_0 + F_1)/2 - D, where D is the scheme's own loss.
//! Linear elastic forces then store exactly what they take, so the audit's error is what is left: the quadrature of
//! contacts, stops and joint rows, and Newton's residual. See `docs/decisions/energy_audit.md`.

use serde::{Deserialize, Serialize};

use crate::dynamics::conditions::Conditions;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::outcome::EnergyAudit;
#[cfg(test)]
use crate::dynamics::state::joint_rotations;
use crate::dynamics::state::{Deflection, State, motion};
use crate::dynamics::stations::{Assembler, inner_forces, outer_force};
use crate::elements::element_form::{add, load};
use crate::model::Model;
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};
use crate::tool::description::Direction;

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
    /// Power of contact and stop damping (W).
    pub(crate) contact_dissipation: f64,
    /// Torque of the drive (N m).
    pub drive_torque: f64,
    bit_torque: f64,
    pub(crate) weight_on_bit: f64,
}

impl EnergyPoint {
    /// Room for `model` in a numbering of so many unknowns; a chain has so many `spans`, all stations have none.
    pub fn new(model: &Model, unknowns: usize, spans: usize) -> Self {
        Self {
            friction: vec![0.0; unknowns],
            geometric: vec![0.0; unknowns],
            damping: vec![0.0; unknowns],
            inertia: vec![0.0; unknowns],
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
            drive_torque: 0.0,
            bit_torque: 0.0,
            weight_on_bit: 0.0,
        }
    }

    /// Whether it is for the same model as `other`.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, other: &Self) -> bool {
        self.friction.len() == other.friction.len()
            && self.geometric.len() == other.geometric.len()
            && self.damping.len() == other.damping.len()
            && self.inertia.len() == other.inertia.len()
            && self.joints.on_top.len() == other.joints.on_top.len()
            && self.joints.multipliers.len() == other.joints.multipliers.len()
            && self.spans.len() == other.spans.len()
            && self.deflection.len() == other.deflection.len()
            && self.loads.len() == other.loads.len()
            && self.reactions.len() == other.reactions.len()
    }

    /// Takes another point's values without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.friction.copy_from_slice(&other.friction);
        self.geometric.copy_from_slice(&other.geometric);
        self.damping.copy_from_slice(&other.damping);
        self.inertia.copy_from_slice(&other.inertia);
        self.joints.on_top.copy_from_slice(&other.joints.on_top);
        self.joints.multipliers.copy_from_slice(&other.joints.multipliers);
        self.spans.copy_from_slice(&other.spans);
        self.deflection.copy_from_slice(&other.deflection);
        self.loads.copy_from_slice(&other.loads);
        self.reactions.copy_from_slice(&other.reactions);
        let Self {
            stored,
            kinetic,
            geometric_energy,
            foresight,
            contact_dissipation,
            drive_torque,
            bit_torque,
            weight_on_bit,
            ..
        } = *other;
        (self.kinetic, self.foresight) = (kinetic, foresight);
        (self.stored, self.geometric_energy, self.contact_dissipation) =
            (stored, geometric_energy, contact_dissipation);
        (self.drive_torque, self.bit_torque, self.weight_on_bit) = (drive_torque, bit_torque, weight_on_bit);
    }

    /// Evaluates at `state`, whose residual (reactions still in it) the assembler holds.
    pub fn evaluate(
        &mut self,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        assembler: &Assembler,
        interactions: &Interactions,
    ) {
        let numbered = Numbered::of(model);
        let mut stored = assembler.instructions().run(ElementEnergies {
            point: self,
            model,
            state,
            conditions,
        });
        self.add_masses(&numbered, state, conditions);
        stored += self.kinetic;
        self.friction.fill(0.0);
        self.contact_dissipation = 0.0;
        for (s, touch) in interactions.inner.iter() {
            let station = &model.stations[s];
            let (pipe, guide) = inner_forces(model, station, &touch.friction_force().into());
            for k in 0..6 {
                self.friction[station.pipe_above + k] += pipe[k];
                self.friction[station.guide + k] += guide[k];
            }
            stored += touch.energy;
            self.contact_dissipation += touch.dissipation;
        }
        for (s, touch) in interactions.outer.iter() {
            let guide = outer_force(model, &touch.friction_force().into());
            let first = model.stations[s].guide;
            (0..6).for_each(|k| self.friction[first + k] += guide[k]);
            stored += touch.energy;
            self.contact_dissipation += touch.dissipation;
        }
        self.finish(stored, &numbered, conditions, interactions, &assembler.residual);
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
        for stop in interactions.joints.stops() {
            stored += stop.energy;
            self.contact_dissipation += stop.dissipation;
        }
        for (value, load) in self.loads.iter_mut().zip(&model.loads) {
            *value = load.load.history.at(conditions.time);
        }
        for (reaction, held) in self.reactions.iter_mut().zip(&places.held) {
            *reaction = held.map_or(0.0, |held| residual[held]);
        }
        self.stored = stored;
        self.drive_torque = places.driven.map_or(0.0, |driven| residual[driven]);
        self.bit_torque = interactions.bit.torque;
        self.weight_on_bit = conditions.weight_on_bit;
    }
}

/// One in the lane of a node's spin.
static SPIN: [f64; 8] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];

/// Forces of the elements and their kinetic energy into `point`. Gives the elastic and geometric energy (J).
struct ElementEnergies<'a> {
    point: &'a mut EnergyPoint,
    model: &'a Model,
    state: &'a State,
    conditions: &'a Conditions,
}

impl Kernel for ElementEnergies<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self {
            point,
            model,
            state,
            conditions,
        } = self;
        point.geometric.fill(0.0);
        point.damping.fill(0.0);
        point.inertia.fill(0.0);
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let zero = V::splat(0.0);
        let (mut elastic, mut geometric, mut kinetic, mut foreseen) = (zero, zero, zero, zero);
        let tensions = state.pipe_axial.iter().chain(&state.guide_axial);
        for (element, &tension) in model.elements.list.iter().zip(tensions) {
            let forms = &model.elements.kinds[element.kind as usize];
            let nodes = [element.nodes[0] as usize, element.nodes[1] as usize];
            let mut q = forms.to_element::<V>([load(&state.q, nodes[0]), load(&state.q, nodes[1])]);
            // Turning as a whole strains nothing; but hundreds of turns times the rounding of the forces would be as large
            // as what the steps make up.
            let spin = V::splat(-lane(q[0], Direction::Psi as usize));
            q = [
                q[0].plus_product(V::load(&SPIN), spin),
                q[1].plus_product(V::load(&SPIN), spin),
            ];
            let v = forms.to_element::<V>([load(&state.v, nodes[0]), load(&state.v, nodes[1])]);
            let a = forms.to_element::<V>([load(&state.a, nodes[0]), load(&state.a, nodes[1])]);
            let bent = forms.stiffness.product(q);
            let moving = forms.mass.product(v);
            let stiff = forms.stiffness.product(v);
            // Along its axis an element is a spring: its axial force is that on the lower node.
            let beyond = V::splat(tension - lane(bent[1], 0));
            let tension = V::splat(tension);
            let mut stretched = forms.geometric.product(q);
            let mut damped = [zero; 2];
            for n in 0..2 {
                foreseen = foreseen.minus_product(v[n], stretched[n].times(beyond));
                stretched[n] = stretched[n].times(tension);
                damped[n] = moving[n].times(alpha).plus_product(stiff[n], beta);
                elastic = elastic.plus_product(q[n], bent[n]);
                geometric = geometric.plus_product(q[n], stretched[n]);
                kinetic = kinetic.plus_product(v[n], moving[n]);
            }
            let inert = forms.to_nodes(forms.mass.product(a));
            let (stretched, damped) = (forms.to_nodes(stretched), forms.to_nodes(damped));
            for n in 0..2 {
                add(&mut point.geometric, nodes[n], stretched[n]);
                add(&mut point.damping, nodes[n], damped[n]);
                add(&mut point.inertia, nodes[n], inert[n]);
            }
        }
        point.kinetic = 0.5 * sum(kinetic);
        point.geometric_energy = 0.5 * sum(geometric);
        point.foresight = sum(foreseen);
        0.5 * sum(elastic) + point.geometric_energy
    }
}

/// Sum of the lanes that belong to a node.
#[inline(always)]
fn sum<V: Vector>(lanes: V) -> f64 {
    let mut out = [0.0; 8];
    lanes.store(&mut out);
    out[..6].iter().sum()
}

/// One lane.
#[inline(always)]
fn lane<V: Vector>(lanes: V, k: usize) -> f64 {
    let mut out = [0.0; 8];
    lanes.store(&mut out);
    out[k]
}

/// dq . (f0 + f1) / 2 for the forces of both ends of a step.
#[inline(always)]
fn mean_work(moved: &[f64], before: &[f64], after: &[f64]) -> f64 {
    // Eight sums, so that the compiler can use vectors.
    let mut sums = [0.0; 8];
    let (moved, before, after) = (moved.as_chunks::<8>(), before.as_chunks::<8>(), after.as_chunks::<8>());
    for ((dq, f0), f1) in moved.0.iter().zip(before.0).zip(after.0) {
        for k in 0..8 {
            sums[k] += dq[k] * (f0[k] + f1[k]);
        }
    }
    for ((dq, f0), f1) in moved.1.iter().zip(before.1).zip(after.1) {
        sums[0] += dq * (f0 + f1);
    }
    0.5 * sums.iter().sum::<f64>()
}

/// Work of some kinds of forces by the trapezoid rule (J).
struct MeanWorks<'a, const N: usize> {
    /// Displacements of the step.
    moved: &'a [f64],
    forces: [[&'a [f64]; 2]; N],
}

impl<const N: usize> Kernel for MeanWorks<'_, N> {
    type Output = [f64; N];

    #[inline(always)]
    fn run<V: Vector>(self) -> [f64; N] {
        let mut out = [0.0; N];
        for (work, [f0, f1]) in out.iter_mut().zip(self.forces) {
            *work = mean_work(self.moved, f0, f1);
        }
        out
    }
}

/// Work of a chain's spans by the trapezoid rule over a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SpanWorks {
    /// Of the damping (J).
    pub damping: f64,
    /// Of the inertia (J).
    pub inertia: f64,
    /// Of the geometric stiffness (J).
    pub geometric: f64,
}

/// Both ends of a step: its states with what was evaluated there.
pub(crate) struct StepEnds<'a> {
    /// Step size (s).
    pub h: f64,
    /// Displacements of the step, by unknown.
    pub moved: &'a [f64],
    /// Work of the spans; over all stations there are none.
    pub spans: SpanWorks,
    pub before: (&'a State, &'a EnergyPoint),
    pub after: (&'a State, &'a EnergyPoint),
}

impl EnergyAudit {
    /// Adds a step.
    pub(crate) fn add_step(&mut self, numbered: &Numbered<'_>, ends: &StepEnds<'_>, instructions: Instructions) {
        let Numbered { model, places, weight } = *numbered;
        let StepEnds {
            h,
            moved,
            spans,
            before: (s0, e0),
            after: (s1, e1),
        } = *ends;
        let [friction, gravity] = instructions.run(MeanWorks {
            moved,
            forces: [[&e0.friction, &e1.friction], [weight, weight]],
        });
        let SpanWorks {
            mut damping,
            mut inertia,
            geometric: mut geometric_work,
        } = spans;
        // Elements by stations, or point masses.
        if e0.spans.is_empty() || !model.masses.is_empty() {
            let nodal = instructions.run(MeanWorks {
                moved,
                forces: [
                    [&e0.damping, &e1.damping],
                    [&e0.inertia, &e1.inertia],
                    [&e0.geometric, &e1.geometric],
                ],
            });
            damping += nodal[0];
            inertia += nodal[1];
            geometric_work += nodal[2];
        }
        let (error_before, foresight_before) = (self.error, self.axial_foresight);
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        if let Some(driven) = places.driven {
            self.drive += mean(e0.drive_torque, e1.drive_torque) * moved[driven];
        }
        self.weight_on_bit -= mean(e0.weight_on_bit, e1.weight_on_bit) * moved[places.guide_end];
        self.bit += mean(e0.bit_torque, e1.bit_torque) * moved[places.bit_spin];
        for (k, &load) in places.loads.iter().enumerate() {
            self.loads += mean(e0.loads[k], e1.loads[k]) * moved[load];
        }
        self.friction -= friction;
        self.contact_damping += h * mean(e0.contact_dissipation, e1.contact_dissipation);
        self.gravity += gravity;
        for (point, places) in model.masses.iter().zip(&places.masses) {
            let (before, after) = (motion(s0, places), motion(s1, places));
            let (r0, r1) = (
                point.body.offset(before.as_node().q),
                point.body.offset(after.as_node().q),
            );
            let down = (0..3).map(|k| point.gravity[k] * (moved[places[k]] + (r1[k] - r0[k])));
            self.gravity += point.body.mass * down.sum::<f64>();
        }
        self.rayleigh_damping += damping;
        // The scheme's own loss: what inertia took less what became kinetic energy.
        self.numerical_damping += inertia - (e1.kinetic - e0.kinetic);
        self.axial_update += (e1.geometric_energy - e0.geometric_energy) - geometric_work;
        self.axial_foresight += h * mean(e0.foresight, e1.foresight);
        self.stored += e1.stored - e0.stored;
        let worked_in = self.drive + self.weight_on_bit + self.gravity + self.loads + self.axial_update;
        let taken = self.bit + self.friction + self.contact_damping + self.rayleigh_damping + self.numerical_damping;
        self.error = worked_in - taken - self.stored;
        let foresight = self.axial_foresight - foresight_before;
        self.against_laws += (self.error - error_before - foresight).abs();
    }
}

#[cfg(test)]
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
