//! Rig protocols of flexdrill. The crate knows the protocols and what their values mean; it knows no ROS 2: the
//! program `flexdrill bridge` joins it to the twin's topics.
//!
//! # Layout
//! - [`wits`]: WITS level 0: frames, items, sequence, mapping to quantities; the same written; captures.
//! - [`lines`]: connections over TCP, as client and as server, and serial lines, which come back after a loss.
//! - `mqtt`, with the feature of that name: the twin's outputs on an MQTT broker, as JSON and as Sparkplug B.
//! - [`figures`]: the twin's figures by name and unit, for every protocol that sends them on.
//! - [`messages`]: values of a rig as messages for the twin.
//! - `opcua`, with the feature of that name: the twin as a server of OPC UA, and a client of a rig's server.

pub mod figures;
pub mod lines;
pub mod messages;
#[cfg(feature = "mqtt")]
pub mod mqtt;
#[cfg(feature = "opcua")]
pub mod opcua;
pub mod quantity;
pub mod wits;

pub use figures::{Figure, TwinFigures};
pub use quantity::{Quantity, SurveyKind};
