//! Peers beyond a router, which passes no multicast on: the twin and who reads and drives it name each other.

use std::path::Path;
use std::time::Duration;

use crate::common::{Network, Peer, Program, skipped};
use serde_json::json;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const TWIN: &str = "10.78.1.2";
const OTHER: &str = "10.78.2.2";
/// Longer than discovery takes (s): a peer is called every 2 s, and asks again for what it has missed of discovery.
const LISTEN: f64 = 15.0;

/// Two networks and the router between them.
struct Routed {
    twin: Network,
    other: Network,
    _router: Network,
}

fn routed() -> Option<Routed> {
    let (twin, other, router) = (Network::new()?, Network::new()?, Network::new()?);
    let id = router.id().to_string();
    for (network, device, far, address) in [(&twin, "rig0", "port0", TWIN), (&other, "rig1", "port1", OTHER)] {
        let cable = [
            "ip", "link", "add", device, "type", "veth", "peer", "name", far, "netns", &id,
        ];
        if !network.done(&cable) {
            return skipped("no cable between two network namespaces can be made (needs root)");
        }
        let gate = format!("{}.1", address.strip_suffix(".2").unwrap());
        assert!(network.done(&["ip", "address", "add", &format!("{address}/24"), "dev", device]));
        assert!(network.done(&["ip", "link", "set", device, "up"]));
        assert!(router.done(&["ip", "address", "add", &format!("{gate}/24"), "dev", far]));
        assert!(router.done(&["ip", "link", "set", far, "up"]));
        assert!(network.done(&["ip", "route", "add", "default", "via", &gate]));
        assert!(network.done(&["ip", "route", "replace", "224.0.0.0/4", "dev", device]));
    }
    assert!(router.done(&["sh", "-c", "echo 1 > /proc/sys/net/ipv4/ip_forward"]));
    Some(Routed {
        twin,
        other,
        _router: router,
    })
}

fn ours(network: &Network, peers: &str, arguments: &[&str]) -> std::process::Command {
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(arguments).env("ROS_STATIC_PEERS", peers);
    command
}

fn twin(routed: &Routed, peers: &str) -> Program {
    let config = crate::common::small_config();
    let mut twin = Program::start(ours(
        &routed.twin,
        peers,
        &["run", "--config", config.to_str().unwrap()],
    ));
    twin.wait_for("model time runs");
    twin
}

/// Reads the status, then drives with `speed` until the twin has noticed that it fell silent again.
fn reads_and_drives(peer: &mut Peer, speed: f64, twin: &mut Program) {
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    assert!(!peer.take(STATUS.0, 1, LISTEN).is_empty(), "nothing is read");
    let (topic, kind) = ("/rig/rotary_speed_rpm", "std_msgs/msg/Float64");
    let speed_sent = json!({"data": speed});
    let sent =
        peer.command(json!({"do": "publish", "topic": topic, "type": kind, "value": speed_sent, "wait": LISTEN}));
    assert_ne!(sent["matched"], json!(0));
    // What was never heard could not fall silent.
    twin.wait_for(&format!("is brought from {speed:.1}"));
}

fn end(mut twin: Program) {
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(!said.contains("DDS is restarted"), "{said}");
}

#[test]
fn ours_find_each_other_by_name_only() {
    let Some(routed) = routed() else { return };
    let alone = twin(&routed, "");
    let watch = ["watch", "--plain", "--duration", "6"];
    let deaf = ours(&routed.other, "", &watch).output().unwrap();
    assert!(
        !deaf.status.success(),
        "multicast goes through the router, so that nothing is tested here"
    );
    end(alone);

    // The name that nobody has is told, and holds nobody up.
    let mut named = twin(&routed, &format!("nobody.invalid;{OTHER}"));
    let heard = ours(&routed.other, TWIN, &watch).output().unwrap();
    let said = String::from_utf8_lossy(&heard.stdout);
    assert!(heard.status.success() && said.contains("RUNNING"), "{said}");
    named.wait_for("the peer nobody.invalid has no IPv4 address");
    let log = crate::common::root().join("config/field_logs/demo.csv");
    let rig = Program::start(ours(&routed.other, TWIN, &["rig", log.to_str().unwrap(), "--loop"]));
    std::thread::sleep(Duration::from_secs_f64(LISTEN));
    rig.signal("INT");
    // What was never heard could not fall silent.
    named.wait_for("rotary_speed: no good sample for ");
    end(named);
}

#[test]
fn cyclone_dds_reads_and_drives() {
    let Some(routed) = routed() else { return };
    let mut twin = twin(&routed, OTHER);
    for (multicast, speed) in [
        ("", 66.0),
        ("<General><AllowMulticast>false</AllowMulticast></General>", 77.0),
    ] {
        let settings = format!(
            "<CycloneDDS><Domain>{multicast}<Discovery><ParticipantIndex>auto</ParticipantIndex>\
             <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address=\"{TWIN}\"/></Peers></Discovery>\
             </Domain></CycloneDDS>"
        );
        let Some(mut peer) = routed.other.peer_with(&[("CYCLONEDDS_URI", &settings)]) else {
            return;
        };
        reads_and_drives(&mut peer, speed, &mut twin);
        // The log has one line of the kind in ten seconds.
        std::thread::sleep(Duration::from_secs(10));
    }
    end(twin);
}

#[test]
fn fast_dds_reads_and_drives() {
    let Some(routed) = routed() else { return };
    let profile = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\
         <dds xmlns=\"http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles\"><profiles>\
         <participant profile_name=\"peers\" is_default_profile=\"true\"><rtps><builtin><initialPeersList>\
         <locator><udpv4><address>{TWIN}</address></udpv4></locator>\
         </initialPeersList></builtin></rtps></participant></profiles></dds>"
    );
    let file = tempfile::Builder::new().suffix(".xml").tempfile().unwrap();
    std::fs::write(file.path(), profile).unwrap();
    let path: &Path = file.path();
    let Some(mut peer) = routed
        .other
        .fast_peer_with(&[("FASTRTPS_DEFAULT_PROFILES_FILE", path.to_str().unwrap())])
    else {
        return;
    };
    let mut twin = twin(&routed, OTHER);
    reads_and_drives(&mut peer, 88.0, &mut twin);
    std::thread::sleep(Duration::from_secs(1));
    end(twin);
}
