//! `twin/hole_ahead` of a run and of its replay: the same bytes, with an answer among them.

use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::{Alarm, AlarmEvent, HoleAhead};

/// The paper's tool with a soft guide of a known shape, after 70 degrees of its arc.
pub(crate) const TOOL: &str = include_str!("../data/hole_ahead.yaml");

/// What a command that succeeds says.
pub(crate) fn succeeds(arguments: &[&Path]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    let said = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(output.status.success(), "{}", said.concat());
    said.concat()
}

/// What a replay that succeeds says.
pub(crate) fn replayed(arguments: &[&Path]) -> String {
    succeeds(&[&[Path::new("replay")], arguments].concat())
}

/// Time and bytes of each message of a topic.
pub(crate) fn messages(of: &Path, topic: &str) -> Vec<(i64, Vec<u8>)> {
    let messages = bag::open(of).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.topic.is(topic))
        .map(|message| (message.log_time, message.data.clone()))
        .collect()
}

/// A plan that continues the hole as an arc with a radius (m), over a length (m).
fn planned(radius: f64, length: f64) -> String {
    let end = 70.0 + (length / radius).to_degrees();
    let rows = [(0.0, 0.0), (1.117010, 0.0), (5.026548, 70.0), (5.026548 + length, end)];
    let station =
        |(depth, inclination)| format!("{{measured_depth: {depth}, inclination_deg: {inclination}, azimuth_deg: 0}}");
    let stations = rows.map(station).join(", ");
    TOOL.replace(
        "  hole_diameter",
        &format!("  plan: {{stations: [{stations}]}}\n  hole_diameter"),
    )
}

/// A run of a tool under 10 kN at 60 r/min over some seconds, with a rate of penetration (m/h): its bag.
pub(super) fn run(folder: &Path, tool: &str, seconds: u32, rate: u32) -> PathBuf {
    let at = |name: &str| -> PathBuf { folder.join(name) };
    std::fs::write(at("tool.yaml"), tool).unwrap();
    // 10 kN within a second; the answer for it is asked for at 6 s and used from 11 s on.
    let rows = (0..seconds).map(|second| format!("{second},60,10,{rate}\n"));
    let rows: String = std::iter::once("time_s,rpm,wob,rop\n".to_owned()).chain(rows).collect();
    std::fs::write(at("log.csv"), rows).unwrap();
    std::fs::write(
        at("mapping.yaml"),
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n  rate_of_penetration: {column: rop, unit: m/h}\n",
    )
    .unwrap();
    let [config, mapping, to] = ["--config", "--mapping", "--out"].map(Path::new);
    let (tool, log, columns) = (at("tool.yaml"), at("log.csv"), at("mapping.yaml"));
    replayed(&[&log, mapping, &columns, config, &tool, to, &at("run")]);
    at("run")
}

/// The events of the alarm on the plan.
fn events(of: &Path) -> Vec<AlarmEvent> {
    let messages = bag::open(of).unwrap().map(Result::unwrap);
    let events = messages.filter(|message| message.topic.is("twin/alarm_events"));
    let events = events.map(|message| flexdrill::messages::from_cdr::<AlarmEvent>(&message.data).unwrap());
    events.filter(|event| event.id == "hole_leaves_plan").collect()
}

/// The closed form has 3.145 m for this tool: a well that is planned so is quiet.
#[test]
fn a_replay_repeats_where_the_tool_drills() {
    let folder = tempfile::tempdir().unwrap();
    let first = run(folder.path(), &planned(3.145, 5.5), 24, 0);
    let to = Path::new("--out");
    let second = folder.path().join("again");
    replayed(&[&first, to, &second]);
    let [run, again] = [&first, &second].map(|of| messages(of, "twin/hole_ahead"));
    assert!(run.len() >= 15, "{} messages", run.len());
    assert!(run == again, "other messages");
    assert!(events(&first).is_empty(), "{:?}", events(&first));

    let all: Vec<HoleAhead> = run
        .iter()
        .map(|(_, data)| flexdrill::messages::from_cdr(data).unwrap())
        .collect();
    let last = all.last().unwrap();
    assert!(last.known, "{}", last.because);
    assert!(!all[0].known && all[0].build_rate.is_nan() && !all[0].because.is_empty());
    // The statics and the twin differ by 2 % in the cases of docs/hole_ahead.md; a message takes up to 5 % for known.
    assert!(
        (last.side_force_low / last.side_force_low_at_rest - 1.0).abs() < 0.05,
        "{last:?}"
    );
    assert!(
        (last.weight_on_bit / 10e3 - 1.0).abs() < 0.01 && last.turns >= 4,
        "{last:?}"
    );
    assert!(
        (last.radius_any_bit_low..last.radius_any_bit_high).contains(&last.radius),
        "{last:?}"
    );
    assert!(last.plan_off < 0.9 && last.plan_weight.is_nan(), "{last:?}");
    assert_eq!(last.plan_high.len(), last.measured_depths.len());
}

/// No bit makes this guide drill a radius outside 2.37 to 4.33 m (docs/hole_ahead.md). A replay has the same event.
#[test]
fn a_plan_that_the_guide_cannot_drill_has_an_alarm() {
    let folder = tempfile::tempdir().unwrap();
    let first = run(folder.path(), &planned(2.0, 3.0), 24, 0);
    let to = Path::new("--out");
    let second = folder.path().join("again");
    replayed(&[&first, to, &second]);
    let [event] = &events(&first)[..] else {
        panic!("{:?}", events(&first))
    };
    assert_eq!((event.change, event.priority), (AlarmEvent::ACTIVATED, Alarm::MEDIUM));
    assert!(
        event.evidence.contains("the plan needs a radius of 2.00 m"),
        "{}",
        event.evidence
    );
    assert!(
        event
            .what_to_do
            .starts_with("This guide cannot drill the plan at any weight."),
        "{}",
        event.what_to_do
    );
    let [again] = &events(&second)[..] else {
        panic!("{:?}", events(&second))
    };
    // By bytes: values that an alarm does not have are not equal to themselves.
    assert!(flexdrill::messages::to_cdr(event).unwrap() == flexdrill::messages::to_cdr(again).unwrap());
}
