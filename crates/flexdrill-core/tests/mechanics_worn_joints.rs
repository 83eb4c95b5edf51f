//! The whole tool with friction in its pins, with play, and with links that shorten: the audit closes, the chain moves as
//! the stations do, and a run continues from a checkpoint and after a reset to the bit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::{Body, Direction, Shortening, ToolDescription, WobPath};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use support::coarse;

const INPUTS: Inputs = Inputs {
    rotary_speed: 4.19,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

fn with_friction(mut tool: ToolDescription) -> ToolDescription {
    tool.joint.friction.coefficient = 0.1;
    tool
}

fn with_play(mut tool: ToolDescription) -> ToolDescription {
    tool.joint.play.half_angle = 0.145_f64.to_radians();
    tool
}

fn with_shortening(mut tool: ToolDescription) -> ToolDescription {
    tool.shortening = Shortening::SecondOrder;
    tool
}

fn settings() -> SimulationSettings {
    SimulationSettings::default().with(|settings| {
        settings.initial_inputs = INPUTS;
        settings.rotary_speed_slew = 8.0;
    })
}

fn advance(simulation: &mut Simulation, steps: u32) {
    for _ in 0..steps {
        simulation.advance(&INPUTS).ok().unwrap();
    }
}

#[test]
fn the_audit_closes_and_the_pins_take_what_swinging_joints_must() {
    for (name, tool) in [
        ("as the paper's", coarse()),
        ("friction", with_friction(coarse())),
        ("play", with_play(coarse())),
        ("shortening", with_shortening(coarse())),
    ] {
        let mut simulation = Simulation::new(&tool, &settings()).unwrap();
        advance(&mut simulation, 4000);
        let (before, angle) = (*simulation.energy(), simulation.applied().rotary_speed);
        advance(&mut simulation, 6000);
        let audit = simulation.energy();
        let worked = audit.drive - before.drive;
        let error = (audit.error - before.error) / worked;
        let torque = (audit.joint_friction - before.joint_friction) / (angle * 3.0);
        let counters = simulation.solver_counters();
        eprintln!(
            "{name}: error {:.3} %, joint friction {torque:.2} N m, drive {:.2} N m, iterations {:.3}, halved {}, \
             bottom {:.3} mm",
            100.0 * error,
            worked / (angle * 3.0),
            counters.newton_iterations as f64 / 10_000.0,
            counters.halved_steps,
            1e3 * simulation
                .displacement(simulation.last_station(), Body::Pipe, Direction::U)
                .unwrap()
        );
        // A tenth of what contacts and damping dissipate (37 J per turn of 581 J) is the bound of a good model quality.
        assert!(error.abs() < 0.01, "{name}: {error}");
        if tool.joint.friction.coefficient > 0.0 {
            // 32 joints that swing by the well's 2.73 to the limit's 6 degrees take 5.4 to 11.8 N m under 92 N m; joints at
            // their stops on one side swing less.
            assert!((2.5..12.0).contains(&torque), "{torque} N m");
            let now = simulation.joint_friction();
            assert!(now.len() == 32 && now.iter().all(|power| *power >= 0.0), "{now:?}");
        } else {
            assert_eq!((torque, simulation.joint_friction().len()), (0.0, 0));
        }
    }
}

#[test]
fn runs_continue_from_checkpoints_and_after_a_reset_to_the_bit() {
    let tool = with_shortening(with_play(with_friction(coarse())));
    let mut whole = Simulation::new(&tool, &settings()).unwrap();
    advance(&mut whole, 300);
    let saved = whole.checkpoint().unwrap();
    advance(&mut whole, 300);
    let end = whole.checkpoint().unwrap();
    let mut resumed = Simulation::new(&tool, &settings()).unwrap();
    resumed.restore(&saved).unwrap();
    advance(&mut resumed, 300);
    assert!(resumed.checkpoint().unwrap() == end, "the resumed run has other bits");
    let state = whole.state();
    whole.reset();
    advance(&mut whole, 600);
    assert!(whole.state() == state, "the run after a reset has other bits");
}

/// Over 50 ms from rest the chain moves as all stations do.
#[test]
fn the_chain_moves_as_the_stations_do() {
    for tool in [
        with_friction(coarse()),
        with_play(coarse()),
        with_shortening(coarse()),
        with_shortening(coarse()).with(|tool| tool.wob_path = WobPath::Shared),
    ] {
        let [mut chain, mut stations] = [SolverKind::Chain, SolverKind::Stations]
            .map(|solver| Simulation::with_solver(&tool, &settings(), solver, Instructions::best()).unwrap());
        advance(&mut chain, 100);
        advance(&mut stations, 100);
        let mut apart = 0.0_f64;
        for station in 0..=chain.last_station() {
            for direction in [Direction::U, Direction::V, Direction::W] {
                let of = |simulation: &Simulation| simulation.displacement(station, Body::Pipe, direction).unwrap();
                apart = apart.max((of(&chain) - of(&stations)).abs());
            }
        }
        eprintln!("{apart:e} m apart");
        // Inner stations that are slaved, and what Newton leaves: the paper's tool is 0.2 um apart after 3 s. With play
        // it is not determined where in its play a joint without torque rests, 0.145 degrees at 31.5 mm.
        let most = if tool.joint.play.half_angle > 0.0 { 8e-5 } else { 2e-6 };
        assert!(apart < most, "{apart} m");
    }
}
