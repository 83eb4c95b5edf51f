//! `network`: how far DDS reaches.

use std::net::IpAddr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far DDS reaches.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Network {
    /// How far others are looked for, and may look. Default environment.
    pub reach: Reach,
    /// IP addresses of this machine's interfaces that DDS is to use. Default: all that `reach` allows.
    pub interfaces: Vec<IpAddr>,
}

/// How far discovery goes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Reach {
    /// As ROS_AUTOMATIC_DISCOVERY_RANGE and ROS_LOCALHOST_ONLY say; without them the subnet.
    #[default]
    Environment,
    /// All machines of the subnet.
    Subnet,
    /// This machine only.
    Localhost,
}
