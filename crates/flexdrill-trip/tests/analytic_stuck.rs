//! What reaches a stuck tool, against closed forms and a rope that is integrated from the rig down.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::{FRAC_PI_2, PI};

use flexdrill_config::Config;
use flexdrill_trip::{Assembly, Limits};

fn config(start: f64, well: &str, guide: &str, sections: &str) -> Config {
    let text = format!(
        "well: {{start_inclination_deg: {start}, sections: [{well}], hole_diameter: 0.103}}
tool:
  links: 40
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080, {guide}}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.103}}
contact: {{inner: {{friction_tangential: 0.2, friction_axial: 0.2}}, outer: {{friction_tangential: 0.3, friction_axial: 0.3}}}}
environment: {{gravity: 9.81, buoyancy_factor: 0.86}}
boundary: {{supports: [{{at: top, body: guide, fix: [psi]}}]}}
string: {{model: line, friction: {{coefficient: 0.25}}, sections: [{sections}]}}
"
    );
    Config::from_text("test.yaml", &text).unwrap()
}

const STRAIGHT: &str = "bending_factor: 0.05, free_curvature: 0";
const PIPE: &str = "outer_diameter: 0.073, inner_diameter: 0.0546";

/// A tool of 6 m and a string of 400 m in one hole of 60 deg.
fn inclined() -> Assembly {
    let string = format!("{{length: 400, {PIPE}, inclination_deg: 60}}");
    Assembly::of(&config(60.0, "{straight: {length: 6}}", STRAIGHT, &string)).unwrap()
}

fn weight(outer: f64, inner: f64) -> f64 {
    7850.0 * PI / 4.0 * (outer * outer - inner * inner) * 9.81 * 0.86
}

/// Weights of string and tool (N) and their friction (N) in a hole of 60 deg.
fn of_inclined() -> [f64; 4] {
    let string = 400.0 * weight(0.073, 0.0546);
    let tool = 6.0 * (weight(0.102, 0.080) + weight(0.063, 0.032));
    let sine = 60.0_f64.to_radians().sin();
    [string * 0.5, tool * 0.5, 0.25 * string * sine, 0.3 * tool * sine]
}

fn limits(pull: f64) -> Limits {
    Limits {
        pull,
        guide: None,
        torque: 3000.0,
    }
}

#[track_caller]
fn near(what: &str, found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() < within, "{what}: {found}, not {expected}");
}

#[test]
fn a_pull_beyond_that_of_pulling_out_arrives_at_the_bit() {
    let [string, tool, of_string, of_tool] = of_inclined();
    let out = string + tool + of_string + of_tool;
    let stuck = inclined().stuck(6.0, &limits(out + 50e3)).unwrap();
    // The statics of the guide to 1e-5 of its loads, and the pull to 1e-5.
    near("at the bit", stuck.at_bit, 50e3, 3.0);
    assert_eq!((stuck.holds_at, stuck.guide_limits), (None, false));
    for at in &stuck.reached {
        // The tension takes some 30 N of wall force from the guide's middle to its ends, whose friction is 0.3 of that.
        near("overpull", at.overpull, 50e3, 15.0);
    }
    // Friction grows with its coefficient alone: (pull - weight) / friction.
    let factor = (out + 50e3 - string - tool) / (of_string + of_tool);
    near("critical factor", stuck.critical_factor.unwrap(), factor, 1e-4 * factor);
}

/// From the run-in on, friction turns round from the rig down to s = (P - H_in) / (2 mu w sin i).
#[test]
fn a_smaller_pull_holds_where_it_meets_the_run_in() {
    let [string, tool, of_string, of_tool] = of_inclined();
    let run_in = string + tool - of_string - of_tool;
    for share in [0.25, 0.75] {
        let pull = run_in + 2.0 * share * of_string;
        let stuck = inclined().stuck(6.0, &limits(pull)).unwrap();
        assert_eq!(stuck.at_bit, 0.0);
        near("holds at", stuck.holds_at.unwrap(), 400.0 * share - 400.0, 1e-2);
        assert!(stuck.reached.last().unwrap().overpull < 0.0);
    }
    // In the guide of 6 m, half of whose friction is turned round.
    let stuck = inclined()
        .stuck(6.0, &limits(run_in + 2.0 * of_string + of_tool))
        .unwrap();
    // A straight guide bears on the wall in its middle and at its ends: the friction is not quite even along it.
    near("holds in the guide", stuck.holds_at.unwrap(), 3.0, 0.5);
    // Less than the run-in shows: the hook does not even move.
    near(
        "at the rig",
        inclined().stuck(6.0, &limits(run_in - 1e3)).unwrap().holds_at.unwrap(),
        -400.0,
        1e-9,
    );
}

#[test]
fn a_bend_takes_its_share_of_the_pull() {
    let string = format!("{{length: 100, {PIPE}}}, {{length: 200, {PIPE}, inclination_deg: 60}}");
    let assembly = Assembly::of(&config(60.0, "{straight: {length: 6}}", STRAIGHT, &string)).unwrap();
    let pipe = weight(0.073, 0.0546);
    let [_, tool, _, of_tool] = of_inclined();
    let (sine, cosine) = 60.0_f64.to_radians().sin_cos();
    let bend = (0.25 * PI / 3.0).exp();
    let out = (tool + of_tool + 200.0 * pipe * (cosine + 0.25 * sine)) * bend + 100.0 * pipe;
    let stuck = assembly.stuck(6.0, &limits(out + 60e3)).unwrap();
    near("at the bit", stuck.at_bit, 60e3 / bend, 3.0);
    // A pull that lacks 1 kN lacks e^(-mu theta) of it below the bend.
    let lacks = assembly.stuck(6.0, &limits(out - 1e3)).unwrap();
    near("overpull", lacks.reached.last().unwrap().overpull, -1e3 / bend, 1.0);
}

/// A soft guide in an arc under a vertical string: the rope from the rig down, by Euler's rule in 100,000 pieces.
#[test]
fn an_arc_passes_a_pull_as_a_rope_does() {
    let string = format!("{{length: 300, {PIPE}}}");
    let soft = "bending_factor: 0.0008, free_curvature: 0.3125";
    let arc = "{arc: {radius: 3.2, build_angle_deg: 90}}";
    let assembly = Assembly::of(&config(0.0, arc, soft, &string)).unwrap();
    let pull = 300.0 * weight(0.073, 0.0546) + 40e3;
    let per_metre = weight(0.102, 0.080) + weight(0.063, 0.032);
    let mut tension = 40e3;
    let pieces = 100_000;
    let step = FRAC_PI_2 / f64::from(pieces);
    for piece in 0..pieces {
        let (sine, cosine) = ((f64::from(piece) + 0.5) * step).sin_cos();
        tension -= (per_metre * cosine + 0.3 * (tension / 3.2 - per_metre * sine).abs()) * 3.2 * step;
    }
    let stuck = assembly.stuck(3.2 * FRAC_PI_2, &limits(pull)).unwrap();
    // Both ends of the guide stand on the axis, half a millimetre off the wall.
    near("at the bit", stuck.at_bit, tension, 0.01 * tension);
}

#[test]
fn torque_loses_what_rubs_around() {
    let stuck = inclined().stuck(6.0, &limits(200e3)).unwrap();
    let sine = 60.0_f64.to_radians().sin();
    let rubs = 0.25 * 400.0 * weight(0.073, 0.0546) * sine * 0.0365 + 0.2 * 6.0 * weight(0.063, 0.032) * sine * 0.0315;
    near("at the bit", stuck.torque_at_bit(), 3000.0 - rubs, 1e-6);
    assert_eq!(stuck.turns_to, None);
    let weak = Limits {
        torque: 0.5 * rubs,
        ..limits(200e3)
    };
    let stuck = inclined().stuck(6.0, &weak).unwrap();
    assert_eq!(stuck.torque_at_bit(), 0.0);
    assert!(stuck.turns_to.is_some());
}

#[test]
fn the_guide_may_be_the_limit() {
    let [string, tool, of_string, of_tool] = of_inclined();
    let slotted = Limits {
        guide: Some(30e3),
        ..limits(500e3)
    };
    let stuck = inclined().stuck(6.0, &slotted).unwrap();
    assert!(stuck.guide_limits);
    near("pull", stuck.pull, 30e3 + string + of_string, 1e-6);
    near("at the bit", stuck.at_bit, 30e3 - tool - of_tool, 3.0);
}

/// A pull below the weight frees nothing without any friction; without inclination no friction takes a pull.
#[test]
fn the_critical_factor_has_both_ends() {
    let [string, tool, ..] = of_inclined();
    let stuck = inclined().stuck(6.0, &limits(string + tool - 1e3)).unwrap();
    assert_eq!(stuck.critical_factor, Some(0.0));
    let string = format!("{{length: 400, {PIPE}}}");
    let hangs = Assembly::of(&config(0.0, "{straight: {length: 6}}", STRAIGHT, &string)).unwrap();
    assert_eq!(hangs.stuck(6.0, &limits(500e3)).unwrap().critical_factor, None);
}
