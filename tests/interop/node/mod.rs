//! The node against a DDS program of another vendor (Cyclone DDS, Python), over loopback in a network of their own.

mod managed;
mod readers;

use crate::common::Network;
use serde_json::{Value, json};

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");

/// All outputs with their types and how a reader asks for them.
const OUTPUTS: [(&str, &str, &str); 17] = [
    ("/twin/joint_deflections", "flexdrill/msg/JointDeflections", "reliable"),
    ("/twin/contact_forces", "flexdrill/msg/ContactForces", "reliable"),
    ("/twin/whirl", "flexdrill/msg/WhirlState", "reliable"),
    ("/twin/whirl_warnings", "flexdrill/msg/WhirlWarning", "latched"),
    ("/twin/alarms", "flexdrill/msg/AlarmList", "latched"),
    ("/twin/alarm_events", "flexdrill/msg/AlarmEvent", "reliable"),
    ("/twin/ageing", "flexdrill/msg/Ageing", "reliable"),
    ("/twin/reactions", "flexdrill/msg/Reactions", "reliable"),
    ("/twin/transfer", "flexdrill/msg/Transfer", "reliable"),
    ("/twin/bit_state", "flexdrill/msg/BitState", "reliable"),
    (STATUS.0, STATUS.1, "reliable"),
    ("/twin/tool_shape", "visualization_msgs/msg/MarkerArray", "best_effort"),
    ("/twin/session", "flexdrill/msg/SessionInfo", "latched"),
    ("/joint_states", "sensor_msgs/msg/JointState", "reliable"),
    ("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable"),
    ("/tf_static", "tf2_msgs/msg/TFMessage", "latched"),
    ("/rosout", "rcl_interfaces/msg/Log", "latched"),
];
const JOINTS: usize = 6;
const STATIONS: usize = 15;

fn length(message: &Value, field: &str) -> usize {
    message[field]
        .as_array()
        .unwrap_or_else(|| panic!("{field} in {message}"))
        .len()
}

#[test]
fn inputs_go_in_and_all_outputs_come_out() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    for (topic, kind, qos) in OUTPUTS {
        peer.subscribe(topic, kind, qos);
    }
    peer.send("/rig/rotary_speed_rpm", json!(40.0));
    peer.send("/rig/weight_on_bit_kn", json!(10.0));
    // The slew limits take 2 s to 40 r/min; the inputs may be sent once only.
    std::thread::sleep(std::time::Duration::from_secs(2));
    let newest = |peer: &mut crate::common::Peer, topic: &str| {
        let messages = peer.take(topic, 1, 10.0);
        messages.last().unwrap_or_else(|| panic!("nothing on {topic}")).clone()
    };
    let joints = newest(&mut peer, "/twin/joint_deflections");
    for field in [
        "measured_depth",
        "bend_angle",
        "lateral_y",
        "spin_rate",
        "axial_force",
        "torque",
    ] {
        assert_eq!(length(&joints, field), JOINTS, "{field}");
    }
    assert_eq!(joints["header"]["frame_id"], "flexible_tool");
    let contacts = newest(&mut peer, "/twin/contact_forces");
    for field in ["state", "pipe_guide_normal_peak", "guide_wall_gap"] {
        assert_eq!(length(&contacts, field), STATIONS, "{field}");
    }
    let clearance = 0.0085 + 1e-9;
    assert!(
        contacts["pipe_guide_gap"]
            .as_array()
            .unwrap()
            .iter()
            .all(|gap| gap.as_f64().unwrap() <= clearance)
    );
    let bit = newest(&mut peer, "/twin/bit_state");
    assert!(bit["weight_on_bit"].as_f64().unwrap() > 1000.0, "{bit}");
    let status = peer.status_with(STATUS.0, |status| {
        status["input_state"] == json!([1, 1]) || status["input_state"] == json!([2, 2])
    });
    assert_eq!(status["input_name"], json!(["rotary_speed", "weight_on_bit"]));
    assert!((status["input_received"][0].as_f64().unwrap() - 40.0 * std::f64::consts::PI / 30.0).abs() < 1e-12);
    assert_eq!(status["input_received"][1], 10e3);
    assert!(
        newest(&mut peer, "/twin/session")["configuration"]
            .as_str()
            .unwrap()
            .contains("build_angle_deg: 19")
    );
    assert_eq!(newest(&mut peer, "/joint_states")["name"][0], "joint_01");
    // Z is down in the tool's frame and up in its parent: half a turn about X.
    let transform = newest(&mut peer, "/tf_static")["transforms"][0].clone();
    assert_eq!(transform["header"]["frame_id"], "map");
    assert_eq!(transform["child_frame_id"], "flexible_tool");
    assert_eq!(
        transform["transform"]["rotation"],
        json!({"x": 1.0, "y": 0.0, "z": 0.0, "w": 0.0})
    );
    let items = newest(&mut peer, "/diagnostics")["status"].clone();
    let names: Vec<&str> = items
        .as_array()
        .unwrap()
        .iter()
        .map(|item| item["name"].as_str().unwrap())
        .collect();
    let items = [
        "pacing",
        "solver",
        "inputs",
        "measured",
        "surveys",
        "configuration",
        "whirl",
        "stick-slip",
        "shock",
        "joint load",
        "transfer",
        "hole",
        "recording",
        "network",
        "alarms",
    ];
    assert_eq!(names, items.map(|item| format!("/flexdrill: {item}")));
    assert!(
        !newest(&mut peer, "/twin/tool_shape")["markers"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    assert!(newest(&mut peer, "/twin/whirl").get("whirl_rate").is_some());
    // A tool without a string has a bit and no surface; what it does not have is not a number, never zero.
    let transfer = newest(&mut peer, "/twin/transfer");
    for (field, known) in [
        ("bit_weight", true),
        ("kickoff_torque", true),
        ("surface_torque", false),
        ("hook_load", false),
    ] {
        let value = transfer
            .get(field)
            .unwrap_or_else(|| panic!("{field} is not in {transfer}"));
        assert_eq!(value.as_f64().is_some_and(f64::is_finite), known, "{field}: {value}");
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn parameters_and_services_answer_both_kinds_of_clients() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--namespace", "rig_7"]);
    twin.wait_for("model time runs");
    let node = "/rig_7/flexdrill";
    let service = |name: &str| format!("{node}/{name}");
    let double = |name: &str, value: f64| json!({"name": name, "value": {"type": 3, "double_value": value}});
    peer.subscribe("/parameter_events", "rcl_interfaces/msg/ParameterEvent", "reliable");
    let set = "rcl_interfaces/srv/SetParameters";
    let good = json!({"parameters": [double("contact.inner.friction_axial", 0.25)]});
    assert_eq!(
        peer.call(&service("set_parameters"), set, good.clone())["results"][0]["successful"],
        true
    );
    assert_eq!(
        peer.call_as_rmw_cyclone(&service("set_parameters"), set, good)["results"][0]["successful"],
        true
    );
    let events = peer.take("/parameter_events", 2, 5.0);
    assert_eq!(
        events[0]["changed_parameters"][0]["name"],
        "contact.inner.friction_axial"
    );
    assert_eq!(events[0]["node"], node);

    let refused = json!({"parameters": [
        {"name": "tool.links", "value": {"type": 2, "integer_value": 9}},
        double("contact.inner.friction_axial", -1.0),
        double("contact.inner.friction_axail", 0.1),
    ]});
    let results = peer.call_as_rmw_cyclone(&service("set_parameters"), set, refused)["results"].clone();
    let reason = |index: usize| results[index]["reason"].as_str().unwrap().to_owned();
    assert!(reason(0).contains("geometry"), "{results}");
    assert!(reason(1).contains("must be 0 to"), "{results}");
    assert!(reason(2).contains("there is no parameter"), "{results}");

    // All or nothing: the first of the two would be fine.
    let mixed =
        json!({"parameters": [double("tool.bit.friction_factor", 0.1), double("contact.outer.friction_axial", -1.0)]});
    let atomic = peer.call(
        &service("set_parameters_atomically"),
        "rcl_interfaces/srv/SetParametersAtomically",
        mixed,
    );
    assert_eq!(atomic["result"]["successful"], false);
    let names = json!({"names": ["tool.bit.friction_factor", "contact.inner.friction_axial", "use_sim_time"]});
    let values = peer.call(
        &service("get_parameters"),
        "rcl_interfaces/srv/GetParameters",
        names.clone(),
    )["values"]
        .clone();
    assert_eq!(values[0]["double_value"], 0.235);
    assert_eq!(values[1]["double_value"], 0.25);
    assert_eq!(values[2]["type"], 1);
    let described = peer.call_as_rmw_cyclone(
        &service("describe_parameters"),
        "rcl_interfaces/srv/DescribeParameters",
        names,
    )["descriptors"]
        .clone();
    // Half of its configured value: alarms depend on it.
    assert_eq!(described[1]["floating_point_range"][0]["from_value"], 0.1);
    assert_eq!(described[2]["read_only"], true);
    let listed = peer.call(
        &service("list_parameters"),
        "rcl_interfaces/srv/ListParameters",
        json!({"prefixes": ["outputs.rates"]}),
    );
    assert_eq!(length(&listed["result"], "names"), 11);

    // The logger of the node's name, as `ros2 service call` would set it.
    let logger = |level: u32| json!({"levels": [{"name": "rig_7.flexdrill", "level": level}]});
    let set = |peer: &mut crate::common::Peer, level| {
        peer.call(
            &service("set_logger_levels"),
            "rcl_interfaces/srv/SetLoggerLevels",
            logger(level),
        )["results"][0]
            .clone()
    };
    assert_eq!(set(&mut peer, 10)["successful"], true);
    let refused = set(&mut peer, 11);
    assert!(refused["reason"].as_str().unwrap().contains("20 (info)"), "{refused}");
    let names = json!({"names": ["rig_7.flexdrill"]});
    let levels = peer.call(
        &service("get_logger_levels"),
        "rcl_interfaces/srv/GetLoggerLevels",
        names,
    );
    assert_eq!(levels["levels"][0]["level"], 10, "{levels}");

    // Replies are not lost: the same question many times.
    for _ in 0..30 {
        peer.call_as_rmw_cyclone(
            &service("list_parameters"),
            "rcl_interfaces/srv/ListParameters",
            json!({"depth": 1}),
        );
    }

    let topic = "/rig_7/twin/status";
    peer.subscribe(topic, STATUS.1, "reliable");
    let trigger = "std_srvs/srv/Trigger";
    assert_eq!(
        peer.call(&service("pause"), "std_srvs/srv/SetBool", json!({"data": true}))["success"],
        true
    );
    let paused = peer.status_with(topic, |status| status["state"] == 2);
    let step = paused["step_count"].as_u64().unwrap();
    let later = peer.status_with(topic, |status| {
        status["sequence"].as_u64() > paused["sequence"].as_u64()
    });
    assert_eq!(later["step_count"], step, "time stands still");
    assert_eq!(peer.call(&service("reset"), trigger, json!({}))["success"], true);
    peer.status_with(topic, |status| status["step_count"] == 0);
    peer.call_as_rmw_cyclone(&service("pause"), "std_srvs/srv/SetBool", json!({"data": false}));
    peer.status_with(topic, |status| {
        status["state"] == 1 && status["step_count"].as_u64() > Some(0)
    });
}

/// Tools without our package learn the types from the node. The hash is made anew from what comes over the wire.
#[test]
fn types_are_described_to_both_kinds_of_clients() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let ask = |peer: &mut crate::common::Peer, name: &str, hash: &str, header: bool| {
        let kind = "type_description_interfaces/srv/GetTypeDescription";
        let request = json!({"type_name": name, "type_hash": hash, "include_type_sources": true});
        let service = "/flexdrill/get_type_description";
        if header {
            peer.call_as_rmw_cyclone(service, kind, request)
        } else {
            peer.call(service, kind, request)
        }
    };
    let inputs = [
        "std_msgs/msg/Float64",
        "flexdrill/msg/RigInputs",
        "flexdrill/msg/RigMeasured",
        "flexdrill/msg/RigSurvey",
        "rosgraph_msgs/msg/Clock",
    ];
    let outputs = OUTPUTS.map(|(_, kind, _)| kind);
    for (index, name) in inputs.into_iter().chain(outputs).enumerate() {
        let reply = ask(&mut peer, name, "", index % 2 == 0);
        assert_eq!(reply["successful"], true, "{name}: {reply}");
        let hash = reply["extra_information"][0]["value"].as_str().unwrap().to_owned();
        let again = peer.command(json!({"do": "rihs01", "description": reply["type_description"]}));
        assert_eq!(again["hash"], hash, "{name}");
        assert_eq!(flexdrill::messages::find_type(name).unwrap().rihs01, hash, "{name}");
        let parts = 1 + length(&reply["type_description"], "referenced_type_descriptions");
        assert_eq!(length(&reply, "type_sources"), parts, "{name}");
        let own = &reply["type_sources"][0];
        assert_eq!((&own["type_name"], &own["encoding"]), (&json!(name), &json!("msg")));
        assert_eq!(
            ask(&mut peer, name, &hash, index % 2 == 1)["successful"],
            true,
            "{name}"
        );
    }
    let status = ask(&mut peer, STATUS.1, "", false);
    let text = std::fs::read_to_string(crate::common::root().join("msg/TwinStatus.msg")).unwrap();
    assert_eq!(status["type_sources"][0]["raw_file_contents"], text);
    // Services too; the known hash is one that ROS 2 gives.
    let own = flexdrill::messages::find_service("flexdrill/srv/ShelveAlarm").unwrap();
    let trigger = "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f";
    for (name, hash, header) in [
        ("std_srvs/srv/Trigger", trigger, true),
        (own.ros_type, own.rihs01, false),
    ] {
        let reply = ask(&mut peer, name, hash, header);
        assert_eq!(reply["successful"], true, "{name}: {reply}");
        let again = peer.command(json!({"do": "rihs01", "description": reply["type_description"]}));
        assert_eq!(again["hash"], hash, "{name}");
        assert_eq!(reply["type_sources"][0]["encoding"], "srv", "{name}");
    }
    let other = format!("RIHS01_{}", "0".repeat(64));
    for (name, hash, words) in [
        (STATUS.1, other.as_str(), "the request is for another definition"),
        ("flexdrill/msg/Nothing", "", "knows no type 'flexdrill/msg/Nothing'"),
    ] {
        let refused = ask(&mut peer, name, hash, true);
        assert_eq!(refused["successful"], false);
        assert!(refused["failure_reason"].as_str().unwrap().contains(words), "{refused}");
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

/// No client waits for a reply that is too long to send.
#[test]
fn replies_that_are_too_long_are_answered_all_the_same() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let all = peer.call(
        "/flexdrill/list_parameters",
        "rcl_interfaces/srv/ListParameters",
        json!({}),
    );
    let names: Vec<Value> = all["result"]["names"].as_array().unwrap().clone();
    let many: Vec<Value> = names.iter().cycle().take(5 * names.len()).cloned().collect();
    let describe = "rcl_interfaces/srv/DescribeParameters";
    let once = peer.call("/flexdrill/describe_parameters", describe, json!({ "names": names }));
    assert_eq!(length(&once, "descriptors"), names.len());
    let began = std::time::Instant::now();
    for header in [false, true] {
        let request = json!({ "names": many });
        let reply = if header {
            peer.call_as_rmw_cyclone("/flexdrill/describe_parameters", describe, request)
        } else {
            peer.call("/flexdrill/describe_parameters", describe, request)
        };
        assert_eq!(length(&reply, "descriptors"), 0, "{reply}");
    }
    assert!(
        twin.wait_for("was shortened")
            .contains("service /flexdrill/describe_parameters")
    );
    // Reasons are cut; which parameters were set stays told.
    let friction = json!({"name": "contact.inner.friction_axial", "value": {"type": 3, "double_value": 0.25}});
    let wrong = json!({"name": format!("nothing.{}", "x".repeat(20)), "value": {"type": 1}});
    let parameters: Vec<&Value> = std::iter::repeat_n(&wrong, 1900).chain([&friction]).collect();
    let set = peer.call(
        "/flexdrill/set_parameters",
        "rcl_interfaces/srv/SetParameters",
        json!({ "parameters": parameters }),
    );
    assert_eq!(length(&set, "results"), 1901);
    for (index, result) in set["results"].as_array().unwrap().iter().enumerate() {
        assert_eq!(result["successful"], index == 1900, "{index}: {result}");
        let reason = result["reason"].as_str().unwrap();
        assert!(reason.is_empty() == (index == 1900) && reason.len() < 34, "{reason}");
    }
    assert!(
        began.elapsed() < std::time::Duration::from_secs(5),
        "{:?}",
        began.elapsed()
    );
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn bad_and_missing_inputs_are_told_and_survived() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.status_with(STATUS.0, |status| status["input_state"] == json!([0, 0]));
    let (speed, weight) = ("/rig/rotary_speed_rpm", "/rig/weight_on_bit_kn");
    peer.send(speed, json!(30.0));
    peer.send(weight, json!(5.0));
    for bad in [json!("NaN"), json!("Infinity"), json!(-3.0), json!(1e9)] {
        peer.send(speed, bad);
    }
    let rejected = peer.status_with(STATUS.0, |status| status["input_rejected"][0] == 4);
    assert_eq!(rejected["input_state"][0], 4);
    assert!(
        (rejected["input_received"][0].as_f64().unwrap() - std::f64::consts::PI).abs() < 1e-12,
        "the last good value is held"
    );
    assert!(
        twin.said().contains("rig/rotary_speed_rpm: NaN r/min refused"),
        "{}",
        twin.said()
    );
    // Silence: stale after 2 s, held for 0.5 s, then brought to zero.
    peer.status_with(STATUS.0, |status| status["input_state"] == json!([3, 3]));
    peer.status_with(STATUS.0, |status| status["input_applied"][1] == 0.0);
    peer.send(speed, json!(20.0));
    peer.send(weight, json!(4.0));
    peer.status_with(STATUS.0, |status| status["input_state"] == json!([1, 1]));
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}
