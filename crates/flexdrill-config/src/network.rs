//! `network`: how far DDS reaches.

use std::net::{IpAddr, Ipv4Addr};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;

/// Largest number of peers: each receives about 16 small packets a second.
const MOST_PEERS: usize = 32;
/// Longest name that DNS allows (bytes).
const LONGEST_NAME: usize = 253;

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
                let holds = is_peer(peer);
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

/// Whether this can be the name or the IPv4 address of a machine. A text of digits and dots alone must be an address.
pub fn is_peer(name: &str) -> bool {
    let is_word = |part: &str| {
        !part.is_empty()
            && !part.starts_with('-')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
    };
    let is_number = name.chars().all(|c| c.is_ascii_digit() || c == '.');
    name.len() <= LONGEST_NAME
        && if is_number {
            name.parse::<Ipv4Addr>().is_ok()
        } else {
            name.trim_end_matches('.').split('.').all(is_word)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peers_are_names_or_addresses() {
        for good in ["rig-7", "rig_7.example.org", "10.0.0.7", "plot.local.", "7up.example"] {
            assert!(is_peer(good), "{good}");
        }
        let long = "a".repeat(300);
        for bad in [
            "",
            " ",
            "a b",
            "10.0.0",
            "10.0.0.256",
            "10.0.0.7:7400",
            "::1",
            "fe80::1",
            "a..b",
            "-a",
            "a;b",
            &long,
        ] {
            assert!(!is_peer(bad), "{bad}");
        }
    }
}
