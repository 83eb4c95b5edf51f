//! Recordings and field logs through the model, and the page made of them.

#[path = "../common/mod.rs"]
mod common;

mod field_log;
mod logs;
mod report;
