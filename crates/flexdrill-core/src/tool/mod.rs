//! What is modelled: the tool, its well and its loads, as described.

pub mod description;
pub mod section;
pub mod well;

pub use description::*;
