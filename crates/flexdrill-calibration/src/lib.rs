//! Fits coefficients of the twin to what a rig measured.
//!
//! The crate takes numbers and gives numbers: it opens no file, runs no twin and reads no clock. The caller reads the
//! log, runs the twin at the points that the design asks for, and writes what was found.
//!
//! # Layout
//! - [`windows`]: the steady parts of a log, and what was left out with its reason.
//! - [`unknown`]: what is fitted, with its prior; everything below works on standardised values, whose prior is N(0, 1).
//! - [`design`]: a Latin hypercube of points at which the twin is run. [`surrogate`]: a Gaussian process through their
//!   results.
//! - [`noise`]: the covariance of what is measured: scatter of a window, drift of a sensor.
//! - [`smoother`]: the ensemble smoother with multiple data assimilation (ES-MDA).
//! - [`identify`]: what the data determine, what they do not, and pairs of which they determine one combination only.
//! - [`fit`]: all of it in one call, with the error of the surrogate.
//! - [`follow`]: the recursive estimate of friction and tare while drilling. [`following`]: the twin's parameters on their
//!   way to it, within limits.
//! - [`residual`]: measured less predicted with its band. [`monitor`]: the comparison of rig and twin while drilling.
//!
//! # Sources
//! Emerick and Reynolds, Ensemble smoother with multiple data assimilation, Comput. Geosci. 55, 2013. McKay, Beckman and
//! Conover, Technometrics 21, 1979 (Latin hypercube).

pub mod design;
mod error;
pub mod fit;
pub mod follow;
pub mod following;
pub mod identify;
pub mod monitor;
pub mod noise;
mod random;
pub mod residual;
pub mod smoother;
pub mod surrogate;
pub mod unknown;
pub mod windows;

pub use error::CalibrationError;

/// Half of the width of a 90 % band of a normal distribution, in standard deviations: the quantile at 95 %.
pub const BAND: f64 = 1.644_853_626_951_472_7;
