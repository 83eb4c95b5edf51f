//! The mechanics of a flexible drilling tool in an ultrashort-radius well (Lin et al., Scientific Reports 2024), and
//! what its motion means. Numbers in, numbers out: nothing here knows of files, clocks, logs or middleware.
//!
//! # The tool
//! A flexible, rotating pipe of rigidly straight *links* and *joints* turns inside a continuous *guide pipe*, which
//! lies in a curved *hole*. Beams of both pipes meet at *stations*, numbered from 0 at the top; two layers of gap
//! elements, pipe in guide and guide in hole, carry contact and friction. The drive turns the top, weight and the bit's
//! torque act at the bottom.
//!
//! # In twenty lines
//! A [`tool::ToolDescription`] says what is modelled, [`twin::SimulationSettings`] how it is stepped, a
//! [`twin::Simulation`] steps it, and a [`twin::Snapshot`] says what is known at an instant.
//!
//! ```
//! use flexdrill_core::inputs::Inputs;
//! use flexdrill_core::tool::ToolDescription;
//! use flexdrill_core::twin::{Simulation, SimulationSettings};
//! use flexdrill_core::units::rpm_to_rad_per_s;
//!
//! // The paper's tool, with two elements per link instead of five and a softer guide.
//! let mut tool = ToolDescription::paper().with_mesh(33, 2);
//! tool.guide_bending_factor = 0.5;
//! let settings = SimulationSettings::default();
//! // Comes to rest under gravity first.
//! let mut twin = Simulation::new(&tool, &settings)?;
//!
//! let inputs = Inputs { rotary_speed: rpm_to_rad_per_s(40.0), weight_on_bit: 10e3, ..Inputs::default() };
//! let mut snapshot = twin.new_snapshot();
//! while twin.time() < 0.1 {
//!     twin.advance(&inputs).ok()?; // a step of half a millisecond, or the reason why there is none
//! }
//! twin.snapshot(&mut snapshot, true);
//! println!("bit {:.2} rad/s, torque {:.1} N m", snapshot.bit.rotary_speed, snapshot.bit.torque);
//! println!("joint 0 bends by {:.4} rad", snapshot.joints.bend_angle[0]);
//! for (station, kind) in snapshot.whirl.station.iter().zip(&snapshot.whirl.kind) {
//!     println!("station {station}: {kind}");
//! }
//! assert_eq!(snapshot.joints.bend_angle.len(), 32);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A description is built in code, as here, or read from a YAML file: the crate `flexdrill-config` checks the file and
//! returns the [`tool::ToolDescription`] and the [`twin::SimulationSettings`] (`Config::load("tool.yaml")?.tool()`).
//!
//! # Features
//! `checkpoints`, on by default, adds [`twin::Simulation::checkpoint`] and [`twin::Simulation::restore`].
//!
//! # Layout
//! - [`tool`]: what is modelled, as plain structs, and its checks.
//! - [`twin`]: simulation, settings, snapshots, checkpoints, the schedule of outputs.
//! - [`inputs`]: from samples of a rig to inputs of a step: limits, ages, safe values.
//! - [`step`]: steps, sub-steps, the start at rest. Below it `effects`, what acts inside spans; `chain`, the tool over
//!   its nodes; [`dynamics`]: state, time scheme, Newton, energy; below these `model`, `elements`, `simd`.
//! - [`units`] and [`validation`], of the crate `flexdrill-base`: the only conversions; the checks of numbers.
//!
//! The crate `flexdrill-motion` says what the motion means: whirl, stick-slip, shock, their levels and a table of episodes.
//! [`twin`] feeds it.
//!
//! # Conventions
//! SI inside, angles in radians. World: X horizontal in the direction of build, Y horizontal, Z down. Station frame: x
//! down the hole, y horizontal, z towards the low side, so that a positive rotary speed turns y towards z. Equations
//! are those of the paper.
//!
//! # Guarantees
//! - The same build, description, settings and inputs give the same bits, on AVX2 and AVX-512 machines alike.
//! - After [`twin::Simulation::new`], [`twin::Simulation::advance`] and [`twin::Simulation::snapshot`] allocate
//!   nothing.
//! - A step that cannot be taken changes nothing but counters and says why. Nothing panics on a number.

#![deny(missing_docs)]

mod chain;
pub mod dynamics;
mod effects;
mod elements;
pub mod inputs;
mod model;
mod simd;
#[cfg(test)]
mod stations;
pub mod step;
pub mod tool;
pub mod twin;

pub use flexdrill_base::{units, validation};
pub use simd::Instructions;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
extern crate self as flexdrill_core;
#[cfg(test)]
#[path = "../tests/support/mod.rs"]
mod support;
