//! What the mechanics, the analysis of its motion and their users share: unit conversions, the two pipes and locations on
//! them, the curvature of a tube as made, numbers with a range, the terms of the energy ledger, the checks of numbers, and
//! [`listed!`], by which the variants of an enumeration are written once. The crate depends on no other of the workspace.

mod band;
mod bends;
pub mod energies;
mod listed;
mod location;
pub mod units;
pub mod validation;

pub use band::Band;
pub use bends::{Bend, Bends};
pub use location::{Body, Location};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
