//! Two machines with a cable between them, as two computers on a rig have: an Ethernet whose datagrams hold 1,452 bytes of
//! DDS, where loopback has 65,507.

use crate::common::{Network, skipped};

/// Address of the twin's machine.
pub const INSIDE: &str = "10.77.0.1";
/// Address of the other machine.
pub const OUTSIDE: &str = "10.77.0.2";

/// Two networks with a cable between them.
pub fn two_machines() -> Option<(Network, Network)> {
    let (inside, outside) = (Network::new()?, Network::new()?);
    let other = outside.id().to_string();
    let cable = [
        "ip", "link", "add", "rig0", "type", "veth", "peer", "name", "rig1", "netns", &other,
    ];
    if !inside.done(&cable) {
        return skipped("no cable between two network namespaces can be made (needs root)");
    }
    for (network, device, address) in [(&inside, "rig0", INSIDE), (&outside, "rig1", OUTSIDE)] {
        let address = format!("{address}/24");
        assert!(network.done(&["ip", "address", "add", &address, "dev", device]));
        assert!(network.done(&["ip", "link", "set", device, "mtu", "1500", "up"]));
        assert!(network.done(&["ip", "route", "replace", "224.0.0.0/4", "dev", device]));
    }
    Some((inside, outside))
}
