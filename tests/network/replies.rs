//! Requests and replies that are longer than a datagram of an Ethernet, between the twin and clients on another machine.

use std::time::{Duration, Instant};

use crate::cable::{OUTSIDE, two_machines};
use crate::common::{Network, Peer, Program};
use serde_json::{Value, json};

const LIST: &str = "rcl_interfaces/srv/ListParameters";

fn twin(inside: &Network) -> Program {
    let mut twin = inside.twin(&[]);
    twin.wait_for("model time runs");
    twin
}

fn end(mut twin: Program) {
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(!said.contains("DDS is restarted"), "{said}");
}

/// Cyclone DDS that uses the cable.
fn cyclone(outside: &Network) -> Option<Peer> {
    let settings = format!(
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"{OUTSIDE}\"/></Interfaces></General>\
         </Domain></CycloneDDS>"
    );
    outside.peer_with(&[("CYCLONEDDS_URI", &settings)])
}

/// Cyclone DDS, the layer below rmw_cyclonedds: what `ros2 param list`, `describe`, `dump` and `set` send and get.
#[test]
fn cyclone_dds_gets_replies_longer_than_a_datagram_over_ethernet() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let Some(mut peer) = cyclone(&outside) else { return };
    let twin = twin(&inside);
    let all = peer.call("/flexdrill/list_parameters", LIST, json!({}));
    let names = all["result"]["names"]
        .as_array()
        .unwrap_or_else(|| panic!("{all}"))
        .clone();
    // Far more than 1,452 bytes in either direction.
    assert!(names.len() > 200 && names.iter().map(|name| name.to_string().len()).sum::<usize>() > 4000);
    for count in [9, 60, names.len()] {
        let request = json!({"names": names[..count]});
        for as_rmw in [false, true] {
            let mut call = |service: &str, ros_type: &str| {
                let service = format!("/flexdrill/{service}");
                if as_rmw {
                    peer.call_as_rmw_cyclone(&service, ros_type, request.clone())
                } else {
                    peer.call(&service, ros_type, request.clone())
                }
            };
            let described = call("describe_parameters", "rcl_interfaces/srv/DescribeParameters");
            let descriptors = described["descriptors"].as_array().map_or(0, Vec::len);
            assert_eq!(descriptors, count, "as rmw: {as_rmw}");
            assert_eq!(described["descriptors"][count - 1]["name"], names[count - 1]);
            let values = call("get_parameters", "rcl_interfaces/srv/GetParameters");
            assert_eq!(values["values"].as_array().map_or(0, Vec::len), count);
        }
    }
    let wrong = |index: usize| json!({"name": format!("nothing.{index}"), "value": {"type": 1}});
    let parameters: Vec<Value> = (0..100).map(wrong).collect();
    let set = peer.call(
        "/flexdrill/set_parameters",
        "rcl_interfaces/srv/SetParameters",
        json!({ "parameters": parameters }),
    );
    let results = set["results"].as_array().unwrap_or_else(|| panic!("{set}"));
    assert!(
        results.len() == 100 && results.iter().all(|result| result["successful"] == false),
        "{set}"
    );
    end(twin);
}

/// Fast DDS, the layer below rmw_fastrtps, which finds its reply by the inline QoS alone.
#[test]
fn fast_dds_gets_replies_longer_than_a_datagram_over_ethernet() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let Some(mut peer) = outside.fast_peer() else { return };
    let twin = twin(&inside);
    for _ in 0..3 {
        // No prefixes, and a depth of 0: all names.
        let listed = peer.command(json!({
            "do": "call", "service": "/flexdrill/list_parameters", "type": LIST, "zeros": 16,
        }));
        assert!(listed["reply"]["bytes"].as_u64() > Some(4000), "{listed}");
    }
    end(twin);
}

/// Messages longer than a datagram in both directions, to both layers: outputs, the latched list of alarms, the event of many
/// parameters that change at once, and an input with a long text.
#[test]
fn messages_longer_than_a_datagram_go_both_ways_over_ethernet() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let (Some(mut peer), Some(mut fast)) = (cyclone(&outside), outside.fast_peer()) else {
        return;
    };
    let twin = twin(&inside);
    for (topic, kind, qos) in [
        ("/twin/status", "flexdrill/msg/TwinStatus", "reliable"),
        ("/twin/contact_forces", "flexdrill/msg/ContactForces", "reliable"),
        ("/twin/tool_shape", "visualization_msgs/msg/MarkerArray", "best_effort"),
        ("/twin/alarms", "flexdrill/msg/AlarmList", "latched"),
        ("/parameter_events", "rcl_interfaces/msg/ParameterEvent", "reliable"),
    ] {
        peer.subscribe(topic, kind, qos);
    }
    peer.status_with("/twin/status", |status| status["state"] == 1);
    for topic in ["/twin/contact_forces", "/twin/tool_shape", "/twin/alarms"] {
        let heard = peer.take(topic, 1, 10.0);
        let length = heard
            .last()
            .unwrap_or_else(|| panic!("nothing on {topic}"))
            .to_string()
            .len();
        assert!(length > 1452, "{topic}: {length} characters");
    }
    fast.subscribe("/twin/status", "flexdrill/msg/TwinStatus", "reliable");
    fast.status_with("/twin/status", |status| status["state"] == 1);

    let all = peer.call("/flexdrill/list_parameters", LIST, json!({}));
    let names = all["result"]["names"].as_array().unwrap().clone();
    let live = [
        "outputs.rates.",
        "inputs.rotary_speed.max_age",
        "whirl.backward_cycles.",
    ];
    let request = json!({ "names": names });
    let values = peer.call("/flexdrill/get_parameters", "rcl_interfaces/srv/GetParameters", request);
    let doubles = names
        .iter()
        .zip(values["values"].as_array().unwrap())
        .filter(|(name, value)| {
            let name = name.as_str().unwrap();
            value["type"] == 3 && live.iter().any(|group| name.starts_with(group))
        });
    // The present values: accepted, and told as one event.
    let parameters: Vec<Value> = doubles
        .map(|(name, value)| json!({"name": name, "value": {"type": 3, "double_value": value["double_value"]}}))
        .collect();
    peer.take("/parameter_events", 1000, 0.0);
    let set = peer.call(
        "/flexdrill/set_parameters_atomically",
        "rcl_interfaces/srv/SetParametersAtomically",
        json!({ "parameters": parameters }),
    );
    assert_eq!(set["result"]["successful"], true, "{set}");
    let event = peer.take("/parameter_events", 1, 10.0);
    let changed = event.last().expect("an event")["changed_parameters"]
        .as_array()
        .unwrap()
        .len();
    assert_eq!(changed, parameters.len());
    assert!(event.last().unwrap().to_string().len() > 1452, "{event:?}");

    // A text of two kilobytes: three fragments towards the twin.
    let now = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .unwrap();
    peer.command(json!({
        "do": "publish", "topic": "/rig/inputs", "type": "flexdrill/msg/RigInputs",
        "value": {
            "header": {"stamp": {"sec": now.as_secs(), "nanosec": now.subsec_nanos()}, "frame_id": "x".repeat(4000)},
            "rotary_speed_rpm": 37.0, "weight_on_bit_kn": 5.0, "quality": 0, "source": "long", "given": 3,
        },
    }));
    let turned = 37.0 * std::f64::consts::PI / 30.0;
    peer.status_with("/twin/status", |status| {
        status["input_received"][0]
            .as_f64()
            .is_some_and(|speed| (speed - turned).abs() < 1e-9)
    });
    end(twin);
}

/// The rig page's server on the other machine: it shows the twin's parameters, and its question to the look-ahead, whose
/// result with four candidates is longer than a datagram, is answered.
#[test]
fn the_dashboard_on_another_machine_asks_and_is_answered() {
    let Some((inside, outside)) = two_machines() else {
        return;
    };
    let twin = twin(&inside);
    let folder = tempfile::tempdir().unwrap();
    let token = folder.path().join("token");
    std::fs::write(&token, "0123456789abcdef").unwrap();
    // Only its owner may read it.
    std::fs::set_permissions(&token, std::os::unix::fs::PermissionsExt::from_mode(0o600)).unwrap();
    let mut command = outside.command(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .args(["dashboard", "--allow-control", "--token-file"])
        .arg(&token);
    let mut server = Program::start(command);
    server.wait_for("dashboard at");
    let root = "http://127.0.0.1:8080";
    let until = |path: &str, seconds: u64, condition: &dyn Fn(&Value) -> bool| {
        let deadline = Instant::now() + Duration::from_secs(seconds);
        loop {
            let answer = outside.http("GET", &format!("{root}{path}"), &[], "").expect("Python");
            if condition(&answer["body"]) {
                return answer["body"].clone();
            }
            assert!(Instant::now() < deadline, "{path}: {answer}");
            std::thread::sleep(Duration::from_millis(200));
        }
    };
    until("/api/session", 30, &|session| !session["limits"].is_null());
    let candidates: Vec<Value> = [30.0, 50.0, 70.0, 90.0]
        .map(|rpm| json!({"rotary_speed_rpm": rpm, "weight_on_bit_kn": 5.0}))
        .into();
    let question = json!({"operator": "Kim", "candidates": candidates, "horizon": 10.0, "members": 1});
    let bearer = "Authorization=Bearer 0123456789abcdef";
    let asked = outside
        .http(
            "POST",
            &format!("{root}/api/control/what_if"),
            &[bearer],
            &question.to_string(),
        )
        .unwrap();
    assert_eq!(asked["code"], 200, "{asked}");
    // A busy machine gets minutes for idle work.
    let answered = until("/api/what_if", 240, &|asked| asked["running"] == false);
    assert_eq!(answered["failed"], false, "{answered}");
    assert_eq!(answered["answers"].as_array().map_or(0, Vec::len), 4, "{answered}");
    server.signal("INT");
    assert_eq!(server.end(), Some(0), "{}", server.said());
    end(twin);
}
