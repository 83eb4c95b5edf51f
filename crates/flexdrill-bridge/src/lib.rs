//! Rig protocols of flexdrill. The crate knows the protocols and what their values mean; it knows no ROS 2: the
//! program `flexdrill bridge` joins it to the twin's topics.
//!
//! # Layout
//! - [`wits`]: WITS level 0: frames, items, sequence, mapping to quantities; the same written; captures.
//! - [`lines`]: connections over TCP, as client and as server, and serial lines, which come back after a loss.
//! - `mqtt`, with the feature of that name: the twin's outputs on an MQTT broker, as JSON and as Sparkplug B.
//! - [`figures`]: the twin's figures by name and unit, for every protocol that sends them on.

pub mod figures;
pub mod lines;
#[cfg(feature = "mqtt")]
pub mod mqtt;
pub mod quantity;
pub mod wits;

pub use figures::{Figure, TwinFigures};
pub use quantity::Quantity;
