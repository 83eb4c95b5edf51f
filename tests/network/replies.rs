//! Requests and replies that are longer than a datagram of an Ethernet, between the twin and clients on another machine.

use crate::cable::{OUTSIDE, two_machines};
use crate::common::{Network, Program};
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

/// Cyclone DDS, the layer below rmw_cyclonedds: what `ros2 param list`, `describe`, `dump` and `set` send and get.
#[test]
fn cyclone_dds_gets_replies_longer_than_a_datagram_over_ethernet() {
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
