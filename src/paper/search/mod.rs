//! Looking for parameter sets that agree with as many findings as possible.
//!
//! The paper's dimensions, weight on bit and stiffnesses are unpublished; [`space`] says between which bounds they are looked for and
//! why. The plan is seeded and takes no clock: a Latin hypercube over the whole space, then rounds of changes to the best so far. All
//! of it on a coarse mesh; the best are run again on the full one.

mod outcome;
mod plan;
pub mod space;

pub use outcome::{Outcome, Trial, csv_header};
pub use plan::{Plan, Stage, leaders, run};
