//! Newton-Raphson, Eq. 40 to 44, for one (sub-)step: on the unknowns of the chain, or on displacements and multipliers of
//! all stations.

use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::outcome::{FailureCause, StepFailure};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::linear::Singular;
use crate::model::Model;
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};
use crate::tool::description::Body;

/// What a step is taken by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    /// The time scheme.
    pub scheme: Scheme,
    /// Step size (s).
    pub h: f64,
    /// How far ahead the axial forces are foreseen (s): the step size in motion, 0 for those of the step's start.
    pub foresight: f64,
    /// Part of the foreseen axial forces that counts, 0 to 1.
    pub foreseen_part: f64,
    /// How closely it is solved.
    pub accuracy: Accuracy,
}

/// The equations of a step in some numbering of the unknowns, with the room that Newton's iteration needs.
pub(crate) trait Equations {
    /// Begins a step: axial forces of `to` are those foreseen from `from`, limits those of its size; what the corrections
    /// of the step before have learned is forgotten.
    fn begin(&mut self, model: &Model, stride: Stride, from: &State, to: &mut State);
    /// Evaluates the residual at `to`, Eq. 35, after `iterations` corrections by
    /// [`Equations::solve`] with `factors`.
    fn residual(
        &mut self,
        model: &Model,
        to: &mut State,
        conditions: &Conditions,
        factors: TangentFactors,
        iterations: u32,
    );
    /// Solves K_T dq = -R, Eq. 40 and 43, into the correction.
    ///
    /// # Errors
    /// When the tangent has no inverse.
    fn solve(
        &mut self,
        model: &Model,
        to: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) -> Result<(), Singular>;
    /// The residual.
    fn residuals(&self) -> &[f64];
    /// One over the limit on each residual, zero where there is no equation.
    fn weights(&self, accuracy: Accuracy) -> &[f64];
    /// The last correction, and per unknown 1, or 0 for multipliers.
    fn correction(&self) -> (&[f64], &[f64]);
    /// The unknowns that the drive prescribes.
    fn driven<'a>(&'a self, model: &'a Model) -> &'a [usize];
    /// The first unknown beyond what is possible, with its value.
    fn out_of_range(&self, model: &Model, state: &State) -> Option<(usize, f64)>;
    /// Station and pipe of an unknown.
    fn locate(&self, model: &Model, unknown: usize) -> (usize, Body);
    /// Vector instructions to use.
    fn instructions(&self) -> Instructions;
}

/// Solves the step that ends under `conditions`, Eq. 40 to 44. `to` holds the new state on success, the equations its
/// residual with the reactions.
///
/// # Errors
/// Why and where no iterate was accepted; the iterations made are in the first field.
pub(crate) fn step(
    equations: &mut impl Equations,
    model: &Model,
    stride: (Stride, u32),
    conditions: &Conditions,
    from: &State,
    to: &mut State,
) -> Result<u32, (u32, StepFailure)> {
    equations.instructions().run(Step {
        equations,
        model,
        stride,
        conditions,
        from,
        to,
    })
}

/// A step, whose loops over all unknowns are compiled for the vector instructions.
struct Step<'a, E> {
    equations: &'a mut E,
    model: &'a Model,
    stride: (Stride, u32),
    conditions: &'a Conditions,
    from: &'a State,
    to: &'a mut State,
}

impl<E: Equations> Kernel for Step<'_, E> {
    type Output = Result<u32, (u32, StepFailure)>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Self::Output {
        let Self {
            equations,
            model,
            stride: (stride, most_iterations),
            conditions,
            from,
            to,
        } = self;
        let Stride {
            scheme, h, accuracy, ..
        } = stride;
        equations.begin(model, stride, from, to);
        scheme.predict(h, from, to);
        to.time = conditions.time;
        let drive_angle = conditions.drive_angle;
        to.drive_angle = drive_angle;
        for &driven in equations.driven(model) {
            to.q[driven] = drive_angle;
            (to.v[driven], to.a[driven]) = scheme.rates(h, drive_angle - from.q[driven], from, driven);
        }
        let factors = scheme.factors(h);
        let mut iterations = 0;
        loop {
            equations.residual(model, to, conditions, factors, iterations);
            let (residuals, weights) = (equations.residuals(), equations.weights(accuracy));
            let ratio = worst(residuals, weights);
            let failure = |cause, value: f64, unknown: usize| {
                let (station, body) = equations.locate(model, unknown);
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
                let unknown = worst_unknown(residuals, weights);
                return Err((iterations, failure(FailureCause::NotFinite, f64::NAN, unknown)));
            }
            // Motion is not left to the predictor: what a small step leaves of its forces is of one sign, step after step.
            if ratio <= 1.0 && (iterations > 0 || accuracy == Accuracy::Rest) {
                return match equations.out_of_range(model, to) {
                    Some((unknown, value)) => Err((iterations, failure(FailureCause::OutOfRange, value, unknown))),
                    None => {
                        scheme.finish(h, from, to);
                        Ok(iterations)
                    }
                };
            }
            if iterations == most_iterations {
                let unknown = worst_unknown(residuals, weights);
                let value = residuals[unknown];
                return Err((iterations, failure(FailureCause::NotConverged, value, unknown)));
            }
            iterations += 1;
            if let Err(singular) = equations.solve(model, to, conditions, factors) {
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
            correct(equations, to, factors);
        }
    }
}

/// Moves `to` by the last correction, velocities and accelerations with it.
#[inline(always)]
pub(crate) fn correct(equations: &impl Equations, to: &mut State, factors: TangentFactors) {
    let (correction, moving) = equations.correction();
    let rates = to.v.iter_mut().zip(&mut to.a);
    for ((q, (v, a)), (dq, moving)) in to.q.iter_mut().zip(rates).zip(correction.iter().zip(moving)) {
        *q += dq;
        let dq = dq * moving;
        *v += factors.damping * dq;
        *a += factors.mass * dq;
    }
}

/// The largest residual relative to its limit, or NaN.
#[inline(always)]
pub(crate) fn worst(residuals: &[f64], weights: &[f64]) -> f64 {
    // Eight running maxima, so that the compiler can use vectors; the place is only looked for when it is asked for.
    const LANES: usize = 8;
    let mut worst = [0.0_f64; LANES];
    let mut sum = [0.0_f64; LANES];
    let (residuals, rest) = residuals.as_chunks::<LANES>();
    let (weights, rest_weights) = weights.as_chunks::<LANES>();
    for (r, w) in residuals.iter().zip(weights) {
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
fn worst_unknown(residuals: &[f64], weights: &[f64]) -> usize {
    let mut worst = (0.0, 0);
    for (unknown, (r, w)) in residuals.iter().zip(weights).enumerate() {
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

/// Displacements (m) beyond which something has come apart: far outside any bore.
pub(crate) const LARGEST_DISPLACEMENT: f64 = 1.0;
