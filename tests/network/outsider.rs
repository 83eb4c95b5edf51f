//! Somebody else on the network, who wants to read the twin and to drive it: what keeps such a one out, and what does not.
//!
//! Two machines (network namespaces with a cable between them). The outsider is a DDS program that calls the twin's
//! address itself, without waiting to be told of it by multicast.

use std::time::Duration;

use crate::cable::{INSIDE, OUTSIDE, two_machines};
use crate::common::{Network, Peer, Program, skipped};
use serde_json::json;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
/// Longer than a participant needs to be discovered and heard (s): Cyclone DDS calls its peers every second at first.
const LISTEN: f64 = 8.0;

/// The outsider, who knows the address of the twin's machine.
fn outsider(outside: &Network) -> Option<Peer> {
    let peers = format!(
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"{OUTSIDE}\"/></Interfaces></General>\
         <Discovery><Peers><Peer address=\"{INSIDE}\"/></Peers></Discovery></Domain></CycloneDDS>"
    );
    outside.peer_with(&[("CYCLONEDDS_URI", &peers)])
}

/// Whether the outsider has read a status, and whether its speed of 77 r/min was taken.
fn try_it(inside: &Network, outside: &Network, reach: &str) -> Option<(bool, bool)> {
    let mut outsider = outsider(outside)?;
    let mut command = inside.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--config"]).arg(crate::common::small_config());
    command.args(["--ros-args", "-p", &format!("network.reach:={reach}")]);
    let mut twin = Program::start(command);
    twin.wait_for("model time runs");
    outsider.subscribe(STATUS.0, STATUS.1, "reliable");
    let read = !outsider.take(STATUS.0, 1, LISTEN).is_empty();
    let sent = outsider.command(json!({
        "do": "publish", "topic": "/rig/rotary_speed_rpm", "type": "std_msgs/msg/Float64",
        "value": {"data": 77.0}, "wait": LISTEN,
    }));
    // What it sends to nobody it cannot have driven with; what was heard shows in the log when it falls silent again.
    std::thread::sleep(Duration::from_secs(4));
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let heard = twin.said().contains("is brought from 77.0");
    assert!(!heard || sent["matched"] != json!(0), "{sent}");
    Some((read, heard))
}

#[test]
fn an_outsider_reads_and_drives_unless_reach_or_a_firewall_keeps_it_out() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let Some(open) = try_it(&inside, &outside, "subnet") else {
        return;
    };
    assert_eq!(open, (true, true), "the cable works, and nothing keeps it out");
    assert_eq!(
        try_it(&inside, &outside, "localhost"),
        Some((false, false)),
        "by its reach alone"
    );
    let rules = "add table inet rig; \
                 add chain inet rig input { type filter hook input priority 0; }; \
                 add rule inet rig input iifname != lo udp dport 7400-65535 drop";
    if !inside.done(&["nft", rules]) {
        skipped::<()>("there is no firewall without nftables");
        return;
    }
    assert_eq!(
        try_it(&inside, &outside, "subnet"),
        Some((false, false)),
        "with the rule"
    );
    assert_eq!(
        try_it(&inside, &outside, "localhost"),
        Some((false, false)),
        "with both"
    );
}
