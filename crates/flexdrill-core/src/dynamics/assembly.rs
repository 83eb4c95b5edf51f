//! Residual and tangent of the whole tool, Eq. 35 and 40 to 42.
//!
//! The residual is internal + inertia + constraint forces - external forces, so Newton solves K_T dq = -R. Evaluating
//! the residual keeps the linearised joints and contacts; [`Assembler::tangent`] assembles from them.

use nalgebra::Vector2;

use crate::dynamics::conditions::Conditions;
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::state::{State, joint_rotations, node, translation};
use crate::elements::beam::ElementMatrix;
use crate::elements::element_form::{add, load};
use crate::elements::gap::{GapVector, Touch, regularised_sign};
use crate::elements::joint::{Joint, JointMatrix, JointVector, Row, Stop};
use crate::elements::joint_group::JointGroup;
use crate::linear::{BlockSystem, Changes, ContactBlock, Diagonal, Touching, add_columns};
use crate::model::{Model, Station};
use crate::simd::instructions::Instructions;
#[cfg(target_arch = "x86_64")]
use crate::simd::vector::{Avx2, Avx512};
use crate::simd::vector::{Portable, Vector};
use crate::tool::description::Direction;

/// Factors of the tangent k K + d C + m M: (1, gamma/(beta h), 1/(beta h^2)) in a Newmark step, Eq. 41; (0, 0, 1) to find
/// accelerations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentFactors {
    /// On stiffness-like terms.
    pub stiffness: f64,
    /// On damping-like terms (1/s).
    pub damping: f64,
    /// On the mass (1/s2).
    pub mass: f64,
}

/// A joint at the last residual.
#[derive(Debug, Clone, Copy, Default)]
pub struct JointReport {
    /// Gradients of the rotational rows in (psi_a, phi_ya, phi_za, psi_b, phi_yb, phi_zb).
    pub rows: [[f64; 6]; 2],
    /// Stop's moment (N m, >= 0).
    pub moment: f64,
    /// Energy in the stop's spring (J).
    pub energy: f64,
    /// Power taken by the stop's damping (W).
    pub dissipation: f64,
}

/// Residual, tangent and the linearised parts they are made of.
pub struct Assembler {
    /// Internal less external force per unknown.
    pub residual: Vec<f64>,
    /// Tangent.
    pub system: BlockSystem,
    /// Touching pipe-guide gaps, per station.
    pub inner: Vec<Option<Touch>>,
    /// Touching guide-wall gaps, per station.
    pub outer: Vec<Option<Touch>>,
    /// Joints.
    pub joints: Vec<JointReport>,
    /// Joints of one rotational row, eight at a time.
    groups: Vec<JointGroup>,
    /// Other joints, one at a time: rows and stops.
    singles: Vec<([Row; 2], Stop)>,
    /// Torque of the rock on the bit at the last residual (N m), against the rotation.
    pub bit_torque: f64,
    /// Times what is done here and in the steps around it.
    pub stopwatch: Stopwatch,
    /// d bit torque / d bit speed.
    bit_torque_slope: f64,
    /// Elastic, damping and inertia part of the tangent for `base_for`.
    base: BlockSystem,
    base_for: Option<(TangentFactors, f64, f64)>,
    /// Diagonal blocks of `base` with the geometric stiffness of the axial forces below and with supports: what `system` holds where
    /// no contact and no joint adds to it.
    still: Diagonal,
    still_for: Option<TangentFactors>,
    pipe_axial: Vec<f64>,
    guide_axial: Vec<f64>,
    /// Stations whose block in `system` differs from `still`.
    changed: Vec<bool>,
    instructions: Instructions,
    /// What contacts, joints and the bit add.
    pub changes: Changes,
}

impl Assembler {
    /// Room for `model`.
    pub fn new(model: &Model) -> Self {
        let system = BlockSystem::new(model.layout.clone());
        let q = JointVector::zeros();
        let kind = model.description.joint.kind;
        let (groups, singles) = if JointGroup::takes(kind) {
            (model.joints.chunks(8).map(JointGroup::of).collect(), Vec::new())
        } else {
            let single = |joint: &Joint| (joint.rows(&q), joint.stop(&q, &q));
            (Vec::new(), model.joints.iter().map(single).collect())
        };
        Self {
            residual: vec![0.0; model.unknowns()],
            base: system.clone(),
            base_for: None,
            still: system.diagonal.clone(),
            still_for: None,
            pipe_axial: vec![0.0; model.pipe.len()],
            guide_axial: vec![0.0; model.guide.len()],
            changed: vec![false; model.stations.len()],
            instructions: Instructions::of_this_machine(),
            changes: Changes::new(
                &model.layout,
                model.joints.len(),
                Joint::rotational_rows(model.description.joint.kind),
                model.held.iter().chain(&model.driven).copied(),
            ),
            system,
            inner: vec![None; model.stations.len()],
            outer: vec![None; model.stations.len()],
            joints: vec![JointReport::default(); model.joints.len()],
            groups,
            singles,
            bit_torque: 0.0,
            stopwatch: Stopwatch::default(),
            bit_torque_slope: 0.0,
        }
    }

    /// Evaluates the residual at `state`; entries of held, driven and padding unknowns are zero.
    pub fn residual(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        self.stopwatch.lap(Phase::Other);
        self.elements(model, state, conditions);
        for point in &model.masses {
            for k in 0..3 {
                let u = point.unknown + k;
                let acceleration = state.a[u] + conditions.rayleigh.alpha * state.v[u] - point.gravity[k];
                self.residual[u] += point.mass * acceleration;
            }
        }
        self.stopwatch.lap(Phase::Assembly);
        self.gaps(model, state, conditions);
        self.stopwatch.lap(Phase::Contact);
        self.joint_forces(model, state);
        let bottom = &model.stations[model.last()];
        if let Some(tie) = model.tie {
            let scale = model.force_scale;
            self.residual[bottom.pipe_above] += scale * state.q[tie];
            self.residual[bottom.guide] -= scale * state.q[tie];
            self.residual[tie] = scale * (state.q[bottom.pipe_above] - state.q[bottom.guide]);
        }
        self.residual[bottom.guide] += conditions.weight_on_bit;
        let spin = bottom.pipe_above + Direction::Psi as usize;
        let (sign, slope) = regularised_sign(state.v[spin], conditions.bit_slip_rate);
        self.bit_torque = conditions.bit_torque * sign;
        self.bit_torque_slope = conditions.bit_torque * slope;
        self.residual[spin] += self.bit_torque;
        for load in &model.loads {
            self.residual[load.unknown] -= load.load.history.at(conditions.time);
        }
    }

    /// Vector instructions in use.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }

    /// Sets the residual of unknowns without an equation to zero. Reactions are read before this.
    pub fn drop_reactions(&mut self, model: &Model) {
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.residual[unknown] = 0.0;
        }
    }

    /// Elastic, damping and inertia forces and those of the geometric stiffness, less gravity.
    fn elements(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        match self.instructions {
            Instructions::Portable => self.elements_with::<Portable>(model, state, conditions),
            // SAFETY: chosen only where the processor was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { self.elements_avx2(model, state, conditions) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { self.elements_avx512(model, state, conditions) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn elements_avx2(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        self.elements_with::<Avx2>(model, state, conditions);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn elements_avx512(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        self.elements_with::<Avx512>(model, state, conditions);
    }

    #[inline(always)]
    fn elements_with<V: Vector>(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        for (r, w) in self.residual.iter_mut().zip(&model.weight) {
            *r = -w;
        }
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let tensions = state.pipe_axial.iter().chain(&state.guide_axial);
        for (element, &tension) in model.elements.list.iter().zip(tensions) {
            let forms = &model.elements.kinds[element.kind as usize];
            let nodes = [element.nodes[0] as usize, element.nodes[1] as usize];
            let zero = V::splat(0.0);
            let (mut x, mut a, mut stretched) = ([zero; 2], [zero; 2], [zero; 2]);
            for n in 0..2 {
                let q: V = load(&state.q, nodes[n]);
                let v: V = load(&state.v, nodes[n]);
                x[n] = q.plus_product(beta, v);
                a[n] = load::<V>(&state.a, nodes[n]).plus_product(alpha, v);
                stretched[n] = q.times(V::splat(tension));
            }
            let mut force = forms.stiffness.product(forms.to_own(x));
            forms.mass.add_product(forms.to_own(a), &mut force);
            forms.geometric.add_product(forms.to_own(stretched), &mut force);
            let force = forms.from_own(force);
            add(&mut self.residual, nodes[0], force[0]);
            add(&mut self.residual, nodes[1], force[1]);
        }
    }

    #[inline]
    fn scatter(&mut self, first: usize, force: &[f64]) {
        for (r, f) in self.residual[first..first + 6].iter_mut().zip(force) {
            *r += f;
        }
    }

    fn gaps(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        for (s, station) in model.stations.iter().enumerate() {
            let lateral = inner_lateral(station, state);
            self.inner[s] = None;
            if lateral.norm_squared() > station.inner_clearance * station.inner_clearance {
                let velocity = inner_velocity(model, station, state);
                self.inner[s] = conditions.inner.touch(lateral, station.inner_clearance, &velocity);
            }
            let lateral = Vector2::new(state.q[station.guide + 1], state.q[station.guide + 2]);
            self.outer[s] = None;
            if lateral.norm_squared() > model.outer_clearance * model.outer_clearance {
                let velocity = outer_velocity(model, station, state);
                self.outer[s] = conditions.outer.touch(lateral, model.outer_clearance, &velocity);
            }
            if let Some(touch) = &self.inner[s] {
                let force = touch.force();
                let (on_pipe, on_guide) = inner_forces(model, station, &force);
                self.scatter(station.pipe_above, (-on_pipe).as_slice());
                self.scatter(station.guide, (-on_guide).as_slice());
            }
            if let Some(touch) = &self.outer[s] {
                let force = touch.force();
                self.scatter(station.guide, (-outer_force(model, &force)).as_slice());
            }
        }
    }

    fn joint_forces(&mut self, model: &Model, state: &State) {
        for (j, joint) in model.joints.iter().enumerate() {
            let station = &model.stations[model.joint_stations[j]];
            let (a, b, first) = (station.pipe_above, station.pipe_below, model.multipliers(j));
            let scale = model.force_scale;
            let lambda = translation(&state.q, first) * scale;
            let (on_a, on_b) = (joint.upper.tr_mul(&lambda), joint.lower.tr_mul(&lambda));
            let open = joint.upper * translation(&state.q, a) - joint.lower * translation(&state.q, b);
            for k in 0..3 {
                self.residual[a + k] += on_a[k];
                self.residual[b + k] -= on_b[k];
                self.residual[first + k] = scale * open[k];
            }
        }
        if self.groups.is_empty() {
            self.single_joints(model, state);
            return;
        }
        match self.instructions {
            Instructions::Portable => self.joint_groups::<Portable>(model, state),
            // SAFETY: chosen only where the processor was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { self.joint_groups_avx2(model, state) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { self.joint_groups_avx512(model, state) },
        }
    }

    /// Rotational rows and stops, a joint at a time.
    fn single_joints(&mut self, model: &Model, state: &State) {
        for (j, joint) in model.joints.iter().enumerate() {
            let station = &model.stations[model.joint_stations[j]];
            let (a, b, first) = (station.pipe_above, station.pipe_below, model.multipliers(j));
            let q = joint_rotations(model, j, &state.q);
            let rate = joint_rotations(model, j, &state.v);
            let rows = joint.rows(&q);
            let stop = joint.stop(&q, &rate);
            let mut moment = stop.force;
            for (r, row) in rows.iter().take(Joint::rotational_rows(joint.kind)).enumerate() {
                let multiplier = first + 3 + r;
                moment += row.gradient * (model.moment_scale * state.q[multiplier]);
                self.residual[multiplier] = model.moment_scale * row.value;
            }
            for k in 0..3 {
                self.residual[a + 3 + k] += moment[k];
                self.residual[b + 3 + k] += moment[3 + k];
            }
            self.joints[j] = JointReport {
                rows: [rows[0].gradient.into(), rows[1].gradient.into()],
                moment: stop.moment,
                energy: stop.energy,
                dissipation: stop.dissipation,
            };
            self.singles[j] = (rows, stop);
        }
    }

    /// Rotational rows and stops, eight joints at a time.
    #[inline(always)]
    fn joint_groups<V: Vector>(&mut self, model: &Model, state: &State) {
        for (g, group) in self.groups.iter_mut().enumerate() {
            let first = 8 * g;
            let count = (model.joints.len() - first).min(8);
            let (mut q, mut rate, mut lambda) = ([[0.0; 8]; 6], [[0.0; 8]; 6], [0.0; 8]);
            for lane in 0..8 {
                let j = first + lane.min(count - 1);
                let station = model.layout.offset(model.joint_stations[j]);
                for k in 0..3 {
                    q[k][lane] = state.q[station + 3 + k];
                    q[3 + k][lane] = state.q[station + 15 + k];
                    rate[k][lane] = state.v[station + 3 + k];
                    rate[3 + k][lane] = state.v[station + 15 + k];
                }
                lambda[lane] = model.moment_scale * state.q[station + 21];
            }
            let moments = group.evaluate::<V>(&q, &rate, &lambda);
            for lane in 0..count {
                let station = model.layout.offset(model.joint_stations[first + lane]);
                for k in 0..3 {
                    self.residual[station + 3 + k] += moments[k][lane];
                    self.residual[station + 15 + k] += moments[3 + k][lane];
                }
                self.residual[station + 21] = model.moment_scale * group.row[lane];
                let report = &mut self.joints[first + lane];
                for (to, from) in report.rows[0].iter_mut().zip(&group.gradient) {
                    *to = from[lane];
                }
                report.moment = group.moment[lane];
                report.energy = group.energy[lane];
                report.dissipation = group.dissipation[lane];
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn joint_groups_avx2(&mut self, model: &Model, state: &State) {
        self.joint_groups::<Avx2>(model, state);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn joint_groups_avx512(&mut self, model: &Model, state: &State) {
        self.joint_groups::<Avx512>(model, state);
    }

    /// Assembles the tangent from the parts linearised by the last [`Assembler::residual`] at `state`.
    pub fn tangent(&mut self, model: &Model, state: &State, conditions: &Conditions, factors: TangentFactors) {
        let key = (factors, conditions.rayleigh.alpha, conditions.rayleigh.beta);
        if self.base_for != Some(key) {
            self.build_base(model, conditions, factors);
            self.base_for = Some(key);
            self.still_for = None;
        }
        if self.still_for == Some(factors)
            && self.pipe_axial == state.pipe_axial
            && self.guide_axial == state.guide_axial
        {
            for (station, changed) in self.changed.iter_mut().enumerate() {
                if std::mem::take(changed) {
                    self.system.restore(station, &self.still);
                }
            }
        } else {
            self.build_still(model, state, factors.stiffness);
            self.still_for = Some(factors);
        }
        self.stopwatch.lap(Phase::Assembly);
        self.linearise(model, state, factors);
        self.changes.add_to(&mut self.system);
        for (s, station) in model.stations.iter().enumerate() {
            self.changed[s] = station.joint.is_some() || self.changes.touching[s] != Touching::Nothing;
        }
        for &unknown in model.held.iter().chain(&model.driven) {
            if self.changed[model.layout.station_of(unknown)] {
                self.system.hold(unknown);
            }
        }
    }

    /// The part of the tangent that lasts as long as step size and damping do: elastic, damping and inertia terms and the joints'
    /// translational rows, with supports. Geometric stiffness is left out.
    pub fn lasting(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) -> BlockSystem {
        self.base_for = None;
        self.build_base(model, conditions, factors);
        let mut system = self.base.clone();
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            system.hold(unknown);
        }
        system
    }

    /// What contacts, joints and the bit add to the tangent: fills [`Assembler::changes`] from the parts linearised by the last
    /// [`Assembler::residual`] at `state`.
    pub fn linearise(&mut self, model: &Model, state: &State, factors: TangentFactors) {
        self.gap_tangent(model, factors);
        self.stopwatch.lap(Phase::Contact);
        self.joint_tangent(model, state, factors);
        // The bit's node is the first of the last station's block.
        let (last, spin) = (model.last(), Direction::Psi as usize);
        if self.changes.touching[last] == Touching::Nothing {
            self.changes.contact[last] = [[0.0; 12]; 12];
        }
        self.changes.touching[last] = Touching::Both;
        self.changes.contact[last][spin][spin] += factors.damping * self.bit_torque_slope;
        self.changes.drop_held();
        self.stopwatch.lap(Phase::Assembly);
    }

    fn build_base(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) {
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        let elastic = factors.stiffness + factors.damping * beta;
        let inertial = factors.mass + factors.damping * alpha;
        self.base.clear();
        for (e, element) in model.pipe.iter().enumerate() {
            let m = element.beam.stiffness() * elastic + element.beam.mass() * inertial;
            add_pipe_element(&mut self.base, model, e, &m, 1.0);
        }
        for (e, element) in model.guide.iter().enumerate() {
            let m = element.stiffness * elastic + element.mass * inertial;
            add_guide_element(&mut self.base, e, &m, 1.0);
        }
        for point in &model.masses {
            let station = model.layout.station_of(point.unknown);
            let local = point.unknown - model.layout.offset(station);
            for k in 0..3 {
                self.base.add(station, local + k, local + k, point.mass * inertial);
            }
        }
        for (j, joint) in model.joints.iter().enumerate() {
            let station = model.joint_stations[j];
            let upper = joint.upper * model.force_scale;
            let lower = joint.lower * -model.force_scale;
            self.base.add_block(station, 18, 0, &upper);
            self.base.add_block(station, 18, 12, &lower);
            self.base.add_block(station, 0, 18, &upper.transpose());
            self.base.add_block(station, 12, 18, &lower.transpose());
        }
        if model.tied {
            let (last, scale) = (model.last(), model.force_scale);
            for (row, column, sign) in [(0, 18, 1.0), (6, 18, -1.0), (18, 0, 1.0), (18, 6, -1.0)] {
                self.base.add(last, row, column, sign * scale);
            }
        }
    }

    /// The part of the tangent that lasts while the axial forces do.
    fn build_still(&mut self, model: &Model, state: &State, factor: f64) {
        self.system.copy_from(&self.base);
        if factor != 0.0 {
            for (e, element) in model.pipe.iter().enumerate() {
                add_pipe_element(
                    &mut self.system,
                    model,
                    e,
                    &element.geometric,
                    factor * state.pipe_axial[e],
                );
            }
            for (e, element) in model.guide.iter().enumerate() {
                add_guide_element(&mut self.system, e, &element.geometric, factor * state.guide_axial[e]);
            }
        }
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.system.hold(unknown);
        }
        self.still.copy_from(&self.system.diagonal);
        self.pipe_axial.copy_from_slice(&state.pipe_axial);
        self.guide_axial.copy_from_slice(&state.guide_axial);
        self.changed.fill(false);
    }

    fn gap_tangent(&mut self, model: &Model, factors: TangentFactors) {
        for (s, station) in model.stations.iter().enumerate() {
            self.changes.touching[s] = match (&self.inner[s], &self.outer[s]) {
                (None, None) => Touching::Nothing,
                (None, Some(_)) => Touching::Guide,
                (Some(_), _) => Touching::Both,
            };
            if self.changes.touching[s] == Touching::Nothing {
                continue;
            }
            let block = &mut self.changes.contact[s];
            *block = [[0.0; 12]; 12];
            // A local force change of minus `on` times `by` . motion is one of the same form on the nodes.
            if let Some(touch) = &self.inner[s] {
                for term in touch.tangent(factors.stiffness, factors.damping) {
                    let (on, by) = (
                        inner_forces(model, station, &term.on),
                        inner_forces(model, station, &term.by),
                    );
                    add_product::<12>(block, 0, &joined(&on), &joined(&by));
                }
            }
            if let Some(touch) = &self.outer[s] {
                for term in touch.tangent(factors.stiffness, factors.damping) {
                    let (on, by) = (outer_force(model, &term.on), outer_force(model, &term.by));
                    add_product::<6>(block, 6, &on.data.0[0], &by.data.0[0]);
                }
            }
        }
    }

    fn joint_tangent(&mut self, model: &Model, state: &State, factors: TangentFactors) {
        for (change, report) in self.changes.joints.iter_mut().zip(&self.joints) {
            for (to, from) in change.rows.iter_mut().zip(&report.rows) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = from * model.moment_scale;
                }
            }
        }
        if self.groups.is_empty() {
            for (j, joint) in model.joints.iter().enumerate() {
                let first = model.multipliers(j);
                let (rows, stop) = &self.singles[j];
                let mut m: JointMatrix = stop.stiffness * factors.stiffness + stop.damping * factors.damping;
                for (r, row) in rows.iter().take(Joint::rotational_rows(joint.kind)).enumerate() {
                    m += row.hessian * (factors.stiffness * model.moment_scale * state.q[first + 3 + r]);
                }
                self.changes.joints[j].rotations = m.data.0;
            }
            return;
        }
        match self.instructions {
            Instructions::Portable => self.group_tangents::<Portable>(model, state, factors),
            // SAFETY: chosen only where the processor was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { self.group_tangents_avx2(model, state, factors) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { self.group_tangents_avx512(model, state, factors) },
        }
    }

    #[inline(always)]
    fn group_tangents<V: Vector>(&mut self, model: &Model, state: &State, factors: TangentFactors) {
        let mut tangent = [[[0.0; 8]; 6]; 6];
        for (g, group) in self.groups.iter().enumerate() {
            let first = 8 * g;
            let changes = &mut self.changes.joints[first..];
            let mut lambda = [0.0; 8];
            for (lambda, j) in lambda.iter_mut().zip(first..model.joints.len()) {
                *lambda = model.moment_scale * state.q[model.multipliers(j) + 3];
            }
            group.tangent::<V>(&lambda, factors.stiffness, factors.damping, &mut tangent);
            for (lane, change) in changes.iter_mut().enumerate().take(8) {
                for (to, from) in change.rotations.iter_mut().zip(&tangent) {
                    for (to, from) in to.iter_mut().zip(from) {
                        *to = from[lane];
                    }
                }
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn group_tangents_avx2(&mut self, model: &Model, state: &State, factors: TangentFactors) {
        self.group_tangents::<Avx2>(model, state, factors);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn group_tangents_avx512(&mut self, model: &Model, state: &State, factors: TangentFactors) {
        self.group_tangents::<Avx512>(model, state, factors);
    }
}

/// Lateral position (y, z) of the pipe relative to the guide, offset included (m).
#[inline]
pub fn inner_lateral(station: &Station, state: &State) -> Vector2<f64> {
    let pipe = station.pipe_to_station * translation(&state.q, station.pipe_above);
    station.offset + Vector2::new(pipe.y - state.q[station.guide + 1], pipe.z - state.q[station.guide + 2])
}

/// Local velocity of the inner gap.
#[inline]
fn inner_velocity(model: &Model, station: &Station, state: &State) -> GapVector {
    let pipe = node(&state.v, station.pipe_above);
    let guide = node(&state.v, station.guide);
    let mut local = GapVector::zeros();
    local
        .fixed_rows_mut::<3>(0)
        .copy_from(&(station.pipe_to_station * pipe.fixed_rows::<3>(0) - guide.fixed_rows::<3>(0)));
    local
        .fixed_rows_mut::<3>(3)
        .copy_from(&(pipe.fixed_rows::<3>(3) * station.pipe_radius - guide.fixed_rows::<3>(3) * model.guide_radii[0]));
    local
}

/// Local velocity of the outer gap.
#[inline]
fn outer_velocity(model: &Model, station: &Station, state: &State) -> GapVector {
    let mut local = node(&state.v, station.guide);
    local.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[1]);
    local
}

/// Forces on the pipe node and the guide node from the local force of the inner gap.
#[inline]
pub fn inner_forces(model: &Model, station: &Station, force: &GapVector) -> (GapVector, GapVector) {
    let mut pipe = *force;
    let turned = station.pipe_to_station.tr_mul(&force.fixed_rows::<3>(0));
    pipe.fixed_rows_mut::<3>(0).copy_from(&turned);
    pipe.fixed_rows_mut::<3>(3).scale_mut(station.pipe_radius);
    let mut guide = -force;
    guide.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[0]);
    (pipe, guide)
}

/// Force on the guide node from the local force of the outer gap.
#[inline]
pub fn outer_force(model: &Model, force: &GapVector) -> GapVector {
    let mut guide = *force;
    guide.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[1]);
    guide
}

/// Forces on pipe and guide in one.
#[inline(always)]
fn joined((pipe, guide): &(GapVector, GapVector)) -> [f64; 12] {
    let mut out = [0.0; 12];
    out[..6].copy_from_slice(pipe.as_slice());
    out[6..].copy_from_slice(guide.as_slice());
    out
}

/// Adds on by^T at (`first`, `first`) of a contact block.
#[inline(always)]
fn add_product<const N: usize>(block: &mut ContactBlock, first: usize, on: &[f64; N], by: &[f64; N]) {
    for (column, by) in block[first..].iter_mut().zip(by) {
        for (x, on) in column[first..].iter_mut().zip(on) {
            *x += on * by;
        }
    }
}

fn add_pipe_element(system: &mut BlockSystem, model: &Model, e: usize, m: &ElementMatrix, factor: f64) {
    let first = if model.stations[e].joint.is_some() { 12 } else { 0 };
    let m = &m.data.0;
    system.add_scaled(e, first, &part(m, 0, 0), factor);
    system.add_scaled(e + 1, 0, &part(m, 6, 6), factor);
    add_columns(&mut system.upper[e].pipe.data.0, 0, &part(m, 0, 6), factor);
    add_columns(&mut system.lower[e].pipe.data.0, 0, &part(m, 6, 0), factor);
}

fn add_guide_element(system: &mut BlockSystem, e: usize, m: &ElementMatrix, factor: f64) {
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
