//! The drill string above the tool, up to the top drive and the hoist.
//!
//! A uniform piece of length L carries torsional and axial waves without dispersion (d'Alembert): with f going down and g
//! coming up, the speed is f + g and the torque or force that is passed down z (f - g). A wave that enters a piece leaves
//! it tau = L / c later; lumps between pieces attenuate it. Every end reads waves from the past only, so that the string adds to the
//! tool's equations nothing but a dashpot z and a known force at the first node:
//!
//! ```text
//! T = z_t (2 f - w)        N = z_a (2 f_a - u')
//! ```
//!
//! Pieces meet where the section changes and where friction on the wall is lumped ([`WallFriction`](crate::tool::description::WallFriction)).

mod friction;
mod history;
mod hoist;
mod line;
mod modes;
mod top_drive;
mod torsion;

#[cfg(feature = "checkpoints")]
pub use line::StringState;
pub use line::{StringLine, StringStep};
