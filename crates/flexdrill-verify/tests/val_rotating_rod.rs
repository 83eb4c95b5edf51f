//! A rod that is pushed into a tube with rotation.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../../flexdrill-core/tests/support/figures.rs"]
mod figures;

use std::f64::consts::TAU;

use figures::figure;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, SectionProperties};
use flexdrill_core::twin::Simulation;

/// A rod of 50 mm in a level tube, with as much penetration as its weight has.
const ROD: &str = "
well: {start_inclination_deg: 90, sections: [{straight: {length: 0.5}}], hole_diameter: 0.090}
tool:
  links: 1
  elements_per_link: 1
  pipe: {outer_diameter: 0.050, inner_diameter: 0}
  guide: {outer_diameter: 0.080, inner_diameter: 0.060, fixed: true}
  joint: {limit_deg: 10}
  damping: {alpha: 0, beta: 0}
  bit: {diameter: 0.090, friction_factor: 0}
contact:
  inner: {stiffness: 1.0e6, damping: 0.5, friction_tangential: 0.2, friction_axial: 0.2, friction: vector}
  slip_speed: 1.0e-5
environment: {gravity: 9.81, buoyancy_factor: 1}
boundary:
  preset: none
  supports: [{at: all, body: pipe, fix: [v, phi_y, phi_z]}]
start: as_given
initial: {velocity: [0.1, 0, 0], displacement: [0, 0, 0.00503780146]}
solver: {time_step: 0.0001}
";

/// Sliding speed along the tube at the start (m/s).
const ALONG: f64 = 0.1;

/// Axial drag of the rod over its weight times the coefficient of friction, in the first milliseconds, with the sliding
/// speed `around` times that along.
fn drag(around: f64) -> f64 {
    let rpm = 60.0 / TAU * around * ALONG / 0.025;
    let config = Config::from_text("a rod in a tube", ROD).unwrap();
    let config = config
        .with_values(
            "a rod in a tube",
            [
                ("initial.spin_rpm", rpm),
                ("inputs.rotary_speed.max_rpm", 5000.0),
                ("inputs.rotary_speed.initial_rpm", rpm),
            ],
        )
        .unwrap();
    let tool = config.tool();
    let mass = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0).mass * config.well.length();
    let mut twin = Simulation::new(&tool, &config.simulation()).unwrap();
    let inputs = Inputs {
        rotary_speed: twin.settings().initial_inputs.rotary_speed,
        ..Inputs::default()
    };
    let (mut sum, mut steps) = (0.0, 0.0);
    for _ in 0..20 {
        twin.advance(&inputs).ok().unwrap();
        let station = |at| twin.axial_friction(at, Body::Pipe).unwrap();
        sum -= station(0) + station(1);
        steps += 1.0;
    }
    sum / steps / (0.2 * mass * tool.gravity)
}

/// Source: J. Appl. Mech. 83 (5), 051003: a rod pushed into a tube reaches up to 5 times further with rotation (abstract;
/// measured). The abstract has neither the speeds along and around nor the stiffness of the rod, so no single figure of
/// ours can be compared with it to 15 %. In the twin the reach F / (mu w f) of a push F grows by 1 / f =
/// sqrt(1 + (u / v)^2), and only the speeds decide: 5 at u / v = 4.90, and more beyond. A measured rod does not gain more
/// than 5, because it also locks up by buckling. The twin's ratio without buckling is therefore a bound from above. This
/// test holds the ratio itself, and that it passes 5.
///
/// Tolerance 3 %: without rotation the rod loses 4 % of its speed along, mu g t / v, in the 2 ms that are averaged; with
/// rotation f falls with it, on average by 2 % at most.
#[test]
fn val_reach_of_a_rotating_rod_is_bounded_from_above() {
    let still = drag(0.0);
    assert!((still - 1.0).abs() < 1e-2, "{still}");
    for around in [1.0, 24.0_f64.sqrt(), 10.0] {
        let ours = still / drag(around);
        let expected = (1.0 + around * around).sqrt();
        let quantity = format!("reach with rotation over that without, u / v = {around:.2} (-)");
        figure(&quantity, expected, ours, 0.03);
    }
    let published = 5.0;
    assert!(still / drag(10.0) > published);
}
