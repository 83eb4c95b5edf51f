//! Fits coefficients of the twin to what a rig measured.
//!
//! All but [`study`](mod@study) takes numbers and gives numbers: it opens no file, runs no twin and reads no clock. The
//! study runs the twin at the points that the design asks for; the caller reads the log and writes what was found.
//!
//! # Layout
//! While drilling:
//! - [`follow`]: the recursive estimate of friction and tare. [`following`]: the twin's parameters on their way to it,
//!   within limits.
//! - [`residual`]: measured less predicted with its band. [`monitor`]: the comparison of rig and twin. [`plausible`]: of the
//!   rig and plausible tools.
//!   [`stated`](fn@stated): errors of sensors and twin, as the configuration has them.
//!
//! From a log:
//! - [`windows`]: the steady parts of a log, and what was left out with its reason.
//! - [`unknown`]: what is fitted, with its prior; everything below works on standardised values, whose prior is N(0, 1).
//! - [`design`]: a Latin hypercube of points at which the twin is run. [`surrogate`]: a Gaussian process through their
//!   results.
//! - [`noise`]: the covariance of what is measured: scatter of a window, drift of a sensor.
//! - [`smoother`]: the ensemble smoother with multiple data assimilation (ES-MDA).
//! - [`identify`]: what the data determine, what they do not, and pairs of which they determine one combination only.
//! - [`sensor`]: what a sensor shows of a figure. [`explain`]: whether the twin explains what each of them showed.
//! - [`fit`]: all of it in one call, with the error of the surrogate.
//! - [`study`](mod@study): the whole, from windows of a log to what was found, with its parts: what is fitted of a
//!   configuration, one run of the twin, all runs of a design on threads, full runs with what was found, which decide
//!   whether it is to be used, and the results as configuration.
//!
//! # Sources
//! Emerick and Reynolds, Ensemble smoother with multiple data assimilation, Comput. Geosci. 55, 2013. McKay, Beckman and
//! Conover, Technometrics 21, 1979 (Latin hypercube).

pub mod design;
mod error;
pub mod explain;
pub mod fit;
pub mod follow;
pub mod following;
pub mod identify;
pub mod monitor;
pub mod noise;
pub mod plausible;
mod random;
pub mod residual;
pub mod sensor;
pub mod smoother;
mod stated;
pub mod study;
pub mod surrogate;
pub mod unknown;
pub mod windows;

pub use error::CalibrationError;
pub use stated::stated;

/// Half of the width of a 90 % band of a normal distribution, in standard deviations: the quantile at 95 %.
pub const BAND: f64 = 1.644_853_626_951_472_7;
