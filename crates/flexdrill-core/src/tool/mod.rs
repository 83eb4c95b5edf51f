//! What is modelled: the tool, its well and its loads, as described.

pub mod description;
mod paper;
pub mod section;
mod validation;
pub mod well;

pub use description::*;
