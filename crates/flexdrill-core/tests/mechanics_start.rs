//! A tool that is given as turning under weight begins as a far shorter step says it does.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_core::units::{rad_per_s_to_rpm, rpm_to_rad_per_s};

/// Lowest and highest speed of the bit (r/min) in the first 20 ms with steps of `time_step` (s), and the audit's error
/// (J).
fn first_swing(time_step: f64) -> (f64, f64, f64) {
    let mut tool = ToolDescription::paper();
    tool.static_start = false;
    tool.initial_spin_rate = rpm_to_rad_per_s(40.0);
    let inputs = Inputs {
        rotary_speed: tool.initial_spin_rate,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let settings = SimulationSettings::default().with(|settings| {
        settings.time_step = time_step;
        settings.initial_inputs = inputs;
    });
    let mut twin = Simulation::new(&tool, &settings).unwrap();
    let mut snapshot = twin.new_snapshot();
    let (mut lowest, mut highest) = (f64::MAX, f64::MIN);
    while twin.time() < 0.02 - 1e-9 {
        twin.advance(&inputs).ok().unwrap();
        twin.snapshot(&mut snapshot, false);
        let speed = rad_per_s_to_rpm(snapshot.bit.rotary_speed);
        (lowest, highest) = (lowest.min(speed), highest.max(speed));
    }
    (lowest, highest, snapshot.energy.error)
}

#[test]
fn the_bit_does_not_kick_when_it_starts_turning_under_weight() {
    // At 0.01 ms the wave that the bit's 92 N m send up the pipe is resolved: it brakes the bit by 25 r/min, to a stop
    // when it comes back, and the drive pulls it loose to 86 r/min.
    let (lowest, highest, _) = first_swing(1e-5);
    assert!(
        lowest > -1.0 && (highest - 86.0).abs() < 1.0,
        "{lowest} to {highest} r/min"
    );
    let (coarse_lowest, coarse_highest, error) = first_swing(5e-4);
    // A step of 0.5 ms makes a fifth of the peak's half period: some percent of it, no more kick than creep.
    assert!(coarse_lowest > -1.0, "turned back to {coarse_lowest} r/min");
    assert!(
        (coarse_highest / highest - 1.0).abs() < 0.2,
        "up to {coarse_highest} r/min"
    );
    // Of 96 J that come in; the collisions of the fall onto the low side make most of it.
    assert!(error.abs() < 2.0, "energy error {error} J");
}
