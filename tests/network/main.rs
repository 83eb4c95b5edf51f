//! DDS on networks that fail, that reach too far, or that do not reach far enough.

#[path = "../common/mod.rs"]
mod common;

mod faults;
mod others;
mod outsider;
mod peers;
