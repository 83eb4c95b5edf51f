//! The twin: mechanics, inputs and analysis joined into one deterministic [`Simulation`].
//!
//! The node, replay, verification and sweeps all drive a [`Simulation`], so that they compute the same motion.

#[cfg(feature = "checkpoints")]
mod checkpoint;
mod fill;
mod observe;
mod quality;
mod readings;
mod run;
mod schedule;
mod settings;
mod simulation;
mod snapshot;
mod step_choice;
mod validation;

#[cfg(feature = "checkpoints")]
pub use checkpoint::CheckpointError;
pub use quality::{
    ENERGY_ERROR_BOUNDS, ModelQuality, NUMERICAL_COUNTS_FROM, NUMERICAL_DAMPING_BOUNDS, QualityCause, QualityLevel,
};
pub use readings::StationGeometry;
pub use run::{Frame, Run, RunInputs};
pub use schedule::{Due, EndsInterval, Output, Schedule, Timeline};
pub use settings::SimulationSettings;
pub use simulation::{BuildError, Simulation};
pub use snapshot::{
    Applied, Bit, ContactLayer, Contacts, Holder, Joints, Reactions, Shape, Snapshot, SolverCounters, Steering,
};
pub use step_choice::{StepChoice, StepRule};
