//! The equations of a step station by station.

use super::assembler::Assembler;
use super::interactions::Interactions;
use super::linear::LinearSolver;
use crate::chain::Effect;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::newton::{Equations, Iteration, LARGEST_DISPLACEMENT, Singular, Stride};
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::state::State;
use crate::dynamics::tolerances::{Accuracy, Limits, Tolerances};
use crate::elements::factors::TangentFactors;
use crate::elements::joint::rotation::LARGEST_TILT;
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::Body;

/// Room for Newton's iteration over all stations.
pub struct StationRoom {
    /// Residual and tangent.
    pub assembler: Assembler,
    /// Solves with the tangent.
    pub solver: Box<dyn LinearSolver>,
    correction: Vec<f64>,
    limits: Limits,
    /// 0 for multipliers, else 1.
    moving: Vec<f64>,
    /// Axial forces of pipe and guide foreseen for the end of the step, and what part of them counts.
    foreseen: [Vec<f64>; 2],
    foreseen_part: f64,
}

impl StationRoom {
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
            correction: vec![0.0; n],
            limits: Limits::new(inverse(&limits), inverse(&moving_limits)),
            moving: multiplier.iter().map(|&m| if m { 0.0 } else { 1.0 }).collect(),
            foreseen: [vec![0.0; model.pipe.len()], vec![0.0; model.guide.len()]],
            foreseen_part: 0.0,
        }
    }
}

/// The tool's equations, station by station.
pub(crate) struct StationEquations<'a> {
    pub model: &'a Model,
    pub room: &'a mut StationRoom,
    pub interactions: &'a mut Interactions,
    pub stopwatch: &'a mut Stopwatch,
}

impl StationEquations<'_> {
    /// Evaluates the residual at `state`, with the axial forces that it holds.
    pub(crate) fn evaluate(&mut self, state: &State, conditions: &Conditions) {
        let assembler = &mut self.room.assembler;
        assembler.residual(self.interactions, self.model, state, conditions);
    }

    /// Assembles the tangent at `state`, and solves it for the right-hand side that is in the correction.
    ///
    /// # Errors
    /// When the tangent has no inverse.
    fn solve_correction(
        &mut self,
        state: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) -> Result<(), Singular> {
        let StationRoom {
            assembler,
            solver,
            correction,
            ..
        } = &mut *self.room;
        assembler.tangent(self.interactions, self.model, state, conditions, factors);
        solver.solve(&assembler.system, correction)
    }
}

impl Equations for StationEquations<'_> {
    fn begin(&mut self, stride: &Stride, from: &State) {
        self.interactions.begin(from, stride.h);
        self.room.assembler.bit.begin(from, stride.h);
        from.foresee_axial(self.model, stride.foresight, &mut self.room.foreseen);
        self.room.foreseen_part = stride.foreseen_part;
        self.room.limits.for_step(stride.h);
    }

    fn residual(&mut self, to: &mut State, at: &Iteration<'_>) {
        to.blend_axial(self.model, self.room.foreseen_part, &self.room.foreseen, at.conditions);
        self.evaluate(to, at.conditions);
        self.stopwatch.lap(Phase::Assembly);
    }

    fn solve(&mut self, to: &State, at: &Iteration<'_>) -> Result<(), Singular> {
        let StationRoom {
            assembler, correction, ..
        } = &mut *self.room;
        assembler.drop_reactions(self.model);
        for (c, r) in correction.iter_mut().zip(&assembler.residual) {
            *c = -r;
        }
        let solved = self.solve_correction(to, at.conditions, at.factors);
        self.stopwatch.lap(Phase::Solve);
        solved
    }

    fn residuals(&self) -> &[f64] {
        &self.room.assembler.residual
    }

    fn weights(&self, accuracy: Accuracy) -> &[f64] {
        self.room.limits.weights(accuracy)
    }

    fn correction(&self) -> (&[f64], &[f64]) {
        (&self.room.correction, &self.room.moving)
    }

    fn driven(&self) -> &[usize] {
        self.model.driven.as_slice()
    }

    fn out_of_range(&self, state: &State) -> Option<(usize, f64)> {
        for station in &self.model.stations {
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

    fn locate(&self, unknown: usize) -> (usize, Body) {
        let layout = &self.model.layout;
        let station = layout.station_of(unknown);
        let guide = (6..12).contains(&(unknown - layout.offset(station)));
        (station, if guide { Body::Guide } else { Body::Pipe })
    }

    fn instructions(&self) -> Instructions {
        self.room.assembler.instructions()
    }
}
