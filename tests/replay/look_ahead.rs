//! A log through a twin that looks ahead: advice and forecasts in its replay.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use flexdrill::bag;
use flexdrill::messages::{Alarm, AlarmList, Forecast, Message, from_cdr};

/// A short tool whose bit swings by 1 % under 10 kN and by 2.5 % under 20 kN, with a stick-slip alarm between, and plausible
/// tools of other friction.
const TOOL: &str = "\
well: {start_inclination_deg: 70, sections: [{arc: {radius: 6.4, build_angle_deg: 6}}], hole_diameter: 0.118}
tool:
  links: 4
  elements_per_link: 1
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6.0}
  bit: {diameter: 0.118}
environment: {gravity: 100}
solver: {time_step: 0.002, step: fixed}
stick_slip:
  {window: 3.0, hysteresis: 1.0e-9, hold_off: 0.0, levels: {watch: 0.018, warning: 0.02, critical: 9.0}}
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial, contact.outer.friction_tangential, contact.outer.friction_axial]
      distribution: {uniform: {low: 0.2, high: 0.4}}
      source: a test
ensemble: {members: 8}
";
/// Length of the log (s), and when its weight rises: plausible tools are looked ahead from once they have run for a minute.
const SECONDS: u32 = 80;
const RISES: u32 = 64;

fn flexdrill(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Replays the log with these keys of `look_ahead` into a bag of this name.
fn replayed(folder: &Path, name: &str, keys: &str, options: &[&str]) -> Output {
    std::fs::write(folder.join("tool.yaml"), format!("{TOOL}look_ahead: {{{keys}}}\n")).unwrap();
    let log = [
        "replay",
        "log.csv",
        "--mapping",
        "mapping.yaml",
        "--config",
        "tool.yaml",
        "--out",
        name,
    ];
    flexdrill(folder, &[&log[..], options].concat())
}

/// The messages of a bag by topic, with their times (ns).
fn messages(bag: &Path) -> BTreeMap<String, Vec<(i64, Vec<u8>)>> {
    let mut found: BTreeMap<String, Vec<_>> = BTreeMap::new();
    for message in bag::open(bag).unwrap().map(Result::unwrap) {
        let of = found.entry(message.topic.name.clone()).or_default();
        of.push((message.log_time, message.data.to_vec()));
    }
    found
}

fn decoded<M: Message>(messages: &[(i64, Vec<u8>)]) -> impl Iterator<Item = M> {
    messages.iter().map(|(_, bytes)| from_cdr(bytes).unwrap())
}

/// A folder with the log.
fn log() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let weight = |second| if second < RISES { 10 } else { 20 };
    let rows: String = (0..SECONDS)
        .map(|second| format!("{second},60,{}\n", weight(second)))
        .collect();
    std::fs::write(folder.path().join("log.csv"), format!("time_s,rpm,wob\n{rows}")).unwrap();
    std::fs::write(
        folder.path().join("mapping.yaml"),
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n",
    )
    .unwrap();
    folder
}

const ASKED: &str = "advice: true, forecast: true, forecast_members: 2";

#[test]
fn a_replay_that_looks_ahead_has_advice_and_forecasts_the_same_each_time() {
    let folder = log();
    let at = |name: &str| folder.path().join(name);
    let of = |name: &str, threads: u32, options: &[&str]| {
        let output = replayed(folder.path(), name, &format!("{ASKED}, threads: {threads}"), options);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        (said, messages(&at(name)))
    };
    let (said, ahead) = of("ahead", 1, &["--look-ahead"]);
    // One search, by plausible tools, once the new weight counts as set; none for the weight before.
    let lines: Vec<&str> = said
        .lines()
        .filter(|line| line.contains("advice on stick-slip"))
        .collect();
    let [line] = lines[..] else { panic!("{said}") };
    assert!(
        line.contains("Lower the weight on bit to") && line.contains("(20 kN now)"),
        "{line}"
    );
    assert!(line.contains("plausible tools."), "{line}");
    let sentence = &line[line.find("Lower").unwrap()..];
    let lists: Vec<AlarmList> = decoded(&ahead["/twin/alarms"]).collect();
    let stick_slip = |list: &AlarmList| -> Alarm {
        list.alarms
            .iter()
            .find(|alarm| alarm.id == "stick_slip")
            .unwrap()
            .clone()
    };
    let last = stick_slip(lists.last().unwrap());
    assert!(
        last.active && last.what_to_do.starts_with(sentence),
        "{}: {sentence}",
        last.what_to_do
    );
    // A forecast every half minute: the first from the twin alone, the last from plausible tools, with all its seconds.
    let forecasts: Vec<Forecast> = decoded(&ahead["/twin/forecast"]).collect();
    let with_bands: Vec<&Forecast> = forecasts.iter().filter(|forecast| !forecast.bands.is_empty()).collect();
    assert_eq!(with_bands.len(), 3, "{forecasts:?}");
    assert_eq!([with_bands[0].tools, with_bands[2].tools], [0, 2]);
    assert!(
        with_bands
            .iter()
            .all(|forecast| forecast.members == 2 && forecast.bands[0].p5.len() == 60)
    );
    // The one that the change overtook is given up.
    assert!(
        forecasts
            .iter()
            .any(|forecast| forecast.failure.contains("20.0 kN are asked for now")),
        "{forecasts:?}"
    );

    let (_, again) = of("again", 2, &["--look-ahead"]);
    let (_, without) = of("without", 1, &[]);
    assert!(!without.contains_key("/twin/forecast"));
    for (topic, messages) in &ahead {
        // The session has the configuration, which says how many threads look ahead.
        if topic != "/twin/session" {
            assert!(
                again[topic] == *messages,
                "{topic} differs with another number of threads"
            );
        }
        // The motion is that of a replay that does not look ahead.
        if !["/twin/forecast", "/twin/alarms", "/twin/alarm_events"].contains(&topic.as_str()) {
            assert!(without[topic] == *messages, "{topic} differs without the look-ahead");
        }
    }
}

#[test]
fn a_look_ahead_that_the_configuration_does_not_ask_for_is_refused() {
    let folder = log();
    let output = replayed(folder.path(), "none", "threads: 1", &["--look-ahead"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(!folder.path().join("none").exists());
    assert!(
        said.contains("set look_ahead.advice or look_ahead.forecast to true"),
        "{said}"
    );
}
