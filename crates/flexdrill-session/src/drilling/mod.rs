//! Where a tool drills next: `flexdrill_drilling`, and for a live twin [`live`].
//!
//! # Layout
//! - [`live`]: what the bit of a live twin does across the hole, where it drills, `twin/hole_ahead`, and what it has
//!   drilled, `twin/hole_drilled`.

pub mod live;

pub use flexdrill_drilling::*;
