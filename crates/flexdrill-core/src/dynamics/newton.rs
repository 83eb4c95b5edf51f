//! Newton-Raphson, Eq. 40 to 44, for one (sub-)step: on the unknowns of the chain, or on displacements and multipliers of
//! all stations.

use crate::dynamics::conditions::Conditions;
use crate::dynamics::outcome::{FailureCause, StepFailure};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::elements::factors::TangentFactors;
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
    /// Most corrections before the step counts as not converged.
    pub most_iterations: u32,
}

/// A pivot is zero: the system has no unique solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Singular {
    /// Station of the block, 0-based from the top.
    pub station: usize,
    /// Size of the best pivot found.
    pub pivot: f64,
}

/// Where Newton's iteration is within a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iteration<'a> {
    /// What acts at the end of the step.
    pub conditions: &'a Conditions,
    /// The weights of K, C and M in the tangent.
    pub factors: TangentFactors,
    /// Corrections made so far.
    pub corrections: u32,
}

impl<'a> Iteration<'a> {
    /// Before the first correction.
    pub(crate) fn first(conditions: &'a Conditions, factors: TangentFactors) -> Self {
        Self {
            conditions,
            factors,
            corrections: 0,
        }
    }
}

/// The equations of a step in some numbering of the unknowns, with the room that Newton's iteration needs.
pub(crate) trait Equations {
    /// Begins a step from `from`: foresees its axial forces, scales the limits by its size, and forgets what the
    /// corrections of the step before have learned of friction.
    fn begin(&mut self, stride: &Stride, from: &State);
    /// Evaluates the residual at `to`, Eq. 35: for the first time in this step, or after a correction by
    /// [`Equations::solve`] with the same factors.
    fn residual(&mut self, to: &mut State, at: &Iteration<'_>);
    /// Solves K_T dq = -R, Eq. 40 and 43, into the correction.
    ///
    /// # Errors
    /// When the tangent has no inverse.
    fn solve(&mut self, to: &State, at: &Iteration<'_>) -> Result<(), Singular>;
    /// The residual.
    fn residuals(&self) -> &[f64];
    /// One over the limit on each residual, zero where there is no equation.
    fn weights(&self, accuracy: Accuracy) -> &[f64];
    /// The last correction, and per unknown 1, or 0 for multipliers.
    fn correction(&self) -> (&[f64], &[f64]);
    /// The unknowns that the drive prescribes.
    fn driven(&self) -> &[usize];
    /// The first unknown that is out of range, with its value.
    fn out_of_range(&self, state: &State) -> Option<(usize, f64)>;
    /// Station and pipe of an unknown.
    fn locate(&self, unknown: usize) -> (usize, Body);
    /// Vector instructions to use.
    fn instructions(&self) -> Instructions;
}

/// A step of which no iterate was accepted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rejected {
    /// Corrections made.
    pub iterations: u32,
    /// Why and where.
    pub failure: StepFailure,
}

/// Solves the step that ends under `conditions`, Eq. 40 to 44. `to` holds the new state on success, the equations its
/// residual with the reactions. Gives the number of corrections.
///
/// # Errors
/// Why and where no iterate was accepted.
pub(crate) fn step(
    equations: &mut impl Equations,
    stride: &Stride,
    conditions: &Conditions,
    from: &State,
    to: &mut State,
) -> Result<u32, Rejected> {
    equations.instructions().run(Step {
        equations,
        stride,
        conditions,
        from,
        to,
    })
}

/// A step, whose loops over all unknowns are compiled for the vector instructions.
struct Step<'a, E> {
    equations: &'a mut E,
    stride: &'a Stride,
    conditions: &'a Conditions,
    from: &'a State,
    to: &'a mut State,
}

impl<E: Equations> Kernel for Step<'_, E> {
    type Output = Result<u32, Rejected>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Self::Output {
        let Self {
            equations,
            stride,
            conditions,
            from,
            to,
        } = self;
        let Stride {
            scheme,
            h,
            accuracy,
            most_iterations,
            ..
        } = *stride;

        // The predictor carries the motion on; what the drive prescribes is set, and no correction changes it.
        equations.begin(stride, from);
        scheme.predict(h, from, to);
        to.time = conditions.time;
        let drive_angle = conditions.drive_angle;
        to.drive_angle = drive_angle;
        for &driven in equations.driven() {
            to.q[driven] = drive_angle;
            (to.v[driven], to.a[driven]) = scheme.rates(h, drive_angle - from.q[driven], from, driven);
        }

        // The same factors relate displacement, velocity and acceleration in every correction of the step.
        let mut at = Iteration::first(conditions, scheme.factors(h));
        loop {
            equations.residual(to, &at);
            let (residuals, weights) = (equations.residuals(), equations.weights(accuracy));
            let ratio = worst(residuals, weights);
            let rejected = |cause, value: f64, unknown: usize| {
                let (station, body) = equations.locate(unknown);
                let failure = StepFailure {
                    cause,
                    time: from.time,
                    step: h,
                    station,
                    body,
                    value,
                };
                Err(Rejected {
                    iterations: at.corrections,
                    failure,
                })
            };
            // A residual that is not a number would pass every comparison below.
            if ratio.is_nan() {
                return rejected(FailureCause::NotFinite, f64::NAN, worst_unknown(residuals, weights));
            }
            // Motion is not left to the predictor: the forces that a small step leaves unbalanced have the same sign in
            // every step, and would add up.
            if ratio <= 1.0 && (at.corrections > 0 || accuracy == Accuracy::Rest) {
                return match equations.out_of_range(to) {
                    Some((unknown, value)) => rejected(FailureCause::OutOfRange, value, unknown),
                    None => {
                        scheme.finish(h, from, to);
                        Ok(at.corrections)
                    }
                };
            }
            // After the residual is judged, so that the last correction counts if it has converged.
            if at.corrections == most_iterations {
                let unknown = worst_unknown(residuals, weights);
                return rejected(FailureCause::NotConverged, residuals[unknown], unknown);
            }
            let solved = equations.solve(to, &at);
            // Counted before the error is returned: the work was done and belongs to the cost of the step.
            at.corrections += 1;
            if let Err(singular) = solved {
                let failure = StepFailure {
                    cause: FailureCause::Singular,
                    time: from.time,
                    step: h,
                    station: singular.station,
                    body: Body::Pipe,
                    value: singular.pivot,
                };
                return Err(Rejected {
                    iterations: at.corrections,
                    failure,
                });
            }
            correct(equations, to, at.factors);
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

/// Largest displacement (m): far outside any bore, so that the tool must have come apart.
pub(crate) const LARGEST_DISPLACEMENT: f64 = 1.0;
