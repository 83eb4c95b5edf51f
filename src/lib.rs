//! flexdrill: the real-time digital twin of a flexible drilling tool in an ultrashort-radius well.
//!
//! The mechanics and what its motion means are the crate [`flexdrill_core`], which knows nothing of the world; this one
//! joins it to the rig.
//!
//! # Layout
//! Each room may use those below it, never those above.
//!
//! - [`cli`]: the subcommands, a file or folder each.
//! - [`node`]: the ROS 2 node: its stages, threads, services and parameters.
//! - [`ahead`]: runs from forks of the present state: what would be under other speeds and weights.
//! - [`map`]: points of maps and sweeps: what would be over two quantities, or over a table of values.
//! - [`hole_ahead`]: where the tool of a configuration drills next, with a plan.
//! - [`reach`]: runs of a lengthened tool: what arrives at the bit against the length of the hole.
//! - [`trip`]: hook load and torque of a trip over the depth of the bit.
//! - [`sensitivity`]: runs of a tool with one uncertain key at an end of its distribution.
//! - [`runs`]: runs that need nothing of each other, on threads, and kept.
//! - [`health`]: status, diagnostics and conditions of the node.
//! - [`bridge`]: a rig's own protocols joined to the twin's topics.
//! - [`life_table`]: the table of `flexdrill life` on the disk. [`state_file`]: small files that outlast a restart of the node.
//!
//! What a run becomes is the crate [`flexdrill_session`], of which this program has three hosts: node, replay, look-ahead. Its
//! rooms have their names here too: [`session`], [`ensemble`], [`drilling`], [`residuals`], [`alarms`], [`safe_window`],
//! [`rig_inputs`].
//!
//! Below them are crates, most of them also under a short name here: [`flexdrill_dashboard`], [`flexdrill_report`],
//! [`flexdrill_live`], [`flexdrill_bag`], [`flexdrill_field_log`], [`flexdrill_ros2`], [`flexdrill_messages`],
//! [`flexdrill_outputs`], [`flexdrill_text`], and the mechanics with the crates around it. `docs/architecture.md` draws the house.

pub mod ahead;
#[cfg(feature = "bridge")]
pub mod bridge;
pub mod cli;
pub mod health;
#[cfg(feature = "sweep")]
pub mod hole_ahead;
pub mod life_table;
#[cfg(feature = "sweep")]
pub mod map;
pub mod node;
#[cfg(feature = "sweep")]
pub mod reach;
#[cfg(feature = "sweep")]
pub mod runs;
#[cfg(feature = "sweep")]
pub mod sensitivity;
pub mod state_file;
#[cfg(feature = "sweep")]
pub mod trip;

pub use flexdrill_bag as bag;
pub use flexdrill_dashboard as dashboard;
pub use flexdrill_field_log as field_log;
pub use flexdrill_live as live;
pub use flexdrill_messages as messages;
#[cfg(feature = "report")]
pub use flexdrill_report as report;
pub use flexdrill_ros2 as ros;
pub use flexdrill_ros2::dds;
pub use flexdrill_session as session;
pub use flexdrill_session::{alarms, drilling, ensemble, residuals, rig_inputs, safe_window};
