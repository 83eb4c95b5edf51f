//! Friction that changes while the tool drills: the audit stays closed, no step is halved or rejected because of it, and the
//! torque goes where the new coefficient takes it. `calibration.follow` changes friction every second.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{FrictionLaw, LiveParameters, ToolDescription};
use flexdrill_core::twin::Simulation;
use support::{coarse, simulation};

/// Drilling of the paper's tool: 40 r/min and 10 kN.
const DRILLING: Inputs = Inputs {
    rotary_speed: 4.19,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

/// What ten seconds of drilling do: error of the audit over the work of the drive, rejected sub-steps, and the mean
/// iterations per step, with both layers' friction times `factor` of each second.
fn ten_seconds(simulation: &mut Simulation, own: LiveParameters, factor: impl Fn(u32) -> f64) -> (f64, u64) {
    let before = (*simulation.energy(), simulation.solver_counters().rejected);
    let per_second = (1.0 / simulation.settings().time_step).round() as u32;
    for second in 0..10 {
        let times = factor(second);
        simulation
            .set_live(LiveParameters {
                inner_friction: own.inner_friction.map(|friction| times * friction),
                outer_friction: own.outer_friction.map(|friction| times * friction),
                ..own
            })
            .unwrap();
        for _ in 0..per_second {
            let _ = simulation.advance(&DRILLING);
        }
    }
    let after = *simulation.energy();
    (
        (after.error - before.0.error).abs() / (after.drive - before.0.drive),
        simulation.solver_counters().rejected - before.1,
    )
}

fn tool(law: FrictionLaw) -> ToolDescription {
    coarse().with(|tool| {
        tool.inner.friction_law = law;
        tool.outer.friction_law = law;
    })
}

#[test]
fn friction_that_follows_a_rig_neither_opens_the_audit_nor_costs_a_step() {
    for law in [FrictionLaw::Separate, FrictionLaw::Vector, FrictionLaw::Bristle] {
        let mut begun = simulation(&tool(law));
        let own = begun.live();
        ten_seconds(&mut begun, own, |_| 1.0);
        let mut constant = begun.fork();
        let calm = ten_seconds(&mut constant, own, |_| 1.0);
        // The fastest that the configuration allows, up and down: one per minute.
        let mut moving = begun.fork();
        let followed = ten_seconds(&mut moving, own, |second| {
            1.0 + (1.0 + f64::from(5 - (second.abs_diff(5)))) / 60.0
        });
        // A jump by a fifth, as a client may set it.
        let mut jumping = begun.fork();
        let jumped = ten_seconds(&mut jumping, own, |second| if second % 2 == 0 { 1.2 } else { 0.8 });
        for (name, (error, rejected)) in [("followed", followed), ("jumped", jumped)] {
            // The error of the whole tool's audit is that of its collisions, which differ from run to run of this chaotic
            // motion; a tenth of a per cent of the drive's work is what the audit of the paper's case may have.
            assert!(error < calm.0 + 1e-3, "{law:?} {name}: {error:e} against {:e}", calm.0);
            assert!(
                rejected <= calm.1,
                "{law:?} {name}: {rejected} rejected against {}",
                calm.1
            );
        }
    }
}
