//! flexdrill: the real-time digital twin of a flexible drilling tool in an ultrashort-radius well.
//!
//! The mechanics and what its motion means are the crate [`flexdrill_core`], which knows nothing of the world; this one
//! joins it to the rig.
//!
//! # Layout
//! What touches the world. Each folder may use those below it; never those above.
//!
//! - [`cli`]: the subcommands, a file or folder each.
//! - [`dashboard`]: the page at the rig, its server, and steering from it.
//! - [`ros`]: the node, its parameters and services, in the message types of ros2-client.
//! - [`health`]: status and diagnostics of the node. [`alarms`]: what the motion and the node's state mean for an operator.
//! - [`live`]: what is published, over WebSocket in Foxglove's protocol, from the node or a bag. [`report`]: a recording as
//!   one page.
//! - [`bag`]: recordings; the only module that knows MCAP and SQLite. [`field_log`]: CSV logs of a rig.
//! - [`rig_inputs`]: who sends the rig's inputs, when they were measured, and what is refused.
//! - [`dds`]: RustDDS and ros2-client's DDS side, in a process of their own.
//!
//! Below them, as crates of their own: [`flexdrill_messages`] (the ROS 2 messages, here also as `messages`),
//! [`flexdrill_text`], `flexdrill-paper`, `flexdrill-plot`, `flexdrill-verify`, `flexdrill-alarms`,
//! [`flexdrill_config`], [`flexdrill_realtime`] and [`flexdrill_core`], the mechanics. `docs/architecture.md` draws the house.

pub mod alarms;
pub mod cli;
pub mod dashboard;
pub mod health;
pub mod node;
pub mod rig_inputs;

pub use flexdrill_bag as bag;
pub use flexdrill_field_log as field_log;
pub use flexdrill_live as live;
pub use flexdrill_messages as messages;
pub use flexdrill_report as report;
pub use flexdrill_ros2 as ros;
pub use flexdrill_ros2::dds;
