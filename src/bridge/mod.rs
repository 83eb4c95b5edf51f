//! Bridges between a rig's own protocols and the twin's topics: nodes like any other, each with one connection. What
//! stands on the line and what it means is [`flexdrill_bridge`]; this room joins it to ROS 2.

#[cfg(feature = "mqtt")]
pub mod birth_number;
pub mod confirmations;
mod diagnosis;
mod diagnostics;
pub mod first_frames;
#[cfg(feature = "mqtt")]
pub mod mqtt;
#[cfg(feature = "mqtt")]
mod mqtt_figures;
mod node;
#[cfg(feature = "opcua")]
pub mod opcua;
pub mod wits;

pub use node::{BridgeNode, Outgoing};
