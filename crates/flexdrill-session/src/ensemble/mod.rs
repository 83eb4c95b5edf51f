//! Plausible tools that run with the twin, under the same inputs (`ensemble` in the configuration): `twin/bands`.
//!
//! A member is a tool with parameters drawn from what is not known (`uncertainty`), on a rig whose weight indicator and speed
//! sensor have errors (`member`). What the rig measures weighs the members (`evidence`), unless a sensor shows what none of them
//! does (`trust`); where few carry most of the weight,
//! tools near those few replace the others (`replacing`). What the members compute becomes bands and chances (`message`), the
//! ranges that the alarm `rig_disagrees` is judged by, and the friction that `calibration.follow` moves to (`judgement`).
//!
//! All of it is a function of the configuration, of what acts on the twin, of what the rig measured and of the number of
//! members, evaluated in slices of model time behind the twin, by a clock on threads of idle work (`running`). A replay of a
//! recording takes the number of members from it and gives the same bands to the bit.

mod engine;
mod evidence;
mod fork;
mod judgement;
mod member;
mod message;
mod place;
mod posterior;
mod replacing;
mod running;
#[cfg(test)]
mod tests;
mod trust;

pub use engine::{Ensemble, Found, Generation, Told};
pub use evidence::Compared;
pub use fork::{Fork, Forks};
pub use message::band_factors;
pub use place::Threads;
pub use posterior::named_by;
pub use running::{Forking, Pace, Running};
