//! A checkpoint goes back only to the tool and settings that it was made with, and only whole. Each of these was
//! restored silently before checkpoints carried an identity and a checksum.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::Scheme;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{CheckpointError, Simulation, SimulationSettings};
use support::tiny;

const INPUTS: Inputs = Inputs {
    rotary_speed: 4.0,
    weight_on_bit: 1e3,
    ..Inputs::ZERO
};

fn simulation(tool: &ToolDescription, settings: &SimulationSettings) -> Simulation {
    let mut simulation = Simulation::new(tool, settings).unwrap();
    for _ in 0..50 {
        simulation.advance(&INPUTS).ok().unwrap();
    }
    simulation
}

fn error_of(simulation: &mut Simulation, bytes: &[u8]) -> CheckpointError {
    let before = simulation.checkpoint().unwrap();
    let error = simulation.restore(bytes).unwrap_err();
    assert_eq!(
        simulation.checkpoint().unwrap(),
        before,
        "a refused checkpoint changed something"
    );
    error
}

#[test]
fn another_tool_or_other_settings_are_refused() {
    let (tool, settings) = (tiny(), SimulationSettings::default());
    let mut own = simulation(&tool, &settings);
    let mut others: Vec<(&str, ToolDescription, SimulationSettings)> = Vec::new();
    let mut with_tool = |name, change: fn(&mut ToolDescription)| {
        let mut changed = tool.clone();
        change(&mut changed);
        others.push((name, changed, settings.clone()));
    };
    with_tool("stiffness", |tool| tool.inner.stiffness = 2e7);
    with_tool("friction", |tool| tool.outer.friction_axial = 0.31);
    with_tool("friction of an interval", |tool| tool.wall_friction_factors.arc = 1.1);
    with_tool("a single bit", |tool| {
        tool.gravity = f64::from_bits(tool.gravity.to_bits() + 1);
    });
    with_tool("mesh", |tool| *tool = tool.clone().with_mesh(2, 2));
    let mut with_settings = |name, change: fn(&mut SimulationSettings)| {
        let mut changed = settings.clone();
        change(&mut changed);
        others.push((name, tool.clone(), changed));
    };
    with_settings("rho_infinity", |settings| {
        settings.scheme = Scheme::generalised_alpha(0.46)
    });
    with_settings("time step", |settings| settings.time_step = 0.25e-3);
    with_settings("whirl threshold", |settings| settings.whirl.min_confidence = 0.4);
    for (name, tool, settings) in others {
        let foreign = simulation(&tool, &settings).checkpoint().unwrap();
        let error = error_of(&mut own, &foreign);
        assert!(matches!(error, CheckpointError::OtherTool { .. }), "{name}: {error}");
        assert!(
            error.to_string().contains("with the configuration it was saved with"),
            "{error}"
        );
    }
}

/// A run that failed is continued with other limits.
#[test]
fn other_limits_on_iterations_and_halvings_are_taken() {
    let saved = simulation(&tiny(), &SimulationSettings::default())
        .checkpoint()
        .unwrap();
    let settings = SimulationSettings::default().with(|settings| {
        settings.max_iterations = 30;
        settings.max_halvings = 8;
    });
    simulation(&tiny(), &settings).restore(&saved).unwrap();
}

#[test]
fn changed_bytes_are_found() {
    let mut own = simulation(&tiny(), &SimulationSettings::default());
    let good = own.checkpoint().unwrap();
    // All bytes of both ends, and of the rest, which one checksum covers alike, enough to meet each of its words' places.
    let (begin, end) = (0..256, good.len() - 64..good.len());
    for at in begin.chain((256..good.len() - 64).step_by(37)).chain(end) {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        let error = own.restore(&bytes).unwrap_err();
        let expected = match at {
            0..8 => matches!(error, CheckpointError::NotACheckpoint),
            8..12 => matches!(error, CheckpointError::Format { .. }),
            _ => matches!(error, CheckpointError::Damaged { .. }),
        };
        assert!(expected, "byte {at}: {error}");
    }
    assert_eq!(own.checkpoint().unwrap(), good);
}

#[test]
fn every_shorter_or_longer_one_is_refused() {
    let mut own = simulation(&tiny(), &SimulationSettings::default());
    let good = own.checkpoint().unwrap();
    for length in (0..200).chain(good.len() - 200..good.len()) {
        let error = error_of(&mut own, &good[..length]);
        let expected = match length {
            0..8 => matches!(error, CheckpointError::NotACheckpoint),
            _ => matches!(error, CheckpointError::Damaged { .. }),
        };
        assert!(expected, "{length} bytes: {error}");
    }
    let longer = [good.as_slice(), &[0]].concat();
    assert!(matches!(error_of(&mut own, &longer), CheckpointError::Damaged { .. }));
}

#[test]
fn other_formats_say_so() {
    let mut own = simulation(&tiny(), &SimulationSettings::default());
    let mut bytes = own.checkpoint().unwrap();
    for format in [0_u32, 1, 4, 77] {
        bytes[8..12].copy_from_slice(&format.to_le_bytes());
        let error = error_of(&mut own, &bytes);
        assert!(
            matches!(error, CheckpointError::Format { found } if found == format),
            "{error}"
        );
        assert!(
            error
                .to_string()
                .contains(&format!("format {format}, this build reads format 25")),
            "{error}"
        );
    }
    // Those from before there were format numbers began with the state.
    let older = &bytes[44..];
    assert!(matches!(error_of(&mut own, older), CheckpointError::NotACheckpoint));
}

#[test]
fn what_may_change_while_running_is_restored() {
    let (tool, settings) = (tiny(), SimulationSettings::default());
    let mut changed = simulation(&tool, &settings);
    let mut live = changed.live();
    live.inner_friction = [0.1, 0.15];
    changed.set_live(live).unwrap();
    changed.set_slew(1.0, 2e3).unwrap();
    let mut whirl = settings.whirl;
    whirl.min_confidence = 0.7;
    changed.set_whirl(&whirl).unwrap();
    let mut fresh = Simulation::new(&tool, &settings).unwrap();
    fresh.restore(&changed.checkpoint().unwrap()).unwrap();
    assert_eq!(fresh.live(), live);
    for _ in 0..200 {
        changed.advance(&INPUTS).ok().unwrap();
        fresh.advance(&INPUTS).ok().unwrap();
    }
    assert_eq!(fresh.checkpoint().unwrap(), changed.checkpoint().unwrap());
}

/// Advance and pressure approach their targets by their slew limits, are part of a checkpoint, and come back from it.
#[test]
fn advance_and_pressure_follow_their_slew_limits_and_continue_from_a_checkpoint() {
    let settings = SimulationSettings::default().with(|settings| {
        settings.rate_of_penetration_slew = 1e-3;
        settings.standpipe_pressure_slew = 2e6;
    });
    let mut twin = Simulation::new(&ToolDescription::paper().with_mesh(8, 2), &settings).unwrap();
    let inputs = Inputs {
        rate_of_penetration: -1e-3,
        standpipe_pressure: 5e6,
        ..INPUTS
    };
    let mut snapshot = twin.new_snapshot();
    for _ in 0..20 {
        assert!(twin.advance(&inputs).ok().is_ok());
    }
    twin.snapshot(&mut snapshot, true);
    // 20 steps of 0.5 ms.
    assert!(
        (snapshot.applied.rate_of_penetration + 1e-5).abs() < 1e-12,
        "{:?}",
        snapshot.applied
    );
    assert!(
        (snapshot.applied.standpipe_pressure - 2e4).abs() < 1e-6,
        "{:?}",
        snapshot.applied
    );
    let saved = twin.checkpoint().unwrap();
    let mut other = Simulation::new(&ToolDescription::paper().with_mesh(8, 2), &settings).unwrap();
    other.restore(&saved).unwrap();
    for twin in [&mut twin, &mut other] {
        for _ in 0..20 {
            assert!(twin.advance(&inputs).ok().is_ok());
        }
    }
    let mut continued = other.new_snapshot();
    twin.snapshot(&mut snapshot, true);
    other.snapshot(&mut continued, true);
    assert_eq!(snapshot.applied, continued.applied);
    twin.reset();
    twin.snapshot(&mut snapshot, true);
    assert_eq!(
        (
            snapshot.applied.rate_of_penetration,
            snapshot.applied.standpipe_pressure
        ),
        (0.0, 0.0)
    );
}
