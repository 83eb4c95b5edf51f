//! The page of a recording: what stands on it is what is in the bag, and what is not in the bag is said.

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

/// Sections, figures and tiles of a page, in their order.
fn contents(page: &str) -> Vec<String> {
    let all = |before: &str, after: &str| -> Vec<String> {
        let pieces = page.split(before).skip(1);
        pieces
            .filter_map(|piece| piece.split(after).next().map(str::to_owned))
            .collect()
    };
    [all("<h2>", "</h2>"), all("<figure id=\"", "\"")].concat()
}

/// Bags of the twin's topics that a recorder from other hands made, MCAP and SQLite, give the page that ours gives.
#[test]
fn interop_a_foreign_recording_of_a_run_has_the_same_sections() {
    let Some(network) = crate::common::Network::new() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("run");
    let mut twin = network.twin(&["--record", text(&own), "--duration", "16"]);
    assert_eq!(twin.end(), Some(0));
    let Some(said) = crate::common::python::run("bags.py", &["record", text(&own)], "") else {
        return;
    };
    assert!(said.contains("/twin/session"), "{said}");
    let (page, _) = report(&own, &[]);
    let sections = contents(&page);
    assert!(sections.len() > 10, "{sections:?}");
    let mut tiles = Vec::new();
    // Folders, and their files alone; of ROS 2 Humble a file without definitions.
    for name in [
        "run_mcap",
        "run_mcap/run_mcap.mcap",
        "run_sqlite",
        "run_sqlite/run_sqlite.db3",
        "run_humble.db3",
    ] {
        let (foreign, said) = report(&folder.path().join(name), &[]);
        let has = contents(&foreign);
        for section in &sections {
            assert!(has.contains(section), "{name}: {section} is not in {has:?}: {said}");
        }
        assert!(foreign.contains("tool:\n"), "the configuration, from the latched topic");
        assert!(!said.contains("cannot be read"), "{said}");
        let tile = foreign.split("largest force, pipe on guide").next().unwrap();
        tiles.push(tile.rsplit("<b>").next().unwrap().to_owned());
    }
    assert!(
        tiles.iter().all(|tile| *tile == tiles[0]),
        "both hold the same: {tiles:?}"
    );
}

/// The example of the manual, on a bag of ours, with the packages that it names.
#[test]
fn interop_the_python_example_reads_and_draws_a_recording() {
    let Some(python) = crate::common::python::with("rosbags, matplotlib") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let picture = folder.path().join("run.png");
    let output = Command::new(python)
        .arg(crate::common::root().join("docs/examples/plot_recording.py"))
        .args([text(&run), "--out", text(&picture)])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    // Both found the same largest force.
    let (page, _) = report(&run, &[]);
    let force = said
        .lines()
        .find_map(|line| line.strip_prefix("largest force, pipe on guide: "))
        .unwrap();
    let newtons: f64 = force.split(' ').next().unwrap().parse().unwrap();
    assert!(newtons > 10.0, "{said}");
    let tile = format!("<b>{:.3} kN</b>largest force, pipe on guide", newtons / 1e3);
    assert!(newtons >= 1000.0 || page.contains(&tile), "{tile}");
}

/// A recording with the default's rates has too few positions to count turns in: the example says so and prints the rest.
#[test]
fn interop_the_example_that_counts_turns_reads_a_recording_of_any_rate() {
    let Some(python) = crate::common::python::with("mcap_ros2, numpy, ruamel.yaml") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let file = std::fs::read_dir(&run)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|path| path.extension().is_some_and(|extension| extension == "mcap"))
        .unwrap();
    let read = |path: &Path| {
        let mut command = Command::new(&python);
        let script = crate::common::root().join("docs/examples/count_turns.py");
        let output = command.arg(script).args(["read", text(path)]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(!said.contains("Traceback"), "{said}");
        (output.status.success(), said)
    };
    let (done, said) = read(&file);
    assert!(done, "{said}");
    assert!(
        said.contains("bit speed ripple") && said.contains("largest pipe-guide force"),
        "{said}"
    );
    assert!(
        said.contains("turns are not counted: twin/tool_shape comes every 0.10 s"),
        "{said}"
    );
    assert!(said.contains("record with outputs.rates.tool_shape: 50"), "{said}");
    // Of a bag without the twin, what is missing is named.
    let path = folder.path().join("rig.mcap");
    let mut bag = Bag::new(&path, &[("/", &topics::ROTARY_SPEED_RPM)]);
    bag.put("/rig/rotary_speed_rpm", 0.0, &to_cdr(&Float64 { data: 40.0 }).unwrap());
    bag.recorder.finish().unwrap();
    let (done, said) = read(&path);
    assert!(!done && said.contains("0 messages of twin/tool_shape"), "{said}");
}

/// A bag with a bit torque (N m) at 10 Hz over 20 s, forces along the tool, and a shock from 2 to 9 s if asked for.
fn steady(path: &Path, torque: f64, shock: bool) {
    let known = [&topics::BIT_STATE, &topics::CONTACT_FORCES, &topics::ALARM_EVENTS];
    let mut bag = Bag::new(path, &known.map(|topic| ("/", topic)));
    for index in 0..=200_u32 {
        let time = 0.1 * f64::from(index);
        let bit = BitState {
            header: header(time),
            torque,
            ..BitState::default()
        };
        bag.put("/twin/bit_state", time, &to_cdr(&bit).unwrap());
        let row = |value: f64| vec![0.0, value, 0.0];
        let contacts = ContactForces {
            header: header(time),
            measured_depth: vec![0.0, 1.5, 3.0],
            inclination: vec![0.0; 3],
            state: vec![ContactForces::FREE; 3],
            pipe_guide_normal_peak: row(10.0 * torque),
            pipe_guide_normal_rms: row(5.0 * torque),
            guide_wall_normal_peak: row(0.0),
            guide_wall_normal_rms: row(0.0),
            ..ContactForces::default()
        };
        bag.put("/twin/contact_forces", time, &to_cdr(&contacts).unwrap());
        for (at, change) in [(20, AlarmEvent::ACTIVATED), (90, AlarmEvent::RETURNED)] {
            if shock && index == at {
                bag.put("/twin/alarm_events", time, &event(time, change, "strong"));
            }
        }
    }
    bag.recorder.finish().unwrap();
}

/// Two bags next to each other: exit code, what is said, JSON and page.
fn against(a: &Path, b: &Path, tolerance: Option<&str>) -> (Option<i32>, String, serde_json::Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut arguments = vec![
        "report",
        text(a),
        "--against",
        text(b),
        "--json",
        "--out",
        text(folder.path()),
    ];
    arguments.extend(tolerance.iter().flat_map(|percent| ["--tolerance", *percent]));
    let output = flexdrill(&arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    check_page(&page);
    let json = serde_json::from_slice(&output.stdout).unwrap();
    (output.status.code(), said, json, page)
}

#[test]
fn two_bags_side_by_side_differ_by_what_was_put_into_them() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name).join("run.mcap"));
    steady(&a, 100.0, true);
    steady(&b, 103.0, false);
    // 3 of 103 are 2.913 %; the forces follow the torque; the shock is in A only.
    let (code, said, json, page) = against(&a, &b, Some("2"));
    assert_eq!(code, Some(1), "{said}");
    for difference in [
        "the alarm \"shock\"",
        "torque of the rock on the bit (2.913 %)",
        "pipe on guide, RMS (2.913 %)",
    ] {
        assert!(said.contains(difference), "{said}");
    }
    assert_eq!(json["same"], false);
    assert_eq!(json["beyond_tolerance"].as_array().unwrap().len(), 3, "{json}");
    let torque = json["quantities"]
        .as_array()
        .unwrap()
        .iter()
        .find(|quantity| quantity["unit"] == "N m");
    // Rounding of a sum of 200 products.
    assert!((torque.unwrap()["a"]["mean"].as_f64().unwrap() - 100.0).abs() < 1e-9);
    assert!((torque.unwrap()["relative_difference"].as_f64().unwrap() - 3.0 / 103.0).abs() < 1e-9);
    let force = &json["along_the_tool"][0];
    assert_eq!(force["largest_difference"]["measured_depth"], 1.5);
    assert_eq!(force["largest_difference"]["b"], 1030.0, "in newtons");
    assert_eq!(json["alarms"][0]["a"]["times"], 1);
    assert!((json["alarms"][0]["a"]["duration_s"].as_f64().unwrap() - 7.0).abs() < 1e-9);
    assert_eq!(json["alarms"][0]["b"]["times"], 0);
    for shown in [
        "<figure id=\"torque\">",
        "<figure id=\"envelopes\">",
        "Alarms on one time line",
        "<b>3</b>beyond the tolerance of 2 %",
    ] {
        assert!(page.contains(shown), "{shown}");
    }
    // A wider tolerance leaves the alarm, and none asks for nothing.
    let (code, said, json, _) = against(&a, &b, Some("3"));
    assert_eq!(
        (code, json["beyond_tolerance"].as_array().unwrap().len()),
        (Some(1), 1),
        "{said}"
    );
    let (code, said, json, _) = against(&a, &b, None);
    assert_eq!((code, json["tolerance"].is_null()), (Some(0), true), "{said}");
    // Of the same bag nothing differs, and of one without the shock only the torque.
    let (code, said, json, page) = against(&b, &b, Some("0"));
    assert_eq!((code, json["same"].as_bool()), (Some(0), Some(true)), "{said}");
    assert!(page.contains("<b>the same</b>"));
    steady(&c, 103.0 * (1.0 + 1e-9), false);
    let (code, said, _, _) = against(&b, &c, Some("0"));
    assert_eq!(code, Some(1), "{said}");
    let (code, said, _, _) = against(&b, &c, Some("0.001"));
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_replay_agrees_with_itself_and_a_wrong_tolerance_is_wrong_use() {
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let (code, said, json, page) = against(&run, &run, Some("0"));
    assert_eq!(code, Some(0), "{said}");
    assert!(json["quantities"].as_array().unwrap().len() > 8, "{json}");
    assert!(page.contains("Both runs have the same configuration."));
    for arguments in [
        vec![
            "report",
            text(&run),
            "--against",
            text(&run),
            "--json",
            "--tolerance",
            "-1",
        ],
        vec!["report", text(&run), "--json"],
        vec!["report", text(&run), "--out", "x", "--tolerance", "1"],
    ] {
        assert_eq!(flexdrill(&arguments).status.code(), Some(2), "{arguments:?}");
    }
}
