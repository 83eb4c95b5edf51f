//! `twin/hole_ahead` of a run and of its replay: the same bytes, with an answer among them.

use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::HoleAhead;

/// The paper's tool with a soft guide of a known shape, after 70 degrees of its arc.
const TOOL: &str = "
well:
  sections: [{straight: {length: 1.117010}}, {arc: {radius: 3.2, build_angle_deg: 70}}]
  hole_diameter: 0.118
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080, bending_factor: 0.05, free_curvature: 0.3125}
  joint: {limit_deg: 6.0}
  bit: {diameter: 0.118, lateral_resistance: 20}
contact:
  outer: {stiffness: 2.0e+7, friction_tangential: 0.3, friction_axial: 0.3}
environment: {gravity: 9.81, buoyancy_factor: 0.86}
";

fn succeeds(arguments: &[&Path]) {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Time and bytes of each message.
fn messages(of: &Path) -> Vec<(i64, Vec<u8>)> {
    let messages = bag::open(of).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.topic.is("twin/hole_ahead"))
        .map(|message| (message.log_time, message.data.clone()))
        .collect()
}

#[test]
fn a_replay_repeats_where_the_tool_drills() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    std::fs::write(at("tool.yaml"), TOOL).unwrap();
    // 10 kN within a second; the answer for it is asked for at 6 s and used from 11 s on.
    let rows = (0..17).map(|second| format!("{second},60,10\n"));
    let rows: String = std::iter::once("time_s,rpm,wob\n".to_owned()).chain(rows).collect();
    std::fs::write(at("log.csv"), rows).unwrap();
    std::fs::write(
        at("mapping.yaml"),
        "columns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob, unit: kN}}\n",
    )
    .unwrap();
    let [replay, config, mapping, to] = ["replay", "--config", "--mapping", "--out"].map(Path::new);
    let (tool, log, columns) = (at("tool.yaml"), at("log.csv"), at("mapping.yaml"));
    succeeds(&[replay, &log, mapping, &columns, config, &tool, to, &at("run")]);
    succeeds(&[replay, &at("run"), to, &at("again")]);
    let (run, again) = (messages(&at("run")), messages(&at("again")));
    assert!(run.len() >= 15, "{} messages", run.len());
    assert!(run == again, "other messages");

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
}
