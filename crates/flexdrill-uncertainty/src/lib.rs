//! What is not known of a tool and its rig: the section `uncertainty` of a configuration as distributions, and plausible
//! tools drawn from them.
//!
//! [`Priors::of`] reads a configuration. [`Priors::member`] draws a plausible tool: a configuration with other values,
//! and errors of the rig's sensors, from what is known before a calibration or, with [`Priors::drawn_from`], after it. A member is a function of configuration, seed and its own number: it does not depend
//! on how many are drawn, nor on which.
//!
//! # Layout
//! - [`law`]: a distribution cut off at limits: its quantiles.
//! - [`priors`]: all entries of a configuration, with the correlation of their draws.
//! - [`sensors`]: the errors of the rig's sensors, by channel.
//! - [`member`]: the draws; [`readings`]: what acts on one where the rig shows a reading.
//! - [`posterior`]: what a calibration has found, as a sample in a file.
//! - [`effects`]: the table of what each prior moves, as `flexdrill sensitivity` writes it.

pub mod effects;
mod error;
pub mod law;
pub mod member;
pub mod posterior;
pub mod priors;
mod random;
pub mod readings;
pub mod sensors;

pub use effects::Effects;
pub use error::UncertaintyError;
pub use law::Law;
pub use member::Member;
pub use posterior::{Posterior, PosteriorError};
pub use priors::{Entry, Priors};
pub use readings::Readings;
pub use sensors::{Channel, Sensor, SensorError};
