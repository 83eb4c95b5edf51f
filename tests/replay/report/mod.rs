//! The page of a recording: what stands on it is what is in the bag, and what is not in the bag is said.

mod compared;
mod foreign;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use flexdrill::alarms::AlarmId;
use flexdrill::bag::{self, Recorder, Topic};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::{Float64, Header};
use flexdrill::messages::topics::{self, TopicInfo};
use flexdrill::messages::{
    AlarmEvent, AppliedInputs, BitState, ContactForces, JointDeflections, Reactions, SessionInfo, Transfer, TwinStatus,
    to_cdr,
};
use flexdrill_core::inputs::InputKind;

/// An instant of the rig's clock (ns): 2023-11-14 22:13:20 UTC.
const START: i64 = 1_700_000_000_000_000_000;

fn flexdrill(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The page of a bag, and what was said while it was made.
fn report(bag: &Path, more: &[&str]) -> (String, String) {
    let folder = tempfile::tempdir().unwrap();
    let output = flexdrill(&[&["report", text(bag), "--out", text(folder.path())], more].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    check_page(&page);
    (page, said)
}

/// What holds of every page: it is whole, needs nothing beside itself, runs nothing, and says no number that is none.
fn check_page(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
    for outside in ["<script", "<link", "<iframe", "src=", "url(", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let addresses = page.matches("://").count();
    assert_eq!(addresses, page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    for (open, close) in [
        ("<svg", "</svg>"),
        ("<table", "</table>"),
        ("<section", "</section>"),
        ("<figure", "</figure>"),
    ] {
        assert_eq!(page.matches(open).count(), page.matches(close).count(), "{open}");
    }
    for wrong in ["NaN", ">inf", "-inf"] {
        assert!(!page.contains(wrong), "{wrong}");
    }
}

/// Twenty seconds of drilling, replayed from the log of the demonstration, which has WOB from there on.
fn replayed(folder: &Path) -> PathBuf {
    let root = crate::common::root();
    let out = folder.join("run");
    let output = flexdrill(&[
        "replay",
        text(&root.join("config/field_logs/demo.csv")),
        "--mapping",
        text(&root.join("config/field_logs/rig_1hz.yaml")),
        "--config",
        text(&crate::common::small_config()),
        "--from",
        "60",
        "--duration",
        "20",
        "--out",
        text(&out),
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    out
}

#[test]
fn a_replay_gives_a_page_with_the_numbers_of_its_bag() {
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let (page, said) = report(&run, &[]);
    // The largest force, taken from the bag in another way.
    let (mut largest, mut bit_torque) = ([0.0_f64; 2], f64::NEG_INFINITY);
    let mut session = SessionInfo::default();
    for message in bag::open(&run).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/contact_forces") {
            let m: ContactForces = message.decode().unwrap();
            for (largest, peaks) in largest
                .iter_mut()
                .zip([m.pipe_guide_normal_peak, m.guide_wall_normal_peak])
            {
                *largest = peaks.into_iter().fold(*largest, f64::max);
            }
        } else if message.topic.is("twin/bit_state") {
            bit_torque = bit_torque.max(message.decode::<BitState>().unwrap().torque);
        } else if message.topic.is("twin/session") {
            session = message.decode().unwrap();
        }
    }
    assert!(largest[0] > 10.0 && bit_torque > 10.0, "{largest:?} {bit_torque}");
    let digits = |value: f64| match value {
        ..1.0 => format!("{value:.3}"),
        ..10.0 => format!("{value:.2}"),
        _ => format!("{value:.1}"),
    };
    let tile = format!("<b>{} kN</b>largest force, pipe on guide", digits(largest[0] / 1e3));
    assert!(page.contains(&tile), "{tile}");
    assert!(
        page.contains(&format!("<td class=\"n\">{}</td>", digits(bit_torque))),
        "{bit_torque}"
    );
    assert!(page.contains(&session.config_hash) && page.contains("tool:\n"));
    for figure in ["inputs", "orbits", "envelopes", "torque"] {
        assert!(page.contains(&format!("<figure id=\"{figure}\">")), "{figure}");
    }
    assert!(page.contains("Every balance that was judged holds.") && page.contains("forces on the tool"));
    // The small tool has no string.
    let left = page.split("Not judged: ").nth(1).unwrap();
    assert!(left.split('.').next().unwrap().contains("hook load"), "{left}");
    // A replay keeps no pace, and says so.
    assert!(
        page.contains("A replay has none") && said.contains("twin/status"),
        "{said}"
    );
    assert!(!page.contains("<figure id=\"pace\">"));
}

#[test]
fn a_bag_that_was_cut_short_gives_a_page_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let whole = std::fs::read(run.join("run_0.mcap")).unwrap();
    let cut = folder.path().join("cut.mcap");
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let (page, said) = report(&cut, &[]);
    assert!(
        page.contains("was cut short") && said.contains("was cut short"),
        "{said}"
    );
    assert!(page.contains("largest force, pipe on guide"));
}

/// Figures that do not balance are found, and named on the page: a force on the wall and a power of the bit that were
/// changed in the recording.
#[test]
fn figures_that_do_not_balance_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let changed = folder.path().join("changed.mcap");
    let mut bag = Bag::new(
        &changed,
        &[
            ("/", &topics::SESSION),
            ("/", &topics::REACTIONS),
            ("/", &topics::TRANSFER),
        ],
    );
    for message in bag::open(&run).unwrap() {
        let message = message.unwrap();
        let name = format!("/{}", message.topic.name.trim_start_matches('/'));
        let bytes = if message.topic.is("twin/reactions") {
            let mut reactions: Reactions = message.decode().unwrap();
            reactions.wall_force[0] += 100.0;
            to_cdr(&reactions).unwrap()
        } else if message.topic.is("twin/transfer") {
            let mut transfer: Transfer = message.decode().unwrap();
            transfer.bit_power += 1.0;
            to_cdr(&transfer).unwrap()
        } else if message.topic.is("twin/session") {
            to_cdr(&message.decode::<SessionInfo>().unwrap()).unwrap()
        } else {
            continue;
        };
        let time = (message.log_time - START) as f64 * 1e-9;
        bag.put(&name, time, &bytes);
    }
    bag.recorder.finish().unwrap();
    let (page, _) = report(&changed, &[]);
    let named = "Out of balance: forces on the tool, with inertia and damping; power put in, taken and stored.";
    assert!(page.contains(named), "{page}");
    assert!(!page.contains("Every balance that was judged holds."));
}

struct Bag {
    recorder: Recorder,
    topics: Vec<Topic>,
}

impl Bag {
    fn new(path: &Path, topics: &[(&str, &TopicInfo)]) -> Self {
        let topics: Vec<Topic> = topics
            .iter()
            .map(|(namespace, topic)| Topic::new(format!("{namespace}{}", topic.name), &topic.kind, topic.qos))
            .collect();
        Self {
            recorder: Recorder::create(path, &topics).unwrap(),
            topics,
        }
    }

    fn put(&mut self, topic: &str, time: f64, bytes: &[u8]) {
        let index = self.topics.iter().position(|known| known.name == topic).unwrap();
        self.recorder.record(index, START + (time * 1e9) as i64, bytes).unwrap();
    }
}

fn header(time: f64) -> Header {
    Header {
        stamp: Time::from_nanoseconds(START + (time * 1e9) as i64),
        frame_id: "flexible_tool".to_owned(),
    }
}

fn event(time: f64, change: u8, evidence: &str) -> Vec<u8> {
    to_cdr(&AlarmEvent {
        header: header(time),
        id: "shock".to_owned(),
        name: "shock".to_owned(),
        change,
        priority: 3,
        evidence: evidence.to_owned(),
        what_to_do: "Lower the speed.".to_owned(),
        what_the_engineer_can_do: "Inspect the joints.".to_owned(),
        measured_depth: 2.5,
        body: 1,
        ..AlarmEvent::default()
    })
    .unwrap()
}

#[test]
fn alarms_and_health_are_told_and_texts_of_others_stay_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut bag = Bag::new(
        &path,
        &[
            ("/rig_7/", &topics::STATUS),
            ("/rig_7/", &topics::ALARM_EVENTS),
            ("/rig_7/", &topics::BIT_STATE),
        ],
    );
    for index in 0..100_u32 {
        let time = f64::from(index) * 0.2;
        let status = TwinStatus {
            header: header(time),
            state: TwinStatus::RUNNING,
            real_time_factor: if index == 50 { 0.25 } else { 1.0 },
            model_quality: u8::from(index >= 75),
            model_quality_cause: "steps too long".to_owned(),
            recording_drops: 17,
            surveys_known: 4,
            surveys_refused: 2,
            ..TwinStatus::default()
        };
        bag.put("/rig_7/twin/status", time, &to_cdr(&status).unwrap());
        if index == 10 {
            bag.put(
                "/rig_7/twin/alarm_events",
                time,
                &event(time, AlarmEvent::ACTIVATED, "<script>alert(1)</script>"),
            );
        }
        if index == 45 {
            bag.put("/rig_7/twin/alarm_events", time, &event(time, AlarmEvent::RETURNED, ""));
        }
    }
    // Bytes that are no message of their type.
    bag.put("/rig_7/twin/bit_state", 19.9, &[0, 1, 0, 0, 7]);
    bag.recorder.finish().unwrap();
    let (page, said) = report(&path, &[]);
    assert!(page.contains("2023-11-14 22:13:20 UTC") && page.contains("<code>/rig_7</code>"));
    assert!(page.contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
    // From 2 s to 9 s.
    assert!(page.contains("HIGH") && page.contains("once, 7.0 s in all"), "{page}");
    assert!(page.contains("pipe, 2.50 m") && page.contains("Lower the speed."));
    assert!(page.contains("Inspect the joints."), "what the engineer can do");
    // Good from 0 to 15 s, degraded from there to the last message at 19.8 s.
    assert!(
        page.contains("waiting below the bit, refused</th><td>4, 0, 2</td>"),
        "{page}"
    );
    assert!(page.contains("good 75.8 %, degraded 24.2 %") && page.contains("steps too long"));
    assert!(page.contains("0.250 to 1") && page.contains("recording 17"));
    assert!(
        said.contains("1 message of twin/bit_state that cannot be read"),
        "{said}"
    );
    for missing in ["twin/contact_forces", "twin/joint_deflections", "twin/session"] {
        assert!(said.contains(&format!("The bag has no {missing}")), "{missing}: {said}");
    }
}

/// The same weight on three topics, each with its own rate, has one mean: samples once per second, accepted inputs on change
/// and every second, the bit at 50 Hz. It rises from 0 to 10 kN within a second, from 5 s on.
#[test]
fn means_are_over_time_in_one_window() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let (received, asked, bit) = (&topics::WEIGHT_ON_BIT_KN, &topics::APPLIED_INPUTS, &topics::BIT_STATE);
    let mut bag = Bag::new(&path, &[("/", received), ("/", asked), ("/", bit)]);
    let weight = |time: f64| 10.0 * (time - 5.0).clamp(0.0, 1.0);
    for hundredth in 0..=4000_u32 {
        let time = 0.01 * f64::from(hundredth);
        let ramp = (5.0..=6.0).contains(&time);
        if ramp || hundredth % 100 == 0 {
            let message = AppliedInputs {
                header: header(time),
                weight_on_bit: 1e3 * weight(time),
                ..AppliedInputs::default()
            };
            bag.put("/twin/applied_inputs", time, &to_cdr(&message).unwrap());
        }
        // The rig begins later and ends earlier.
        if hundredth % 100 == 0 && (200..=2000).contains(&hundredth) {
            let message = Float64 { data: weight(time) };
            bag.put("/rig/weight_on_bit_kn", time, &to_cdr(&message).unwrap());
        }
        if hundredth % 2 == 0 {
            let message = BitState {
                header: header(time),
                weight_on_bit: 1e3 * weight(time),
                ..BitState::default()
            };
            bag.put("/twin/bit_state", time, &to_cdr(&message).unwrap());
        }
    }
    bag.recorder.finish().unwrap();
    let (page, _) = report(&path, &[]);
    assert!(page.contains("Means are over time, from 2 to 20 s"), "{page}");
    let mean = |what: &str| -> f64 {
        let row = page.split(&format!("<td>weight on bit, {what}</td>")).nth(1).unwrap();
        let cell = row.split("<td class=\"n\">").nth(2).unwrap();
        cell.split('<').next().unwrap().parse().unwrap()
    };
    // 0 to 5 s, half of 10 kN to 6 s, 10 kN to 20 s. Samples of 1 Hz know of the ramp at its end only.
    let exact = (0.5 * 10.0 + 14.0 * 10.0) / 18.0;
    for (what, off) in [("received", 5.0 / 18.0), ("accepted", 0.02), ("at the bit", 0.02)] {
        assert!(
            (mean(what) - exact).abs() <= off + 0.005,
            "{what}: {} instead of {exact}",
            mean(what)
        );
    }
}

/// The report knows the alarms about inputs by their ids, because a recording has nothing else.
#[test]
fn alarms_about_inputs_have_the_ids_of_the_catalogue() {
    let ids = InputKind::ALL.map(|kind| AlarmId::of_input(kind).id());
    assert_eq!(flexdrill::report::INPUT_ALARMS, ids);
}

#[test]
fn of_several_twins_one_is_asked_for_and_of_none_the_next_step_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.mcap");
    let mut bag = Bag::new(&path, &[("/a/", &topics::BIT_STATE), ("/b/", &topics::BIT_STATE)]);
    for (name, torque) in [("/a/twin/bit_state", 111.0), ("/b/twin/bit_state", 222.0)] {
        let state = BitState {
            header: header(1.0),
            torque,
            ..BitState::default()
        };
        bag.put(name, 1.0, &to_cdr(&state).unwrap());
    }
    bag.recorder.finish().unwrap();
    let out = folder.path().join("out");
    let output = flexdrill(&["report", text(&path), "--out", text(&out)]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said.contains("namespaces /a, /b; choose one with --namespace"),
        "{said}"
    );
    let (page, _) = report(&path, &["--namespace", "/b"]);
    assert!(page.contains("<td class=\"n\">222</td>") && !page.contains("<td class=\"n\">111</td>"));

    let rig = folder.path().join("rig/rig.mcap");
    let mut bag = Bag::new(&rig, &[("/", &topics::ROTARY_SPEED_RPM)]);
    bag.put("/rig/rotary_speed_rpm", 0.0, &to_cdr(&Float64 { data: 40.0 }).unwrap());
    bag.recorder.finish().unwrap();
    let output = flexdrill(&["report", text(&rig), "--out", text(&out)]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said.contains("none of its topics is the twin's") && said.contains("flexdrill replay"),
        "{said}"
    );
    assert!(!out.exists());
}

/// A message can hold any number; the page shows those that are quantities, and never ends the program.
#[test]
fn numbers_that_no_tool_can_have_do_not_end_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let known = [
        &topics::BIT_STATE,
        &topics::JOINT_DEFLECTIONS,
        &topics::CONTACT_FORCES,
        &topics::STATUS,
    ];
    let mut bag = Bag::new(&path, &known.map(|topic| ("/", topic)));
    let strange = [f64::NAN, f64::INFINITY, -f64::MAX, f64::MAX, 5e-324, -0.0, 1e300, 7.0];
    for (index, value) in strange.into_iter().cycle().take(400).enumerate() {
        // Some of the stamps are of another century, and some run backward.
        let time = if index % 97 == 0 {
            1e9
        } else {
            0.02 * (index ^ 5) as f64
        };
        let row = || vec![value; 3];
        let depth = vec![0.0, 0.5, 1.0];
        let bit = BitState {
            header: header(time),
            torque: value,
            rotary_speed: value,
            stick_slip_index: value,
            ..BitState::default()
        };
        bag.put("/twin/bit_state", 0.02 * index as f64, &to_cdr(&bit).unwrap());
        let joints = JointDeflections {
            header: header(time),
            measured_depth: depth.clone(),
            inclination: row(),
            bend_angle: row(),
            bend_direction: row(),
            limit_angle: row(),
            stop_moment: row(),
            lateral_y: row(),
            lateral_z: row(),
            spin_rate: row(),
            axial_force: row(),
            shear_force: row(),
            torque: row(),
            ..JointDeflections::default()
        };
        bag.put(
            "/twin/joint_deflections",
            0.02 * index as f64,
            &to_cdr(&joints).unwrap(),
        );
        let contacts = ContactForces {
            header: header(time),
            measured_depth: depth,
            inclination: row(),
            state: vec![255; 3],
            pipe_guide_normal_peak: row(),
            pipe_guide_normal_rms: row(),
            guide_wall_normal_peak: row(),
            guide_wall_normal_rms: row(),
            // Longer than the places.
            pipe_guide_shock: vec![value; 9],
            ..ContactForces::default()
        };
        bag.put("/twin/contact_forces", 0.02 * index as f64, &to_cdr(&contacts).unwrap());
        let status = TwinStatus {
            header: header(time),
            real_time_factor: value,
            step_time_p99: value,
            energy_error_ratio: value,
            model_quality: 255,
            ..TwinStatus::default()
        };
        bag.put("/twin/status", 0.02 * index as f64, &to_cdr(&status).unwrap());
    }
    bag.recorder.finish().unwrap();
    let (page, _) = report(&path, &[]);
    assert!(page.contains("<figure id=\"torque\">") && page.contains("<td class=\"n\">7</td>"));
}
