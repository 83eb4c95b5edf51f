//! Where a drilling tool with a curved guide drills next.
//!
//! The hole grows at the bit, in the direction in which the bit points plus the direction into which its side force cuts
//! ([`BitLaw`]). Tilt and side force follow from the statics of the guide in the hole that it has drilled ([`at_rest`]).
//! [`Propagation`] joins both, chord by chord in depth. [`steady`] has the curvature that results in closed form, and
//! [`bounds`] between which curvatures it lies for any bit. [`SurveyFilter`] learns from surveys where the hole is, and by
//! how much its curvature differs from that of a model.
//!
//! # Frames and signs
//! World: X horizontal, in the build's direction at azimuth 0; Y to the right of it; Z down. Along the hole: x down the
//! hole, y to the right, z to the low side; the frame is carried along the hole without twist. A build curvature above 0
//! turns the hole towards -z, the high side. A side force is that of the bit on the rock, across the hole: its component
//! along z drops the hole if it is above 0. A tilt is that of the bit's axis against the hole's tangent; below 0 along z
//! it points to the high side. Vectors across the hole are (right, low). Units are SI.
//!
//! # Layout
//! `bit_law` is the law, `guide` the tool, `closed_form` and `ripple` have formulas, `hole` the drilled path; `beam`,
//! `blocks` and `statics` compute the equilibrium, at rest or `sliding` on a trip, and `propagation` lets the hole grow. `surveys` corrects a forecast by what
//! was measured.

mod beam;
mod bit_law;
mod blocks;
mod closed_form;
mod error;
mod guide;
mod hole;
mod propagation;
mod ripple;
mod sliding;
mod statics;
mod surveys;

pub use bit_law::BitLaw;
pub use closed_form::{Bounds, Steady, bounds, indifferent_resistance, steady};
pub use error::HoleError;
pub use flexdrill_base::{Bend, Bends};
pub use guide::{Gravity, Guide, Spine};
pub use hole::{Frame, Hole};
pub use propagation::{Advance, Propagation};
pub use ripple::{RIPPLE_THRESHOLD, Ripple, ripple_of_two_contacts};
pub use sliding::{Sense, Sliding, sliding};
pub use statics::{Equilibrium, at_rest};
pub use surveys::{
    KEPT, PlaneModel, PlaneState, Planes, RunStart, Survey, SurveyFilter, USUAL_INCLINATION_DEVIATION,
    usual_azimuth_deviation,
};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
