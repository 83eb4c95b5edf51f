//! A tool at the end of the hole that it has drilled: its kick-off, the string above it, and its run.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// Length that is drilled (m).
const DRILLED: f64 = 0.4;

/// What keeps the guide from turning where no curvature does.
const HELD: &str = "boundary: {supports: [{at: top, body: guide, fix: [psi]}]}";

/// A short tool with these sections of the hole, below a string with these.
fn config(hole: &str, string: &str) -> Config {
    let held = if hole.contains("arc") { "" } else { HELD };
    let text = format!(
        "
well:
  sections: [{hole}]
  hole_diameter: 0.118
  kick_off_depth: 350
  drilled_from: 0.6
tool:
  links: 7
  elements_per_link: 2
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080, bending_factor: 0.05, free_curvature: 0.3125}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.118}}
string:
  model: line
  sections: [{string}]
{held}
"
    );
    Config::from_text("tool.yaml", &text).unwrap()
}

/// A section of the string.
fn pipe(length: f64, outer: f64, inner: f64, inclination: f64) -> String {
    format!("{{length: {length}, outer_diameter: {outer}, inner_diameter: {inner}, inclination_deg: {inclination}}}")
}

fn before() -> Config {
    config(
        "{straight: {length: 0.6}}, {arc: {radius: 3.2, build_angle_deg: 12}}",
        &[pipe(300.0, 0.089, 0.070, 0.0), pipe(50.0, 0.073, 0.054, 0.0)].join(", "),
    )
}

fn rebased(config: &Config) -> Config {
    config.rebased(&[[1.0 / 3.2, 0.0]; 20], DRILLED / 20.0).unwrap()
}

/// The lengths of the string's sections (m).
fn lengths(config: &Config) -> Vec<f64> {
    config.string.sections.iter().map(|section| section.length).collect()
}

fn near(found: &[f64], expected: &[f64]) {
    let same = found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(same, "{found:?} {expected:?}");
}

#[test]
fn the_kick_off_moves_down_and_the_string_grows() {
    let rebased = rebased(&before());
    near(
        &[rebased.well.kick_off_depth, rebased.well.drilled_from.unwrap()],
        &[350.4, 0.2],
    );
    // The rig adds pipe of the first section.
    near(&lengths(&rebased), &[300.4, 50.0]);
    // A bend of the hole between equal pipes stays, and the hole below it grows.
    let bend = [pipe(300.0, 0.089, 0.070, 0.0), pipe(50.0, 0.089, 0.070, 30.0)].join(", ");
    let bent = config("{straight: {length: 1.2}}", &bend)
        .rebased(&[[0.0; 2]; 20], 0.02)
        .unwrap();
    near(&lengths(&bent), &[300.0, 50.4]);
    // A section that would be shorter than a section may be stays as it is.
    let short = [
        pipe(300.0, 0.089, 0.070, 0.0),
        pipe(10.0, 0.073, 0.054, 0.0),
        pipe(40.0, 0.063, 0.040, 0.0),
    ];
    let short = config("{straight: {length: 1.2}}", &short.join(", "))
        .rebased(&[[0.0; 2]; 20], 0.02)
        .unwrap();
    near(&lengths(&short), &[300.0, 10.4, 40.0]);
    // Without a string nothing grows.
    let text = before().to_yaml().unwrap();
    let without = text.split("\nstring:").next().unwrap();
    let without = Config::from_text("without", without).unwrap();
    assert!(self::rebased(&without).string.sections.is_empty());
}

/// Hook load (N) at rest, and after so many seconds of turning under weight with the torque at the bit (N m).
fn run(config: &Config, seconds: f64) -> [f64; 3] {
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let at_rest = simulation.hook_load().unwrap();
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(20.0),
        weight_on_bit: kn_to_n(2.0),
        ..Inputs::default()
    };
    let steps = (seconds / config.solver.time_step) as usize;
    for _ in 0..steps {
        simulation.advance(&inputs).ok().unwrap();
    }
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    [at_rest, simulation.hook_load().unwrap(), snapshot.bit.torque]
}

/// Against the same tool in the same hole, written by hand: another kind of section for the arc, and a string that is longer.
/// Both runs have the same equations. What is left at first is the rounding of angles and lengths, which Newton's tolerance
/// bounds: 1e-6 of each figure. Within a second the contacts of the turning pipe amplify it a thousand times. Without the longer
/// string the hook would carry 0.4 m of its pipe less.
#[test]
fn a_run_after_it_has_the_figures_of_the_long_path() {
    let turned = 12.0 + (DRILLED / 3.2_f64).to_degrees();
    let long = config(
        &format!("{{straight: {{length: 0.2}}}}, {{arc: {{radius: 3.2, build_angle_deg: {turned}}}}}"),
        &[pipe(300.4, 0.089, 0.070, 0.0), pipe(50.0, 0.073, 0.054, 0.0)].join(", "),
    );
    let tools = [rebased(&before()), long];
    for (seconds, bound) in [(0.1, 1e-6), (1.0, 1e-3)] {
        let [after, by_hand] = [0, 1].map(|tool| run(&tools[tool], seconds));
        println!("{seconds} s: {after:?} {by_hand:?}");
        for (found, expected) in after.iter().zip(by_hand) {
            // The bit has no torque before the weight comes: of a newton metre.
            let size = expected.abs().max(1.0);
            assert!(
                (found - expected).abs() < bound * size,
                "{seconds} s: {after:?} {by_hand:?}"
            );
        }
    }
    // Steel of 89 mm by 70 mm in mud, hanging.
    let config = before();
    let area = std::f64::consts::FRAC_PI_4 * (0.089_f64.powi(2) - 0.070_f64.powi(2));
    let gravity = config.environment.gravity * config.environment.buoyancy_factor;
    let added = area * config.string.material.density * gravity * DRILLED;
    let short = Config::from_text("short", &rebased(&config).to_yaml().unwrap().replace("300.4", "300")).unwrap();
    let [[after, ..], [shorter, ..]] = [&tools[0], &short].map(|config| run(config, 0.0));
    assert!(
        (after - shorter - added).abs() < 1e-3 * added,
        "{after} {shorter} {added}"
    );
}
