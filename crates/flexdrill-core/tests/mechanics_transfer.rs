//! Transfer from the surface to the bit: means over every step, balances of torque and power, figures that a tool does not
//! have.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_motion::{BIT, KICK_OFF, SURFACE, Transfer};
use support::coarse;

const DRILLING: Inputs = Inputs {
    rotary_speed: 4.19,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

fn transfer(simulation: &mut Simulation) -> Transfer {
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    snapshot.transfer
}

/// The paper's tool at 40 r/min and 10 kN, run in.
fn drilling(tool: &ToolDescription, seconds: f64) -> Simulation {
    let settings = SimulationSettings::default().with(|settings| settings.initial_inputs = DRILLING);
    let mut simulation = Simulation::new(tool, &settings).unwrap();
    while simulation.time() < seconds {
        simulation.advance(&DRILLING).ok().unwrap();
    }
    simulation
}

/// Means and root mean squares are those of every step of the last five seconds, not of samples of them.
#[test]
fn the_window_holds_every_step() {
    let mut simulation = drilling(&coarse(), 4.0);
    let (mut sums, mut squares, mut steps) = ([0.0; 2], [0.0; 2], 0.0);
    let audit = *simulation.energy();
    while simulation.time() < 9.0 - 1e-9 {
        simulation.advance(&DRILLING).ok().unwrap();
        let at = [simulation.applied().drive_torque, simulation.bit().torque];
        for (k, torque) in at.into_iter().enumerate() {
            sums[k] += torque;
            squares[k] += torque * torque;
        }
        steps += 1.0;
    }
    let found = transfer(&mut simulation);
    assert!((found.duration - 5.0).abs() < 1e-9, "{}", found.duration);
    for (k, place) in [KICK_OFF, BIT].into_iter().enumerate() {
        let (mean, rms) = (sums[k] / steps, (squares[k] / steps).sqrt());
        // Rounding of ten thousand sums.
        assert!((found.torque.mean[place] / mean - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.torque.rms[place] / rms - 1.0).abs() < 1e-9, "{found:?}");
    }
    let now = simulation.energy();
    for (power, [before, after]) in [
        (found.power.drive, [audit.drive, now.drive]),
        (found.power.bit, [audit.bit, now.bit]),
        (found.power.friction, [audit.friction, now.friction]),
        (found.power.stored, [audit.stored, now.stored]),
        (found.power.error, [audit.error, now.error]),
    ] {
        let mean = (after - before) / 5.0;
        assert!(
            (power - mean).abs() < 1e-9 * found.power.drive.abs(),
            "{power} for {mean}"
        );
    }
}

/// Without a string there is no surface, without a rock that holds the bit no depth of cut. What friction takes explains
/// what does not arrive.
#[test]
fn the_papers_tool_loses_to_friction_what_does_not_arrive() {
    let mut simulation = drilling(&coarse(), 12.0);
    let found = transfer(&mut simulation);
    let Transfer {
        torque,
        weight,
        mean,
        power,
        ..
    } = &found;
    assert!(torque.mean[SURFACE].is_nan() && weight.mean[SURFACE].is_nan() && mean.hook_load.is_nan());
    assert!(mean.depth_of_cut.is_nan() && found.friction_torque[3].is_nan() && mean.axial_drag[2].is_nan());
    assert_eq!((mean.rate_of_penetration, found.friction_torque[2]), (0.0, 0.0));
    assert!((found.torque_efficiency - torque.mean[BIT] / torque.mean[KICK_OFF]).abs() < 1e-12);
    assert!(
        found.torque_efficiency > 0.3 && found.torque_efficiency < 1.0,
        "{found:?}"
    );
    // What is put in, less the bit's, is what friction takes and what the damping of collisions, steel and steps takes.
    let lost = torque.mean[KICK_OFF] - torque.mean[BIT];
    let damped = power.contact_damping + power.rayleigh_damping + power.numerical_damping;
    let explained = found.friction_torque[..3].iter().sum::<f64>() + damped / DRILLING.rotary_speed;
    // A ripple of the stored energy is left over a window: 0.5 W of 410 W.
    assert!(
        (explained / lost - 1.0).abs() < 0.05,
        "{lost} N m lost, {explained} N m explained: {found:?}"
    );
    // Powers: the audit's terms close, and the layers' friction is the audit's by the rectangle rule of a step.
    let put_in = power.drive
        + power.weight_on_bit
        + power.gravity
        + power.loads
        + power.feed
        + power.pressure
        + power.hoist
        + power.axial_update;
    let taken = power.bit
        + power.friction
        + power.contact_damping
        + power.rayleigh_damping
        + power.numerical_damping
        + power.mud
        + power.string;
    assert!(
        (put_in - taken - power.stored - power.error).abs() < 1e-6 * power.drive,
        "{power:?}"
    );
    let layers: f64 = mean.friction_power.iter().sum();
    assert!(
        (layers / power.friction - 1.0).abs() < 0.02,
        "{layers} W in layers of {} W",
        power.friction
    );
}

/// A checkpoint holds the window: a run that continues from it publishes the same bits.
#[test]
fn a_restored_run_publishes_the_same() {
    let mut simulation = drilling(&support::tiny(), 1.03);
    let saved = simulation.checkpoint().unwrap();
    let mut other = drilling(&support::tiny(), 0.2);
    other.restore(&saved).unwrap();
    let bits = |found: &Transfer| format!("{found:?}");
    assert_eq!(bits(&transfer(&mut simulation)), bits(&transfer(&mut other)));
    for _ in 0..1500 {
        simulation.advance(&DRILLING).ok().unwrap();
        other.advance(&DRILLING).ok().unwrap();
    }
    assert_eq!(bits(&transfer(&mut simulation)), bits(&transfer(&mut other)));
    simulation.reset();
    assert_eq!(transfer(&mut simulation).duration, 0.0);
}
