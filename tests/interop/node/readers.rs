//! Readers that come late, stall, or look at the graph.

use super::*;

/// ROS 2's tools warn of mixed qualities of service where a topic has two writers, and list each name that begins as theirs.
#[test]
fn the_graph_has_one_writer_of_parameter_events_and_nothing_private() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let found = peer.command(json!({"do": "endpoints"}));
    let endpoints = |kind: &str| -> Vec<(String, bool)> { serde_json::from_value(found[kind].clone()).unwrap() };
    let (writers, readers) = (endpoints("writers"), endpoints("readers"));
    assert!(writers.len() > 30 && readers.len() > 15, "{found}");
    let events: Vec<_> = writers
        .iter()
        .filter(|(topic, _)| topic == "rt/parameter_events")
        .collect();
    assert_eq!(events, [&("rt/parameter_events".to_owned(), false)]);
    for (topic, _) in writers.iter().chain(&readers) {
        let is_ros = ["rt/", "rq/", "rr/"].iter().any(|prefix| topic.starts_with(prefix));
        // rmw_cyclonedds leaves what begins like DDS's own topics out of the graph.
        let is_hidden = topic.starts_with("DCPS");
        assert!(is_ros || is_hidden || topic == "ros_discovery_info", "{topic}");
    }
    for (topic, _) in &writers {
        let count = writers.iter().filter(|(other, _)| other == topic).count();
        assert_eq!(count, 1, "{topic} has {count} writers");
    }
}

#[test]
fn a_late_joiner_gets_the_latched_warning_and_a_killed_node_comes_back() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    std::thread::sleep(std::time::Duration::from_secs(1));
    let warnings = ("/twin/whirl_warnings", "flexdrill/msg/WhirlWarning");
    peer.subscribe(warnings.0, warnings.1, "latched");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let latched = peer.take(warnings.0, 1, 10.0);
    assert!(!latched.is_empty(), "the level was sent before the peer came");
    let before = peer.status_with(STATUS.0, |_| true);
    twin.signal("KILL");
    twin.end();
    let mut again = network.twin(&[]);
    again.wait_for("model time runs");
    let after = peer.status_with(STATUS.0, |status| {
        status["header"]["stamp"]["sec"].as_i64() >= before["header"]["stamp"]["sec"].as_i64()
            && status["step_count"].as_u64() < before["step_count"].as_u64()
    });
    assert_eq!(after["config_hash"], before["config_hash"]);
    peer.send("/rig/rotary_speed_rpm", json!(25.0));
    peer.status_with(STATUS.0, |status| status["input_state"][0] == 1);
}

/// Lists are a second apart and not cleaned from the writer before six: a reader that joins receives the newest one, not
/// those before it.
#[test]
fn a_late_joiner_gets_the_present_state_first() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    std::thread::sleep(std::time::Duration::from_secs(4));
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let second = |message: &Value| {
        let stamp = &message["header"]["stamp"];
        stamp["sec"].as_f64().unwrap() + 1e-9 * stamp["nanosec"].as_f64().unwrap()
    };
    let now = second(&peer.status_with(STATUS.0, |_| true));
    let alarms = ("/twin/alarms", "flexdrill/msg/AlarmList");
    peer.subscribe(alarms.0, alarms.1, "latched");
    let lists = peer.take(alarms.0, 2, 10.0);
    let ages: Vec<f64> = lists.iter().map(|list| now - second(list)).collect();
    // The list in force was sent within the last second; half of one is for a busy machine.
    assert!(lists.len() >= 2 && ages.iter().all(|age| *age < 1.5), "{ages:?}");
}

#[test]
fn a_stalled_reader_holds_up_nobody() {
    let Some(network) = Network::new() else { return };
    let (Some(mut stalled), Some(mut healthy)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    for peer in [&mut stalled, &mut healthy] {
        peer.subscribe(STATUS.0, STATUS.1, "reliable");
        peer.subscribe("/twin/contact_forces", "flexdrill/msg/ContactForces", "reliable");
        assert!(!peer.take("/twin/contact_forces", 1, 10.0).is_empty());
    }
    stalled.signal("STOP");
    healthy.take("/twin/contact_forces", 1, 0.0);
    let before = healthy.status_with(STATUS.0, |_| true);
    let mut counts = Vec::new();
    for _ in 0..6 {
        counts.push(healthy.take("/twin/contact_forces", 1000, 1.0).len());
    }
    let after = healthy.status_with(STATUS.0, |status| {
        status["sequence"].as_u64() > before["sequence"].as_u64()
    });
    stalled.signal("CONT");
    // 50 Hz of model time; a busy machine skips some.
    assert!(
        counts.iter().all(|count| *count >= 10),
        "{counts:?} messages in each second"
    );
    assert_eq!(
        after["output_dropped"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|dropped| **dropped != json!(0))
            .count(),
        0,
        "{after}"
    );
}

/// ROS 2's own programs warn of each endpoint without user data, and show the hash in `ros2 topic info -v`.
#[test]
fn every_endpoint_announces_the_hash_of_its_type() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--lifecycle"]);
    twin.wait_for("model time");
    let found = peer.command(json!({"do": "user_data"}))["user_data"].clone();
    let found = found.as_object().unwrap();
    assert!(found.len() > 60, "{found:?}");
    // ROS 2's layers look at no topic of DDS itself, such as the one with which the node checks its own DDS.
    for (topic, announced) in found.iter().filter(|(topic, _)| !topic.starts_with("DCPS")) {
        for data in announced.as_array().unwrap() {
            let data = data.as_str().unwrap();
            let is_hash = data.starts_with("typehash=RIHS01_") && data.len() == 9 + 7 + 64 + 1 && data.ends_with(';');
            assert!(is_hash, "{topic}: '{data}'");
        }
    }
    // As `ros2 topic info -v` shows it for std_msgs/msg/Float64 everywhere.
    let float64 = "typehash=RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a;";
    assert_eq!(found["rt/rig/rotary_speed_rpm"], json!([float64]));
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}
