//! A run that is judged by a map of speed and weight: its replay has that map and the same alarm, without the map's
//! file.

use std::path::Path;
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::{AlarmEvent, Message as _};

fn succeeds(arguments: &[&Path]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Topic, time (ns) and bytes of a message.
type Recorded = (String, i64, Vec<u8>);

/// The messages of a bag that have the map or an event of an alarm, and the events of `known_window`.
fn judged(path: &Path) -> (Vec<Recorded>, Vec<AlarmEvent>) {
    let (mut messages, mut events) = (Vec::new(), Vec::new());
    for message in bag::open(path).unwrap().map(Result::unwrap) {
        if message.topic.ros_type == AlarmEvent::ROS_TYPE {
            events.push(message.decode::<AlarmEvent>().unwrap());
        } else if !message.topic.is("twin/safe_window") {
            continue;
        }
        messages.push((message.topic.name.clone(), message.log_time, message.data.to_vec()));
    }
    events.retain(|event| event.id == "known_window");
    (messages, events)
}

#[test]
fn a_replay_judges_by_the_map_of_the_recorded_run() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let small = crate::common::small_config();
    let map = "map SMALL --rpm 40:80 --wob 2:6 --grid 2x2 --share 100 --horizon 10 --members 1 --jobs 2 --out MAP";
    let place = at("map");
    let words = map.split(' ').map(|word| match word {
        "SMALL" => small.as_path(),
        "MAP" => place.as_path(),
        word => Path::new(word),
    });
    succeeds(&words.collect::<Vec<_>>());
    // A relative path is relative to the folder of the configuration.
    let text = std::fs::read_to_string(&small).unwrap();
    std::fs::write(at("tool.yaml"), format!("{text}\nmap: {{file: map/map.json}}\n")).unwrap();
    // On the map, then with more weight than it has, for longer than the alarm's delay of 5 s.
    let rows = (0..16).map(|second| format!("{second},60,{}\n", if second < 3 { 4 } else { 14 }));
    let rows: String = std::iter::once("time_s,rpm,wob\n".to_owned()).chain(rows).collect();
    std::fs::write(at("log.csv"), rows).unwrap();
    std::fs::write(
        at("mapping.yaml"),
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n",
    )
    .unwrap();
    let [replay, with_config, with_mapping, to] = ["replay", "--config", "--mapping", "--out"].map(Path::new);
    let (log, mapping, config, run) = (at("log.csv"), at("mapping.yaml"), at("tool.yaml"), at("run"));
    succeeds(&[replay, &log, with_mapping, &mapping, with_config, &config, to, &run]);
    let (messages, events) = judged(&run);
    assert_eq!(messages[0].0, "/twin/safe_window");
    let raised = events.iter().find(|event| event.change == AlarmEvent::ACTIVATED);
    let evidence = &raised.expect("an alarm off the map").evidence;
    assert!(evidence.starts_with("Weight on bit beyond the map"), "{evidence}");

    std::fs::remove_dir_all(at("map")).unwrap();
    let said = succeeds(&[replay, &run, to, &at("again")]);
    assert!(!said.contains("not exact"), "{said}");
    assert!(judged(&at("again")).0 == messages, "another map or other alarms");
}
