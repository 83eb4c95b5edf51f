//! Inputs at the door: units, limits, age and state.
