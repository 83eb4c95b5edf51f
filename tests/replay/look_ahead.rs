//! A log through a twin that looks ahead: advice and forecasts in its replay.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use flexdrill::bag;
use flexdrill::messages::{AlarmList, Forecast, Message as _};

/// A short tool whose pipe whirls backwards at 120 r/min, and whirls no more at half of it, with plausible tools of other
/// friction.
const TOOL: &str = "\
well: {sections: [{arc: {radius: 3.2, build_angle_deg: 19}}], hole_diameter: 0.118}
tool:
  links: 7
  elements_per_link: 2
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6.0}
  bit: {diameter: 0.118}
contact: {inner: {friction_tangential: 0.7, friction_axial: 0.7}}
solver: {time_step: 0.0005}
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial]
      distribution: {uniform: {low: 0.6, high: 0.8}}
      source: a test
ensemble: {members: 8}
";

fn flexdrill(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// What a replay says of the look-ahead, and its messages by topic.
type Replayed = (String, BTreeMap<String, Vec<(i64, Vec<u8>)>>);

/// Replays the log with these keys of `look_ahead`.
fn replayed(folder: &Path, keys: &str, options: &[&str]) -> Replayed {
    std::fs::write(folder.join("tool.yaml"), format!("{TOOL}look_ahead: {{{keys}}}\n")).unwrap();
    let out = folder.join(format!("run_{}", std::fs::read_dir(folder).unwrap().count()));
    let out = out.to_str().unwrap();
    let log = ["replay", "log.csv", "--mapping", "mapping.yaml", "--config", "tool.yaml", "--out", out];
    let output = flexdrill(&[&log[..], options].concat(), folder);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let mut messages: BTreeMap<String, Vec<_>> = BTreeMap::new();
    for message in bag::open(Path::new(out)).unwrap().map(Result::unwrap) {
        // The configuration differs in what is asked of the look-ahead.
        if message.topic.is("twin/session") {
            continue;
        }
        let of = messages.entry(message.topic.name.clone()).or_default();
        of.push((message.log_time, message.data.to_vec()));
    }
    (said, messages)
}

/// The newest message of a topic.
fn newest<M: flexdrill::messages::Message>(replayed: &Replayed, topic: &str) -> M {
    let (_, bytes) = replayed.1[topic].last().unwrap();
    flexdrill::messages::from_cdr(bytes).unwrap()
}

#[test]
fn a_replay_that_looks_ahead_has_advice_and_forecasts_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rows: String = (0..90).map(|second| format!("{second},120,10\n")).collect();
    std::fs::write(folder.join("log.csv"), format!("time_s,rpm,wob\n{rows}")).unwrap();
    std::fs::write(
        folder.join("mapping.yaml"),
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n",
    )
    .unwrap();
    let asked = "advice: true, forecast: true, forecast_members: 2";
    let alone = replayed(folder, &format!("{asked}, threads: 1"), &["--look-ahead"]);
    let again = replayed(folder, &format!("{asked}, threads: 2"), &["--look-ahead"]);
    let without = replayed(folder, asked, &[]);
    println!("{}", alone.0);
    // Half a minute apart, from when the set point is known to the end.
    let forecasts = &alone.1["/twin/forecast"];
    println!("{} forecasts", forecasts.len());
    let newest_forecast: Forecast = newest(&alone, "/twin/forecast");
    println!("{:?}", newest_forecast.tools);
    let list: AlarmList = newest(&alone, "/twin/alarms");
    println!("{:?}", list.alarms.iter().filter(|alarm| alarm.active).map(|alarm| (&alarm.id, &alarm.what_to_do)).collect::<Vec<_>>());
    assert_eq!(alone.1.keys().collect::<Vec<_>>(), again.1.keys().collect::<Vec<_>>());
    for (topic, messages) in &alone.1 {
        assert!(again.1[topic] == *messages, "{topic} differs with another number of threads");
        let motion = !["/twin/forecast", "/twin/alarms", "/twin/alarm_events"].contains(&topic.as_str());
        assert!(!motion || without.1[topic] == *messages, "{topic} differs without the look-ahead");
    }
    assert!(!without.1.contains_key("/twin/forecast"));
}

#[test]
fn a_look_ahead_that_the_configuration_does_not_ask_for_is_refused() {}
