//! The part of the network that the node uses: domain and reach, from options and ROS 2's environment variables.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use rustdds::dds::CreateError;
use rustdds::{DomainParticipant, DomainParticipantBuilder};
use serde::{Deserialize, Serialize};

/// Highest domain whose UDP ports fit (7400 + 250 x domain + ...).
const MAX_DOMAIN: u16 = 232;

/// The range of discovery.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reach {
    /// All interfaces, multicast within the subnet.
    Subnet,
    /// This machine only.
    Localhost,
}

/// Domain and reach.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Network {
    /// DDS domain, 0 to 232.
    pub domain_id: u16,
    /// The range of discovery.
    pub reach: Reach,
    /// Addresses of the interfaces to use; all if there are none.
    pub interfaces: Vec<IpAddr>,
    /// Machines that multicast does not reach, by name or IPv4 address.
    pub peers: Vec<String>,
    /// Folder with the keys, certificates and permissions of DDS Security; without one any program may read and write.
    pub keys: Option<PathBuf>,
}

/// Why the network settings or the DDS participant cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// Not a domain number.
    #[error("{origin} is '{value}'; a domain is a whole number from 0 to {MAX_DOMAIN}")]
    Domain {
        /// Option or variable.
        origin: &'static str,
        /// Value, as it was given.
        value: String,
    },
    /// A discovery range that ROS 2 does not know.
    #[error("ROS_AUTOMATIC_DISCOVERY_RANGE is '{0}'; use SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT")]
    Range(String),
    /// A peer that is no host name or address.
    #[error(
        "ROS_STATIC_PEERS has '{0}'; give names of machines or IPv4 addresses without ports, with semicolons between them"
    )]
    Peer(String),
    /// Peers are configured, and DDS is restricted to this machine.
    #[error(
        "network.peers in the configuration names {0}, and ROS_AUTOMATIC_DISCOVERY_RANGE or ROS_LOCALHOST_ONLY keeps \
         DDS on this machine; set network.reach: subnet, or leave network.peers out"
    )]
    PeersKeptOut(String),
    /// DDS Security is enabled without a keystore.
    #[error("ROS_SECURITY_ENABLE is true and ROS_SECURITY_KEYSTORE is not set; set it to the folder of the keystore")]
    NoKeystore,
    /// DDS Security is enabled, and this program was built without it.
    #[error(
        "ROS_SECURITY_ENABLE is true, and this flexdrill was built without DDS Security; build it with \
         `cargo build --release --features security`, or unset the variable to run without access control"
    )]
    NoSecurity,
    /// DDS did not start.
    #[error(
        "DDS did not start in domain {domain_id}: {source}; check that a network interface is up (`ip link`) and that fewer than 120 participants run on this machine"
    )]
    Participant {
        /// Domain.
        domain_id: u16,
        /// From RustDDS.
        source: CreateError,
    },
}

impl Network {
    /// Reads the settings. `domain` is the option of the command line, which has precedence over ROS_DOMAIN_ID. The second
    /// result has a sentence for each of ROS 2's settings that is not supported.
    ///
    /// # Errors
    /// When a variable or the option has a value that ROS 2 does not know.
    pub fn read(
        domain: Option<u16>,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<(Self, Vec<String>), NetworkError> {
        // An empty variable counts as not set.
        let variable = |name: &str| {
            variable(name)
                .map(|value| value.trim().to_owned())
                .filter(|value| !value.is_empty())
        };
        let mut notes = Vec::new();
        // The option has precedence: it belongs to this call, the variable to the shell.
        let domain_id = match (domain, variable("ROS_DOMAIN_ID")) {
            (Some(domain), _) => checked_domain("--domain", domain.to_string())?,
            (None, Some(text)) => checked_domain("ROS_DOMAIN_ID", text)?,
            (None, None) => 0,
        };
        let localhost_only = variable("ROS_LOCALHOST_ONLY").is_some_and(|value| value == "1");
        let range = variable("ROS_AUTOMATIC_DISCOVERY_RANGE");
        let mut reach = match range.as_deref() {
            None | Some("SUBNET" | "SYSTEM_DEFAULT") => Reach::Subnet,
            Some("LOCALHOST") => Reach::Localhost,
            // What is not supported comes as near as possible and is said;
            // silence would make a node unreachable without a reason.
            Some("OFF") => {
                notes.push("ROS_AUTOMATIC_DISCOVERY_RANGE=OFF is not supported (RustDDS cannot switch discovery off); the node stays on this machine, as with LOCALHOST".into());
                Reach::Localhost
            }
            Some(other) => return Err(NetworkError::Range(other.to_owned())),
        };
        // The older variable, kept by ROS 2, is the stricter one and wins.
        if localhost_only {
            reach = Reach::Localhost;
        }
        let mut peers = peers(variable("ROS_STATIC_PEERS").as_deref())?;
        // A peer on another machine contradicts staying on this one. The stricter setting wins here too.
        if reach == Reach::Localhost && !peers.is_empty() {
            notes.push("ROS_STATIC_PEERS is ignored: the node stays on this machine, and RustDDS cannot open it to some machines only; set ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET, with a firewall".into());
            peers.clear();
        }
        if variable("ROS_DISCOVERY_SERVER").is_some() {
            notes.push("ROS_DISCOVERY_SERVER is ignored: it is a feature of Fast DDS".into());
        }
        let network = Self {
            domain_id,
            reach,
            interfaces: Vec::new(),
            peers,
            keys: keys(variable)?,
        };
        Ok((network, notes))
    }

    /// The network with the settings of a configuration: a reach in place of that of ROS 2's variables, if one is given,
    /// the interfaces, and the peers in place of those of the variables, if there are any.
    ///
    /// # Errors
    /// When there are peers, and the reach is this machine only.
    pub fn configured(
        mut self,
        reach: Option<Reach>,
        interfaces: &[IpAddr],
        peers: &[String],
    ) -> Result<Self, NetworkError> {
        self.reach = reach.unwrap_or(self.reach);
        self.interfaces = interfaces.to_vec();
        if !peers.is_empty() {
            self.peers = peers.to_vec();
        }
        if self.reach == Reach::Localhost {
            // Ignored peers of the environment have a note from `read`.
            if !peers.is_empty() {
                return Err(NetworkError::PeersKeptOut(self.peers.join(", ")));
            }
            self.peers.clear();
        }
        Ok(self)
    }

    /// A sentence on which machines can reach the node, and what they may do.
    pub fn describe(&self) -> String {
        let domain = self.domain_id;
        if self.reach == Reach::Localhost {
            return format!("domain {domain}, this machine only{}", self.security());
        }
        let mut reached = if self.interfaces.is_empty() {
            "all interfaces".to_owned()
        } else {
            let addresses: Vec<String> = self.interfaces.iter().map(ToString::to_string).collect();
            addresses.join(", ")
        };
        if !self.peers.is_empty() {
            reached += &format!(" and the peers {}", self.peers.join(", "));
        }
        if self.keys.is_some() {
            return format!("domain {domain}, {reached}{}", self.security());
        }
        format!(
            "domain {domain}, {reached}: any machine there can read the outputs, send inputs and set parameters \
             (network.reach: localhost keeps it on this machine)"
        )
    }

    fn security(&self) -> String {
        let keys = self.keys.as_ref();
        keys.map_or_else(String::new, |keys| {
            format!(
                ", with DDS Security: only programs with keys of {} may read or drive, as its governance states",
                keys.display()
            )
        })
    }

    /// Starts DDS in this process.
    ///
    /// # Errors
    /// When the participant cannot be created, or DDS Security is enabled in a program that was built without it.
    pub fn start(&self) -> Result<DomainParticipant, NetworkError> {
        let failed = |source| NetworkError::Participant {
            domain_id: self.domain_id,
            source,
        };
        let mut builder = DomainParticipantBuilder::new(self.domain_id);
        if self.reach == Reach::Localhost {
            builder = builder.with_only_networks([IpAddr::V4(Ipv4Addr::LOCALHOST)]);
        } else if !self.interfaces.is_empty() {
            builder = builder.with_only_networks(self.interfaces.iter().copied());
        }
        if let Some(keys) = &self.keys {
            builder = secured(builder, keys)?;
        }
        builder.build().map_err(failed)
    }
}

/// The machines that ROS_STATIC_PEERS lists.
fn peers(list: Option<&str>) -> Result<Vec<String>, NetworkError> {
    let names = list.unwrap_or_default().split(';').map(str::trim);
    names
        .filter(|name| !name.is_empty())
        .map(|name| {
            if flexdrill_text::is_host(name) {
                Ok(name.to_owned())
            } else {
                Err(NetworkError::Peer(name.to_owned()))
            }
        })
        .collect()
}

/// The folder of an enclave of SROS2, from ROS 2's own variables.
fn keys(variable: impl Fn(&str) -> Option<String>) -> Result<Option<PathBuf>, NetworkError> {
    if variable("ROS_SECURITY_ENABLE").as_deref() != Some("true") {
        return Ok(None);
    }
    if cfg!(not(feature = "security")) {
        return Err(NetworkError::NoSecurity);
    }
    let keystore = variable("ROS_SECURITY_KEYSTORE").ok_or(NetworkError::NoKeystore)?;
    let enclave = variable("ROS_SECURITY_ENCLAVE_OVERRIDE").unwrap_or_default();
    let folder = PathBuf::from(keystore).join("enclaves");
    Ok(Some(folder.join(enclave.trim_matches('/'))))
}

#[cfg(feature = "security")]
fn secured(
    builder: DomainParticipantBuilder,
    keys: &std::path::Path,
) -> Result<DomainParticipantBuilder, NetworkError> {
    let files = rustdds::DomainParticipantSecurityConfigFiles::with_ros_default_names(keys, String::new());
    Ok(builder.builtin_security(files))
}

#[cfg(not(feature = "security"))]
fn secured(_: DomainParticipantBuilder, _: &std::path::Path) -> Result<DomainParticipantBuilder, NetworkError> {
    Err(NetworkError::NoSecurity)
}

fn checked_domain(origin: &'static str, value: String) -> Result<u16, NetworkError> {
    match value.parse() {
        Ok(domain) if domain <= MAX_DOMAIN => Ok(domain),
        _ => Err(NetworkError::Domain { origin, value }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(domain: Option<u16>, variables: &[(&str, &str)]) -> Result<(Network, Vec<String>), NetworkError> {
        Network::read(domain, |name| {
            variables
                .iter()
                .find(|(variable, _)| *variable == name)
                .map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn the_option_wins_over_the_variable() {
        assert_eq!(
            read(None, &[]).unwrap().0,
            Network {
                domain_id: 0,
                reach: Reach::Subnet,
                interfaces: Vec::new(),
                peers: Vec::new(),
                keys: None,
            }
        );
        assert_eq!(read(None, &[("ROS_DOMAIN_ID", "7")]).unwrap().0.domain_id, 7);
        assert_eq!(read(Some(3), &[("ROS_DOMAIN_ID", "7")]).unwrap().0.domain_id, 3);
    }

    #[test]
    fn reach_follows_both_generations_of_variables() {
        assert_eq!(
            read(None, &[("ROS_LOCALHOST_ONLY", "1")]).unwrap().0.reach,
            Reach::Localhost
        );
        assert_eq!(
            read(None, &[("ROS_LOCALHOST_ONLY", "0")]).unwrap().0.reach,
            Reach::Subnet
        );
        assert_eq!(
            read(None, &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")])
                .unwrap()
                .0
                .reach,
            Reach::Localhost
        );
        let (network, notes) = read(
            None,
            &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF"), ("ROS_STATIC_PEERS", "a")],
        )
        .unwrap();
        assert_eq!((network.reach, notes.len()), (Reach::Localhost, 2));
    }

    #[test]
    fn peers_are_those_of_the_environment_or_the_configuration() {
        let list = ("ROS_STATIC_PEERS", "plot.rig.lan; 10.0.0.7;");
        let (network, notes) = read(None, &[list]).unwrap();
        assert_eq!((network.peers.len(), notes.len()), (2, 0), "{notes:?}");
        assert!(network.describe().contains("plot.rig.lan, 10.0.0.7"));
        let refused = read(None, &[("ROS_STATIC_PEERS", "10.0.0.7:7400")]).unwrap_err();
        assert!(refused.to_string().contains("'10.0.0.7:7400'"), "{refused}");

        let configured = |network: &Network, peers: &[String]| network.clone().configured(None, &[], peers);
        assert_eq!(configured(&network, &[]).unwrap().peers, network.peers);
        let peers = ["10.0.0.8".to_owned()];
        assert_eq!(configured(&network, &peers).unwrap().peers, peers);

        let here = ("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
        let (network, notes) = read(None, &[list, here]).unwrap();
        assert_eq!((network.peers.len(), notes.len()), (0, 1), "told, and none is called");
        let refused = configured(&network, &peers).unwrap_err().to_string();
        assert!(
            refused.contains("10.0.0.8") && refused.contains("network.reach: subnet"),
            "{refused}"
        );
    }

    /// Whoever asks for security gets it or is refused.
    #[test]
    fn keys_are_those_of_the_enclave() {
        let (on, store) = (("ROS_SECURITY_ENABLE", "true"), ("ROS_SECURITY_KEYSTORE", "/keys"));
        assert_eq!(read(None, &[store]).unwrap().0.keys, None, "not enabled");
        if cfg!(not(feature = "security")) {
            let refused = read(None, &[on, store]).unwrap_err().to_string();
            assert!(refused.contains("--features security"), "{refused}");
            return;
        }
        assert!(matches!(read(None, &[on]), Err(NetworkError::NoKeystore)));
        let (network, _) = read(None, &[on, store]).unwrap();
        assert_eq!(network.keys, Some("/keys/enclaves".into()));
        assert!(network.describe().contains("/keys/enclaves"), "{}", network.describe());
        let enclave = ("ROS_SECURITY_ENCLAVE_OVERRIDE", "/rig_7/twin");
        let (network, _) = read(None, &[on, store, enclave]).unwrap();
        assert_eq!(network.keys, Some("/keys/enclaves/rig_7/twin".into()));
    }

    #[test]
    fn wrong_values_are_named() {
        for value in ["233", "-1", "x"] {
            let error = read(None, &[("ROS_DOMAIN_ID", value)]).unwrap_err().to_string();
            assert!(error.contains(value) && error.contains("232"), "{error}");
        }
        assert!(read(None, &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "NEAR")]).is_err());
    }
}
