//! A map of the tool in the node: latched on `twin/safe_window`, an alarm where the present point is outside, and refused
//! where it belongs to another configuration.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::common::{Network, Peer, Program, small_config};
use flexdrill::messages::{Alarm, SafeWindow};
use serde_json::{Value, json};

const WINDOW: (&str, &str) = ("/twin/safe_window", "flexdrill/msg/SafeWindow");
const ALARMS: (&str, &str) = ("/twin/alarms", "flexdrill/msg/AlarmList");

/// A map of the short tool, 40 and 80 r/min by 2 and 6 kN, made as a user makes it.
pub(crate) fn made(folder: &Path) {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("map")
        .arg(small_config())
        .args(["--rpm", "40:80", "--wob", "2:6", "--grid", "2x2", "--share", "100"])
        .args(["--horizon", "10", "--members", "1", "--jobs", "2", "--out"])
        .arg(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The node with the short tool's configuration, changed, and a map.
fn twin(network: &Network, folder: &Path, change: (&str, &str), map: &str) -> Program {
    let text = std::fs::read_to_string(small_config()).unwrap();
    assert!(text.contains(change.0));
    let file = folder.join("twin.yaml");
    let text = text.replace(change.0, change.1);
    std::fs::write(&file, format!("{text}\nmap: {{file: {map}}}\n")).unwrap();
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--config"]).arg(&file);
    Program::start(command)
}

/// Sends speed and weight until `known_window` is as wanted.
fn drilled(peer: &mut Peer, rpm: f64, kn: f64, wanted: impl Fn(&Value) -> bool) -> Value {
    let limit = Instant::now() + Duration::from_secs(60);
    let mut last = Value::Null;
    while Instant::now() < limit {
        peer.send("/rig/rotary_speed_rpm", json!(rpm));
        peer.send("/rig/weight_on_bit_kn", json!(kn));
        for list in peer.take(ALARMS.0, 1, 0.4) {
            let alarms = list["alarms"].as_array().unwrap();
            let found = alarms.iter().find(|alarm| alarm["id"] == "known_window");
            last = found.unwrap().clone();
            if wanted(&last) {
                return last;
            }
        }
    }
    panic!("known_window is not as it should be; the last: {last}");
}

#[test]
fn a_map_is_latched_and_the_alarm_stands_while_the_point_is_off_it() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    made(&folder.path().join("map"));
    // A relative path is relative to the folder of the configuration.
    let mut twin = twin(&network, folder.path(), ("run:", "run:"), "map/map.json");
    twin.wait_for("model time runs");

    peer.subscribe(WINDOW.0, WINDOW.1, "latched");
    let heard = peer.take(WINDOW.0, 1, 20.0);
    let window = heard.first().expect("a map");
    assert_eq!(window["rotary_speed_rpm"], json!([40.0, 80.0]));
    assert_eq!(window["weight_on_bit_kn"], json!([2.0, 6.0]));
    // Calm drilling: a short tool at low speed and weight has no alarm in any cell.
    assert_eq!(window["verdict"], json!(vec![SafeWindow::CLEAR; 4]), "{window}");
    assert_eq!(window["was_run"], json!(vec![true; 4]));

    peer.subscribe(ALARMS.0, ALARMS.1, "latched");
    // On the map, half a cell beyond its last values at most.
    let quiet = drilled(&mut peer, 60.0, 4.0, |alarm| alarm["state"] == Alarm::NORMAL);
    assert_eq!(quiet["priority"], Alarm::NO_PRIORITY, "{quiet}");
    // Off it by more.
    let off = drilled(&mut peer, 60.0, 14.0, |alarm| {
        alarm["state"] == Alarm::ACTIVE_UNACKNOWLEDGED
    });
    let evidence = off["evidence"].as_str().unwrap();
    assert!(
        evidence.starts_with("Weight on bit beyond the map") && evidence.contains("6 kN"),
        "{off}"
    );
    assert_eq!(off["priority"], Alarm::LOW, "{off}");
    assert!(!off["what_to_do"].as_str().unwrap().is_empty(), "{off}");
    // The advice followed ends it.
    drilled(&mut peer, 60.0, 6.0, |alarm| {
        [Alarm::NORMAL, Alarm::RETURNED_UNACKNOWLEDGED]
            .map(Value::from)
            .contains(&alarm["state"])
    });
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn a_map_of_another_tool_or_none_is_refused_in_words() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    made(&folder.path().join("map"));
    std::fs::write(folder.path().join("damaged.json"), "{\"format\": 1").unwrap();
    for (change, map, words) in [
        (
            ("links: 7", "links: 6"),
            "map/map.json",
            "a map of another tool or configuration",
        ),
        (("links: 7", "links: 7"), "map/none.json", "none.json"),
        (("links: 7", "links: 7"), "damaged.json", "damaged.json"),
    ] {
        let mut twin = twin(&network, folder.path(), change, map);
        assert_ne!(twin.end(), Some(0), "{map}");
        let said = twin.said();
        assert!(said.contains("map.file") && said.contains(words), "{said}");
    }
}
