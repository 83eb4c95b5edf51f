//! `rig/measured` of a field log against the twin, and the parameters that follow it, through `flexdrill replay`. The
//! simulated rig is the twin with 1.3 times the friction.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill::messages::{Alarm, AlarmEvent, AppliedInputs, Bands, Message, Residuals, SessionInfo, Transfer};
use flexdrill_config::Config;

/// Friction of the rig over that of the twin.
const TRUTH: f64 = 1.3;
/// Seconds of the log: off bottom up to [`DRILLS`], then drilling.
const SECONDS: u32 = 80;
const DRILLS: u32 = 20;

/// What the program says of a replay that succeeds.
fn replay(input: &Path, out: &Path, config: Option<&Path>, more: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    command.arg("replay").arg(input).arg("--out").arg(out).args(more);
    if let Some(config) = config {
        command.arg("--config").arg(config);
    }
    let output = command.output().unwrap();
    let said = [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat();
    assert!(output.status.success(), "{said}");
    said
}

/// Messages of a topic in a bag.
fn messages<M: Message>(path: &Path, topic: &str) -> Vec<M> {
    let all = flexdrill::bag::open(path).unwrap().map(Result::unwrap);
    all.filter(|message| message.topic.is(topic))
        .map(|message| message.decode().unwrap())
        .collect()
}

/// The bytes of a bag by topic, without the topics in `left_out`.
fn bytes(path: &Path, left_out: &[&str]) -> BTreeMap<String, Vec<Vec<u8>>> {
    let mut found: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    for message in flexdrill::bag::open(path).unwrap().map(Result::unwrap) {
        if !left_out.iter().any(|name| message.topic.is(name)) {
            found.entry(message.topic.name.clone()).or_default().push(message.data);
        }
    }
    found
}

/// The heavy tool with other values, as a file.
fn config(folder: &Path, name: &str, values: &[(&str, serde_json::Value)]) -> PathBuf {
    let config = Config::load(crate::common::root().join("tests/data/heavy.yaml")).unwrap();
    let config = config.with_values("a test", values.iter().cloned()).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, config.to_yaml().unwrap()).unwrap();
    path
}

/// A log at 1 Hz with its mapping, in a folder of its own. `torque` gives the surface torque of a second (N m), or nothing
/// for a log without that column.
fn log(folder: &Path, name: &str, seconds: u32, torque: Option<&dyn Fn(u32) -> f64>) -> PathBuf {
    let folder = folder.join(name);
    std::fs::create_dir(&folder).unwrap();
    let mut text = String::from(if torque.is_some() {
        "t,rpm,wob,torque\n"
    } else {
        "t,rpm,wob\n"
    });
    for second in 0..seconds {
        let weight = if second < DRILLS { 0 } else { 10 };
        write!(text, "{second},60,{weight}").unwrap();
        if let Some(torque) = torque {
            write!(text, ",{:.4}", torque(second) / 1000.0).unwrap();
        }
        text.push('\n');
    }
    let mut mapping = String::from(
        "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit:\n    direct: {column: wob, unit: kN}\n",
    );
    if torque.is_some() {
        mapping += "  torque: {column: torque, unit: kN.m}\n";
    }
    std::fs::write(folder.join("mapping.yaml"), mapping).unwrap();
    std::fs::write(folder.join("rig.csv"), text).unwrap();
    folder.join("rig.csv")
}

/// Torque of the simulated rig by second, with a ripple of a newton metre as its sensor's noise.
fn rig(folder: &Path) -> impl Fn(u32) -> f64 {
    let rig = config(folder, "rig.yaml", &[("calibration.friction_factor", TRUTH.into())]);
    let bag = folder.join("rig.bag");
    replay(&log(folder, "inputs", SECONDS, None), &bag, Some(&rig), &[]);
    let all: Vec<Transfer> = messages(&bag, "twin/transfer");
    let torques: Vec<f64> = all
        .iter()
        .step_by(10) // Nothing is known at the first instant.
        .map(|transfer| {
            if transfer.duration > 0.0 {
                transfer.kickoff_torque
            } else {
                0.0
            }
        })
        .collect();
    move |second| {
        let noise = (f64::from(second) * 2.4).sin() * std::f64::consts::SQRT_2;
        torques.get(second as usize).or(torques.last()).unwrap() + noise
    }
}

/// The surface torque of a comparison.
fn ratio(message: &Residuals) -> f64 {
    message
        .residuals
        .iter()
        .find(|of| of.name == "surface_torque")
        .unwrap()
        .ratio
}

fn disagreed(bag: &Path) -> Vec<(u8, u8)> {
    let events: Vec<AlarmEvent> = messages(bag, "twin/alarm_events");
    let of_rig = events.into_iter().filter(|event| event.id == "rig_disagrees");
    let of_state = of_rig.filter(|event| event.change != AlarmEvent::ADJUSTED);
    of_state.map(|event| (event.change, event.priority)).collect()
}

/// Reasons of the entries in the journal that say what was adjusted.
fn adjusted(bag: &Path) -> Vec<String> {
    let events: Vec<AlarmEvent> = messages(bag, "twin/alarm_events");
    let adjusted = events.into_iter().filter(|event| event.change == AlarmEvent::ADJUSTED);
    adjusted
        .inspect(|event| assert_eq!(event.from_state, event.to_state, "{event:?}"))
        .map(|event| event.reason)
        .collect()
}

#[test]
fn friction_follows_a_rig_within_its_limits_and_only_where_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let path = |name: &str| folder.join(name);
    let torque = rig(folder);
    let rig_log = log(folder, "log", SECONDS, Some(&torque));

    // Off: rig and twin disagree, and nothing moves.
    let plain = config(folder, "plain.yaml", &[]);
    let said = replay(&rig_log, &path("off"), Some(&plain), &[]);
    let off: Vec<Residuals> = messages(&path("off"), "twin/residuals");
    let judged = off.iter().filter(|message| ratio(message).is_finite()).count();
    // Off bottom no mean is filled; drilling it is from 35 s after the change on.
    assert!(judged >= 20, "{judged}: {said}");
    assert!(
        off.iter()
            .all(|message| !message.following && message.applied_friction_factor == 1.0)
    );
    assert!(ratio(off.last().unwrap()) > 1.5, "{:?}", off.last());
    assert_eq!(disagreed(&path("off")).len(), 1, "{said}");
    assert!(
        said.contains("rig against twin") && said.contains("twin and rig disagree"),
        "{said}"
    );
    // The same motion as that of a log without measured values, to the bit.
    let short = ["--duration", "30"];
    replay(&log(folder, "bare", SECONDS, None), &path("bare"), Some(&plain), &short);
    replay(&rig_log, &path("with"), Some(&plain), &short);
    let others = ["twin/residuals", "rig/measured"];
    assert!(bytes(&path("bare"), &others) == bytes(&path("with"), &others));
    assert!(messages::<Residuals>(&path("bare"), "twin/residuals").is_empty());

    assert_eq!(adjusted(&path("off")), [""; 0]);

    // On: it comes to the truth, and the residual returns into its band. The alarm says that the twin was moved by more than
    // a quarter for that.
    let follow = config(folder, "follow.yaml", &[("calibration.follow", true.into())]);
    let said = replay(&rig_log, &path("on"), Some(&follow), &[]);
    let on: Vec<Residuals> = messages(&path("on"), "twin/residuals");
    let last = on.last().unwrap();
    assert!(last.following, "{last:?}");
    // Half of the 90 % band of the estimate is below 0.05 by then.
    assert!((last.applied_friction_factor - TRUTH).abs() < 0.05, "{last:?}");
    assert!(ratio(last).abs() < 0.5, "{last:?}");
    assert_eq!(disagreed(&path("on")), [(AlarmEvent::ACTIVATED, Alarm::LOW)], "{said}");
    let events: Vec<AlarmEvent> = messages(&path("on"), "twin/alarm_events");
    let of_rig = events
        .iter()
        .find(|event| event.id == "rig_disagrees" && event.change == AlarmEvent::ACTIVATED);
    let evidence = &of_rig.unwrap().evidence;
    assert!(
        evidence.contains("agrees with the rig only with a friction factor of 1.2"),
        "{evidence}"
    );
    assert!(said.contains("follows the rig"), "{said}");
    for pair in on.windows(2) {
        let moved = pair[1].applied_friction_factor - pair[0].applied_friction_factor;
        // One per minute, and no time is left out.
        assert!(moved.abs() <= 1.0 / 60.0 + 1e-9, "{pair:?}");
    }
    // The journal has the motion, from the configured value on, gathered per minute.
    let entries = adjusted(&path("on"));
    assert!(
        (1..=2).contains(&entries.len()) && entries[0].starts_with("friction factor from 1.000 to 1."),
        "{entries:?}"
    );
    // Every change is in the applied inputs, with who asked for it.
    let applied: Vec<AppliedInputs> = messages(&path("on"), "twin/applied_inputs");
    let changes = applied.iter().flat_map(|inputs| {
        let named = inputs.parameter_name.iter().zip(&inputs.parameter_asked_by);
        named.filter(|(name, _)| *name == "calibration.friction_factor")
    });
    assert!(changes.clone().count() > 15 && changes.clone().all(|(_, by)| by == "calibration.follow"));
    // The coefficient in force is the configured one, 0.4, times the factor.
    let last_applied = applied.last().unwrap();
    assert!(
        (last_applied.inner_friction[0] - 0.4 * last.applied_friction_factor).abs() < 0.01,
        "{last_applied:?}"
    );
    // The session keeps the configured value.
    let session: Vec<SessionInfo> = messages(&path("on"), "twin/session");
    assert!(
        session[0].configuration.contains("friction_factor: 1"),
        "{}",
        session[0].configuration
    );

    // A replay of the recording repeats it to the bit.
    let said = replay(&path("on"), &path("again"), None, &[]);
    assert!(said.contains("exact: the recording has everything"), "{said}");
    let (first, second) = (bytes(&path("on"), &[]), bytes(&path("again"), &[]));
    for (topic, recorded) in &first {
        assert!(Some(recorded) == second.get(topic), "{topic} differs");
    }
    assert_eq!(first.len(), second.len());
}

#[test]
fn a_limit_stops_it_and_bad_input_freezes_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // A rig whose torque is that of the heavy tool with much more friction, off bottom (19 N m there at 0.2).
    let torque = |second: u32| {
        let noise = (f64::from(second) * 2.4).sin() * std::f64::consts::SQRT_2;
        // Three seconds with a value that no rig measures.
        if (28..31).contains(&second) { 1e9 } else { 44.0 + noise }
    };
    let log = log(folder, "log", DRILLS, Some(&torque));
    let log = {
        // The same off bottom for twice the time.
        let text = std::fs::read_to_string(&log).unwrap();
        let more: String = (DRILLS..2 * DRILLS).fold(text, |mut text, second| {
            writeln!(text, "{second},60,0,{:.4}", torque(second) / 1000.0).unwrap();
            text
        });
        std::fs::write(&log, more).unwrap();
        log
    };
    let limited = config(
        folder,
        "limited.yaml",
        &[
            ("calibration.follow", true.into()),
            ("calibration.follow_limits.high", 1.1.into()),
        ],
    );
    let out = folder.join("limited");
    let said = replay(&log, &out, Some(&limited), &[]);
    let all: Vec<Residuals> = messages(&out, "twin/residuals");
    assert!(all.iter().all(|message| message.applied_friction_factor <= 1.1));
    // After the last row there is one more comparison, without a value.
    let last = all
        .iter()
        .rfind(|message| message.following_held != "a value is missing")
        .unwrap();
    assert_eq!(
        last.following_held, "the friction factor is at its limit of 1.1",
        "{last:?}"
    );
    assert!(last.applied_friction_factor > 1.09, "{last:?}");
    assert!(
        said.contains("calibration.follow: the friction factor is at its limit of 1.1"),
        "{said}"
    );
    // The refused values are missing, and nothing moves meanwhile.
    assert!(said.contains("surface_torque = 1.00000e9 N.m"), "{said}");
    let missing = all
        .windows(2)
        .filter(|pair| pair[0].following_held == "a value is missing");
    let still = missing
        .clone()
        .all(|pair| pair[0].applied_friction_factor == pair[1].applied_friction_factor);
    assert!(missing.count() >= 3 && still, "{all:?}");
}

/// A torque sensor that shows half more than the truth, which none of eight plausible tools does whose friction is within a
/// quarter of the configured one and takes a third of the torque. The alarm comes and stands to the end, although friction follows: it follows the tools, which do not believe the sensor.
#[test]
fn a_fault_that_no_plausible_tool_has_is_an_alarm_and_is_not_followed_away() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let path = |name: &str| folder.join(name);
    let torque = rig(folder);
    let faulty = |second: u32| 1.5 * torque(second);
    let seconds = SECONDS + 20;
    let rig_log = log(folder, "log", seconds, Some(&faulty));
    let plain = config(folder, "plain.yaml", &[("calibration.follow", true.into())]);
    let text = std::fs::read_to_string(&plain).unwrap()
        + "
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial]
      distribution: {uniform: {low: 0.3, high: 0.5}}
      source: a test
ensemble: {members: 8}
";
    std::fs::write(&plain, text).unwrap();
    let said = replay(&rig_log, &path("on"), Some(&plain), &[]);
    let bands: Vec<Bands> = messages(&path("on"), "twin/bands");
    assert!(
        bands.len() > 90 && bands.iter().all(|bands| bands.members == 8),
        "{said}"
    );

    let events: Vec<AlarmEvent> = messages(&path("on"), "twin/alarm_events");
    let of_rig: Vec<&AlarmEvent> = events
        .iter()
        .filter(|event| event.id == "rig_disagrees" && event.change != AlarmEvent::ADJUSTED)
        .collect();
    let first = of_rig.first().unwrap();
    let ended = of_rig.iter().any(|event| event.change == AlarmEvent::RETURNED);
    assert!(!ended, "{of_rig:?}");
    let begun = bands[0].begun.to_nanoseconds();
    let after = (first.header.stamp.to_nanoseconds() - begun) as f64 * 1e-9 - f64::from(DRILLS);
    // The motion is steady after 15 s and the mean filled after 20 more; plausible tools are judged 11 s late, and the alarm
    // waits for 10 s. The weight takes some seconds to come.
    assert!((0.0..70.0).contains(&after), "{after} s after it drills");
    assert!(
        first.evidence.contains("all 8 plausible tools show"),
        "{}",
        first.evidence
    );

    let all: Vec<Residuals> = messages(&path("on"), "twin/residuals");
    for message in &all {
        assert!(message.following, "{message:?}");
        // 90 % of 0.3 to 0.5 of the inner layer over 0.4, and the outer layer as configured: 1 -+ 0.1125 in the mean.
        assert!((message.applied_friction_factor - 1.0).abs() < 0.1126, "{message:?}");
        assert_eq!(message.applied_torque_tare, 0.0);
    }
    // A replay of the recording repeats it to the bit.
    replay(&path("on"), &path("again"), None, &[]);
    let (first, second) = (bytes(&path("on"), &[]), bytes(&path("again"), &[]));
    for (topic, recorded) in &first {
        assert!(Some(recorded) == second.get(topic), "{topic} differs");
    }
}
