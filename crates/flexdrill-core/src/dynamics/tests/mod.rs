//! Tests of the mechanics that look at its insides: residual, tangent, state.

mod balance;
mod tangent;
