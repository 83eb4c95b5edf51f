//! The monotonic clock of the machine. The crate depends on no other of the workspace.

pub mod monotonic;
