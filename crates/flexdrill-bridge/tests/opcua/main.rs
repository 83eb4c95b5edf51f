//! The server and the client of OPC UA against asyncua (PyPI), by others. Without it these tests say SKIPPED, and fail with
//! CI=true.

#![cfg(feature = "opcua")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

mod crowd;
mod follower;
mod peer;
mod rig;
mod running;
mod server;
