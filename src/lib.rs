//! flexdrill: the real-time digital twin of a flexible drilling tool in an ultrashort-radius well.
//!
//! # Layout
//! Each folder may use those below it and, on its own line, those to its right; never those above.
//!
//! - [`cli`]: the subcommands, a file or folder each.
//! - [`ros`]: the only module that knows ros2-client. [`bag`]: the only one that knows MCAP. [`field_log`]: CSV rig
//!   logs. [`pacing`]: deadlines.
//! - [`messages`]: message types generated from `msg/*.msg`, and how they are filled from a snapshot.
//! - [`paper`]: the paper's figures and findings from a run, and the search for parameters that agree.
//! - [`verify`]: the closed-form cases. [`config`]: the YAML configuration. [`inputs`]: units, limits, age and state of
//!   what the rig sends.
//! - [`twin`]: one deterministic simulation.
//! - [`analysis`]: what the motion means. [`mechanics`]: the paper.

pub mod bag;
pub mod cli;
pub mod field_log;
pub mod health;
pub mod messages;
pub mod ros;
