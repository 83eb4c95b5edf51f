//! Calibration of a configuration: coefficients of the twin fitted to what a rig measured.
//!
//! The mathematics is the crate [`flexdrill_calibration`]. Here is the twin's part of it.
//!
//! # Layout
//! - [`unknowns`]: what is fitted of a configuration, with its priors.
//! - [`point`]: one run of the twin at constant speed and weight. [`points`]: all runs of a design, on threads, kept in a
//!   file.
//! - [`study`](mod@study): the whole, from windows of a log to what was found. [`check`]: full runs with it, which decide
//!   whether it is to be used.
//! - [`stated`](fn@stated): errors of sensors and twin, for the comparison while drilling.
//! - [`overlay`]: what was found as configuration and for other programs.

pub mod check;
pub mod overlay;
pub mod point;
pub mod points;
mod stated;
pub mod study;
pub mod unknowns;

pub use check::{Checked, Objection};
pub use stated::stated;
pub use study::{Study, StudySettings, study};
