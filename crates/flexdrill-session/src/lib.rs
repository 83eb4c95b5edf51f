//! What a run becomes: messages, alarms, the comparison with the rig, plausible tools that run with it, and the hole that it
//! drills. A [`Session`] makes them for each host: node, replay, look-ahead and the package for Python.
//!
//! The crate knows no middleware, no recording and no file of the node. A [`Host`] says where messages are sent and what the
//! rig has measured.
//!
//! # Layout
//! Each room may use those below it, never those above.
//!
//! - [`Session`]: a run's frames and inputs in, messages and alarms out.
//! - [`ensemble`]: plausible tools that run with the twin, and what they do together.
//! - [`residuals`]: what the rig measures against what the twin computes, once per second.
//! - [`drilling`]: where a tool drills next, with the range of plausible tools, also under the load of a live twin.
//! - [`alarms`]: the meaning of the motion for an operator.
//! - [`safe_window`]: the map of speed and weight, and where a point is on it.
//! - [`rig_inputs`]: publishers, age and validity of the rig's inputs.

pub mod alarms;
pub mod drilling;
pub mod ensemble;
pub mod residuals;
pub mod rig_inputs;
pub mod safe_window;
mod session;

use flexdrill_messages as messages;
pub use session::{Host, Session};
