//! Shortening of the pipe's elements over all stations.

use super::assembler::Assembler;
use super::linear::BlockSystem;
use super::tangent::add_pipe_element;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::State;
use crate::effects::pressure::{self, PipePressure};
use crate::effects::shortening::{Stretch, StretchTangent};
use crate::elements::beam::ElementVector;
use crate::elements::factors::TangentFactors;
use crate::model::Model;

/// An element at one state.
struct Stretched {
    stretch: Stretch,
    /// E A / l (N/m).
    axial: f64,
    /// d linear axial force / d q.
    tension: [f64; 12],
    /// G q and G v.
    slopes: [ElementVector; 2],
}

impl Stretched {
    fn of(model: &Model, e: usize, state: &State, conditions: &Conditions) -> Self {
        let beta = conditions.rayleigh.beta;
        let by_pressure = PipePressure::around(model).map_or(0.0, |pressure| {
            pressure.at_top(conditions.standpipe_pressure) * pressure.unstrained[e]
        });
        let [top, bottom] = nodes(model, e);
        let at = |values: &[f64]| {
            ElementVector::from_fn(|k, _| if k < 6 { values[top + k] } else { values[bottom + k - 6] })
        };
        let (q, v) = (at(&state.q), at(&state.v));
        let element = &model.pipe[e];
        let axial = element.beam.section.axial / element.beam.length;
        let slopes = [element.geometric * q, element.geometric * v];
        let linear = [axial * (q[6] - q[0]), axial * (v[6] - v[0])];
        let mut tension = [0.0; 12];
        (tension[0], tension[6]) = (-axial, axial);
        Self {
            stretch: Stretch::of(axial, beta, by_pressure, linear, [q.dot(&slopes[0]), v.dot(&slopes[0])]),
            axial,
            tension,
            slopes,
        }
    }
}

/// First unknowns of both nodes of the pipe's element `e`.
fn nodes(model: &Model, e: usize) -> [usize; 2] {
    [model.stations[e].pipe_below, model.stations[e + 1].pipe_above]
}

/// Adds forces on both nodes of an element.
fn add(to: &mut [f64], [top, bottom]: [usize; 2], of: impl Fn(usize) -> f64) {
    for k in 0..6 {
        to[top + k] += of(k);
        to[bottom + k] += of(6 + k);
    }
}

impl Assembler {
    /// Adds the forces of the pipe's elements beyond the linear ones, N G q included.
    pub(super) fn shortening_forces(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        for e in 0..model.pipe.len() {
            let at = Stretched::of(model, e, state, conditions);
            let (along, across) = (at.stretch.along(), at.stretch.across());
            add(&mut self.residual, nodes(model, e), |k| {
                along * at.tension[k] + across * at.slopes[0][k]
            });
        }
    }
}

/// Adds the derivative of [`Assembler::shortening_forces`] to the tangent.
pub(crate) fn add_shortening_tangent(
    system: &mut BlockSystem,
    model: &Model,
    state: &State,
    conditions: &Conditions,
    factors: TangentFactors,
) {
    for (e, element) in model.pipe.iter().enumerate() {
        let at = Stretched::of(model, e, state, conditions);
        let tangent = StretchTangent {
            axial: at.axial,
            beta: conditions.rayleigh.beta,
            factors: [factors.stiffness, factors.damping],
        };
        let mut matrix = element.geometric;
        let p: [f64; 12] = at.slopes[0].into();
        for (j, column) in matrix.data.0.iter_mut().enumerate() {
            let (geometric, of) = (*column, [at.tension[j], p[j], at.slopes[1][j]]);
            tangent.column(&at.stretch, [&at.tension, &p], of, &geometric, column);
        }
        add_pipe_element(system, model, e, &matrix, 1.0);
    }
}

impl LedgerPoint {
    /// Adds the damping of the pipe's elements beyond that of the linear ones, and what their shortening lifts of the
    /// pressure's force. Gives their elastic energy beyond that (J).
    pub(crate) fn add_shortening(&mut self, model: &Model, state: &State, conditions: &Conditions) -> f64 {
        let mut energy = 0.0;
        self.sums.of_effects[pressure::PLACE] = 0.0;
        let pressure = PipePressure::around(model);
        for e in 0..model.pipe.len() {
            let at = Stretched::of(model, e, state, conditions);
            let (along, across) = (at.stretch.damped_shortening, at.stretch.damped);
            add(&mut self.damping, nodes(model, e), |k| {
                along * at.tension[k] + across * at.slopes[0][k]
            });
            energy += at.stretch.energy;
            if let Some(pressure) = &pressure {
                self.sums.of_effects[pressure::PLACE] += pressure.unstrained[e] * at.stretch.shortening;
            }
        }
        energy
    }
}
