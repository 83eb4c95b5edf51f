//! The paper's tool moves with the same bits from version to version.
//!
//! Physics beyond the paper is switched off unless a description asks for it. Each record below is a digest of every
//! displacement, velocity and acceleration after a run of the tool without that physics. A change of arithmetic that is
//! meant changes these records in the same commit, and says so in the change log.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{ToolDescription, WobPath};

/// FNV-1a over the bits of all numbers: a digest that depends on nothing but the numbers and their order.
fn digest(numbers: impl Iterator<Item = f64>) -> u64 {
    numbers
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        })
}

/// Digest of the motion of `tool` after `steps` steps of an increasing speed under 10 kN.
fn motion(tool: &ToolDescription, steps: u64) -> u64 {
    let mut simulation = support::simulation(tool);
    for step in 0..steps {
        let inputs = Inputs {
            rotary_speed: 8.0 * (step as f64 / steps as f64).min(0.5),
            weight_on_bit: 10e3,
            ..Inputs::default()
        };
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
    }
    let state = simulation.state();
    digest(state.q.iter().chain(&state.v).chain(&state.a).copied())
}

#[test]
fn regress_the_papers_tool_keeps_its_bits() {
    assert_eq!(
        format!("{:016x}", motion(&ToolDescription::paper(), 1000)),
        "9fa60e1e1c1555f3"
    );
}

#[test]
fn regress_a_hinged_tool_keeps_its_bits() {
    assert_eq!(format!("{:016x}", motion(&support::hinged(), 500)), "7908a07c7e5bfe9b");
}

#[test]
fn regress_a_tied_tool_keeps_its_bits() {
    let tied = ToolDescription::paper().with_mesh(33, 2).with(|tool| {
        tool.wob_path = WobPath::Shared;
    });
    assert_eq!(format!("{:016x}", motion(&tied, 500)), "ed94249a3801e536");
}
