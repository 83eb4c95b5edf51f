//! `flexdrill ahead --from`: what a recording and a state say of the tool, and what is refused.

use std::path::{Path, PathBuf};

use flexdrill::bag::{Recorder, Topic};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::topics::{self, TopicInfo};
use flexdrill::messages::{AppliedInputs, HoleAhead, Message, SessionInfo, Transfer, to_cdr};
use flexdrill_config::Config;
use flexdrill_core::twin::Simulation;

use crate::ahead::{ahead, configuration};
use crate::program::{flexdrill, text};

/// An instant of the rig's clock (ns).
const START: i64 = 1_700_000_000_000_000_000;
const SECOND: i64 = 1_000_000_000;

fn header(seconds: i64) -> Header {
    Header {
        stamp: Time::from_nanoseconds(START + seconds * SECOND),
        frame_id: "flexible_tool".to_owned(),
    }
}

/// A recording of a twin in a namespace.
struct Bag {
    recorder: Recorder,
    known: Vec<&'static TopicInfo>,
}

impl Bag {
    fn begin(path: &Path, known: &[&'static TopicInfo], namespaces: &[&str]) -> Self {
        let name = |namespace: &&str| {
            known
                .iter()
                .map(move |topic| Topic::new(format!("{namespace}/{}", topic.name), &topic.kind, topic.qos))
                .collect::<Vec<_>>()
        };
        let topics: Vec<Topic> = namespaces.iter().flat_map(name).collect();
        Self {
            recorder: Recorder::create(path, &topics).unwrap(),
            known: known.to_vec(),
        }
    }

    fn push<M: Message>(&mut self, topic: &TopicInfo, seconds: i64, message: &M) {
        let index = self.known.iter().position(|known| known.name == topic.name).unwrap();
        let bytes = to_cdr(message).unwrap();
        self.recorder.record(index, START + seconds * SECOND, &bytes).unwrap();
    }
}

const ALL: [&TopicInfo; 4] = [
    &topics::SESSION,
    &topics::APPLIED_INPUTS,
    &topics::TRANSFER,
    &topics::HOLE_AHEAD,
];

/// What is in the recording of a tool.
struct Recorded<'a> {
    config: &'a Path,
    weight: f64,
    friction: f64,
    /// When the last message of `twin/hole_ahead` was sent (s).
    hole: i64,
}

/// A run of a minute, with other values before its end.
fn recording(path: PathBuf, of: &Recorded<'_>) -> PathBuf {
    let config = Config::load(of.config).unwrap();
    let live = config.live();
    let mut bag = Bag::begin(&path, &ALL, &["/rig_7"]);
    bag.push(
        &topics::SESSION,
        0,
        &SessionInfo {
            header: header(0),
            config_hash: config.hash(),
            ..SessionInfo::default()
        },
    );
    for (seconds, friction, weight) in [(0, 0.3, 4e3), (60, of.friction, of.weight)] {
        bag.push(
            &topics::APPLIED_INPUTS,
            seconds,
            &AppliedInputs {
                header: header(seconds),
                inner_friction: live.inner_friction,
                outer_friction: [live.outer_friction[0], friction],
                bit_friction_factor: live.bit_friction_factor,
                ..AppliedInputs::default()
            },
        );
        bag.push(
            &topics::TRANSFER,
            seconds,
            &Transfer {
                header: header(seconds),
                duration: 10.0,
                bit_weight: weight + 50.0,
                ..Transfer::default()
            },
        );
    }
    bag.push(
        &topics::HOLE_AHEAD,
        60,
        &HoleAhead {
            header: header(of.hole),
            window: 4.0,
            weight_on_bit: of.weight,
            // More than the statics of any guide in these tests have, at most 2 kN.
            side_force_low: 5000.0,
            side_force_low_error: 10.0,
            ..HoleAhead::default()
        },
    );
    bag.recorder.finish().unwrap();
    path
}

fn table(out: &Path) -> String {
    std::fs::read_to_string(out.join("ahead.csv")).unwrap()
}

/// The forecast is that of the configuration with the recorded friction at the recorded weight.
#[test]
fn a_recording_has_weight_and_friction_at_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let run = Recorded {
        config: &config,
        weight: 8250.0,
        friction: 0.2,
        hole: 58,
    };
    let bag = recording(folder.path().join("run.mcap"), &run);
    let fixed = ["--members=1", "--metres=1"];
    let from = ["--from", bag.to_str().unwrap()];
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name));
    let (said, _) = ahead(&config, &a, &[&fixed[..], &from].concat());
    assert!(
        said.contains("8.25 kN arrive at the bit, mean over its last 4.0 s (twin/hole_ahead)."),
        "{said}"
    );
    let friction = "Parameters in force at its end: contact.outer.friction_axial is 0.2, configured 0.3.";
    assert!(said.contains(friction), "{said}");
    assert!(!said.contains("another configuration"), "{said}");
    // A side force that no guide of this shape has is not hidden.
    assert!(
        said.contains("Doubtful: the bit pushes 5000 N to the low side, and the guide at rest "),
        "{said}"
    );
    assert!(said.contains("At 8.25 kN on the bit"), "{said}");
    // The same by hand, and the weight that is asked for counts before the one that arrived.
    let by_hand = tempfile::tempdir().unwrap();
    let changed = configuration(by_hand.path(), &[("friction_axial: 0.3", "friction_axial: 0.2")]);
    ahead(&changed, &b, &[&fixed[..], &["--weight=8.25"]].concat());
    assert_eq!(table(&a), table(&b));
    let (said, _) = ahead(&config, &c, &[&fixed[..], &from, &["--weight=12"]].concat());
    assert!(
        said.contains("in place of which --weight asks for 12.00 kN.") && said.contains("At 12.00 kN on the bit"),
        "{said}"
    );
}

/// A recording that ends while messages of the hole ahead wait has newer means in `twin/transfer`.
#[test]
fn an_older_message_of_the_hole_is_not_used() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let other = tempfile::tempdir().unwrap();
    let run = Recorded {
        config: &configuration(other.path(), &[("bending_factor: 0.05", "bending_factor: 0.04")]),
        weight: 9000.0,
        friction: 0.3,
        hole: 49,
    };
    let bag = recording(folder.path().join("run.mcap"), &run);
    let more = ["--members=1", "--metres=1", "--from", bag.to_str().unwrap()];
    let (said, _) = ahead(&config, &folder.path().join("out"), &more);
    assert!(
        said.contains("9.05 kN arrive at the bit, mean over its last 10.0 s (twin/transfer)."),
        "{said}"
    );
    assert!(
        said.contains("The parameters in force at its end are those of "),
        "{said}"
    );
    let hash = &Config::load(run.config).unwrap().hash()[..12];
    assert!(
        said.contains(&format!("The run had another configuration ({hash})")),
        "{said}"
    );
    assert!(!said.contains("Doubtful"), "{said}");
}

/// A state has the mean weight of `twin/transfer` and the friction that was set while it ran.
#[test]
fn a_state_has_the_mean_weight_and_the_friction_in_force() {
    let folder = tempfile::tempdir().unwrap();
    let file = configuration(folder.path(), &[]);
    let config = Config::load(&file).unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut live = config.live();
    live.outer_friction[1] = 0.25;
    simulation.set_live(live).unwrap();
    let inputs = flexdrill_core::inputs::Inputs {
        rotary_speed: 4.0,
        weight_on_bit: 9e3,
        ..config.simulation().initial_inputs
    };
    // A quarter of a second: means begin with the first tenth.
    let steps = (0.25 / config.solver.time_step).round() as usize;
    for _ in 0..steps {
        let outcome = simulation.advance(&inputs);
        assert!(
            matches!(outcome, flexdrill_core::dynamics::StepOutcome::Advanced { .. }),
            "{outcome:?}"
        );
    }
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    let mean = snapshot.transfer.weight.mean[flexdrill_motion::BIT];
    assert!(mean > 100.0 && snapshot.transfer.duration > 0.09, "{mean}");
    let state = folder.path().join("run.checkpoint");
    std::fs::write(&state, simulation.checkpoint().unwrap()).unwrap();
    let more = ["--members=1", "--metres=1", "--from", state.to_str().unwrap()];
    let (said, _) = ahead(&file, &folder.path().join("out"), &more);
    let expected = format!(
        "{:.2} kN arrive at the bit, mean over its last {:.1} s (the state).",
        1e-3 * mean,
        snapshot.transfer.duration
    );
    assert!(said.contains(&expected), "{expected}: {said}");
    assert!(
        said.contains("contact.outer.friction_axial is 0.25, configured 0.3"),
        "{said}"
    );
    // A state belongs to the tool that it was saved with.
    let other = tempfile::tempdir().unwrap();
    let other = configuration(other.path(), &[("bending_factor: 0.05", "bending_factor: 0.04")]);
    let output = flexdrill(&[
        "ahead",
        other.to_str().unwrap(),
        "--from",
        state.to_str().unwrap(),
        "--out",
        folder.path().join("none").to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output.stderr).contains("saved with another tool"),
        "{}",
        text(&output.stderr)
    );
}

#[test]
fn what_says_nothing_of_the_weight_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let refused = |from: &Path, more: &[&str]| {
        let out = folder.path().join("none");
        let [config, from, out] = [&config, from, out.as_path()].map(|path: &Path| path.to_str().unwrap());
        let output = flexdrill(&[&["ahead", config, "--from", from, "--out", out], more].concat());
        (output.status.code(), text(&output.stderr))
    };
    let lifted = Recorded {
        config: &config,
        weight: 0.0,
        friction: 0.3,
        hole: 60,
    };
    let bag = recording(folder.path().join("lifted"), &lifted);
    let (code, said) = refused(&bag, &[]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("the bit is off bottom at the end of the run") && said.contains("with --weight"),
        "{said}"
    );
    // Of two twins none is chosen.
    let two = folder.path().join("two");
    let both = Bag::begin(&two, &ALL, &["/rig_7", "/rig_8"]);
    both.recorder.finish().unwrap();
    let (code, said) = refused(&two, &[]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("/rig_7/") && said.contains("/rig_8/"), "{said}");
    // A recording without the twin's messages.
    let inputs = folder.path().join("inputs");
    Bag::begin(&inputs, &[&topics::RIG_INPUTS], &["/rig_7"])
        .recorder
        .finish()
        .unwrap();
    let (_, said) = refused(&inputs, &[]);
    assert!(said.contains("no message on twin/session"), "{said}");
    // A file that is neither.
    let (_, said) = refused(&config, &[]);
    assert!(said.contains("no checkpoint of flexdrill"), "{said}");
    assert!(!folder.path().join("none").exists());
}
