//! `calibration.follow` in a running node: a rig whose torque is too high, measured over `rig/measured`, moves the twin's
//! friction; the recording has every change and repeats it.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::{AppliedInputs, Message, Residuals};
use flexdrill_config::Config;

use crate::common::{Network, Program, root};

fn messages<M: Message>(path: &Path, topic: &str) -> Vec<M> {
    let all = bag::open(path).unwrap().map(Result::unwrap);
    let of_topic = all.filter(|message| message.topic.is(topic));
    of_topic.map(|message| message.decode().unwrap()).collect()
}

/// Changes of the friction factor in the applied inputs: value and who asked.
fn changes(bag: &Path) -> Vec<(f64, String)> {
    let applied: Vec<AppliedInputs> = messages(bag, "twin/applied_inputs");
    let all = applied.iter().flat_map(|inputs| {
        let named = inputs.parameter_name.iter().zip(&inputs.parameter_value);
        named
            .zip(&inputs.parameter_asked_by)
            .filter(|((name, _), _)| *name == "calibration.friction_factor")
            .map(|((_, value), by)| (*value, by.clone()))
    });
    all.collect()
}

#[test]
fn friction_follows_a_live_rig_and_the_recording_repeats_it() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [live, again] = ["live", "again"].map(|name| folder.path().join(name));
    // Off bottom, with twice the torque that the tool's friction takes (19 N m at 60 r/min), and a sensor's ripple.
    let mut log = String::from("t,rpm,wob,torque\n");
    for second in 0..120 {
        let torque = 44.0 + (f64::from(second) * 2.4).sin() * std::f64::consts::SQRT_2;
        writeln!(log, "{second},60,0,{:.4}", torque / 1000.0).unwrap();
    }
    let mapping = "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
                   weight_on_bit:\n    direct: {column: wob, unit: kN}\n  torque: {column: torque, unit: kN.m}\n";
    let rig_log = folder.path().join("rig.csv");
    std::fs::write(&rig_log, log).unwrap();
    std::fs::write(folder.path().join("mapping.yaml"), mapping).unwrap();
    let heavy = Config::load(root().join("tests/data/heavy.yaml")).unwrap();
    let follow = heavy.with_value("calibration.follow", true).unwrap();
    let config = folder.path().join("follow.conf");
    std::fs::write(&config, follow.to_yaml().unwrap()).unwrap();

    let program = |arguments: &[&str]| {
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(arguments);
        command
    };
    let mut twin = program(&["run", "--config"]);
    twin.arg(&config).arg("--record").arg(&live);
    let mut twin = Program::start(twin);
    twin.wait_for("model time runs");
    let mut rig = Program::start(program(&["rig", rig_log.to_str().unwrap()]));
    // 15 s after the start of the rotation, and then once per second. The log has one line per parameter in ten seconds.
    twin.wait_for("parameter calibration.friction_factor is");
    for _ in 0..3 {
        twin.wait_for("asked for by calibration.follow");
    }
    rig.signal("INT");
    rig.end();
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0), "{}", twin.said());

    let moved = changes(&live);
    assert!(moved.len() >= 3, "{moved:?}");
    assert!(
        moved
            .iter()
            .all(|(value, by)| *value > 1.0 && by == "calibration.follow"),
        "{moved:?}"
    );
    let last: Vec<Residuals> = messages(&live, "twin/residuals");
    let last = last.last().unwrap();
    assert!(last.following && last.applied_friction_factor > 1.0, "{last:?}");
    assert_eq!(last.configured_friction_factor, 1.0);

    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["replay".as_ref(), live.as_os_str(), "--out".as_ref(), again.as_os_str()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("exact: the recording has everything"), "{said}");
    assert_eq!(changes(&again), moved);
    // The same comparisons, and the same applied inputs. A value that is not known is not a number, which equals nothing.
    let compared = |bag: &Path| format!("{:?}", messages::<Residuals>(bag, "twin/residuals"));
    assert_eq!(compared(&again), compared(&live));
    assert_eq!(
        messages::<AppliedInputs>(&again, "twin/applied_inputs"),
        messages::<AppliedInputs>(&live, "twin/applied_inputs")
    );
}
