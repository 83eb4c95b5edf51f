//! Loads of trips, and which pull and torque at the surface reach a stuck tool.
//!
//! The string above the tool is a soft string ([`soft_string`]); the guide has the statics of
//! [`flexdrill_hole::sliding`], so that a guide which the hole bends rubs without tension too. The pipe hangs in the guide and
//! turns in it. The guide does not turn: rotation frees the string from friction along the hole, and not the guide.
//!
//! Depths count from the kick-off, above 0 below it; the string is above it.
//!
//! # Layout
//! - [`soft_string`]: the law of a string on the wall, piece by piece.
//! - [`string`]: the string of a configuration as pieces; [`tool`]: its guide and pipe.
//! - [`stuck`]: what reaches a stuck tool.
//! - [`trip`]: hook load and torque at a depth of the bit.
//! - [`unknowns`]: plausible tools.

pub mod soft_string;
pub mod string;
pub mod stuck;
pub mod tool;
pub mod trip;
pub mod unknowns;

pub use flexdrill_hole::Sense;
pub use stuck::{Limits, Reached, Stuck};
pub use trip::{Assembly, Loads, Refusal, Station, Trip};
