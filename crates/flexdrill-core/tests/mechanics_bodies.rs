//! Bodies on nodes in the whole chain: an unbalance turns with the pipe, its account of energy closes, and the bit's
//! inertia slows what the bit does.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::Scheme;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, Location, PointMass, ToolDescription};
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};

const SPEED: f64 = 20.0;

/// A short chain without contact, bit torque and damping, turning from the start, with a body at its joint.
fn unbalanced(eccentricity: f64) -> ToolDescription {
    let mut tool = support::tiny();
    tool.static_start = false;
    tool.initial_spin_rate = SPEED;
    (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
    tool.bit.friction_factor = 0.0;
    tool.masses = vec![PointMass {
        location: Location::Joint(0),
        body: Body::Pipe,
        mass: 5.0,
        axial_inertia: 0.02,
        transverse_inertia: 0.015,
        eccentricity,
        eccentricity_phase: 0.3,
    }];
    tool
}

fn run(tool: &ToolDescription, time_step: f64, duration: f64) -> Snapshot {
    let inputs = Inputs {
        rotary_speed: SPEED,
        weight_on_bit: 0.0,
        ..Inputs::default()
    };
    let settings = SimulationSettings::default().with(|settings| {
        settings.time_step = time_step;
        settings.scheme = Scheme::newmark(0.5);
        settings.initial_inputs = inputs;
    });
    let mut twin = Simulation::new(tool, &settings).unwrap();
    while twin.time() < duration - 1e-9 {
        twin.advance(&inputs).ok().unwrap();
    }
    twin.new_snapshot()
}

#[test]
fn the_account_of_energy_closes_with_an_unbalance() {
    let (balanced, unbalanced) = (run(&unbalanced(0.0), 1e-4, 1.0), run(&unbalanced(0.01), 1e-4, 1.0));
    let energy = unbalanced.energy;
    // The chain stands out of balance under gravity and the unbalance: some joules go to and fro.
    let turnover = energy.gravity.abs() + energy.drive.abs() + energy.rayleigh_damping;
    assert!(turnover > 1.0, "nothing moves: {turnover} J");
    assert!(
        energy.drive != balanced.energy.drive,
        "the unbalance does nothing to the drive"
    );
    // What the quadrature of joint rows and Newton leave, step by step.
    assert!(energy.error.abs() < 1e-3 * turnover, "{} of {turnover} J", energy.error);
    // gamma 1/2 takes nothing but what the quadrature of the turning mass leaves, of second order.
    assert!(
        energy.numerical_damping.abs() < 1e-2 * turnover,
        "{} of {turnover} J",
        energy.numerical_damping
    );
}

#[test]
fn inertia_slows_the_bit() {
    let peak = |inertia: f64| {
        let mut tool = ToolDescription::paper().with_mesh(33, 2);
        tool.bit.inertia = inertia;
        let inputs = Inputs {
            rotary_speed: 4.0,
            weight_on_bit: 10e3,
            ..Inputs::default()
        };
        let settings = SimulationSettings::default().with(|settings| {
            settings.initial_inputs = inputs;
            settings.rotary_speed_slew = 1e3;
        });
        let mut twin = Simulation::new(&tool, &settings).unwrap();
        let mut snapshot = twin.new_snapshot();
        let mut fastest = 0.0_f64;
        while twin.time() < 1.0 {
            twin.advance(&inputs).ok().unwrap();
            twin.snapshot(&mut snapshot, false);
            fastest = fastest.max(snapshot.bit.tangential_acceleration);
        }
        fastest
    };
    let (without, with) = (peak(0.0), peak(0.5));
    // Half a kg m2 is four times the whole pipe's inertia.
    assert!(with < 0.5 * without, "{with} against {without} m/s2");
}
