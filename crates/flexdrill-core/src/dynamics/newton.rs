//! Newton-Raphson on displacements and multipliers together, Eq. 40 to 44, for one (sub-)step.

use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::outcome::{FailureCause, StepFailure};
use crate::dynamics::phases::Phase;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::elements::joint::rotation::LARGEST_TILT;
use crate::linear::{CondensedElimination, CondensedSystem, LinearSolver};
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::Body;

/// When an iterate is accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Largest unbalanced force on a node (N).
    pub force: f64,
    /// Largest unbalanced moment on a node (N m).
    pub moment: f64,
    /// Largest opening of a joint (m) and largest value of a rotational row (-).
    pub constraint: f64,
    /// Corrections after which a sub-step counts as not converged.
    pub max_iterations: u32,
}

impl Default for Tolerances {
    /// 10 mN and 1 mN m: a millionth of a weight on bit of 10 kN and a hundred-thousandth of its torque, three orders
    /// below what the step itself leaves, five above the rounding of the stiffest element. Rows to 1e-10 m, a tenth of
    /// what is promised.
    fn default() -> Self {
        Self {
            force: 1e-2,
            moment: 1e-3,
            constraint: 1e-10,
            max_iterations: 15,
        }
    }
}

/// Displacements (m) beyond which something has come apart: far outside any bore.
const LARGEST_DISPLACEMENT: f64 = 1.0;

/// Newton's iteration and the room it needs.
pub struct Newton {
    /// Residual and tangent.
    pub assembler: Assembler,
    /// Solves with the whole tangent: static start, and tools that cannot be condensed.
    pub solver: Box<dyn LinearSolver>,
    /// When an iterate is accepted.
    pub tolerances: Tolerances,
    /// Solves with the condensed tangent: steps in motion.
    condensed: Option<CondensedTangents>,
    correction: Vec<f64>,
    /// One over the limit on the residual, per unknown; zero where there is no equation.
    weights: Vec<f64>,
    multiplier: Vec<bool>,
    /// 0 for multipliers, else 1.
    moving: Vec<f64>,
}

/// The condensed step-constant tangents, one per step size, and what solves with them. Geometric stiffness is left out,
/// so that but for contacts and joints a tangent stays the same in motion.
struct CondensedTangents {
    elimination: CondensedElimination,
    systems: Vec<(Key, CondensedSystem)>,
}

/// What the step-constant tangent depends on: factors, alpha, beta.
type Key = (TangentFactors, f64, f64);

fn key(factors: TangentFactors, conditions: &Conditions) -> Key {
    (factors, conditions.rayleigh.alpha, conditions.rayleigh.beta)
}

impl Newton {
    /// Room for `model`.
    pub fn new(
        model: &Model,
        solver: Box<dyn LinearSolver>,
        tolerances: Tolerances,
        instructions: Instructions,
    ) -> Self {
        let n = model.unknowns();
        let mut limits = vec![0.0; n];
        let mut multiplier = vec![false; n];
        for station in &model.stations {
            for node in [station.pipe_above, station.pipe_below, station.guide] {
                limits[node..node + 3].fill(tolerances.force);
                limits[node + 3..node + 6].fill(tolerances.moment);
            }
        }
        for joint in 0..model.joints.len() {
            let first = model.multipliers(joint);
            limits[first..first + 3].fill(tolerances.constraint * model.force_scale);
            limits[first + 3..first + 6].fill(tolerances.constraint * model.moment_scale);
            multiplier[first..first + 6].fill(true);
        }
        if let Some(tie) = model.tie {
            limits[tie] = tolerances.constraint * model.force_scale;
            multiplier[tie] = true;
        }
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            limits[unknown] = f64::INFINITY;
        }
        Self {
            assembler: Assembler::new(model, instructions),
            solver,
            tolerances,
            condensed: None,
            correction: vec![0.0; n],
            weights: limits.iter().map(|limit| 1.0 / limit).collect(),
            moving: multiplier.iter().map(|&m| if m { 0.0 } else { 1.0 }).collect(),
            multiplier,
        }
    }

    /// Condenses the step-constant tangent for steps with these factors, if the tool's joints allow it; others are
    /// solved by block LU.
    pub fn prepare(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) {
        let key = key(factors, conditions);
        let known = |condensed: &CondensedTangents| condensed.systems.iter().any(|(known, _)| *known == key);
        if self.condensed.as_ref().is_some_and(known) {
            return;
        }
        let step_constant = self.assembler.step_constant(model, conditions, factors);
        let Some(system) = CondensedSystem::of(step_constant, &model.joint_stations) else {
            return;
        };
        let condensed = self.condensed.get_or_insert_with(|| CondensedTangents {
            elimination: CondensedElimination::new(&model.layout, &model.joint_stations, self.assembler.instructions()),
            systems: Vec::new(),
        });
        condensed.systems.push((key, system));
    }

    /// Solves the step of size `h` that ends under `conditions`, Eq. 40 to 44. `to` comes with the axial forces to use
    /// and holds the new state on success; the assembler holds its residual with the reactions.
    ///
    /// # Errors
    /// Why and where no iterate was accepted; the iterations made are in the first field.
    pub fn step(
        &mut self,
        model: &Model,
        scheme: Scheme,
        h: f64,
        conditions: &Conditions,
        from: &State,
        to: &mut State,
    ) -> Result<u32, (u32, StepFailure)> {
        self.assembler.bit.begin();
        scheme.predict(h, from, to);
        to.time = conditions.time;
        let drive_angle = conditions.drive_angle;
        to.drive_angle = drive_angle;
        if let Some(driven) = model.driven {
            to.q[driven] = drive_angle;
            (to.v[driven], to.a[driven]) = scheme.rates(h, drive_angle - from.q[driven], from, driven);
        }
        let factors = scheme.factors(h);
        let mut iterations = 0;
        loop {
            self.assembler.residual(model, to, conditions);
            let ratio = self.worst();
            let failure = |cause, value: f64, unknown: usize| {
                let (station, body) = locate(model, unknown);
                StepFailure {
                    cause,
                    time: from.time,
                    step: h,
                    station,
                    body,
                    value,
                }
            };
            if ratio.is_nan() {
                return Err((
                    iterations,
                    failure(FailureCause::NotFinite, f64::NAN, self.worst_unknown()),
                ));
            }
            if ratio <= 1.0 {
                return match out_of_range(model, to) {
                    Some((unknown, value)) => Err((iterations, failure(FailureCause::OutOfRange, value, unknown))),
                    None => {
                        scheme.finish(h, from, to);
                        Ok(iterations)
                    }
                };
            }
            if iterations == self.tolerances.max_iterations {
                let unknown = self.worst_unknown();
                let value = self.assembler.residual[unknown];
                return Err((iterations, failure(FailureCause::NotConverged, value, unknown)));
            }
            iterations += 1;
            if let Err(singular) = self.correct(model, to, conditions, factors) {
                let failure = StepFailure {
                    cause: FailureCause::Singular,
                    time: from.time,
                    step: h,
                    station: singular.station,
                    body: Body::Pipe,
                    value: singular.pivot,
                };
                return Err((iterations, failure));
            }
        }
    }

    /// One correction K_T dq = -R, Eq. 40 and 43.
    fn correct(
        &mut self,
        model: &Model,
        to: &mut State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) -> Result<(), crate::linear::Singular> {
        self.assembler.drop_reactions(model);
        for (c, r) in self.correction.iter_mut().zip(&self.assembler.residual) {
            *c = -r;
        }
        let key = key(factors, conditions);
        let condensed = self.condensed.as_mut().and_then(|condensed| {
            let (_, system) = condensed.systems.iter().find(|(known, _)| *known == key)?;
            Some((&mut condensed.elimination, system))
        });
        if let Some((elimination, system)) = condensed {
            self.assembler.stopwatch.lap(Phase::Assembly);
            self.assembler.linearise(model, to, conditions, factors);
            let solved = elimination.solve(system, &self.assembler.increment, &mut self.correction);
            self.assembler.stopwatch.lap(Phase::Solve);
            solved?;
        } else {
            self.assembler.tangent(model, to, conditions, factors);
            let solved = self.solver.solve(&self.assembler.system, &mut self.correction);
            self.assembler.stopwatch.lap(Phase::Solve);
            solved?;
        }
        let spin = model.bit_spin();
        self.assembler
            .bit
            .corrected(conditions.bit_torque, factors.damping * self.correction[spin]);
        let rates = to.v.iter_mut().zip(&mut to.a);
        for ((q, (v, a)), (dq, moving)) in to.q.iter_mut().zip(rates).zip(self.correction.iter().zip(&self.moving)) {
            *q += dq;
            let dq = dq * moving;
            *v += factors.damping * dq;
            *a += factors.mass * dq;
        }
        Ok(())
    }

    /// Accelerations and multipliers in balance with the forces at `state`, Eq. 17: M a + Phi_q^T lambda = F.
    ///
    /// With `h` (s) above 0 as far as steps of that size can follow them: (M + h C + h^2 K) a + Phi_q^T lambda = F, the
    /// forces with what the accelerations themselves do to them within a step. Motion of frequency omega keeps its
    /// acceleration but for the part (omega h)^2.
    ///
    /// # Errors
    /// When the mass matrix with the constraints is singular.
    pub fn balance_accelerations(
        &mut self,
        model: &Model,
        state: &mut State,
        conditions: &Conditions,
        h: f64,
    ) -> Result<(), crate::linear::Singular> {
        state.a.fill(0.0);
        self.assembler.residual(model, state, conditions);
        self.assembler.drop_reactions(model);
        let factors = TangentFactors {
            stiffness: h * h,
            damping: h,
            mass: 1.0,
        };
        self.assembler.tangent(model, state, conditions, factors);
        for (i, c) in self.correction.iter_mut().enumerate() {
            // The rows ask for accelerations along the constraints, not for corrections of position.
            *c = if self.multiplier[i] {
                0.0
            } else {
                -self.assembler.residual[i]
            };
        }
        self.solver.solve(&self.assembler.system, &mut self.correction)?;
        for (i, &x) in self.correction.iter().enumerate() {
            if self.multiplier[i] {
                state.q[i] += x;
            } else {
                state.a[i] = x;
            }
        }
        self.assembler.residual(model, state, conditions);
        Ok(())
    }

    /// Static corrections of a state at rest, as long as they bring the residual down; `scratch` is overwritten. Where
    /// the static tangent has no inverse (a body that could float), the state stays as it is.
    pub fn polish_rest(&mut self, model: &Model, state: &mut State, scratch: &mut State, conditions: &Conditions) {
        let factors = TangentFactors {
            stiffness: 1.0,
            damping: 0.0,
            mass: 0.0,
        };
        self.assembler.bit.begin();
        self.assembler.residual(model, state, conditions);
        let mut best = self.worst();
        for _ in 0..self.tolerances.max_iterations {
            scratch.copy_from(state);
            if self.correct(model, scratch, conditions, factors).is_err() {
                return;
            }
            scratch.update_axial(model);
            self.assembler.residual(model, scratch, conditions);
            let ratio = self.worst();
            if ratio.is_nan() || ratio >= best || out_of_range(model, scratch).is_some() {
                return;
            }
            best = ratio;
            state.copy_from(scratch);
        }
    }

    /// The largest residual relative to its limit, or NaN.
    fn worst(&self) -> f64 {
        // Eight running maxima, so that the compiler can use vectors; the place is only looked for when it is asked
        // for.
        const LANES: usize = 8;
        let mut worst = [0.0_f64; LANES];
        let mut sum = [0.0_f64; LANES];
        let (residual, rest) = self.assembler.residual.as_chunks::<LANES>();
        let (weights, rest_weights) = self.weights.as_chunks::<LANES>();
        for (r, w) in residual.iter().zip(weights) {
            for k in 0..LANES {
                let ratio = r[k].abs() * w[k];
                // A maximum passes over a number that is not one; the sum does not.
                worst[k] = if ratio > worst[k] { ratio } else { worst[k] };
                sum[k] += ratio;
            }
        }
        let mut ratio = 0.0_f64;
        let mut total = 0.0;
        for k in 0..LANES {
            ratio = ratio.max(worst[k]);
            total += sum[k];
        }
        for (r, w) in rest.iter().zip(rest_weights) {
            ratio = ratio.max(r.abs() * w);
            total += r.abs() * w;
        }
        if total.is_nan() { f64::NAN } else { ratio }
    }

    /// The unknown whose residual is worst, or the first that is not a number.
    fn worst_unknown(&self) -> usize {
        let mut worst = (0.0, 0);
        for (unknown, (r, w)) in self.assembler.residual.iter().zip(&self.weights).enumerate() {
            let ratio = r.abs() * w;
            if ratio.is_nan() {
                return unknown;
            }
            if ratio > worst.0 {
                worst = (ratio, unknown);
            }
        }
        worst.1
    }
}

fn out_of_range(model: &Model, state: &State) -> Option<(usize, f64)> {
    for station in &model.stations {
        for first in [station.pipe_above, station.pipe_below, station.guide] {
            for k in 0..3 {
                if state.q[first + k].abs() > LARGEST_DISPLACEMENT {
                    return Some((first + k, state.q[first + k]));
                }
            }
            for k in 4..6 {
                if state.q[first + k].abs() > LARGEST_TILT {
                    return Some((first + k, state.q[first + k]));
                }
            }
        }
    }
    None
}

/// Station and pipe of an unknown.
fn locate(model: &Model, unknown: usize) -> (usize, Body) {
    let station = model.layout.station_of(unknown);
    let local = unknown - model.layout.offset(station);
    (
        station,
        if (6..12).contains(&local) {
            Body::Guide
        } else {
            Body::Pipe
        },
    )
}
