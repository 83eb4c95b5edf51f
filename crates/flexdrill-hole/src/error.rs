//! What this crate cannot compute.

use flexdrill_base::validation::ValidationError;

/// A guide, a law or a hole for which there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HoleError {
    /// A number out of its bounds.
    #[error(transparent)]
    Invalid(#[from] ValidationError),
    /// The hole as found is shorter than the guide that lies in it.
    #[error("the hole is {hole_length:.3} m long, and the guide {guide_length:.3} m: add the hole above")]
    HoleTooShort {
        /// Length of the hole (m).
        hole_length: f64,
        /// Length of the guide (m).
        guide_length: f64,
    },
    /// Newton's method ended without an equilibrium.
    #[error(
        "no equilibrium of the guide {depth:.2} m down the hole under a thrust of {weight:.0} N after {iterations} iterations"
    )]
    NoEquilibrium {
        /// Depth of the bit along the hole (m).
        depth: f64,
        /// Thrust at the bit (N).
        weight: f64,
        /// Iterations of Newton's method, all attempts together.
        iterations: usize,
    },
    /// The closed form has no solution between its bounds.
    #[error("no steady curvature: a thrust of {weight:.0} N bends this guide without limit")]
    NoSteadyCurvature {
        /// Thrust at the bit (N).
        weight: f64,
    },
}
