//! A survey from another machine, longer than a datagram of an Ethernet.

use std::time::{Duration, Instant};

use crate::cable::{OUTSIDE, two_machines};
use serde_json::{Value, json};

/// A reliable publisher's one survey arrives, though its text of four kilobytes takes three datagrams. A lost survey would not
/// come again.
#[test]
fn a_survey_longer_than_a_datagram_arrives_over_ethernet() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let settings = format!(
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"{OUTSIDE}\"/></Interfaces></General>\
         </Domain></CycloneDDS>"
    );
    let Some(mut peer) = outside.peer_with(&[("CYCLONEDDS_URI", &settings)]) else {
        return;
    };
    let mut twin = inside.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    let now = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .unwrap();
    // The short tool's hole is 1.06 m long.
    let value = json!({
        "header": {"stamp": {"sec": now.as_secs(), "nanosec": now.subsec_nanos()}, "frame_id": "x".repeat(4000)},
        "measured_depth": 1.0, "inclination": 0.31, "inclination_deviation": "NaN",
        "azimuth": "NaN", "azimuth_deviation": "NaN", "quality": 0, "source": "mwd",
    });
    peer.command(json!({"do": "publish", "topic": "/rig/survey", "type": "flexdrill/msg/RigSurvey", "value": value}));
    let limit = Instant::now() + Duration::from_secs(30);
    let known = |message: &Value| -> String {
        let all = message["status"].as_array().unwrap();
        let item = all.iter().find(|item| item["name"] == "/flexdrill: surveys").unwrap();
        item["message"].as_str().unwrap().to_owned()
    };
    let mut last = String::new();
    while !last.starts_with("1 survey of the hole, the deepest at 1.00 m") {
        assert!(Instant::now() < limit, "{last}");
        if let Some(message) = peer.take("/diagnostics", 1, 1.0).last() {
            last = known(message);
        }
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
