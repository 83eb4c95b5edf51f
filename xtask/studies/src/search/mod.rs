//! Looking for parameter sets that agree with as many findings as possible.
//!
//! The paper's dimensions, weight on bit and stiffnesses are unpublished; `space` says between which bounds they are
//! looked for and why. The plan is seeded and takes no clock: points with reasons, a Latin hypercube over the whole
//! space on a coarse mesh, then an evolution strategy from the best points that lie apart, on the full mesh because
//! wall forces depend on it; the best are run again with the full record. A table that a stopped search left is taken
//! up where it ends.

pub(crate) mod command;
mod descent;
mod outcome;
mod plan;
mod random;
mod space;
