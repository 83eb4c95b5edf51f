//! `network`: how far DDS reaches.

use std::net::IpAddr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;

/// Largest number of peers: each receives about 16 small packets a second.
const MOST_PEERS: usize = 32;

/// Reach of DDS.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Network {
    /// Reach of the discovery in both directions: `environment` follows ROS 2's variables, `subnet` includes all
    /// machines of the subnet, `localhost` this machine only. Default environment.
    pub reach: Reach,
    /// IP addresses of this machine's interfaces that DDS uses. Default: all that `reach` allows.
    pub interfaces: Vec<IpAddr>,
    /// Machines that multicast does not reach, by name or IPv4 address; each must name this one too. Default: those of
    /// ROS_STATIC_PEERS.
    pub peers: Vec<String>,
}

impl Network {
    pub(super) fn check(&self, c: &mut Checker) {
        let count = self.peers.len();
        c.require(
            count <= MOST_PEERS,
            "peers",
            format!("{count} names"),
            "",
            format!("at most {MOST_PEERS} names"),
            "each is called on its own, again and again",
        );
        c.require(
            count == 0 || self.reach != Reach::Localhost,
            "peers",
            format!("{count} names"),
            "",
            "left out with reach: localhost",
            "peers are other machines",
        );
        c.below("peers", |c| {
            for (index, peer) in self.peers.iter().enumerate() {
                let bound = "the name of a machine or its IPv4 address, without a port";
                let holds = flexdrill_text::is_host(peer);
                c.require(
                    holds,
                    &index.to_string(),
                    format!("{peer:?}"),
                    "",
                    bound,
                    "DDS finds the port",
                );
            }
        });
    }
}

/// Reach of the discovery.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Reach {
    /// The reach that ROS_AUTOMATIC_DISCOVERY_RANGE and ROS_LOCALHOST_ONLY set; without them the subnet.
    #[default]
    Environment,
    /// All machines of the subnet.
    Subnet,
    /// This machine only.
    Localhost,
}
