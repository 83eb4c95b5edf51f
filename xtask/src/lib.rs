//! What is done to the repository itself: message types generated from `msg/`, and the log of the demonstration.

pub mod demo_log;
pub mod messages;
