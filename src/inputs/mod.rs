//! Inputs from the rig: units, limits, age and state.

pub mod units;
