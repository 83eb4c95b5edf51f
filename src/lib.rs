//! flexdrill: the real-time digital twin of a flexible drilling tool in an ultrashort-radius well.
//!
//! The mechanics and what its motion means are the crate [`flexdrill_core`], which knows nothing of the world; this one
//! joins it to the rig.
//!
//! # Layout
//! What touches the world. Each folder may use those below it; never those above.
//!
//! - [`cli`]: the subcommands, a file or folder each.
//! - [`ros`]: the only module that knows ros2-client. [`bag`]: the only one that knows MCAP. [`field_log`]: CSV rig
//!   logs. [`health`]: what is said of the node's state.
//! - [`rig_inputs`]: who sends the rig's inputs, when they were measured, and what is refused.
//! - [`dashboard`]: the page beside the rig, its server, and steering from it.
//! - [`live`]: what is published, over WebSocket in Foxglove's protocol, from the node or a bag.
//! - [`alarms`]: what the motion and the node's state mean for an operator.
//! - [`report`]: a recording as one page.
//! - [`messages`]: message types generated from `msg/*.msg`, and how they are filled from a snapshot.
//! - [`told`]: text of others that is shown and not run, and log lines that do not flood.
//!
//! Below them, as crates of their own: `flexdrill-paper`, `flexdrill-verify`, [`flexdrill_config`],
//! [`flexdrill_realtime`] and [`flexdrill_core`], the mechanics. `docs/architecture.md` draws the house.

pub mod alarms;
pub mod bag;
pub mod cli;
pub mod dashboard;
pub mod dds;
pub mod field_log;
pub mod health;
pub mod live;
pub mod messages;
pub mod report;
pub mod rig_inputs;
pub mod ros;
pub mod told;
