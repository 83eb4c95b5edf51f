//! Hook loads and torques of configurations against closed forms.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::PI;

use flexdrill_config::Config;
use flexdrill_trip::{Assembly, Refusal, unknowns};

/// A straight guide in a straight hole of this inclination (deg), under a string of these sections.
fn config(inclination: f64, sections: &str) -> Config {
    in_hole(inclination, "{straight: {length: 6}}", sections)
}

/// The same in a hole of these sections.
fn in_hole(inclination: f64, hole: &str, sections: &str) -> Config {
    let text = format!(
        "well: {{start_inclination_deg: {inclination}, sections: [{hole}], hole_diameter: 0.118}}
tool:
  links: 40
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080, bending_factor: 0.05, free_curvature: 0}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.118}}
contact: {{inner: {{friction_tangential: 0.2, friction_axial: 0.2}}, outer: {{friction_tangential: 0.3, friction_axial: 0.3}}}}
environment: {{gravity: 9.81, buoyancy_factor: 0.86}}
boundary: {{supports: [{{at: top, body: guide, fix: [psi]}}]}}
string: {{model: line, friction: {{coefficient: 0.25}}, sections: [{sections}]}}
"
    );
    Config::from_text("test.yaml", &text).unwrap()
}

/// Weight per metre of a steel tube in the mud of these configurations (N/m).
fn weight(outer: f64, inner: f64) -> f64 {
    7850.0 * PI / 4.0 * (outer * outer - inner * inner) * 9.81 * 0.86
}

const LIGHT: &str = "outer_diameter: 0.073, inner_diameter: 0.0546";
const HEAVY: &str = "outer_diameter: 0.127, inner_diameter: 0.108";
/// Trip speed (m/s), and the angular speed (rad/s) at which the light pipe slides around as fast as along.
const ALONG: f64 = 0.2;
const SPIN: f64 = ALONG / 0.0365;

#[track_caller]
fn near(what: &str, found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() < within, "{what}: {found}, not {expected}");
}

#[test]
fn one_straight_hole_asks_for_all_weights_and_their_friction() {
    for degrees in [0.0_f64, 35.0, 80.0] {
        let config = config(
            degrees,
            &format!("{{length: 400, {LIGHT}, inclination_deg: {degrees}}}"),
        );
        let assembly = Assembly::of(&config).unwrap();
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let string = weight(0.073, 0.0546);
        let [guide, pipe] = [weight(0.102, 0.080), weight(0.063, 0.032)];
        for depth in [6.0, 2.5, 0.0] {
            let trip = assembly.trip(depth, ALONG, SPIN).unwrap();
            let hangs = 400.0 - (6.0 - depth);
            let along = (string * hangs + (guide + pipe) * 6.0) * cosine;
            let [of_string, of_guide] = [0.25 * string * hangs * sine, 0.3 * (guide + pipe) * 6.0 * sine];
            // The statics of the guide are iterated to 1e-5 of its loads, 2 kN.
            near("weight", trip.weight, along, 1e-6);
            near("out", trip.out[0].hook_load(), along + of_string + of_guide, 0.1);
            near("in", trip.into[0].hook_load(), along - of_string - of_guide, 0.1);
            // The string slides at 45 degrees, the guide along.
            let half = of_string / 2.0_f64.sqrt();
            near("out, turning", trip.out[1].hook_load(), along + half + of_guide, 0.1);
            near("in, turning", trip.into[1].hook_load(), along - half - of_guide, 0.1);
            let torque = half * 0.0365 + 0.2 * 0.0315 * pipe * 6.0 * sine;
            near("torque", trip.out[1].torque(), torque, 1e-6);
            assert_eq!(trip.out[0].torque(), 0.0);
            near(
                "guide",
                trip.out[0].guide_tension(),
                (guide + pipe) * 6.0 * cosine + of_guide,
                0.1,
            );
        }
    }
}

/// Each pipe moves up by what the bit is above the bottom, into the hole of the one above, and the upper end is out of the hole.
#[test]
fn pipes_move_up_through_the_hole() {
    let sections = format!("{{length: 100, {HEAVY}}}, {{length: 200, {LIGHT}, inclination_deg: 60}}");
    let assembly = Assembly::of(&config(60.0, &sections)).unwrap();
    let [heavy, light] = [weight(0.127, 0.108), weight(0.073, 0.0546)];
    let tool = 6.0 * (weight(0.102, 0.080) + weight(0.063, 0.032));
    let (sine, cosine) = 60.0_f64.to_radians().sin_cos();
    for depth in [6.0, 1.0] {
        let raised = 6.0 - depth;
        let out = assembly.trip(depth, ALONG, SPIN).unwrap().out[0].clone();
        // 200 m of inclined hole less what the tool fills of it; the light pipe above that has come up into the vertical hole.
        let below_bend = tool * (cosine + 0.3 * sine) + light * (200.0 - raised) * (cosine + 0.25 * sine);
        let above_bend = below_bend * (0.25 * 60.0_f64.to_radians()).exp();
        let expected = above_bend + light * raised + heavy * (100.0 - raised);
        near("out", out.hook_load(), expected, 0.2);
        near("rig", out.stations[0].depth, -300.0, 1e-9);
        near("bit", out.stations.last().unwrap().depth, depth, 1e-9);
    }
}

#[test]
fn depths_without_a_hole_are_refused() {
    let assembly = Assembly::of(&config(0.0, &format!("{{length: 400, {LIGHT}}}"))).unwrap();
    for depth in [-0.1, 6.1, f64::NAN] {
        assert!(
            matches!(assembly.trip(depth, ALONG, SPIN), Err(Refusal::Depth { .. })),
            "{depth}"
        );
    }
}

/// Without a string the loads are those at the tool's top.
#[test]
fn a_tool_without_a_string_has_loads_too() {
    let alone = config(40.0, &format!("{{length: 400, {LIGHT}}}"))
        .with_value("string.model", "none")
        .unwrap();
    let trip = Assembly::of(&alone).unwrap().trip(3.0, ALONG, SPIN).unwrap();
    let tool = 6.0 * (weight(0.102, 0.080) + weight(0.063, 0.032));
    let (sine, cosine) = 40.0_f64.to_radians().sin_cos();
    near("out", trip.out[0].hook_load(), tool * (cosine + 0.3 * sine), 0.1);
    near("top", trip.out[0].stations[0].depth, -3.0, 1e-9);
}

#[test]
fn friction_is_drawn_where_the_configuration_says_nothing() {
    let config = config(40.0, &format!("{{length: 400, {LIGHT}}}"));
    let priors = unknowns::priors(&config).unwrap();
    let names: Vec<&str> = priors.entries().iter().map(|entry| entry.name()).collect();
    // A straight guide has no factor on its curvature.
    assert_eq!(
        names,
        [
            "string.friction.coefficient",
            "contact.outer.friction_axial",
            "contact.inner.friction_tangential",
            "tool.guide.bending_factor",
            "well.hole_diameter",
            "environment.buoyancy_factor",
        ]
    );
    let draws: Vec<f64> = (0..400)
        .map(|member| priors.member(1, member).unwrap().config.string.friction.coefficient)
        .collect();
    let below = draws.iter().filter(|draw| **draw < 0.25 * 0.7).count();
    let above = draws.iter().filter(|draw| **draw > 0.25 * 1.4).count();
    // 5 % of 400, with a standard deviation of 4.4.
    assert!(
        (7..=33).contains(&below) && (7..=33).contains(&above),
        "{below} {above}"
    );
}

#[test]
fn a_hole_drilled_with_the_curvature_of_an_arc_has_the_loads_of_the_arc() {
    let (radius, points) = (3.2, 195);
    let degrees = (0.02 * f64::from(points) / radius).to_degrees();
    let point = format!("[{}, 0.0]", 1.0 / radius);
    let drilled = vec![point; points as usize].join(", ");
    let string = format!("{{length: 400, {LIGHT}, inclination_deg: 0}}");
    let [arc, drilled] = [
        format!("{{arc: {{radius: {radius}, build_angle_deg: {degrees}}}}}"),
        format!("{{drilled: {{points: [{drilled}]}}}}"),
    ]
    .map(|hole| in_hole(0.0, &format!("{{straight: {{length: 2}}}}, {hole}"), &string))
    .map(|config| Assembly::of(&config).unwrap());
    // On the bottom, and with the bit between two points in the bend.
    for depth in [5.9, 4.0] {
        let [expected, found] = [&arc, &drilled].map(|assembly| assembly.trip(depth, ALONG, SPIN).unwrap());
        // Chords and steps are the same: the statics of the guide are iterated to 1e-5 of its loads, some 10 kN.
        near("weight", found.weight, expected.weight, 1e-3);
        for motion in [0, 1] {
            near(
                "out",
                found.out[motion].hook_load(),
                expected.out[motion].hook_load(),
                0.2,
            );
            near(
                "in",
                found.into[motion].hook_load(),
                expected.into[motion].hook_load(),
                0.2,
            );
            near(
                "torque",
                found.out[motion].torque(),
                expected.out[motion].torque(),
                1e-3,
            );
        }
        assert!(
            found.out[0].hook_load() > found.weight + 100.0,
            "a straight guide in a bend rubs"
        );
    }
}
