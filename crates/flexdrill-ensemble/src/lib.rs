//! An ensemble of plausible tools: what measurements say of each member, and what the members say together.
//!
//! A member is a tool with drawn parameters. Measurements weigh members ([`Evidence`], [`weights`]); where few carry most of
//! the weight, the ensemble is renewed near them ([`renewal`()]). A power of the weights leaves enough members alike
//! ([`tempering`]); the rest counts afterwards. What members compute becomes bands ([`Band`]) and chances
//! ([`Chance`]) over plausible tools. The model itself is wrong by a stated amount per channel, the *discrepancy*: no number
//! of measurements takes it away.
//!
//! The crate knows no tool and no clock. All of it is a function of its arguments and of a seed.

mod band;
mod chance;
mod evidence;
mod renewal;
mod weights;

pub use band::{Band, LEAST_MEMBERS};
pub use chance::Chance;
pub use evidence::{Evidence, Measurement, Part};
pub use renewal::{Renewal, renewal};
pub use weights::{effective_number, tempering, weights};
