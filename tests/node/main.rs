//! The node as a process: its command line, clock, alarms and recording.

#[path = "../common/mod.rs"]
mod common;

mod alarms;
mod clock;
mod command_line;
mod recording;
