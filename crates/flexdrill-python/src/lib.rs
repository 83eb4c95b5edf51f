//! The twin for Python.
//!
//! The Rust side is an ordinary library: a [`Twin`] runs towards inputs and fills a [`Recorder`], a session judges its alarms,
//! [`rollout`] runs many on threads, [`saved`] keeps one as bytes. With the feature `extension`, which only maturin turns on, it is also the
//! module `flexdrill._native`; the package around it is in `python/flexdrill`.
//!
//! # Layout
//! - [`columns`]: which figures of a snapshot a recording has, with names that carry their units.
//! - [`recorder`]: columns that grow by a sample, and the events of the alarms.
//! - `judge`: the session of a run.
//! - [`twin`]: one run with its configuration.
//! - [`rollout`]: many runs on threads.
//! - [`ahead`]: where the tool drills next.
//! - [`saved`]: a run as bytes.
//! - `extension`: the Python module.

pub mod ahead;
pub mod columns;
#[cfg(feature = "extension")]
mod extension;
mod judge;
pub mod recorder;
pub mod rollout;
pub mod saved;
pub mod twin;

pub use recorder::{Recorder, RecorderError};
pub use twin::{InputError, Plan, Twin};
