//! The published scalars, one row each: messages, bridges, reports and the rig page are made from the same table
//! (`tables.rs`). A new figure is a row there, and its field with a sentence in `msg/`.

mod over_tools;
mod row;
mod tables;

pub use over_tools::{Known, OverTools};
pub use row::{Figure, Group, Kind, Shown, Window};
pub use tables::{BIT_STATE, CONTACT_FORCES, HOLE_AHEAD, JOINT_DEFLECTIONS, TRANSFER};
pub(crate) use tables::{fill_bit_state, fill_contact_forces, fill_joint_deflections, fill_transfer};
