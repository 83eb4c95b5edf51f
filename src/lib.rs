//! flexdrill: the real-time digital twin of a flexible drilling tool in an ultrashort-radius well.
//!
//! The mechanics and what its motion means are the crate [`flexdrill_core`], which knows nothing of the world; this one
//! joins it to the rig.
//!
//! # Layout
//! Each folder may use those below it and, on its own line, those to its right; never those above.
//!
//! - [`cli`]: the subcommands, a file or folder each.
//! - [`ros`]: the only module that knows ros2-client.
//! - [`health`]: status and diagnostics. [`bag`]: the only module that knows MCAP. [`field_log`]: CSV rig logs.
//! - [`messages`]: message types generated from `msg/*.msg`, and how they are filled from a snapshot.
//! - The crates: `flexdrill-paper`, `flexdrill-verify`, [`flexdrill_realtime`], [`flexdrill_config`],
//!   [`flexdrill_core`].

pub mod bag;
pub mod cli;
pub mod field_log;
pub mod health;
pub mod messages;
pub mod ros;
