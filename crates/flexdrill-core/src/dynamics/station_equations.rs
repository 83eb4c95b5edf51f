//! The equations of a step station by station: the static start, and the plain form that the chain is held against.

use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::newton::{Equations, LARGEST_DISPLACEMENT, Stride, correct, worst};
use crate::dynamics::phases::Phase;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::{Accuracy, Limits, Tolerances};
use crate::elements::joint::rotation::LARGEST_TILT;
use crate::linear::{LinearSolver, Singular};
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::Body;

/// The tool's equations, station by station, with the room that Newton's iteration needs.
pub struct StationEquations {
    /// Residual and tangent.
    pub assembler: Assembler,
    /// Solves with the tangent.
    pub solver: Box<dyn LinearSolver>,
    /// When an iterate is accepted.
    pub tolerances: Tolerances,
    correction: Vec<f64>,
    limits: Limits,
    multiplier: Vec<bool>,
    /// 0 for multipliers, else 1.
    moving: Vec<f64>,
    /// Axial forces of pipe and guide foreseen for the end of the step, and what part of them counts.
    foreseen: (Vec<f64>, Vec<f64>),
    foreseen_part: f64,
}

impl StationEquations {
    /// Room for `model`.
    pub fn new(
        model: &Model,
        solver: Box<dyn LinearSolver>,
        tolerances: Tolerances,
        instructions: Instructions,
    ) -> Self {
        let n = model.unknowns();
        let moving_force = tolerances.moving_force(model);
        let (mut limits, mut moving_limits) = (vec![0.0; n], vec![0.0; n]);
        let mut multiplier = vec![false; n];
        for station in &model.stations {
            for node in [station.pipe_above, station.pipe_below, station.guide] {
                limits[node..node + 3].fill(tolerances.force);
                limits[node + 3..node + 6].fill(tolerances.moment);
                moving_limits[node..node + 3].fill(moving_force);
                moving_limits[node + 3..node + 6].fill(moving_force * tolerances.moving_moment);
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
            (limits[unknown], moving_limits[unknown]) = (f64::INFINITY, f64::INFINITY);
        }
        for unknown in (0..n).filter(|&unknown| multiplier[unknown]) {
            moving_limits[unknown] = limits[unknown];
        }
        let inverse = |limits: &[f64]| limits.iter().map(|limit| 1.0 / limit).collect();
        Self {
            assembler: Assembler::new(model, instructions),
            solver,
            tolerances,
            correction: vec![0.0; n],
            limits: Limits::new(inverse(&limits), inverse(&moving_limits)),
            moving: multiplier.iter().map(|&m| if m { 0.0 } else { 1.0 }).collect(),
            multiplier,
            foreseen: (vec![0.0; model.pipe.len()], vec![0.0; model.guide.len()]),
            foreseen_part: 0.0,
        }
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
    ) -> Result<(), Singular> {
        state.a.fill(0.0);
        self.assembler.begin();
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
        self.assembler.begin();
        self.assembler.residual(model, state, conditions);
        let mut best = worst(&self.assembler.residual, self.limits.weights(Accuracy::Rest));
        for _ in 0..self.tolerances.max_iterations {
            scratch.copy_from(state);
            if self.solve(model, scratch, conditions, factors).is_err() {
                return;
            }
            correct(self, scratch, factors);
            scratch.update_axial(model);
            self.assembler.residual(model, scratch, conditions);
            let ratio = worst(&self.assembler.residual, self.limits.weights(Accuracy::Rest));
            if ratio.is_nan() || ratio >= best || out_of_range(model, scratch).is_some() {
                return;
            }
            best = ratio;
            state.copy_from(scratch);
        }
    }
}

impl Equations for StationEquations {
    fn begin(&mut self, model: &Model, stride: Stride, from: &State, to: &mut State) {
        self.assembler.begin();
        to.predict_axial(model, from, stride.foresight);
        self.foreseen.0.copy_from_slice(&to.pipe_axial);
        self.foreseen.1.copy_from_slice(&to.guide_axial);
        self.foreseen_part = stride.foreseen_part;
        self.limits.for_step(stride.h);
    }

    fn residual(&mut self, model: &Model, to: &mut State, conditions: &Conditions, _: TangentFactors, _: u32) {
        to.blend_axial(model, self.foreseen_part, &self.foreseen);
        self.assembler.residual(model, to, conditions);
    }

    fn solve(
        &mut self,
        model: &Model,
        to: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) -> Result<(), Singular> {
        self.assembler.drop_reactions(model);
        for (c, r) in self.correction.iter_mut().zip(&self.assembler.residual) {
            *c = -r;
        }
        self.assembler.tangent(model, to, conditions, factors);
        let solved = self.solver.solve(&self.assembler.system, &mut self.correction);
        self.assembler.stopwatch.lap(Phase::Solve);
        solved
    }

    fn residuals(&self) -> &[f64] {
        &self.assembler.residual
    }

    fn weights(&self, accuracy: Accuracy) -> &[f64] {
        self.limits.weights(accuracy)
    }

    fn correction(&self) -> (&[f64], &[f64]) {
        (&self.correction, &self.moving)
    }

    fn driven<'a>(&'a self, model: &'a Model) -> &'a [usize] {
        model.driven.as_slice()
    }

    fn out_of_range(&self, model: &Model, state: &State) -> Option<(usize, f64)> {
        out_of_range(model, state)
    }

    fn instructions(&self) -> Instructions {
        self.assembler.instructions()
    }

    fn locate(&self, model: &Model, unknown: usize) -> (usize, Body) {
        locate(model, unknown)
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
